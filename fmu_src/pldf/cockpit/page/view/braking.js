// When brake lights burn.

const BRAKES_MPS2 = -0.8; // more than a motor slows a car down
const SINCE_M = 1; // speeds are compared over so much of our own way

/** Tells of the car ahead, of which only the speed is known, whether it brakes. */
export class Braking {
  constructor() {
    /** @type {{s_m: number, time_s: number, lead_mps: number} | null} */
    this.before = null;
    this.time_s = 0;
    this.s_m = NaN;
    this.lit = false;
  }

  /**
   * @param {number} s_m our own place @param {number} speed_mps our own speed: how much time has passed
   * @param {number} lead_mps
   * @returns {boolean}
   */
  ahead(s_m, speed_mps, lead_mps) {
    const passed_m = s_m - this.s_m;
    this.s_m = s_m;
    if (!(passed_m >= 0 && passed_m < 10))
      this.before = null; // another drive
    else if (speed_mps > 0) this.time_s += passed_m / speed_mps;
    const { before } = this;
    if (before && s_m - before.s_m < SINCE_M) return this.lit;
    const passed_s = before ? this.time_s - before.time_s : 0;
    this.lit = before !== null && passed_s > 0 && brakes((lead_mps - before.lead_mps) / passed_s);
    this.before = { s_m, time_s: this.time_s, lead_mps };
    return this.lit;
  }
}

/** @param {number} acceleration_mps2 */
export function brakes(acceleration_mps2) {
  return acceleration_mps2 < BRAKES_MPS2;
}
