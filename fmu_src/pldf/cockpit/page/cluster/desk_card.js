// A participant on the experimenter's page: where the person is, how the drive goes, and an end to it.

import { element } from "../dom.js";
import { interventionsOf } from "../engine/interventions.js";
import { language, wording } from "../language.js";
import { AbortForm } from "./abort_form.js";
import { rowOf, sentenceOf } from "./sentence.js";
import { SpeedPlot } from "./speed_plot.js";
import { actions, perMetre } from "./story.js";
import { say, update } from "./svg.js";
import { speedText, unitText } from "./units.js";

/** @typedef {import("../types.js").HmiTexts} HmiTexts */
/** @typedef {import("./watched.js").Watched} Watched */

const words = wording({
  en: {
    simulator: "Simulator",
    driving: "driving",
    paused: "paused",
    between: "between drives",
    ended: "ended",
    silent: "no news",
    position: "{position} of {of}: {place}",
    drive: "drive {phase}",
    speed: "Speed",
    at: "at {s} of {end} m",
    why: "The car says",
    did: "Interventions",
    none: "none so far",
    learned: "Learned",
    places: "{count} places",
    place: "1 place",
    stored: "Stored drives",
    nothing: "none yet",
    reason: "Reason",
    condition: "Condition",
    conditioned: "order {order}, cluster: {explained}",
    explained_none: "no explanations",
    explained_icon: "icon",
    explained_text: "icon and text",
    cluster: "Instrument cluster in its own window",
  },
  de: {
    simulator: "Simulator",
    driving: "fährt",
    paused: "angehalten",
    between: "zwischen Fahrten",
    ended: "beendet",
    silent: "keine Nachricht",
    position: "{position} von {of}: {place}",
    drive: "Fahrt {phase}",
    speed: "Tempo",
    at: "bei {s} von {end} m",
    why: "Das Auto sagt",
    did: "Eingriffe",
    none: "bisher keine",
    learned: "Gelernt",
    places: "{count} Stellen",
    place: "1 Stelle",
    stored: "Gespeicherte Fahrten",
    nothing: "noch keine",
    reason: "Grund",
    condition: "Bedingung",
    conditioned: "Reihenfolge {order}, Anzeige: {explained}",
    explained_none: "keine Erklärungen",
    explained_icon: "Symbol",
    explained_text: "Symbol und Text",
    cluster: "Kombiinstrument in eigenem Fenster",
  },
});

const FACTS = /** @type {const} */ ([
  "condition",
  "speed",
  "why",
  "did",
  "learned",
  "stored",
  "reason",
]);

/** Follows one participant. */
export class DeskCard {
  /**
   * @param {Watched} watched
   * @param {{texts: HmiTexts, limit_mps: Float64Array, nodes: number, abort: (reason: string) => void}} desk
   */
  constructor(watched, desk) {
    this.watched = watched;
    this.desk = desk;
    const { participant } = watched;
    this.state = element("span", { class: "desk-state", role: "status" });
    this.place = element("p", { class: "desk-place" });
    this.facts = Object.fromEntries(FACTS.map((name) => [name, element("dd", {})]));
    const plot = element("div", { class: "after-plot" });
    this.form = new AbortForm(desk.abort);
    this.root = element(
      "section",
      { class: "desk-card", "aria-label": participant || words("simulator") },
      element(
        "header",
        {},
        element("h2", {}, participant || words("simulator")),
        this.state,
        this.place,
      ),
      element("dl", {}, ...this.listed()),
      plot,
      element(
        "footer",
        {},
        element(
          "a",
          { href: `cluster.html?participant=${encodeURIComponent(participant)}`, target: "_blank" },
          words("cluster"),
        ),
        participant !== "" && this.form.root,
      ),
    );
    /** @type {SpeedPlot | null} */
    this.plot = null;
    this.plotted = plot;
    /** @type {import("../types.js").Frame | null} the newest one in the plot */
    this.drawn = null;
  }

  listed() {
    return FACTS.map((name) =>
      element("div", {}, element("dt", {}, words(name)), this.facts[name]),
    );
  }

  /** Show what is known now. @param {number} now_ms as the one of what was told */
  show(now_ms) {
    const { status, values, frames } = this.watched;
    const fresh = this.watched.isFresh(now_ms);
    const drives = frames.length > 0 && fresh;
    const state = status?.state ?? (drives ? "driving" : "between");
    const silent = state === "driving" && !fresh;
    update(this.root, { "data-state": silent ? "silent" : state });
    say(this.state, words(silent ? "silent" : state));
    say(
      this.place,
      status ? words("position", { ...status }) : words("drive", { phase: this.watched.phase }),
    );
    this.tell("speed", drives ? this.speed(values) : "–");
    const row = drives ? rowOf(this.desk.texts, values) : null;
    this.tell("why", row ? sentenceOf(row, values, language()) : "–");
    const interventions = interventionsOf(frames);
    this.tell("did", actions(interventions) || words("none"));
    const count = status?.learned_places;
    this.tell(
      "learned",
      count === undefined ? "–" : count === 1 ? words("place") : words("places", { count }),
    );
    this.tell("reason", status?.reason || "–");
    this.tell("condition", status ? conditionOf(status) : "–");
    this.form.enable(state === "driving" || state === "paused");
    this.draw(interventions);
  }

  /** @param {Record<string, import("../types.js").Value>} values @returns {string} */
  speed(values) {
    const unit = this.watched.status?.unit ?? "KMH";
    const end = this.watched.status?.end_m ?? this.desk.nodes - 1;
    const at = words("at", {
      s: Math.round(Number(values["vehicle.s_m"] ?? 0)),
      end: Math.round(end),
    });
    return `${speedText(Number(values["vehicle.speed_mps"] ?? NaN), unit)} ${unitText(unit)} ${at}`;
  }

  /** @param {string[]} phases of the drives that are stored */
  store(phases) {
    this.tell("stored", phases.join(", ") || words("nothing"));
  }

  /** @param {string} name @param {string} text */
  tell(name, text) {
    const fact = this.facts[name];
    if (fact) say(fact, text);
  }

  /** @param {import("../engine/interventions.js").Intervention[]} interventions */
  draw(interventions) {
    const { frames, status } = this.watched;
    const { limit_mps, nodes } = this.desk;
    const unit = status?.unit ?? "KMH";
    const newest = frames.at(-1) ?? null;
    if (this.plot?.unit === unit && this.drawn === newest) return;
    this.drawn = newest;
    this.plot = this.plotFor(unit);
    this.plot.show(
      {
        limit_mps,
        base_mps: perMetre(frames, nodes, "base_speed_mps"),
        driven_mps: perMetre(frames, nodes),
        last_mps: perMetre(frames, nodes, "target_speed_mps"),
      },
      interventions,
      [],
    );
  }

  /** @param {import("./live.js").Unit} unit @returns {SpeedPlot} */
  plotFor(unit) {
    if (this.plot?.unit === unit) return this.plot;
    this.plot?.dispose();
    return new SpeedPlot(this.plotted, unit, "profile");
  }
}

/** @param {import("./live.js").StatusMessage} status @returns {string} */
function conditionOf({ order, explanation }) {
  return words("conditioned", { order, explained: words(`explained_${explanation}`) });
}
