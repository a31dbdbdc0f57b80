// A drive in time: when it steps, when it stands, and what of the time was lost.

import { StepClock } from "./clock.js";

/** @typedef {import("../types.js").DriveResult} DriveResult */
/** @typedef {import("../types.js").Interruption} Interruption */
/** @typedef {import("./drive.js").Drive} Drive */
/** @typedef {import("./drive.js").End} End */

/** Reasons of ours; others come from who pauses. */
export const READY = "ready";
export const LATE = "late";
/** Lost at once, or in all since the drive went on: then a person should notice, and it stands. */
const LOST_AT_ONCE_MAX_MS = 1000;
const LOST_MAX_MS = 3000;
/** A page that has said nothing for so long, in ms, shows nothing and hears no pedal: the drive stands. */
const UNHEARD_MAX_MS = 1000;
/** How long a drive as fast as possible runs before others are heard, in ms. */
const SLICE_MS = 40;

/** One drive that is told what time it is; it stands until it is resumed. */
export class Run {
  /**
   * @param {Drive} drive
   * @param {() => number} clock_ms
   */
  constructor(drive, clock_ms) {
    this.drive = drive;
    this.clock_ms = clock_ms;
    this.steps = new StepClock(drive.step_s);
    /** @type {Interruption[]} */
    this.interruptions = [];
    /** @type {{reason: string, since_ms: number} | null} */
    this.paused = { reason: READY, since_ms: clock_ms() };
    this.begun = false;
    this.lost_ms = 0;
    this.late_steps = 0;
    this.late_max_ms = 0;
    this.stepping_ms = 0;
    /** When the person was heard last; a page tells with every picture. */
    this.heard_ms = Infinity;
  }

  /**
   * Hear what the person does now.
   * @param {import("../types.js").Controls} controls
   */
  hear(controls) {
    this.heard_ms = this.clock_ms();
    if (this.paused === null) {
      this.drive.person?.take(controls);
    } else {
      this.drive.person?.takeStanding(controls);
    }
  }

  /**
   * Let the drive stand; one that stands already, and not only because it has not begun, keeps its reason.
   * @param {string} reason
   * @param {number} [since_ms] it stands since then
   */
  pause(reason, since_ms = this.clock_ms()) {
    if (this.paused !== null && this.paused.reason !== READY) {
      return;
    }
    this.paused = { reason, since_ms };
    this.drive.person?.release();
  }

  /** Let the drive go on, or begin. */
  resume() {
    if (this.paused === null) {
      return;
    }
    const now_ms = this.clock_ms();
    this.keepPause(now_ms);
    this.begun = true;
    this.lost_ms = 0;
    this.heard_ms = Math.max(this.heard_ms, now_ms);
    this.steps.start(now_ms);
  }

  /**
   * Make the steps that are due in real time.
   * @returns {End | null} how the drive ended
   */
  tick() {
    if (this.paused !== null) {
      return null;
    }
    const now_ms = this.clock_ms();
    const { steps, late_ms, lost_ms } = this.steps.due(now_ms);
    this.late_max_ms = Math.max(this.late_max_ms, late_ms);
    this.lost_ms += lost_ms;
    if (lost_ms > LOST_AT_ONCE_MAX_MS || this.lost_ms > LOST_MAX_MS) {
      this.pause(LATE, now_ms - lost_ms);
      return null;
    }
    if (lost_ms > 0) {
      this.keep(lost_ms, LATE);
    }
    this.late_steps += Math.max(0, steps - 1);
    const end = this.make(steps);
    if (end === null && now_ms - this.heard_ms > UNHEARD_MAX_MS) {
      this.pause(LATE);
    }
    return end;
  }

  /**
   * Make as many steps as fit in a moment, however fast that is.
   * @returns {End | null} how the drive ended
   */
  hurry() {
    const until_ms = this.clock_ms() + SLICE_MS;
    let end = null;
    while (end === null && this.paused === null && this.clock_ms() < until_ms) {
      end = this.make(20);
    }
    return end;
  }

  /**
   * Finish the drive.
   * @param {End} end
   * @returns {DriveResult}
   */
  finish(end) {
    this.keepPause(this.clock_ms());
    return this.drive.finish(end, this.interruptions, this.timing());
  }

  /**
   * Return what is left of a drive that failed.
   * @param {string} reason
   * @returns {DriveResult}
   */
  fail(reason) {
    this.keepPause(this.clock_ms());
    return this.drive.fail(reason, this.interruptions, this.timing());
  }

  /**
   * @param {number} steps
   * @returns {End | null}
   */
  make(steps) {
    const begin_ms = this.clock_ms();
    let end = null;
    for (let step = 0; end === null && step < steps; step += 1) {
      end = this.drive.advance();
    }
    this.stepping_ms += this.clock_ms() - begin_ms;
    return end;
  }

  /**
   * The drive stands no longer: keep for how long it did.
   * @param {number} now_ms
   */
  keepPause(now_ms) {
    if (this.paused !== null && this.begun) {
      this.keep(now_ms - this.paused.since_ms, this.paused.reason);
    }
    this.paused = null;
  }

  /**
   * @param {number} lost_ms
   * @param {string} reason
   */
  keep(lost_ms, reason) {
    this.interruptions.push({ time_s: this.drive.time_s, lost_s: lost_ms / 1000, reason });
  }

  /** @returns {DriveResult["timing"]} */
  timing() {
    const { steps } = this.drive;
    const step_us = steps === 0 ? 0 : (1000 * this.stepping_ms) / steps;
    return { steps, late_steps: this.late_steps, late_max_ms: this.late_max_ms, step_us };
  }
}
