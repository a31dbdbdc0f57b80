// A keyboard as pedals, wheel and lever: what a key can only switch moves at a foot's pace.

import { Lever } from "./lever.js";

/** @typedef {import("../../types.js").Controls} Controls */
/** @typedef {import("./lever.js").Way} Way */

/**
 * What a key does.
 * @typedef {"gas" | "brake" | "left" | "right" | Way | "pause_learning" | "forget_here" | "undo"} Action
 */

/** @type {Readonly<Record<string, Action>>} by the key's place on the keyboard, not by its letter */
export const KEYS = Object.freeze({
  ArrowUp: "gas",
  KeyW: "gas",
  ArrowDown: "brake",
  KeyS: "brake",
  ArrowLeft: "left",
  KeyA: "left",
  ArrowRight: "right",
  KeyD: "right",
  KeyR: "resume",
  KeyC: "cancel",
  KeyE: "up",
  PageUp: "up",
  NumpadAdd: "up",
  KeyQ: "down",
  PageDown: "down",
  NumpadSubtract: "down",
  KeyP: "pause_learning",
  KeyF: "forget_here",
  KeyU: "undo",
});
/** @type {ReadonlySet<Action>} */
const WAYS = new Set(["resume", "cancel", "up", "down"]);

/** What keys are written into. */
const WRITTEN_INTO = "input, select, textarea, [contenteditable]";

/** Travel per second of a pedal that is pressed, and that is let go. */
const PEDAL_RATES = Object.freeze({ gas: [0.7, 3], brake: [0.9, 4] });
/** Travel per second of the wheel, turned and let go. */
const WHEEL_RATES = [1, 4];
/** A moment without a picture moves pedals and wheel by no more than this many ms of it. */
const MOVED_MAX_MS = 100;

/** Pedals, wheel, lever and buttons on a keyboard. */
export class Keyboard {
  /** @param {Window} [target] where the keys are heard */
  constructor(target = window) {
    this.target = target;
    this.lever = new Lever();
    /** @type {Map<string, Action>} keys that are down */
    this.down = new Map();
    this.gas = 0;
    this.brake = 0;
    this.wheel = 0;
    this.pause_learning = false;
    /** @type {Set<Action>} buttons pressed since they were read */
    this.pressed = new Set();
    this.read_ms = NaN;
    this.listeners = /** @type {const} */ ({
      keydown: (/** @type {KeyboardEvent} */ event) => this.press(event),
      keyup: (/** @type {KeyboardEvent} */ event) => this.let(event),
      blur: () => this.release(),
    });
    target.addEventListener("keydown", this.listeners.keydown);
    target.addEventListener("keyup", this.listeners.keyup);
    target.addEventListener("blur", this.listeners.blur);
  }

  /** Hear no more keys. */
  dispose() {
    this.target.removeEventListener("keydown", this.listeners.keydown);
    this.target.removeEventListener("keyup", this.listeners.keyup);
    this.target.removeEventListener("blur", this.listeners.blur);
  }

  /**
   * Return what the person does.
   * @param {number} now_ms
   * @returns {Controls}
   */
  read(now_ms) {
    const passed_ms = this.read_ms <= now_ms ? now_ms - this.read_ms : 0;
    this.read_ms = now_ms;
    this.move(Math.min(passed_ms, MOVED_MAX_MS) / 1000);
    const controls = {
      gas_pedal: this.gas,
      brake_pedal: this.brake,
      steering: this.wheel,
      ...this.lever.contacts(now_ms),
      pause_learning: this.pause_learning,
      forget_here: this.holds("forget_here") || this.pressed.has("forget_here"),
      undo: this.holds("undo") || this.pressed.has("undo"),
    };
    this.pressed.clear();
    return controls;
  }

  /**
   * Press a button that is shown on the page.
   * @param {"pause_learning" | "forget_here" | "undo"} action
   */
  push(action) {
    if (action === "pause_learning") {
      this.pause_learning = !this.pause_learning;
    } else {
      this.pressed.add(action);
    }
  }

  /** Let all keys go. */
  release() {
    this.down.clear();
    this.lever.release();
    this.pressed.clear();
  }

  /** @param {KeyboardEvent} event */
  press(event) {
    const action = KEYS[event.code];
    if (!action || event.ctrlKey || event.altKey || event.metaKey || isWriting(event)) {
      return;
    }
    event.preventDefault();
    if (event.repeat || this.down.has(event.code)) {
      return;
    }
    this.down.set(event.code, action);
    if (isWay(action)) {
      this.lever.hold(action, true, event.timeStamp);
    } else if (action === "pause_learning" || action === "forget_here" || action === "undo") {
      this.push(action);
    }
  }

  /** @param {KeyboardEvent} event */
  let(event) {
    const action = this.down.get(event.code);
    if (action === undefined) {
      return;
    }
    event.preventDefault();
    this.down.delete(event.code);
    if (isWay(action) && !this.holds(action)) {
      this.lever.hold(action, false, event.timeStamp);
    }
  }

  /** @param {Action} action */
  holds(action) {
    return [...this.down.values()].includes(action);
  }

  /** @param {number} passed_s */
  move(passed_s) {
    this.gas = moved(this.gas, this.holds("gas") ? 1 : 0, PEDAL_RATES.gas, passed_s);
    this.brake = moved(this.brake, this.holds("brake") ? 1 : 0, PEDAL_RATES.brake, passed_s);
    const wheel = Number(this.holds("left")) - Number(this.holds("right"));
    this.wheel = moved(this.wheel, wheel, WHEEL_RATES, passed_s);
  }
}

/**
 * Return a travel on its way to `aim`.
 * @param {number} travel
 * @param {number} aim
 * @param {readonly number[]} rates per second: away from 0, back to it
 * @param {number} passed_s
 */
function moved(travel, aim, rates, passed_s) {
  const most = passed_s * (Math.abs(aim) > 0 ? rates[0] : rates[1]);
  return travel + Math.max(-most, Math.min(aim - travel, most));
}

/**
 * @param {Action} action
 * @returns {action is Way}
 */
function isWay(action) {
  return WAYS.has(action);
}

/** @param {KeyboardEvent} event */
function isWriting(event) {
  const target = /** @type {Partial<Element> | null} */ (event.target);
  return target?.matches?.(WRITTEN_INTO) ?? false;
}
