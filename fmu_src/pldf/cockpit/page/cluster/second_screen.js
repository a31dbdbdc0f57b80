// The instrument cluster alone in a window: on a second screen, a tablet, in a simulator's car.

import { element, fill } from "../dom.js";
import { speak, wording } from "../language.js";
import { Cluster } from "./cluster.js";
import { Watched } from "./watched.js";

/** @typedef {import("../types.js").HmiTexts} HmiTexts */
/** @typedef {import("../language.js").Language} Language */
/** @typedef {import("./live.js").Explanation} Explanation */
/** @typedef {import("./live.js").Unit} Unit */
/** @typedef {import("./live.js").LiveMessage} LiveMessage */
/**
 * What the address asks for; null: as the drive says.
 * @typedef {object} Wanted
 * @property {string | null} participant only this one's drives
 * @property {Explanation | null} explanation
 * @property {Unit | null} unit of a simulator, which tells none: as its `hmi.unit`
 * @property {Language | null} language
 */

const LOOK_MS = 500;

const words = wording({
  en: {
    title: "Instrument cluster",
    waiting: "Waiting for a drive",
    stale: "No news from the drive",
    lost: "No connection to the server: is pldf cockpit still running?",
    paused: "Paused",
  },
  de: {
    title: "Kombiinstrument",
    waiting: "Wartet auf eine Fahrt",
    stale: "Keine Nachricht von der Fahrt",
    lost: "Keine Verbindung zum Server: Läuft pldf cockpit noch?",
    paused: "Angehalten",
  },
});

/**
 * Return what an address asks for, as `?participant=P07&explanation=icon&unit=MPH&language=de`.
 * @param {string} query
 * @returns {Wanted}
 */
export function wantedBy(query) {
  const asked = new URLSearchParams(query);
  return {
    participant: asked.get("participant"),
    explanation: one(asked.get("explanation"), /** @type {const} */ (["none", "icon", "text"])),
    unit: one(asked.get("unit"), /** @type {const} */ (["KMH", "MPH"])),
    language: one(asked.get("language"), /** @type {const} */ (["en", "de"])),
  };
}

/**
 * @template {string} T
 * @param {string | null} value
 * @param {readonly T[]} known
 * @returns {T | null}
 */
function one(value, known) {
  return known.find((name) => name.toLowerCase() === value?.toLowerCase()) ?? null;
}

/** Fills a window with the cluster of the drive that it hears of. */
export class SecondScreen {
  /**
   * @param {Element} parent
   * @param {HmiTexts} texts
   * @param {Wanted} wanted
   * @param {Language} language of the study
   */
  constructor(parent, texts, wanted, language) {
    this.texts = texts;
    this.wanted = wanted;
    this.language = wanted.language ?? language;
    this.place = element("div", { class: "second-cluster" });
    this.note = element("p", { class: "second-note", role: "status" });
    this.connected = true;
    /** @type {Watched | null} */
    this.drive = null;
    /** what the cluster is made for: another wish makes another cluster */
    this.made = "";
    /** @type {Cluster | null} */
    this.cluster = null;
    fill(parent, this.place, this.note);
    this.look();
    setInterval(() => this.look(), LOOK_MS);
  }

  /** @param {LiveMessage} message */
  take(message) {
    const { participant } = this.wanted;
    if (message.kind === "abort" || (participant !== null && message.participant !== participant))
      return;
    if (this.drive?.participant !== (message.participant ?? "")) {
      this.drive = new Watched(message.participant ?? "");
    }
    this.drive.take(message, performance.now());
    this.look();
  }

  /** @param {boolean} connected to the server */
  connect(connected) {
    this.connected = connected;
    this.look();
  }

  look() {
    const status = this.drive?.status;
    const fresh = this.drive?.isFresh(performance.now()) === true;
    this.make(
      this.wanted.explanation ?? status?.explanation ?? "text",
      status?.unit ?? this.wanted.unit ?? "KMH", // the sentence's numbers are in the drive's unit
      this.wanted.language ?? status?.language ?? this.language,
    );
    this.cluster?.show(fresh && this.drive ? this.drive.values : {});
    const note = !this.connected
      ? words("lost")
      : this.drive === null
        ? words("waiting")
        : status?.state === "paused"
          ? words("paused")
          : fresh
            ? ""
            : words("stale");
    if (this.note.textContent !== note) fill(this.note, note);
  }

  /** @param {Explanation} explanation @param {Unit} unit @param {Language} language */
  make(explanation, unit, language) {
    const wish = [explanation, unit, language].join(" ");
    if (wish === this.made) return;
    this.made = wish;
    speak(language);
    document.title = words("title");
    this.cluster = new Cluster(this.place, this.texts, { explanation, unit });
  }
}
