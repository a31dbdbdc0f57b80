// Forget what was learned at some places, or the newest lesson, after the drive: the function alone is
// put there and hears the button, so that the profile is changed by the function and by nobody else.

import { Fmu } from "./fmu.js";
import { filesOf, profilesOf, STORE } from "./coupling.js";

/** @typedef {import("../types.js").DriveSetup} DriveSetup */
/** @typedef {import("../types.js").Files} Files */
/** @typedef {import("./coupling.js").DriveBundle} DriveBundle */

/** No lesson of its own, and what was learned is in force: else there is nothing to forget. */
const LISTENING = Object.freeze({ learn: 0, apply_learned: true, profile_store: STORE });

/**
 * Return the profiles with what was learned at `places_m` forgotten, one place after the other.
 * @param {DriveBundle} bundle
 * @param {DriveSetup} setup its profiles, its values of the function
 * @param {number[]} places_m
 * @returns {Promise<Files>}
 * @throws {import("./fmu_error.js").FmuError} the function refused a value or a call
 */
export async function forgetPlaces(bundle, setup, places_m) {
  const fmu = await Fmu.load(bundle.models.pldf);
  let { profiles } = setup;
  for (const s_m of places_m) {
    profiles = pressed(fmu, bundle, { ...setup, profiles }, "teach.forget_here", s_m);
  }
  return profiles;
}

/**
 * Return the profiles with the newest lesson taken back.
 * @param {DriveBundle} bundle
 * @param {DriveSetup} setup
 * @returns {Promise<Files>}
 * @throws {import("./fmu_error.js").FmuError} the function refused a value or a call
 */
export async function undoLesson(bundle, setup) {
  return pressed(await Fmu.load(bundle.models.pldf), bundle, setup, "teach.undo", 0);
}

/**
 * Return the profiles after a button was pressed at `s_m`.
 * @param {Fmu} fmu
 * @param {DriveBundle} bundle
 * @param {DriveSetup} setup
 * @param {"teach.forget_here" | "teach.undo"} button
 * @param {number} s_m
 */
function pressed(fmu, bundle, setup, button, s_m) {
  const function_ = fmu.instantiate("pldf", filesOf("pldf", bundle, setup));
  function_.setAll({ ...setup.values.pldf, ...LISTENING, "vehicle.s_m": s_m });
  function_.enterInitialization();
  function_.exitInitialization();
  function_.step(0, setup.step_s);
  function_.set(button, true);
  function_.step(setup.step_s, setup.step_s);
  function_.terminate();
  return profilesOf(function_.files());
}
