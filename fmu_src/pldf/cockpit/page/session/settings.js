// What the person sets for the page: kept in this browser, for visitors and for each participant.

import { fromJson, toJson } from "./saved.js";

/**
 * @typedef {object} Settings
 * @property {"cockpit" | "chase"} camera
 * @property {boolean} sound
 * @property {boolean} mirror
 * @property {"kmh" | "mph"} unit
 * @property {"assisted" | "person"} steering
 * @property {number} fov_deg horizontal field of view
 * @property {"auto" | "less"} motion auto: as the system is set
 * @property {string} whose participant; empty: whoever visits
 */
/**
 * What a person sees and hears, as it is kept with a drive.
 * @typedef {Pick<Settings, "camera" | "sound" | "mirror" | "unit" | "fov_deg"> & {reduced_motion: boolean}} Shown
 */

const KEY = "pldf-cockpit settings";
/** As in study files. */
export const FOV_DEG = { low: 20, high: 150 };

/**
 * Return the settings kept in this browser, and the plan's where there are none.
 *
 * Those of one participant are not the next one's: all begin with the same picture and sound.
 * @param {{steering: Settings["steering"], fov_deg: number}} plan
 * @param {string} [whose] participant
 * @returns {Settings}
 */
export function readSettings(plan, whose = "") {
  /** @type {Settings} */
  const first = {
    camera: "cockpit",
    sound: true,
    mirror: true,
    unit: "kmh",
    steering: plan.steering,
    fov_deg: plan.fov_deg,
    motion: "auto",
    whose,
  };
  return checked({ ...first, ...fromJson(keyOf(whose)) }, first);
}

/**
 * Return the unit of speeds as the cluster and the function's messages name it.
 * @param {Pick<Settings, "unit">} settings
 * @returns {"KMH" | "MPH"}
 */
export function unitOf({ unit }) {
  return unit === "mph" ? "MPH" : "KMH";
}

/**
 * Return `settings` with what cannot be replaced by what it was `first`.
 * @param {Settings} settings
 * @param {Settings} first
 * @returns {Settings}
 */
export function checked(settings, first) {
  const choices = {
    camera: ["cockpit", "chase"],
    sound: [true, false],
    mirror: [true, false],
    unit: ["kmh", "mph"],
    steering: ["assisted", "person"],
    motion: ["auto", "less"],
  };
  const known = Object.entries(choices).map(([key, values]) => {
    const name = /** @type {keyof typeof choices} */ (key);
    return [name, values.some((one) => one === settings[name]) ? settings[name] : first[name]];
  });
  const fits = settings.fov_deg >= FOV_DEG.low && settings.fov_deg <= FOV_DEG.high;
  const { whose } = first;
  return { ...Object.fromEntries(known), whose, fov_deg: fits ? settings.fov_deg : first.fov_deg };
}

/** @param {Settings} settings */
export function saveSettings(settings) {
  toJson(keyOf(settings.whose), settings);
}

/** @param {string} whose */
function keyOf(whose) {
  return `${KEY} ${whose}`.trim();
}

/**
 * @param {Settings} settings
 * @returns {Shown}
 */
export function shownBy(settings) {
  const { camera, sound, mirror, unit, fov_deg } = settings;
  return { camera, sound, mirror, unit, fov_deg, reduced_motion: reducedMotion(settings) };
}

/**
 * @param {Settings} settings
 * @returns {boolean} whether moving pictures are to be few
 */
export function reducedMotion(settings) {
  return settings.motion === "less" || matchMedia("(prefers-reduced-motion: reduce)").matches;
}
