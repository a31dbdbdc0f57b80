// How evenly the pictures came: part of what is kept of a drive.

/** @typedef {import("./record.js").FrameTiming} FrameTiming */

// Longer than this between two pictures is seen as a jerk: under 20 per second.
const JERK_MS = 50;

export class FrameTimes {
  constructor() {
    this.frames = 0;
    this.sum_ms = 0;
    this.max_ms = 0;
    this.over = 0;
    this.last_ms = NaN;
  }

  /** @param {number} now_ms of a picture */
  drawn(now_ms) {
    const passed_ms = now_ms - this.last_ms;
    this.last_ms = now_ms;
    if (!Number.isFinite(passed_ms)) {
      return;
    }
    this.frames += 1;
    this.sum_ms += passed_ms;
    this.max_ms = Math.max(this.max_ms, passed_ms);
    this.over += Number(passed_ms > JERK_MS);
  }

  /**
   * The drive pauses: until now the last picture stood, and what comes next is not counted against it.
   * @param {number} now_ms
   */
  interrupted(now_ms) {
    this.drawn(now_ms);
    this.last_ms = NaN;
  }

  /** @returns {FrameTiming} */
  get timing() {
    return {
      frames: this.frames,
      mean_ms: rounded(this.sum_ms / Math.max(1, this.frames)),
      max_ms: rounded(this.max_ms),
      over_50_ms: this.over,
    };
  }
}

/** @param {number} ms */
function rounded(ms) {
  return Math.round(ms * 100) / 100;
}
