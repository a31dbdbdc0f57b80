// The person as a part of the drive: in place of the driver FMU's outputs, what is pressed now.

/** @typedef {import("../types.js").Controls} Controls */
/** @typedef {import("../types.js").InputChange} InputChange */

/** What the person does now, by the input that it feeds; `steering` feeds no FMU. */
const CONTROL_OF = Object.freeze(
  /** @type {Record<string, keyof Controls>} */ ({
    "driver.gas_pedal": "gas_pedal",
    "driver.brake_pedal": "brake_pedal",
    "lever.resume": "resume",
    "lever.cancel": "cancel",
    "lever.up": "up",
    "lever.down": "down",
    "lever.up_long": "up_long",
    "lever.down_long": "down_long",
    "teach.pause": "pause_learning",
    "teach.forget_here": "forget_here",
    "teach.undo": "undo",
    steering: "steering",
  }),
);
const NAMES = Object.keys(CONTROL_OF);
/** A contact that closed and opened again between two steps is seen by the next one. */
const CONTACTS = new Set(NAMES.filter((name) => /^(lever\.|teach\.(forget|undo))/.test(name)));
/** When RESUME is pressed for the person at the start: as the driver FMU does. */
const ACTIVATION = { name: "lever.resume", from_s: 1.0, to_s: 1.3 };

/** @type {Readonly<Controls>} */
export const RELEASED = Object.freeze({
  gas_pedal: 0,
  brake_pedal: 0,
  steering: 0,
  resume: false,
  cancel: false,
  up: false,
  down: false,
  up_long: false,
  down_long: false,
  pause_learning: false,
  forget_here: false,
  undo: false,
});

/**
 * What drives instead of the driver FMU: values by name, fixed anew before each step.
 * @typedef {object} Driving
 * @property {Map<string, number>} values
 * @property {InputChange[]} changes all values that were not 0 from the start
 * @property {(step: number) => void} advance take over what holds from this step on
 */

/**
 * A person, as told by `take` between the steps.
 * @implements {Driving}
 */
export class Person {
  /**
   * @param {number} step_s
   * @param {boolean} activate press RESUME at the start
   */
  constructor(step_s, activate) {
    this.values = new Map(NAMES.map((name) => [name, 0]));
    /** @type {InputChange[]} */
    this.changes = [];
    this.step_s = step_s;
    this.activate = activate;
    this.now = { ...RELEASED };
    /** @type {Set<string>} closed since the last step */
    this.closed = new Set();
  }

  /**
   * Hear what the person does now.
   * @param {Controls} controls
   */
  take(controls) {
    this.now = { ...controls };
    for (const name of CONTACTS) {
      if (controls[CONTROL_OF[name]]) {
        this.closed.add(name);
      }
    }
  }

  /** Let go of pedals, wheel and lever; what was pressed before still counts. */
  release() {
    this.now = { ...RELEASED, pause_learning: this.now.pause_learning };
  }

  /**
   * Hear what the person does while the drive stands: the driver's last word counts, nothing else.
   * @param {Controls} controls
   */
  takeStanding({ pause_learning, forget_here, undo }) {
    this.take({ ...RELEASED, pause_learning, forget_here, undo });
  }

  /** @param {number} step */
  advance(step) {
    const time_s = step * this.step_s;
    const activates = this.activate && time_s >= ACTIVATION.from_s && time_s < ACTIVATION.to_s;
    for (const name of NAMES) {
      const held = Number(this.now[CONTROL_OF[name]]);
      const pressed = this.closed.has(name) || (activates && name === ACTIVATION.name);
      note(this, step, name, pressed ? 1 : held);
    }
    this.closed.clear();
  }
}

/**
 * A person's drive, driven again.
 * @implements {Driving}
 */
export class Repeated {
  /** @param {InputChange[]} inputs in the order of steps */
  constructor(inputs) {
    this.values = new Map(NAMES.map((name) => [name, 0]));
    /** @type {InputChange[]} */
    this.changes = [];
    this.inputs = inputs;
    this.next = 0;
  }

  /** @param {number} step */
  advance(step) {
    while (this.next < this.inputs.length && this.inputs[this.next].step <= step) {
      const { name, value } = this.inputs[this.next];
      note(this, step, name, value);
      this.next += 1;
    }
  }
}

/**
 * @param {Driving} driving
 * @param {number} step
 * @param {string} name
 * @param {number} value
 */
function note(driving, step, name, value) {
  if (driving.values.get(name) !== value) {
    driving.values.set(name, value);
    driving.changes.push({ step, name, value });
  }
}
