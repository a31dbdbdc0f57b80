// A wheel, pedals or a gamepad, as its calibration says.

import { isPressed, travelOf } from "./calibration.js";
import { Lever } from "./lever.js";

/** @typedef {import("../../types.js").Controls} Controls */
/** @typedef {import("./calibration.js").Calibration} Calibration */
/** @typedef {import("./calibration.js").Button} Button */
/** @typedef {import("./lever.js").Way} Way */

/** @type {readonly Way[]} */
const WAYS = ["resume", "cancel", "up", "down"];

/** @typedef {Pick<Gamepad, "id" | "mapping" | "axes" | "buttons">} Pad */

const AND = " + ";

/**
 * Return the devices that are connected, and all of them as one: pedals may have a plug of their own.
 * Browsers show a device only after a button of it was pressed.
 * @returns {Pad[]}
 */
export function connectedDevices() {
  const found = navigator.getGamepads().flatMap((device) => (device?.connected ? [device] : []));
  return found.length > 1 ? [...found, together(found)] : found;
}

/**
 * @param {Gamepad[]} devices
 * @returns {Pad}
 */
function together(devices) {
  // By name: the order in which they were plugged in must not decide what is which.
  const sorted = devices.toSorted((one, other) => (one.id < other.id ? -1 : 1));
  return {
    id: sorted.map(({ id }) => id).join(AND),
    mapping: "",
    axes: sorted.flatMap(({ axes }) => [...axes]),
    buttons: sorted.flatMap(({ buttons }) => [...buttons]),
  };
}

/**
 * Return the device of this name (`Pad.id`); null if it is not connected, or a part of it.
 * @param {string} name
 */
export function deviceNamed(name) {
  return connectedDevices().find((device) => device.id === name) ?? null;
}

/** One device. */
export class GamepadInput {
  /**
   * @param {string} name of the device (`Pad.id`)
   * @param {Calibration} calibration
   */
  constructor(name, calibration) {
    this.name = name;
    this.calibration = calibration;
    this.lever = new Lever();
    this.pause_learning = false;
    this.pauseWas = false;
  }

  /** Whether it can be read. */
  get connected() {
    return deviceNamed(this.name) !== null;
  }

  /**
   * Return what the person does; null: the device is not connected.
   * @param {number} now_ms
   * @returns {Controls | null}
   */
  read(now_ms) {
    const device = deviceNamed(this.name);
    if (device === null) {
      this.lever.release();
      return null;
    }
    /** @param {Button} button */
    const pressed = (button) => isPressed(this.calibration, button, device);
    for (const way of WAYS) {
      this.lever.hold(way, pressed(way), now_ms);
    }
    this.switchPause(pressed("pause_learning"));
    return {
      gas_pedal: travelOf(this.calibration, "gas", device),
      brake_pedal: travelOf(this.calibration, "brake", device),
      steering: travelOf(this.calibration, "steering", device),
      ...this.lever.contacts(now_ms),
      pause_learning: this.pause_learning,
      forget_here: pressed("forget_here"),
      undo: pressed("undo"),
    };
  }

  /** @param {boolean} pressed the button that switches */
  switchPause(pressed) {
    if (pressed && !this.pauseWas) {
      this.pause_learning = !this.pause_learning;
    }
    this.pauseWas = pressed;
  }
}
