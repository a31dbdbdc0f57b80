// What the person drives with: devices appear when a button of theirs is pressed, the keyboard is always there.

import { element, fill } from "../dom.js";
import { connectedDevices } from "../engine/inputs/gamepad.js";
import { button, buttons, showPage } from "./app.js";
import { calibrationOf, inputsOf, saveCalibration, savedCalibration } from "./devices.js";
import { calibrate } from "./calibration_screen.js";
import { keysTable } from "./keys_table.js";
import { say } from "./drive_words.js";

/** @typedef {import("../engine/inputs/gamepad.js").Pad} Pad */
/** @typedef {import("../engine/inputs/inputs.js").Inputs} Inputs */
/** @typedef {import("./app.js").App} App */
/** @typedef {{name: string | null, calibrate: boolean}} Choice name null: keyboard */

const LOOK_MS = 300;

/**
 * Let the person choose and set up a device.
 * @param {App} app
 * @returns {Promise<Inputs>}
 */
export async function chooseDevice(app) {
  for (;;) {
    const { name, calibrate: anew } = await offered(app);
    if (name === null) {
      return inputsOf(null);
    }
    const device = connectedDevices().find((one) => one.id === name);
    const known = device ? calibrationOf(device) : null;
    const calibration = anew || !known ? await calibrate(app, name, known) : known;
    if (calibration) {
      saveCalibration(name, calibration);
      return inputsOf(name, calibration);
    }
  }
}

/**
 * @param {App} app
 * @returns {Promise<Choice>}
 */
function offered(app) {
  return new Promise((resolve) => {
    const list = element("ul", { class: "devices" });
    /** @param {Choice} choice */
    const chosen = (choice) => {
      clearInterval(timer);
      resolve(choice);
    };
    let shown = "";
    const look = () => {
      const found = connectedDevices();
      const now = JSON.stringify(found.map(({ id }) => id));
      if (now !== shown) {
        shown = now;
        const rows = found.map((device) => deviceRow(device, chosen));
        fill(
          list,
          ...rows,
          keyboardRow(() => chosen({ name: null, calibrate: false })),
        );
      }
    };
    const timer = setInterval(look, LOOK_MS);
    look();
    const steered = app.settings.steering === "person";
    const keys = element("div", {}, element("h2", {}, say("keys_title")), keysTable(steered, true));
    showPage(app, say("device_title"), element("p", {}, say("device_text")), list, keys);
  });
}

/**
 * @param {Pad} device
 * @param {(choice: Choice) => void} chosen
 */
function deviceRow(device, chosen) {
  const name = device.id;
  const known = calibrationOf(device) !== null;
  const state = savedCalibration(name)
    ? say("calibrated")
    : known
      ? say("standard")
      : say("not_calibrated");
  return element(
    "li",
    {},
    element("strong", {}, name),
    element("small", {}, state),
    buttons(
      known && button(say("use"), () => chosen({ name, calibrate: false }), "main"),
      button(known ? say("again") : say("calibrate"), () => chosen({ name, calibrate: true })),
    ),
  );
}

/** @param {() => void} chosen */
function keyboardRow(chosen) {
  const name = element("strong", {}, say("keyboard"));
  return element("li", {}, name, buttons(button(say("use"), chosen, "main")));
}
