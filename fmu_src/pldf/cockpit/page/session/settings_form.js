// The settings as a form; a change counts at once.

import { element } from "../dom.js";
import { FOV_DEG, saveSettings } from "./settings.js";
import { say } from "./drive_words.js";

/** @typedef {import("./settings.js").Settings} Settings */

/**
 * Return a form that changes `settings` and keeps them in this browser.
 * @param {Settings} settings
 * @param {object} how
 * @param {boolean} how.study steering and field of view are the plan's
 * @param {boolean} [how.driving] the unit is that of the drive that goes on
 * @param {() => void} [how.changed]
 * @returns {HTMLElement}
 */
export function settingsForm(settings, { study, driving = false, changed = () => {} }) {
  const kept = () => {
    saveSettings(settings);
    changed();
  };
  /**
   * @template {"camera" | "unit" | "steering" | "motion"} K
   * @param {K} key
   * @param {string} text
   * @param {[Settings[K], string][]} options
   */
  const choice = (key, text, options) => {
    const made = options.map(([value, label]) =>
      element("option", { value, selected: settings[key] === value }, label),
    );
    const select = /** @type {HTMLSelectElement} */ (element("select", { name: key }, ...made));
    select.addEventListener("change", () => {
      settings[key] = /** @type {Settings[K]} */ (select.value);
      kept();
    });
    return element("label", {}, text, select);
  };
  /**
   * @param {"sound" | "mirror"} key
   * @param {string} text
   */
  const flag = (key, text) => {
    const input = /** @type {HTMLInputElement} */ (
      element("input", { type: "checkbox", name: key, checked: settings[key] })
    );
    input.addEventListener("change", () => {
      settings[key] = input.checked;
      kept();
    });
    return element("label", { class: "flag" }, input, text);
  };
  return element(
    "form",
    { class: "settings", onsubmit: (/** @type {Event} */ event) => event.preventDefault() },
    choice("camera", say("camera"), [
      ["cockpit", say("camera_cockpit")],
      ["chase", say("camera_chase")],
    ]),
    !driving &&
      choice("unit", say("unit"), [
        ["kmh", "km/h"],
        ["mph", "mph"],
      ]),
    !study &&
      choice("steering", say("steering"), [
        ["assisted", say("steering_assisted")],
        ["person", say("steering_person")],
      ]),
    choice("motion", say("motion"), [
      ["auto", say("motion_auto")],
      ["less", say("motion_less")],
    ]),
    !study && fieldOfView(settings, kept),
    flag("sound", say("sound")),
    flag("mirror", say("mirror")),
  );
}

/**
 * @param {Settings} settings
 * @param {() => void} kept
 */
function fieldOfView(settings, kept) {
  const { low, high } = FOV_DEG;
  const input = /** @type {HTMLInputElement} */ (
    element("input", {
      type: "number",
      name: "fov_deg",
      min: low,
      max: high,
      value: settings.fov_deg,
    })
  );
  input.addEventListener("change", () => {
    settings.fov_deg = Math.max(low, Math.min(Number(input.value) || settings.fov_deg, high));
    input.value = String(settings.fov_deg);
    kept();
  });
  return element("label", {}, say("fov"), input);
}
