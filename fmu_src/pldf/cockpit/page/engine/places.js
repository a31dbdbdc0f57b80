// Where something is learned, as places that a person can name, keep and forget.

import { columnOf, iterationOf } from "./profile.js";

/** @typedef {import("./profile.js").Profile} Profile */
/** @typedef {import("./profile.js").Iteration} Iteration */

// Smaller deviations are no lesson to the function either (learning.deviation_min_mps).
const SHOWN_MPS = 1 / 3.6;

/**
 * A run of metres where one thing is learned.
 * @typedef {object} Place
 * @property {"pedal" | "lever"} by
 * @property {boolean} waits it was shown, and is not driven before it has been shown again
 * @property {number} from_m
 * @property {number} to_m last metre of it
 * @property {number} at_m where it deviates most: there "forget here" means this place
 * @property {number} change_mps how much at `at_m`, above 0: faster
 * @property {number} speed_mps learned speed at `at_m`
 * @property {number} base_mps what it would be at `at_m` without lessons
 * @property {number} limit_mps legal limit at `at_m`
 * @property {number[]} iterations numbers of those that shaped it last; none of what waits
 * @property {number} lessons how many drives shaped it, or have shown what waits
 */

/**
 * Return the places of a profile as it is now, by distance.
 * @param {Profile} profile
 * @param {Float64Array} limit_mps legal limit per cell: what the lever taught holds for one limit
 * @param {number} [known] number of the last iteration before the drive that is looked at; without it
 *   no lesson is a new one
 * @returns {Place[]}
 */
export function placesOf(profile, limit_mps, known = profile.iterations.length - 1) {
  const iteration = iterationOf(profile);
  const before = columnOf(iterationOf(profile, known), "learned_mps");
  const places = [
    ...pedalPlaces(iteration, before, known),
    ...leverPlaces(profile, iteration, limit_mps),
    ...waitingPlaces(iteration),
  ].map((found) => ({
    ...found,
    limit_mps: at(limit_mps, Math.min(found.at_m, limit_mps.length - 1)),
  }));
  return places.sort((a, b) => a.from_m - b.from_m || a.to_m - b.to_m);
}

/** @typedef {Omit<Place, "limit_mps">} Found */

/**
 * Return where pedals taught more than what the learned set speed does, which moves the plan by its
 * offset at most; and where they changed anything in the drive that is looked at.
 * @param {Iteration} iteration
 * @param {Float64Array} before learned speeds before that drive
 * @param {number} known number of the last iteration before it
 * @returns {Found[]}
 */
function pedalPlaces(iteration, before, known) {
  const [learned, base] = speeds(iteration);
  const drive = columnOf(iteration, "drive");
  const byPedal = columnOf(iteration, "intervention");
  const offset = columnOf(iteration, "offset_mps");
  const change = learned.map((speed, i) => speed - at(base, i));
  const sign = change.map((mps, i) => {
    const [low, high] = [Math.min(at(offset, i), 0), Math.max(at(offset, i), 0)];
    const beyond = mps < low - SHOWN_MPS || mps > high + SHOWN_MPS;
    const changed = at(drive, i) > known && Math.abs(at(learned, i) - at(before, i)) > SHOWN_MPS;
    const taught = at(drive, i) > 0 && at(byPedal, i) > 0 && Math.abs(mps) > SHOWN_MPS;
    return taught && (beyond || changed) ? Math.sign(mps) : 0;
  });
  return runs(sign).map(([from, to]) => ({
    ...place("pedal", iteration, change, from, to),
    iterations: distinct(drive, from, to),
  }));
}

/**
 * @param {Profile} profile
 * @param {Iteration} iteration
 * @param {Float64Array} limit
 * @returns {Found[]}
 */
function leverPlaces(profile, iteration, limit) {
  const offset = columnOf(iteration, "offset_mps");
  const own = offset.map((mps, i) => (mps === 0 ? 0 : 1 + at(limit, i)));
  return runs(own).map(([from, to]) => ({
    ...place("lever", iteration, offset, from, to),
    iterations: [taughtBy(profile, iteration.number, from)],
  }));
}

/** @param {Iteration} iteration @returns {Found[]} what waits for more evidence */
function waitingPlaces(iteration) {
  const base = columnOf(iteration, "base_mps");
  return ["faster", "slower"].flatMap((sign) => [
    ...waiting(
      iteration,
      "pedal",
      columnOf(iteration, `pending_${sign}`),
      columnOf(iteration, `pending_${sign}_mps`).map((speed, i) => speed - at(base, i)),
    ),
    ...waiting(
      iteration,
      "lever",
      columnOf(iteration, `offset_pending_${sign}`),
      columnOf(iteration, `offset_pending_${sign}_mps`),
    ),
  ]);
}

/**
 * @param {Iteration} iteration
 * @param {"pedal" | "lever"} by
 * @param {Float64Array} pending how many demonstrations wait
 * @param {Float64Array} change_mps their mean against the base profile
 * @returns {Found[]}
 */
function waiting(iteration, by, pending, change_mps) {
  return runs(pending.map(Math.sign)).map(([from, to]) => {
    const found = place(by, iteration, change_mps, from, to);
    const speed_mps = found.base_mps + found.change_mps;
    return { ...found, speed_mps, waits: true, lessons: at(pending, found.at_m), iterations: [] };
  });
}

/**
 * @param {"pedal" | "lever"} by
 * @param {Iteration} iteration
 * @param {Float64Array} change_mps
 * @param {number} from_m
 * @param {number} to_m
 */
function place(by, iteration, change_mps, from_m, to_m) {
  let most = from_m;
  for (let i = from_m; i <= to_m; i += 1) {
    if (Math.abs(at(change_mps, i)) > Math.abs(at(change_mps, most))) most = i;
  }
  const [learned, base] = speeds(iteration);
  const lessons = columnOf(iteration, "lessons").subarray(from_m, to_m + 1);
  return {
    by,
    waits: false,
    from_m,
    to_m,
    at_m: most,
    change_mps: at(change_mps, most),
    speed_mps: at(learned, most),
    base_mps: at(base, most),
    lessons: lessons.reduce((a, b) => Math.max(a, b), 0),
  };
}

/**
 * Return the iteration since which an offset has been what it is.
 * @param {Profile} profile
 * @param {number} number of the iteration that is looked at
 * @param {number} cell
 */
function taughtBy(profile, number, cell) {
  const value = at(columnOf(iterationOf(profile, number), "offset_mps"), cell);
  let since = number;
  while (since > 1 && at(columnOf(iterationOf(profile, since - 1), "offset_mps"), cell) === value) {
    since -= 1;
  }
  return since;
}

/** @param {Iteration} iteration @returns {[Float64Array, Float64Array]} learned and base */
function speeds(iteration) {
  return [columnOf(iteration, "learned_mps"), columnOf(iteration, "base_mps")];
}

/** @param {Float64Array} values @param {number} from @param {number} to @returns {number[]} */
function distinct(values, from, to) {
  return [...new Set(values.subarray(from, to + 1))].sort((a, b) => a - b);
}

/**
 * Return first and last index of each run of one value other than 0.
 * @param {ArrayLike<number>} values
 * @returns {[number, number][]}
 */
export function runs(values) {
  /** @type {[number, number][]} */
  const found = [];
  for (let i = 0; i < values.length; i += 1) {
    const last = found.at(-1);
    if (values[i] === 0) continue;
    if (last !== undefined && last[1] === i - 1 && values[i - 1] === values[i]) last[1] = i;
    else found.push([i, i]);
  }
  return found;
}

/** @param {ArrayLike<number>} values @param {number} i @returns {number} NaN beyond the ends */
function at(values, i) {
  return values[i] ?? NaN;
}
