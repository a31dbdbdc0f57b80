// Which devices there are and how they are set up: kept in this browser by the device's name.

import { DEAD_ZONE, NEEDED, STANDARD } from "../engine/inputs/calibration.js";
import { GamepadInput } from "../engine/inputs/gamepad.js";
import { Inputs } from "../engine/inputs/inputs.js";
import { Keyboard } from "../engine/inputs/keyboard.js";
import { fromJson, toJson } from "./saved.js";

/** @typedef {import("../engine/inputs/calibration.js").Calibration} Calibration */
/** @typedef {import("../engine/inputs/calibration.js").Mapped} Mapped */

const KEY = "pldf-cockpit devices";
const DEAD_ZONE_MAX = 0.5;

/**
 * Return how a device was set up in this browser; null: it was not, or what is kept cannot be read.
 * @param {string} name
 * @returns {Calibration | null}
 */
export function savedCalibration(name) {
  const kept = /** @type {Record<string, unknown>} */ (fromJson(KEY))[name];
  return isCalibration(kept) ? kept : null;
}

/**
 * @param {string} name
 * @param {Calibration} calibration
 */
export function saveCalibration(name, calibration) {
  toJson(KEY, { ...fromJson(KEY), [name]: calibration });
}

/**
 * Return how a device is set up: by the person, or by a layout that all browsers know.
 * @param {{id: string, mapping: string}} device
 * @returns {Calibration | null} null: it must be set up first
 */
export function calibrationOf(device) {
  return savedCalibration(device.id) ?? (device.mapping === "standard" ? STANDARD : null);
}

/**
 * Return what a person drives with.
 * @param {string | null} name of the device; null: keyboard
 * @param {Calibration | null} [calibration]
 * @returns {Inputs}
 */
export function inputsOf(name, calibration = null) {
  const device = name !== null && calibration ? new GamepadInput(name, calibration) : null;
  return new Inputs(new Keyboard(), device);
}

/**
 * @param {unknown} kept
 * @returns {kept is Calibration}
 */
export function isCalibration(kept) {
  if (kept === null || typeof kept !== "object") {
    return false;
  }
  const { controls, dead_zone } = /** @type {Partial<Calibration>} */ (kept);
  if (controls === null || typeof controls !== "object") {
    return false;
  }
  const fits = typeof (dead_zone ?? DEAD_ZONE) === "number" && Number(dead_zone) >= 0;
  const mapped = Object.values(controls);
  return (
    fits &&
    Number(dead_zone) <= DEAD_ZONE_MAX &&
    NEEDED.every((control) => controls[control] !== undefined) &&
    mapped.every(isMapped)
  );
}

/** @param {Partial<Mapped> | null | undefined} one */
function isMapped(one) {
  return (
    (one?.kind === "axis" || one?.kind === "button") &&
    Number.isInteger(one.index) &&
    Number.isFinite(one.rest) &&
    Number.isFinite(one.full) &&
    one.rest !== one.full
  );
}
