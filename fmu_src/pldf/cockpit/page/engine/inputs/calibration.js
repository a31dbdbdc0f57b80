// What the axes and buttons of a device mean, found by asking for each control once.

/** @typedef {"gas" | "brake" | "steering"} Axis */
/** @typedef {"resume" | "cancel" | "up" | "down" | "pause_learning" | "forget_here" | "undo"} Button */
/** @typedef {Axis | Button} Control */

/**
 * A control on a device. An axis is at `rest` when let go and at `full` when pressed (the wheel: turned
 * to the left); that `full` may be below `rest` is how an axis is inverted. A pedal may be a button.
 * @typedef {object} Mapped
 * @property {"axis" | "button"} kind
 * @property {number} index
 * @property {number} rest
 * @property {number} full
 */

/**
 * All of a device; what is not mapped is not on it. As JSON it is what is kept of the device.
 * @typedef {object} Calibration
 * @property {Partial<Record<Control, Mapped>>} controls
 * @property {number} dead_zone share of the travel that counts as none, 0..0.5
 */

/** @typedef {{axes: readonly number[], buttons: readonly {value: number, pressed: boolean}[]}} Device */

/** @type {readonly Control[]} in the order in which they are asked for */
export const CONTROLS = Object.freeze([
  "gas",
  "brake",
  "steering",
  "resume",
  "cancel",
  "up",
  "down",
  "pause_learning",
  "forget_here",
  "undo",
]);
/** Without these one cannot drive. @type {readonly Control[]} */
export const NEEDED = Object.freeze(["gas", "brake"]);
export const DEAD_ZONE = 0.05;
/** @type {ReadonlySet<Control>} */
const PEDALS = new Set(["gas", "brake"]);
/** A movement by this much of an axis (-1..1) is meant. */
const MEANT = 0.5;

/**
 * @param {number} index of a button
 * @returns {Mapped}
 */
function button(index) {
  return { kind: "button", index, rest: 0, full: 1 };
}

/** A gamepad in the layout "standard" of the Gamepad API. @type {Readonly<Calibration>} */
export const STANDARD = Object.freeze({
  dead_zone: DEAD_ZONE,
  controls: {
    gas: button(7),
    brake: button(6),
    steering: /** @type {Mapped} */ ({ kind: "axis", index: 0, rest: 0, full: -1 }),
    resume: button(0),
    cancel: button(1),
    up: button(12),
    down: button(13),
    pause_learning: button(3),
    forget_here: button(2),
    undo: button(8),
  },
});

/** One control after the other is asked for; `look` is called with the device as it is now. */
export class Calibrating {
  /**
   * @param {Device} device with all controls let go, after each axis was moved once: until then
   *   browsers report 0 of an axis, wherever it rests
   */
  constructor(device) {
    /** @type {Calibration} */
    this.calibration = { controls: {}, dead_zone: DEAD_ZONE };
    this.asked = 0;
    this.rest = snapshot(device);
    /** @type {Mapped | null} the control that moves now */
    this.moving = null;
    /** Share of its travel, 0..1, that the control asked for shows; 0 until one moves. */
    this.travel = 0;
  }

  /** What is asked for now; null: all were. */
  get control() {
    return CONTROLS[this.asked] ?? null;
  }

  /**
   * Take notice of the device; when the control that moved is let go, it is mapped.
   * @param {Device} device
   * @returns {boolean} whether the next one is asked for now
   */
  look(device) {
    if (this.control === null) {
      return false;
    }
    const found = this.moving ?? mostMoved(this.rest, device, this.taken());
    if (found === null) {
      return false;
    }
    const value = valueOf(found, device);
    const beyond = Math.abs(value - found.rest) > Math.abs(found.full - found.rest);
    this.moving = beyond ? { ...found, full: value } : found;
    this.travel = Math.abs(value - found.rest) / Math.abs(this.moving.full - found.rest);
    if (this.travel > 1 - MEANT) {
      return false;
    }
    this.calibration.controls[this.control] = this.moving;
    this.next();
    return true;
  }

  /** The device has no such control. */
  skip() {
    this.next();
  }

  /** Whether all that is needed is known. */
  get complete() {
    return NEEDED.every((control) => this.calibration.controls[control] !== undefined);
  }

  next() {
    this.asked += 1;
    this.moving = null;
    this.travel = 0;
  }

  /** @returns {Mapped[]} */
  taken() {
    return Object.values(this.calibration.controls);
  }
}

/**
 * Return the share of its travel that a control shows, 0..1; the wheel -1..1. 0 if it is not on the device.
 * @param {Calibration} calibration
 * @param {Control} control
 * @param {Device} device
 */
export function travelOf(calibration, control, device) {
  const mapped = calibration.controls[control];
  if (mapped === undefined) {
    return 0;
  }
  const share = (valueOf(mapped, device) - mapped.rest) / (mapped.full - mapped.rest);
  const low = control === "steering" ? -1 : 0;
  const beyond = Math.max(0, Math.abs(share) - calibration.dead_zone) / (1 - calibration.dead_zone);
  return Math.max(low, Math.min(Math.sign(share) * beyond, 1)) || 0;
}

/**
 * Return whether a button, or what is used as one, is pressed.
 * @param {Calibration} calibration
 * @param {Control} control
 * @param {Device} device
 */
export function isPressed(calibration, control, device) {
  return travelOf(calibration, control, device) > MEANT;
}

/**
 * Return the calibration with an axis the other way round.
 * @param {Calibration} calibration
 * @param {Control} control
 * @returns {Calibration}
 */
export function inverted(calibration, control) {
  const mapped = calibration.controls[control];
  if (mapped === undefined) {
    return calibration;
  }
  const { rest, full } = mapped;
  const other = PEDALS.has(control) ? { rest: full, full: rest } : { rest, full: 2 * rest - full };
  return {
    ...calibration,
    controls: { ...calibration.controls, [control]: { ...mapped, ...other } },
  };
}

/** @param {Device} device */
function snapshot(device) {
  return { axes: [...device.axes], buttons: device.buttons.map(({ value }) => ({ value })) };
}

/**
 * Return the control that has moved most since the rest, far enough to be meant; null if none has.
 * @param {ReturnType<typeof snapshot>} rest
 * @param {Device} device
 * @param {Mapped[]} taken
 * @returns {Mapped | null}
 */
function mostMoved(rest, device, taken) {
  /** @type {Mapped[]} */
  const all = [
    ...rest.axes.map((at, index) => mapped("axis", index, at, device)),
    ...rest.buttons.map(({ value }, index) => mapped("button", index, value, device)),
  ];
  const free = all.filter((one) => !taken.some((other) => isSame(one, other)));
  /** @param {Mapped} one */
  const moved = (one) => Math.abs(one.full - one.rest);
  const most = free.sort((one, other) => moved(other) - moved(one))[0];
  return most !== undefined && moved(most) >= MEANT ? most : null;
}

/**
 * Tell whether two controls are one; an axis can be two, such as gas one way and brake the other.
 * @param {Mapped} one
 * @param {Mapped} other
 */
function isSame(one, other) {
  const ways = Math.sign(one.full - one.rest) * Math.sign(other.full - other.rest);
  return one.kind === other.kind && one.index === other.index && ways >= 0;
}

/**
 * @param {Mapped["kind"]} kind
 * @param {number} index
 * @param {number} rest
 * @param {Device} device
 * @returns {Mapped}
 */
function mapped(kind, index, rest, device) {
  const full = valueOf({ kind, index, rest, full: rest }, device);
  return { kind, index, rest, full };
}

/**
 * @param {Mapped} mapped
 * @param {Device} device
 */
function valueOf({ kind, index, rest }, device) {
  return (kind === "axis" ? device.axes[index] : device.buttons[index]?.value) ?? rest;
}
