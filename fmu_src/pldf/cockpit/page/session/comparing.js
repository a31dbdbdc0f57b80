// Recordings of the same road, compared where they are at the same place.

/** @typedef {import("../types.js").Frame} Frame */

/** @typedef {{time_s: number, speed_mps: number}} Passing when and how fast a place was passed */

/** A recording by distance. */
export class ByDistance {
  /** @param {Frame[]} frames in the order of time */
  constructor(frames) {
    /** @type {Float64Array} */
    this.time_s = Float64Array.from(frames, (frame) => frame.time_s);
    this.speed_mps = Float64Array.from(frames, (frame) => valueOf(frame, "vehicle.speed_mps"));
    // A car that rolls back a little has passed a place all the same.
    let furthest = -Infinity;
    this.s_m = Float64Array.from(frames, (frame) => {
      furthest = Math.max(furthest, valueOf(frame, "vehicle.s_m"));
      return furthest;
    });
  }

  /**
   * Return when and how fast a place was passed first; null: it was not.
   * @param {number} s_m
   * @returns {Passing | null}
   */
  at(s_m) {
    const last = this.s_m.length - 1;
    if (last < 0 || s_m < at(this.s_m, 0) || s_m > at(this.s_m, last)) {
      return null;
    }
    const after = this.firstAt(s_m);
    const before = Math.max(0, after - 1);
    const [from, to] = [at(this.s_m, before), at(this.s_m, after)];
    const share = to > from ? (s_m - from) / (to - from) : 0;
    /** @param {Float64Array} values */
    const mixed = (values) => at(values, before) + share * (at(values, after) - at(values, before));
    return { time_s: mixed(this.time_s), speed_mps: mixed(this.speed_mps) };
  }

  /** @param {number} s_m */
  firstAt(s_m) {
    let low = 0;
    let high = this.s_m.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (at(this.s_m, middle) < s_m) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low;
  }
}

/**
 * Return speeds at places, in the given unit; null where a recording was not.
 * @param {ByDistance} recording
 * @param {number[]} places_m
 * @param {number} per_mps how many of the unit 1 m/s is
 * @returns {(number | null)[]}
 */
export function speedsAt(recording, places_m, per_mps) {
  return places_m.map((s_m) => {
    const passing = recording.at(s_m);
    return passing ? passing.speed_mps * per_mps : null;
  });
}

/**
 * @param {Frame} frame
 * @param {string} name
 */
function valueOf(frame, name) {
  const value = frame.values[name];
  return typeof value === "number" ? value : 0;
}

/**
 * @param {Float64Array} values
 * @param {number} index
 */
function at(values, index) {
  return values[index] ?? 0;
}
