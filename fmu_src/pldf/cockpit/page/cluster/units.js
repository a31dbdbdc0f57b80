// Speeds as people read them: only here numbers leave SI.

/** @typedef {import("./live.js").Unit} Unit */

const MPS_PER = { KMH: 1 / 3.6, MPH: 0.44704 };

/**
 * @param {number} speed_mps
 * @param {Unit} unit
 * @returns {number} in that unit
 */
export function inUnit(speed_mps, unit) {
  return speed_mps / MPS_PER[unit];
}

/**
 * @param {number} speed_mps
 * @param {Unit} unit
 * @returns {string} whole number, with a true minus; a dash for what is no number
 */
export function speedText(speed_mps, unit) {
  if (!Number.isFinite(speed_mps)) return "–";
  return whole(inUnit(speed_mps, unit));
}

/**
 * @param {number} change_mps
 * @param {Unit} unit
 * @returns {string} whole number with its sign: +8, −8, 0
 */
export function changeText(change_mps, unit) {
  const text = speedText(change_mps, unit);
  return change_mps > 0 && text !== "0" && text !== "–" ? `+${text}` : text;
}

/** @param {Unit} unit @returns {string} */
export function unitText(unit) {
  return unit === "MPH" ? "mph" : "km/h";
}

/**
 * Return a distance as one says it while driving: by 10 m, from a kilometre on by 100 m.
 * @param {number} distance_m
 * @param {import("../language.js").Language} language
 * @returns {string}
 */
export function distanceText(distance_m, language) {
  if (distance_m < 995) return `${10 * Math.round(distance_m / 10)} m`;
  const kilometres = (Math.round(distance_m / 100) / 10).toFixed(1);
  return `${language === "de" ? kilometres.replace(".", ",") : kilometres} km`;
}

/** @param {number} number @returns {string} */
function whole(number) {
  return String(Math.round(number) + 0).replace("-", "−");
}
