// What a drive was, per metre and in words.

import { language, wording } from "../language.js";
import { changeText, inUnit, speedText, unitText } from "./units.js";

/** @typedef {import("../types.js").Frame} Frame */
/** @typedef {import("../engine/interventions.js").Intervention} Intervention */
/** @typedef {import("../engine/places.js").Place} Place */
/** @typedef {import("./live.js").Unit} Unit */

const words = wording({
  en: {
    gas: "gas pedal {count}×",
    brake: "brake {count}×",
    set_speed: "set speed {count}×",
    nothing: "You let the car drive by itself.",
    did: "You acted: {list}.",
    noneLearned: "Nothing is learned on this road yet.",
    oneLearned: "1 place is learned.",
    learned: "{count} places are learned.",
    waits: "{count} more wait to be shown again.",
    faster: "{change}: {speed} instead of {base}",
    between: "{from} to {to} km",
    waiting: "{change}: noted, not driven before you have shown it again",
    lever: "{change}: set speed {speed} at limit {limit}",
    fresh: "new from this drive",
    drive: "learned in drive {drive}",
    shown: "shown in {count} of your drives",
  },
  de: {
    gas: "Gaspedal {count}×",
    brake: "Bremse {count}×",
    set_speed: "Setztempo {count}×",
    nothing: "Sie haben das Auto fahren lassen.",
    did: "Sie haben eingegriffen: {list}.",
    noneLearned: "Auf dieser Strecke ist noch nichts gelernt.",
    oneLearned: "1 Stelle ist gelernt.",
    learned: "{count} Stellen sind gelernt.",
    waits: "{count} weitere warten darauf, noch einmal gezeigt zu werden.",
    faster: "{change}: {speed} statt {base}",
    between: "{from} bis {to} km",
    waiting: "{change}: gemerkt; gefahren wird es erst, wenn Sie es wieder gezeigt haben",
    lever: "{change}: Setztempo {speed} bei Tempolimit {limit}",
    fresh: "neu aus dieser Fahrt",
    drive: "gelernt in Fahrt {drive}",
    shown: "in {count} Ihrer Fahrten gezeigt",
  },
});

/**
 * Return the speed driven at each metre, NaN where the car was not.
 * @param {Frame[]} frames
 * @param {number} nodes metres of the road, and one
 * @param {string} [name] of another value
 * @returns {Float64Array}
 */
export function perMetre(frames, nodes, name = "vehicle.speed_mps") {
  const values = new Float64Array(nodes).fill(NaN);
  for (let i = 1; i < frames.length; i += 1) {
    const [from, to] = [numberOf(frames[i - 1], "vehicle.s_m"), numberOf(frames[i], "vehicle.s_m")];
    const [before, after] = [numberOf(frames[i - 1], name), numberOf(frames[i], name)];
    for (let node = Math.max(Math.ceil(from), 0); node <= Math.min(to, nodes - 1); node += 1) {
      values[node] = to > from ? before + ((node - from) / (to - from)) * (after - before) : after;
    }
  }
  return values;
}

/**
 * @param {Intervention[]} interventions
 * @returns {string} how many of which kind, empty if there are none
 */
export function actions(interventions) {
  const kinds = /** @type {const} */ (["gas", "brake", "set_speed"]);
  return kinds
    .map((kind) => ({ kind, count: interventions.filter((found) => found.kind === kind).length }))
    .filter(({ count }) => count > 0)
    .map(({ kind, count }) => words(kind, { count }))
    .join(", ");
}

/**
 * Say what the person did and what is known now.
 * @param {Intervention[]} interventions
 * @param {Place[]} places
 * @returns {string}
 */
export function summary(interventions, places) {
  const list = actions(interventions);
  const waiting = places.filter((place) => place.waits).length;
  const known = places.length - waiting;
  return [
    list === "" ? words("nothing") : words("did", { list }),
    known === 0
      ? words("noneLearned")
      : words(known === 1 ? "oneLearned" : "learned", { count: known }),
    waiting > 0 && words("waits", { count: waiting }),
  ]
    .filter(Boolean)
    .join(" ");
}

/**
 * @param {Place} place
 * @param {Unit} unit
 * @returns {string} what is learned there
 */
export function lesson(place, unit) {
  const change = `${changeText(place.change_mps, unit)} ${unitText(unit)}`;
  if (place.waits) return words("waiting", { change });
  if (place.by === "lever") {
    const [speed, limit] = [place.limit_mps + place.change_mps, place.limit_mps];
    return words("lever", { change, speed: speedText(speed, unit), limit: speedText(limit, unit) });
  }
  const [speed, base] = [speedText(place.speed_mps, unit), speedText(place.base_mps, unit)];
  return words("faster", { change, speed, base });
}

/** @param {Place} place @returns {string} where it lies */
export function whereabouts(place) {
  return words("between", { from: kilometres(place.from_m), to: kilometres(place.to_m) });
}

/**
 * @param {Place} place
 * @param {number} known number of the last iteration before this drive
 * @returns {string} since when it is known
 */
export function since(place, known) {
  if (place.waits) return words("shown", { count: place.lessons });
  const newest = place.iterations.at(-1) ?? 0;
  return newest > known ? words("fresh") : words("drive", { drive: newest });
}

/** @param {number} distance_m @returns {string} */
function kilometres(distance_m) {
  const text = (distance_m / 1000).toFixed(2);
  return language() === "de" ? text.replace(".", ",") : text;
}

/**
 * @param {Float64Array} speeds_mps
 * @param {Unit} unit
 * @returns {(number | null)[]} for a plot, which leaves out null
 */
export function plotted(speeds_mps, unit) {
  return Array.from(speeds_mps, (speed) => (Number.isFinite(speed) ? inUnit(speed, unit) : null));
}

/** @param {Frame | undefined} frame @param {string} name @returns {number} */
function numberOf(frame, name) {
  return Number(frame?.values[name] ?? NaN);
}
