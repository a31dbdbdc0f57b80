// The driver's last word as buttons: pause learning, forget here, undo.

import { element, fill } from "../dom.js";
import { wording } from "../language.js";
import { icon } from "./icons.js";
import { update } from "./svg.js";

/** @typedef {"pause_learning" | "forget_here" | "undo"} Word a name among the controls */

/** @type {Record<Word, {icon: string, key: string}>} */
const BUTTONS = {
  pause_learning: { icon: "paused", key: "P" },
  forget_here: { icon: "forgotten", key: "F" },
  undo: { icon: "undone", key: "U" },
};

const words = wording({
  en: {
    pause_learning: "Pause learning",
    forget_here: "Forget here",
    undo: "Undo",
    key: "key {key}",
  },
  de: {
    pause_learning: "Lernen pausieren",
    forget_here: "Hier vergessen",
    undo: "Zurücknehmen",
    key: "Taste {key}",
  },
});

/** The three buttons; keys are the business of the inputs. */
export class Buttons {
  /**
   * @param {Element} parent what they fill
   * @param {(word: Word) => void} press once per click; the pause is a switch
   */
  constructor(parent, press) {
    this.press = press;
    const names = /** @type {Word[]} */ (Object.keys(BUTTONS));
    const made = names.map((word) => this.button(word));
    this.pause = made[0];
    fill(parent, element("div", { class: "cluster-buttons" }, ...made));
  }

  /** @param {Word} word @returns {HTMLElement} */
  button(word) {
    const { icon: name, key } = BUTTONS[word];
    return element(
      "button",
      {
        type: "button",
        class: "cluster-button",
        "aria-pressed": word === "pause_learning" && "false",
        "aria-keyshortcuts": key,
        onclick: (/** @type {MouseEvent} */ event) => this.clicked(word, event),
      },
      icon(name),
      element("span", {}, words(word)),
      element("kbd", { title: words("key", { key }) }, key),
    );
  }

  /** @param {Word} word @param {MouseEvent} event */
  clicked(word, event) {
    // A mouse must not leave the focus here: the next key is meant for the car.
    if (event.detail > 0 && event.currentTarget instanceof HTMLElement) event.currentTarget.blur();
    this.press(word);
  }

  /** @param {import("./sentence.js").Values} values */
  show(values) {
    const paused = values["teach.pause"] === true;
    if (this.pause) update(this.pause, { "aria-pressed": String(paused) });
  }
}
