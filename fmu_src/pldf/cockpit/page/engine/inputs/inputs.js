// All that a person drives with: a keyboard, always, and a device if one was chosen.

import { GamepadInput } from "./gamepad.js";
import { Keyboard } from "./keyboard.js";

/** @typedef {import("../../types.js").Controls} Controls */

/** Name of the keyboard in the data. */
export const KEYBOARD = "keyboard";

/** What keyboard and device say, as one. The pedals of a device count alone: they are no switches. */
export class Inputs {
  /**
   * @param {Keyboard} keyboard
   * @param {GamepadInput | null} [device]
   */
  constructor(keyboard, device = null) {
    this.keyboard = keyboard;
    this.device = device;
    this.keyboardPause = false;
    this.devicePause = false;
    this.pause_learning = false;
  }

  /** Name of what the person drives with. */
  get name() {
    return this.device?.name ?? KEYBOARD;
  }

  /** Begin a drive: nothing is pressed, learning is not paused. */
  begin() {
    this.keyboard.release();
    this.pause_learning = false;
  }

  /**
   * Return what the person does; null: the device is not connected any more.
   * @param {number} now_ms
   * @returns {Controls | null}
   */
  read(now_ms) {
    const keys = this.keyboard.read(now_ms);
    const device = this.device?.read(now_ms);
    if (device === null) {
      return null;
    }
    const controls = device === undefined ? keys : joined(keys, device);
    return { ...controls, pause_learning: this.pause(keys, device) };
  }

  /**
   * Return the switch that both can flip.
   * @param {Controls} keys
   * @param {Controls} [device]
   */
  pause(keys, device) {
    const now = device?.pause_learning ?? false;
    const flips =
      Number(keys.pause_learning !== this.keyboardPause) + Number(now !== this.devicePause);
    this.keyboardPause = keys.pause_learning;
    this.devicePause = now;
    this.pause_learning = flips === 1 ? !this.pause_learning : this.pause_learning;
    return this.pause_learning;
  }
}

/**
 * @param {Controls} keys
 * @param {Controls} device
 * @returns {Controls}
 */
function joined(keys, device) {
  return {
    ...device,
    resume: keys.resume || device.resume,
    cancel: keys.cancel || device.cancel,
    up: keys.up || device.up,
    down: keys.down || device.down,
    up_long: keys.up_long || device.up_long,
    down_long: keys.down_long || device.down_long,
    forget_here: keys.forget_here || device.forget_here,
    undo: keys.undo || device.undo,
  };
}
