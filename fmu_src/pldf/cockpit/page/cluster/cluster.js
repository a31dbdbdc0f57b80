// The instrument cluster: how fast, how fast one may, what the function does and why.

import { language, wording } from "../language.js";
import { element, fill } from "../dom.js";
import { Dial } from "./dial.js";
import { icon } from "./icons.js";
import { rowOf, sentenceOf, shown } from "./sentence.js";
import { say, svg, update } from "./svg.js";
import { changeText, distanceText, inUnit, speedText, unitText } from "./units.js";

/** @typedef {import("../types.js").HmiTexts} HmiTexts */
/** @typedef {import("./sentence.js").Values} Values */
/** @typedef {import("./live.js").Explanation} Explanation */
/** @typedef {import("./live.js").Unit} Unit */

const MODES = ["OFF", "STANDBY", "ACTIVE", "GAS_OVERRIDE", "FAULT"];
const CHANGE_SHOWN_MPS = 1 / 3.6; // a smaller lesson is none to the function either
const NEXT_SHOWN_MPS = 2 / 3.6; // a speed that is nearer to the present one is no news

const words = wording({
  en: {
    cluster: "Instrument cluster",
    limit: "Speed limit",
    limitUnknown: "Speed limit not known",
    set: "Set speed",
    next: "Next",
    learned: "Learned here",
    inDistance: "in {distance}",
    drives: "{count} drives",
    drive: "1 drive",
    sure: "{percent} % sure",
    paused: "Learning paused",
    OFF: "Off",
    STANDBY: "Ready",
    ACTIVE: "Drives",
    GAS_OVERRIDE: "You drive",
    FAULT: "Fault",
  },
  de: {
    cluster: "Kombiinstrument",
    limit: "Tempolimit",
    limitUnknown: "Tempolimit unbekannt",
    set: "Setztempo",
    next: "Als Nächstes",
    learned: "Hier gelernt",
    inDistance: "in {distance}",
    drives: "{count} Fahrten",
    drive: "1 Fahrt",
    sure: "{percent} % sicher",
    paused: "Lernen pausiert",
    OFF: "Aus",
    STANDBY: "Bereit",
    ACTIVE: "Fährt",
    GAS_OVERRIDE: "Sie fahren",
    FAULT: "Störung",
  },
});

/** Shows values as the FMUs name them; what is not among them is not shown. */
export class Cluster {
  /**
   * @param {Element} parent what it fills; nothing else stands there
   * @param {HmiTexts} texts the project's table of reasons and events
   * @param {{explanation: Explanation, unit: Unit}} options
   */
  constructor(parent, texts, { explanation, unit }) {
    this.texts = texts;
    this.explanation = explanation;
    this.unit = unit;
    this.dial = new Dial(unit);
    this.sign = new Sign();
    this.mode = element("p", { class: "cluster-mode" });
    this.set = element("p", { class: "cluster-value" });
    this.next = new Note("cluster-next", words("next"));
    this.learned = new Note("cluster-learned", words("learned"));
    this.sentence = element("p", { class: "cluster-sentence" });
    this.spoken = element("p", { class: "cluster-spoken", "aria-live": "polite" });
    this.warning = element("p", { class: "cluster-spoken", "aria-live": "assertive" });
    /** @type {import("./sentence.js").Row | null} */
    this.row = null;
    this.root = element(
      "section",
      { class: "cluster", "aria-label": words("cluster") },
      element(
        "div",
        { class: "cluster-left" },
        this.sign.drawing,
        element(
          "div",
          { class: "cluster-state" },
          this.mode,
          element("p", { class: "cluster-label" }, words("set")),
          this.set,
        ),
      ),
      this.dial.drawing,
      element("div", { class: "cluster-right" }, this.next.root, this.learned.root),
      element("div", { class: "cluster-says", "aria-hidden": "true" }, this.sentence),
      this.spoken,
      this.warning,
    );
    fill(parent, this.root);
    this.show({});
  }

  /** @param {Values} values */
  show(values) {
    const explained = this.explanation !== "none";
    this.dial.show({
      speed_mps: number(values, "vehicle.speed_mps"),
      limit_mps: number(values, "limit_mps"),
      set_mps: number(values, "set_speed_mps"),
      base_mps: explained ? number(values, "base_speed_mps") : NaN,
      target_mps: explained ? number(values, "target_speed_mps") : NaN,
    });
    this.sign.show(number(values, "limit_mps"), this.unit);
    this.showMode(values);
    this.showNext(explained ? values : {});
    this.showLearned(explained ? values : {});
    this.showSentence(values);
  }

  /** @param {Values} values */
  showMode(values) {
    const mode = MODES[number(values, "mode")] ?? "";
    update(this.root, {
      "data-mode": mode,
      "data-take-over": String(values["hmi.take_over"] === true),
    });
    const paused = values["teach.pause"] === true;
    const said = mode === "" ? "" : words(/** @type {"OFF"} */ (mode));
    say(this.mode, paused ? words("paused") : said);
    const set = number(values, "set_speed_mps");
    say(this.set, set > 0 ? `${speedText(set, this.unit)} ${unitText(this.unit)}` : "–");
  }

  /** @param {Values} values */
  showNext(values) {
    const next = number(values, "hmi.next_speed_mps");
    const distance = number(values, "hmi.next_distance_m");
    const change = next - number(values, "target_speed_mps");
    const known = next > 0 && distance > 0 && Math.abs(change) >= NEXT_SHOWN_MPS;
    const name = change > 0 ? "faster" : "slower";
    this.next.show(
      known,
      name,
      `${speedText(next, this.unit)} ${unitText(this.unit)}`,
      known ? words("inDistance", { distance: distanceText(distance, language()) }) : "",
    );
  }

  /** @param {Values} values */
  showLearned(values) {
    const change = number(values, "hmi.learned_delta_mps");
    const drives = Math.round(number(values, "hmi.learned_in_drives"));
    const sure = number(values, "hmi.confidence");
    const known = Math.abs(change) >= CHANGE_SHOWN_MPS;
    const why = [
      drives > 1 ? words("drives", { count: drives }) : drives === 1 && words("drive"),
      sure > 0 && words("sure", { percent: Math.round(100 * sure) }),
    ];
    this.learned.show(
      known,
      change > 0 ? "learned-faster" : "learned-slower",
      `${changeText(change, this.unit)} ${unitText(this.unit)}`,
      why.filter(Boolean).join(", "),
    );
  }

  /** @param {Values} values */
  showSentence(values) {
    const row = rowOf(this.texts, values);
    const may = row === null ? { icon: false, text: false } : shown(row, this.explanation);
    const text = row !== null && may.text ? sentenceOf(row, values, language()) : "";
    const limit = String(values["hmi.sentence_limit"] ?? "");
    const key = `${may.icon ? row?.icon : ""} ${limit} ${text}`;
    if (this.sentence.dataset["key"] === key) return;
    this.sentence.dataset["key"] = key;
    fill(
      this.sentence,
      may.icon && row !== null && icon(row.icon, limit),
      text !== "" && element("span", {}, text),
    );
    this.speak(row, text);
  }

  /**
   * Read a sentence out: once per row of the table, since its numbers may change by the second.
   * @param {import("./sentence.js").Row | null} row
   * @param {string} text
   */
  speak(row, text) {
    if (row === this.row) return;
    this.row = row;
    const urgent = row?.name === "TAKE_OVER";
    say(this.warning, urgent ? text : "");
    if (!urgent) say(this.spoken, text);
  }
}

/** A speed with its picture, its name and a word beside it. */
class Note {
  /** @param {string} kind its class @param {string} name */
  constructor(kind, name) {
    this.picture = element("div", { class: "cluster-picture" });
    this.value = element("p", { class: "cluster-value" });
    this.more = element("p", { class: "cluster-more" });
    const text = element(
      "div",
      {},
      element("p", { class: "cluster-label" }, name),
      this.value,
      this.more,
    );
    this.root = element("div", { class: `cluster-note ${kind}` }, this.picture, text);
  }

  /**
   * @param {boolean} known else it is hidden, and its room is kept
   * @param {string} name of the icon
   * @param {string} value
   * @param {string} more
   */
  show(known, name, value, more) {
    update(this.root, { "data-known": String(known), "aria-hidden": String(!known) });
    if (!known) return;
    if (this.picture.dataset["icon"] !== name) {
      this.picture.dataset["icon"] = name;
      fill(this.picture, icon(name));
    }
    say(this.value, value);
    say(this.more, more);
  }
}

/** The legal limit as its sign. */
class Sign {
  constructor() {
    this.number = svg("text", { x: 50, class: "sign-number" });
    const ring = svg("circle", { cx: 50, cy: 50, r: 42, class: "sign-ring" });
    this.drawing = svg(
      "svg",
      { viewBox: "0 0 100 100", class: "sign", role: "img" },
      ring,
      this.number,
    );
  }

  /** @param {number} limit_mps @param {Unit} unit */
  show(limit_mps, unit) {
    const known = Number.isFinite(inUnit(limit_mps, unit)) && limit_mps > 0;
    const text = known ? speedText(limit_mps, unit) : "";
    say(this.number, text);
    const size = text.length > 2 ? 32 : 46; // within the ring
    update(this.number, { "font-size": size, y: 50 + 0.36 * size });
    const said = known ? `${words("limit")} ${text} ${unitText(unit)}` : words("limitUnknown");
    update(this.drawing, { "aria-label": said });
  }
}

/** @param {Values} values @param {string} name @returns {number} NaN if it is not there */
function number(values, name) {
  const value = values[name];
  return typeof value === "number" ? value : NaN;
}
