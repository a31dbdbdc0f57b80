// The speedometer: how fast the car is, the limit, the set speed, and what was learned here.

import { inUnit, speedText, unitText } from "./units.js";
import { say, svg, update } from "./svg.js";

/** @typedef {import("./live.js").Unit} Unit */
/**
 * What it shows; NaN: not known, nothing is shown.
 * @typedef {object} Speeds
 * @property {number} speed_mps
 * @property {number} limit_mps
 * @property {number} set_mps
 * @property {number} base_mps without lessons
 * @property {number} target_mps with them
 */

const BEGIN_DEG = -120;
const END_DEG = 120;
const RADIUS = 82;
const SCALE = { KMH: { end: 160, tick: 20 }, MPH: { end: 100, tick: 10 } };
const NOTABLE = 1; // smaller lessons are not drawn, in the unit of the dial

/** A dial around the point 100, 100; below it nothing is drawn. */
export class Dial {
  /** @param {Unit} unit */
  constructor(unit) {
    this.unit = unit;
    this.arc = svg("path", { class: "dial-speed" });
    this.lesson = svg("path", { class: "dial-lesson" });
    this.limit = svg("path", { class: "dial-limit", d: `M100 ${100 - RADIUS - 9}v18` });
    this.set = svg("path", { class: "dial-set", d: `M100 ${100 - RADIUS - 9}l-7-13h14z` });
    this.number = svg("text", { class: "dial-number", x: 100, y: 112 });
    this.drawing = svg(
      "svg",
      { class: "dial", viewBox: "-6 -6 212 156", "aria-hidden": "true" },
      svg("path", { class: "dial-track", d: arc(BEGIN_DEG, END_DEG) }),
      this.lesson,
      this.arc,
      ...ticks(unit),
      this.limit,
      this.set,
      this.number,
      svg("text", { class: "dial-unit", x: 100, y: 138 }, unitText(unit)),
    );
  }

  /** @param {Speeds} speeds */
  show({ speed_mps, limit_mps, set_mps, base_mps, target_mps }) {
    const text = speedText(speed_mps, this.unit);
    say(this.number, text);
    update(this.number, { "font-size": text.length > 2 ? 42 : 52 }); // clear of the labels
    update(this.arc, { d: arc(BEGIN_DEG, this.angle(speed_mps)) });
    this.mark(this.limit, limit_mps);
    this.mark(this.set, set_mps);
    const learned = Math.abs(inUnit(target_mps - base_mps, this.unit)) >= NOTABLE;
    const ends = [this.angle(base_mps), this.angle(target_mps)].sort((a, b) => a - b);
    update(this.lesson, { d: learned ? arc(ends[0] ?? 0, ends[1] ?? 0) : "" });
  }

  /**
   * @param {SVGElement} mark
   * @param {number} speed_mps
   */
  mark(mark, speed_mps) {
    const known = speed_mps > 0;
    update(mark, {
      transform: `rotate(${known ? this.angle(speed_mps) : 0} 100 100)`,
      visibility: known ? "visible" : "hidden",
    });
  }

  /** @param {number} speed_mps @returns {number} clockwise from the top, in tenths of a degree */
  angle(speed_mps) {
    const share = Math.min(Math.max(inUnit(speed_mps, this.unit) / SCALE[this.unit].end, 0), 1);
    const degrees = BEGIN_DEG + (Number.isFinite(share) ? share : 0) * (END_DEG - BEGIN_DEG);
    return Math.round(10 * degrees) / 10;
  }
}

/** @param {Unit} unit @returns {SVGElement[]} */
function ticks(unit) {
  const { end, tick } = SCALE[unit];
  const drawn = [];
  for (let speed = 0; speed <= end; speed += tick) {
    const degrees = BEGIN_DEG + (speed / end) * (END_DEG - BEGIN_DEG);
    const [x, y] = point(degrees, RADIUS - 24);
    const line = `M${point(degrees, RADIUS - 6).join(" ")}L${point(degrees, RADIUS - 12).join(" ")}`;
    drawn.push(svg("path", { class: "dial-tick", d: line }));
    if ((speed / tick) % 2 === 0) {
      drawn.push(svg("text", { class: "dial-label", x: x, y: y + 4 }, String(speed)));
    }
  }
  return drawn;
}

/** @param {number} from_deg @param {number} to_deg @returns {string} a path */
function arc(from_deg, to_deg) {
  const large = to_deg - from_deg > 180 ? 1 : 0;
  const [begin, end] = [point(from_deg, RADIUS), point(to_deg, RADIUS)];
  return `M${begin.join(" ")}A${RADIUS} ${RADIUS} 0 ${large} 1 ${end.join(" ")}`;
}

/** @param {number} degrees clockwise from the top @param {number} radius @returns {[number, number]} */
function point(degrees, radius) {
  const angle = (degrees * Math.PI) / 180;
  return [round(100 + radius * Math.sin(angle)), round(100 - radius * Math.cos(angle))];
}

/** @param {number} value */
function round(value) {
  return Math.round(100 * value) / 100;
}
