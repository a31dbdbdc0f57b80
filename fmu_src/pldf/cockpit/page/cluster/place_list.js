// The places where something is learned, each to keep or to forget.

import { element, fill } from "../dom.js";
import { wording } from "../language.js";
import { icon } from "./icons.js";
import { lesson, since, whereabouts } from "./story.js";
import { say, update } from "./svg.js";

/** @typedef {import("../engine/places.js").Place} Place */
/** @typedef {import("./live.js").Unit} Unit */
/** @typedef {{item: HTMLElement, radios: HTMLInputElement[], state: HTMLElement}} Row */
/**
 * @typedef {object} Answers
 * @property {(place: Place | null) => void} choose a place is looked at, or none
 * @property {((forgotten: Place[]) => Promise<boolean>) | null} change others shall be forgotten; says
 *   whether they are; null: nobody may
 */

const words = wording({
  en: {
    keep: "Keep",
    forget: "Forget",
    look: "Show place {number}",
    choice: "Place {number}",
    gone: "forgotten",
    along: "forgotten along with its neighbour",
    all: "Show the whole road",
  },
  de: {
    keep: "Behalten",
    forget: "Vergessen",
    look: "Stelle {number} zeigen",
    choice: "Stelle {number}",
    gone: "vergessen",
    along: "mit der Nachbarstelle vergessen",
    all: "Ganze Strecke zeigen",
  },
});

let lists = 0;

/** A list with a number for each place, in the order of the road. */
export class PlaceList {
  /**
   * @param {Place[]} places
   * @param {Unit} unit
   * @param {number} known number of the last iteration before this drive
   * @param {Answers} answers
   */
  constructor(places, unit, known, answers) {
    this.places = places;
    this.answers = answers;
    lists += 1;
    this.group = `places-${lists}`;
    /** @type {Place[]} what is forgotten now */
    this.forgotten = [];
    /** @type {Row[]} */
    this.rows = places.map((place, i) => this.row(place, i + 1, unit, known));
    this.root = element(
      "div",
      { class: "after-places" },
      places.length > 0 && element("ol", {}, ...this.rows.map((row) => row.item)),
      places.length > 0 &&
        element("button", { type: "button", onclick: () => answers.choose(null) }, words("all")),
    );
  }

  /**
   * @param {Place} place
   * @param {number} number
   * @param {Unit} unit
   * @param {number} known
   * @returns {Row}
   */
  row(place, number, unit, known) {
    const picture =
      place.by === "lever"
        ? "learned-set-speed"
        : place.change_mps > 0
          ? "learned-faster"
          : "learned-slower";
    const radios = this.answers.change ? [this.radio(number, true), this.radio(number, false)] : [];
    const state = element("span", { class: "after-state" });
    const item = element(
      "li",
      { class: "after-place" },
      element(
        "button",
        {
          type: "button",
          class: "after-look",
          "aria-label": words("look", { number }),
          onclick: () => this.answers.choose(place),
        },
        String(number),
      ),
      icon(picture),
      element(
        "div",
        { class: "after-lesson" },
        element("strong", {}, lesson(place, unit)),
        element("span", {}, `${whereabouts(place)} · ${since(place, known)}`),
        state,
      ),
      radios.length > 0 && this.choice(number, radios),
    );
    return { item, radios, state };
  }

  /** @param {number} number @param {HTMLInputElement[]} radios */
  choice(number, radios) {
    return element(
      "fieldset",
      { class: "after-choice" },
      element("legend", { class: "cluster-spoken" }, words("choice", { number })),
      ...radios.map((radio) =>
        element(
          "label",
          {},
          radio,
          element("span", {}, words(radio.value === "keep" ? "keep" : "forget")),
        ),
      ),
    );
  }

  /** @param {number} number @param {boolean} keeps @returns {HTMLInputElement} */
  radio(number, keeps) {
    const radio = element("input", {
      type: "radio",
      name: `${this.group}-${number}`,
      value: keeps ? "keep" : "forget",
      checked: keeps,
      onchange: () => void this.changed(),
    });
    return /** @type {HTMLInputElement} */ (radio);
  }

  async changed() {
    const wanted = this.places.filter((_, i) => this.rows[i]?.radios[1]?.checked);
    this.enable(false);
    if (await this.answers.change?.(wanted)) this.forgotten = wanted;
    this.rows.forEach((row, i) => {
      const place = this.places[i];
      const gone = place !== undefined && this.forgotten.includes(place);
      row.radios.forEach((radio) => {
        radio.checked = (radio.value === "forget") === gone;
      });
    });
    this.enable(true);
  }

  /** @param {boolean} on while what is forgotten is worked out, nothing else is asked */
  enable(on) {
    const focused = document.activeElement;
    update(this.root, { "aria-busy": String(!on) });
    for (const radio of this.rows.flatMap((row) => row.radios))
      radio.disabled = !on && radio !== focused;
  }

  /** @param {(place: Place) => boolean} gone */
  show(gone) {
    this.rows.forEach((row, i) => {
      const place = this.places[i];
      const is = place !== undefined && gone(place);
      update(row.item, { "data-forgotten": String(is) });
      const chosen = row.radios[1]?.checked === true;
      say(row.state, is ? words(chosen ? "gone" : "along") : "");
      if (!is) fill(row.state);
    });
  }
}
