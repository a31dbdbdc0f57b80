// A drive as other windows follow it: what was told of it so far, and whether that is still true.

/** @typedef {import("../types.js").Frame} Frame */
/** @typedef {import("./live.js").LiveMessage} LiveMessage */
/** @typedef {import("./live.js").FrameMessage} FrameMessage */
/** @typedef {import("./live.js").StatusMessage} StatusMessage */

// An instrument that shows a speed of some seconds ago as the present one would lie.
const STALE_MS = 2000;

/** What is known of one participant, or of a simulator that names none. */
export class Watched {
  /** @param {string} participant */
  constructor(participant) {
    this.participant = participant;
    /** @type {Frame[]} of the drive that goes on, or was the last one */
    this.frames = [];
    this.phase = "";
    /** @type {StatusMessage | null} */
    this.status = null;
    this.told_ms = -Infinity;
  }

  /**
   * @param {FrameMessage | StatusMessage} message
   * @param {number} now_ms of a clock that only goes forward
   */
  take(message, now_ms) {
    if (message.kind === "status") {
      this.status = message;
      return;
    }
    const before = this.frames.at(-1)?.time_s ?? -Infinity;
    if (message.time_s < before || (message.phase ?? "") !== this.phase) this.frames = [];
    this.phase = message.phase ?? "";
    this.frames.push({
      time_s: message.time_s,
      lateral_m: 0,
      heading_rad: 0,
      values: message.values,
    });
    this.told_ms = now_ms;
  }

  /**
   * @param {number} now_ms
   * @returns {boolean} whether the newest frame is of now, or the drive stands still where it is
   */
  isFresh(now_ms) {
    return now_ms - this.told_ms < STALE_MS || this.status?.state === "paused";
  }

  /** @returns {Frame["values"]} of the newest frame */
  get values() {
    return this.frames.at(-1)?.values ?? {};
  }
}
