// What somebody else does in the car that is watched: pedals and lever.

import { element, fill } from "../dom.js";
import { say } from "./drive_words.js";

/** @typedef {import("../types.js").Frame} Frame */
/** @typedef {import("../types.js").Value} Value */

/** @type {[string, Parameters<typeof say>[0]][]} */
const LEVER = [
  ["lever.resume", "name_resume"],
  ["lever.cancel", "name_cancel"],
  ["lever.up", "name_up"],
  ["lever.up_long", "name_up"],
  ["lever.down", "name_down"],
  ["lever.down_long", "name_down"],
];
// A tip of the lever is over before anybody has read it.
const SHOWN_S = 1.5;

export class Pedals {
  constructor() {
    this.gas = meter(say("gas"));
    this.brake = meter(say("brake"));
    this.lever = element("p", { class: "pedals-lever" });
    this.tipped_s = -Infinity;
    this.root = element("div", { class: "pedals" }, this.gas.row, this.brake.row, this.lever);
  }

  /** @param {Frame} frame */
  show({ time_s, values }) {
    this.gas.show(values["driver.gas_pedal"]);
    this.brake.show(values["driver.brake_pedal"]);
    const tip = LEVER.find(([name]) => Boolean(values[name]));
    if (tip) {
      this.tipped_s = time_s;
      fill(this.lever, say(tip[1]));
    } else if (Math.abs(time_s - this.tipped_s) > SHOWN_S) {
      fill(this.lever);
    }
  }
}

/** @param {string} text */
function meter(text) {
  const bar = element("meter", { min: 0, max: 1, value: 0, "aria-label": text });
  const row = element("p", {}, element("span", {}, text), bar);
  /** @param {Value | undefined} value nothing where a recording does not say */
  const show = (value) => {
    row.hidden = value === undefined;
    bar.setAttribute("value", String(value ?? 0));
  };
  return { row, show };
}
