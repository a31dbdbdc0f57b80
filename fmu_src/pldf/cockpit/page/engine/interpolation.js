// What a picture shows between two steps: a moment a little ago, so that there is one behind it, too.

/** @typedef {import("../types.js").Frame} Frame */
/** @typedef {import("../types.js").Value} Value */

/** How long ago what is shown was, in ms: more than steps and messages usually take. */
const DELAY_MS = 25;
/** Frames that are kept. */
const KEPT = 8;
/** A message that comes this much later than the others is no measure of how late they are. */
const JUMP_MS = 150;
/** The estimate of the delay follows slower messages slowly, quicker ones at once. */
const FOLLOWING = 0.02;
/** What changes from step to step without jumps; all else is that of the frame before. */
const SMOOTH = Object.freeze([
  "vehicle.s_m",
  "vehicle.speed_mps",
  "vehicle.acceleration_mps2",
  "lead.gap_m",
  "lead.speed_mps",
]);

/** The newest frames of a drive, and what lay between them. */
export class Interpolation {
  constructor() {
    /** @type {Frame[]} */
    this.frames = [];
    this.offset_ms = NaN;
  }

  /**
   * Take a frame.
   * @param {Frame} frame
   * @param {number} now_ms when it came
   */
  push(frame, now_ms) {
    const offset_ms = now_ms - 1000 * frame.time_s;
    const slower_ms = offset_ms - this.offset_ms;
    if (!(Math.abs(slower_ms) < JUMP_MS)) {
      this.offset_ms = offset_ms;
    } else {
      this.offset_ms += slower_ms < 0 ? slower_ms : FOLLOWING * slower_ms;
    }
    const last = this.frames.at(-1);
    if (last !== undefined && frame.time_s < last.time_s) {
      this.frames.length = 0;
    }
    this.frames.push(frame);
    if (this.frames.length > KEPT) {
      this.frames.shift();
    }
  }

  /**
   * Return what to show now; null before the first frame.
   * @param {number} now_ms
   * @returns {Frame | null}
   */
  at(now_ms) {
    return frameAt(this.frames, (now_ms - this.offset_ms - DELAY_MS) / 1000);
  }
}

/**
 * Return the moment `time_s` between `frames`, which are in order: the first before them, the last behind.
 * @param {Frame[]} frames
 * @param {number} time_s
 * @returns {Frame | null}
 */
export function frameAt(frames, time_s) {
  const after = firstBehind(frames, time_s);
  if (after === 0 || after === frames.length) {
    return frames[after === 0 ? 0 : after - 1] ?? null;
  }
  return between(frames[after - 1], frames[after], time_s);
}

/**
 * @param {Frame[]} frames
 * @param {number} time_s
 */
function firstBehind(frames, time_s) {
  let low = 0;
  let high = frames.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (frames[middle].time_s <= time_s) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

/**
 * @param {Frame} before
 * @param {Frame} after
 * @param {number} time_s
 * @returns {Frame}
 */
function between(before, after, time_s) {
  const share = (time_s - before.time_s) / (after.time_s - before.time_s);
  const values = { ...before.values };
  const carAppears = before.values["lead.present"] !== after.values["lead.present"];
  for (const name of SMOOTH) {
    const [from, to] = [before.values[name], after.values[name]];
    const jumps = carAppears && name.startsWith("lead.");
    if (typeof from === "number" && typeof to === "number" && !jumps) {
      values[name] = mixed(from, to, share);
    }
  }
  return {
    time_s,
    lateral_m: mixed(before.lateral_m, after.lateral_m, share),
    heading_rad: mixed(before.heading_rad, after.heading_rad, share),
    values,
  };
}

/**
 * @param {number} from
 * @param {number} to
 * @param {number} share
 */
function mixed(from, to, share) {
  return from + share * (to - from);
}
