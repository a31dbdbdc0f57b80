// When the next steps of a drive are due: small delays are caught up, longer ones are counted as lost.

/** Delay in ms up to which missed steps are driven at once; time beyond it is lost, and told. */
export const CATCH_UP_MAX_MS = 100;

/** @typedef {{steps: number, late_ms: number, lost_ms: number}} Due late_ms: of the first of the steps */

/** A clock of fixed steps in real time. It reads no clock itself: it is told what time it is. */
export class StepClock {
  /** @param {number} step_s */
  constructor(step_s) {
    this.step_ms = 1000 * step_s;
    this.begin_ms = NaN;
    this.steps = 0;
  }

  /**
   * Begin, or go on after a pause: the next step is due now.
   * @param {number} now_ms
   */
  start(now_ms) {
    this.begin_ms = now_ms;
    this.steps = 0;
  }

  /**
   * Return how many steps are to be made now; they count as made.
   * @param {number} now_ms
   * @returns {Due} lost_ms: by how much the drive stood still, 0 if nothing was lost
   */
  due(now_ms) {
    // From the number of steps: a sum of steps would drift.
    const late_ms = now_ms - (this.begin_ms + this.steps * this.step_ms);
    if (!(late_ms >= 0)) {
      return { steps: 0, late_ms: 0, lost_ms: 0 };
    }
    if (late_ms > Math.max(CATCH_UP_MAX_MS, this.step_ms)) {
      this.start(now_ms);
      this.steps = 1;
      return { steps: 1, late_ms, lost_ms: late_ms };
    }
    const steps = Math.floor(late_ms / this.step_ms) + 1;
    this.steps += steps;
    return { steps, late_ms, lost_ms: 0 };
  }
}
