// What motor, wind and road sound like at a speed: numbers, without a loudspeaker.

/** @typedef {{speed_mps: number, acceleration_mps2: number, gas_pedal: number}} Motion */
/**
 * @typedef {object} Noise
 * @property {number} motor_hz ignitions per second
 * @property {number} motor 0..1, loudness
 * @property {number} motor_tone_hz what is above sounds muffled
 * @property {number} road 0..1
 * @property {number} road_tone_hz
 * @property {number} wind 0..1
 * @property {number} wind_tone_hz
 */

// A mid-size car with four cylinders and six gears: revolutions per minute for each m/s.
const GEARS_RPM_PER_MPS = [460, 262, 172, 126, 98, 79];
const IDLE_RPM = 850;
const UP_RPM = 2300; // shifts up above, with a gentle foot
const UP_FULL_RPM = 4200; // with a heavy one
const DOWN_RPM = 1250;
const FULL_MPS2 = 3;
const IGNITIONS_PER_REVOLUTION = 2;
const FAST_MPS = 36; // 130 km/h

/** Which gear an automatic gearbox is in, and what is heard. */
export class Motor {
  constructor() {
    this.gear = 0;
  }

  /** @param {Motion} motion @returns {Noise} */
  noise({ speed_mps, acceleration_mps2, gas_pedal }) {
    const load = Math.max(clamp((acceleration_mps2 + 0.6) / (FULL_MPS2 + 0.6)), clamp(gas_pedal));
    const rpm = this.#revolutions(Math.max(speed_mps, 0), load);
    const share = clamp(speed_mps / FAST_MPS, 1.4);
    return {
      motor_hz: (rpm / 60) * IGNITIONS_PER_REVOLUTION,
      motor: 0.05 + 0.2 * load + 0.1 * clamp(rpm / 5000),
      motor_tone_hz: 180 + 900 * load + 0.12 * rpm,
      road: 0.9 * share ** 1.2,
      road_tone_hz: 130 + 480 * share,
      wind: 0.85 * share ** 2,
      wind_tone_hz: 350 + 900 * share,
    };
  }

  /** @param {number} speed_mps @param {number} load */
  #revolutions(speed_mps, load) {
    const up_rpm = UP_RPM + (UP_FULL_RPM - UP_RPM) * load * load;
    const rpm = () => speed_mps * GEARS_RPM_PER_MPS[this.gear];
    while (this.gear < GEARS_RPM_PER_MPS.length - 1 && rpm() > up_rpm) this.gear += 1;
    while (this.gear > 0 && rpm() < DOWN_RPM) this.gear -= 1;
    return Math.max(rpm(), IDLE_RPM);
  }
}

/** @param {number} value */
function clamp(value, high = 1) {
  return Math.min(Math.max(value, 0), high);
}
