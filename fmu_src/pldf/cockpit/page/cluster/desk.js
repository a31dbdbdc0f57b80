// The experimenter's page: everybody who drives, side by side.

import { element, fill } from "../dom.js";
import { wording } from "../language.js";
import { DeskCard } from "./desk_card.js";
import { Watched } from "./watched.js";

/** @typedef {import("./live.js").LiveMessage} LiveMessage */
/** @typedef {import("./live.js").AbortMessage} AbortMessage */
/** @typedef {import("../engine/road.js").RoadModel} RoadModel */

const LOOK_MS = 500;

const words = wording({
  en: {
    title: "Experimenter",
    nobody: "Nobody drives yet. This page shows who begins a session.",
    lost: "No connection to the server: is pldf cockpit still running? The drives go on by themselves.",
  },
  de: {
    title: "Versuchsleitung",
    nobody: "Noch fährt niemand. Hier erscheint, wer eine Sitzung beginnt.",
    lost: "Keine Verbindung zum Server: Läuft pldf cockpit noch? Die Fahrten gehen von selbst weiter.",
  },
});

/** Cards of all participants, in the order of their names. */
export class Desk {
  /**
   * @param {Element} parent
   * @param {{texts: import("../types.js").HmiTexts, road: RoadModel,
   *   tell: (message: AbortMessage) => void, recordings: () => Promise<string[]>}} study
   */
  constructor(parent, study) {
    this.study = study;
    /** @type {Map<string, {watched: Watched, card: DeskCard}>} */
    this.people = new Map();
    this.cards = element("div", { class: "desk-cards" });
    this.nobody = element("p", { class: "desk-nobody" }, words("nobody"));
    this.lost = element("p", { class: "desk-lost", role: "alert" });
    document.title = words("title");
    fill(parent, element("h1", {}, words("title")), this.lost, this.nobody, this.cards);
    setInterval(() => this.show(), LOOK_MS);
  }

  /** @param {LiveMessage} message */
  take(message) {
    if (message.kind === "abort") return;
    const name = message.participant ?? "";
    const { watched } = this.people.get(name) ?? this.add(name);
    watched.take(message, performance.now());
    if (message.kind === "status") void this.lookForDrives();
  }

  /** @param {string} participant */
  add(participant) {
    const watched = new Watched(participant);
    const { texts, road, tell } = this.study;
    const abort = (/** @type {string} */ reason) => tell({ kind: "abort", participant, reason });
    const card = new DeskCard(watched, {
      texts,
      limit_mps: road.limit_mps,
      nodes: road.nodes,
      abort,
    });
    const person = { watched, card };
    this.people.set(participant, person);
    const names = [...this.people.keys()].sort((a, b) =>
      a.localeCompare(b, "en", { numeric: true }),
    );
    const next = this.people.get(names[names.indexOf(participant) + 1] ?? "");
    this.cards.insertBefore(card.root, next && next !== person ? next.card.root : null);
    this.nobody.hidden = true;
    return person;
  }

  show() {
    for (const { card } of this.people.values()) card.show(performance.now());
  }

  /** Which drives of whom are safe: only files that are there count. */
  async lookForDrives() {
    const paths = await this.study.recordings().catch(() => []);
    for (const [name, { card }] of this.people) card.store(phasesOf(paths, name));
  }

  /** @param {boolean} connected to the server */
  connect(connected) {
    fill(this.lost, connected ? "" : words("lost"));
  }
}

/**
 * Return the phases of a participant's drives among the paths of recordings.
 * @param {string[]} paths `recordings/P07_A1.csv`
 * @param {string} participant
 * @returns {string[]}
 */
export function phasesOf(paths, participant) {
  const begin = `recordings/${participant}_`;
  return paths
    .filter((path) => path.startsWith(begin) && path.endsWith(".csv"))
    .map((path) => path.slice(begin.length, -".csv".length))
    .sort();
}
