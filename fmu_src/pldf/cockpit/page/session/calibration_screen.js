// A device is set up: press each pedal, pull each lever; then try it, and turn round what is inverted.

import { element, fill } from "../dom.js";
import {
  CONTROLS,
  Calibrating,
  inverted,
  isPressed,
  travelOf,
} from "../engine/inputs/calibration.js";
import { deviceNamed } from "../engine/inputs/gamepad.js";
import { button, buttons, showPage } from "./app.js";
import { say } from "./drive_words.js";
import { say as sayPage } from "./words.js";

/** @typedef {import("../engine/inputs/calibration.js").Calibration} Calibration */
/** @typedef {import("../engine/inputs/calibration.js").Control} Control */
/** @typedef {import("./app.js").App} App */

const AXES = /** @type {const} */ (["gas", "brake", "steering"]);
const AXIS_WORD = /** @type {const} */ ({ gas: "gas", brake: "brake", steering: "wheel" });
const PERCENT_MAX = 50;

/**
 * Set up a device.
 * @param {App} app
 * @param {string} name of the device
 * @param {Calibration | null} known so far: it is shown first
 * @returns {Promise<Calibration | null>} null: back to the choice of devices
 */
export async function calibrate(app, name, known) {
  let calibration = known;
  for (;;) {
    calibration ??= await asked(app, name);
    if (!calibration) {
      return null;
    }
    const tried = await triedOut(app, name, calibration);
    if (tried !== "again") {
      return tried;
    }
    calibration = null;
  }
}

/**
 * Ask for each control.
 * @param {App} app
 * @param {string} name
 * @returns {Promise<Calibration | null>}
 */
async function asked(app, name) {
  const begun = await letGo(app, name);
  return begun ? each(app, name) : null;
}

/**
 * Browsers say 0 of an axis until it has moved, so everything is moved and let go once.
 * @param {App} app
 * @param {string} name
 * @returns {Promise<boolean>}
 */
function letGo(app, name) {
  return new Promise((resolve) => {
    showPage(
      app,
      name,
      element("p", {}, say("move_all")),
      element("p", {}, say("let_go")),
      buttons(
        button(sayPage("begin"), () => resolve(true), "main"),
        button(sayPage("back"), () => resolve(false)),
      ),
    );
  });
}

/**
 * @param {App} app
 * @param {string} name
 * @returns {Promise<Calibration | null>}
 */
function each(app, name) {
  const device = deviceNamed(name);
  if (!device) {
    return Promise.resolve(null);
  }
  const calibrating = new Calibrating(device);
  return new Promise((resolve) => {
    const question = element("p", { class: "question", "aria-live": "polite" });
    const bar = element("progress", { max: 1, "aria-label": say("try_it") });
    const told = element("p", { class: "problem" });
    const skip = button(say("skip"), () => {
      calibrating.skip();
      ask();
    });
    const ask = () => {
      fill(question, calibrating.control && say(`ask_${calibrating.control}`));
      if (calibrating.control === null) {
        finished();
      }
    };
    const finished = () => {
      if (calibrating.complete) {
        resolve(calibrating.calibration);
      } else {
        fill(told, say("needed"));
        skip.remove();
      }
    };
    const back = button(sayPage("back"), () => resolve(null));
    const page = showPage(app, name, question, bar, told, buttons(skip, back));
    ask();
    everyFrame(page, () => {
      const now = deviceNamed(name);
      if (now && calibrating.look(now)) {
        ask();
      }
      bar.setAttribute("value", String(calibrating.travel));
    });
  });
}

/**
 * Show what the device does as it is set up.
 * @param {App} app
 * @param {string} name
 * @param {Calibration} first
 * @returns {Promise<Calibration | "again" | null>}
 */
function triedOut(app, name, first) {
  let calibration = first;
  return new Promise((resolve) => {
    const rows = AXES.filter((axis) => calibration.controls[axis]).map((axis) =>
      axisRow(axis, () => {
        calibration = inverted(calibration, axis);
      }),
    );
    const pressed = element("p", { class: "pressed", "aria-live": "polite" });
    const page = showPage(
      app,
      name,
      element("p", {}, say("try_it")),
      ...rows.map(({ row }) => row),
      pressed,
      deadZone(calibration, (dead_zone) => {
        calibration = { ...calibration, dead_zone };
      }),
      buttons(
        button(say("save"), () => resolve(calibration), "main"),
        button(say("again"), () => resolve("again")),
        button(sayPage("back"), () => resolve(null)),
      ),
    );
    everyFrame(page, () => {
      const device = deviceNamed(name);
      if (device) {
        rows.forEach(({ axis, meter }) => {
          meter.setAttribute("value", String(travelOf(calibration, axis, device)));
        });
        const down = CONTROLS.filter((one) => !isAxis(one) && isPressed(calibration, one, device));
        fill(pressed, down.map((one) => say(`name_${/** @type {Button} */ (one)}`)).join(", "));
      }
    });
  });
}

/** @typedef {import("../engine/inputs/calibration.js").Button} Button */
/** @typedef {import("../engine/inputs/calibration.js").Axis} Axis */

/** @param {Control} control */
function isAxis(control) {
  return AXES.some((axis) => axis === control);
}

/**
 * @param {Axis} axis
 * @param {() => void} invert
 */
function axisRow(axis, invert) {
  const text = say(AXIS_WORD[axis]);
  const low = axis === "steering" ? -1 : 0;
  const meter = element("meter", { min: low, max: 1, value: 0, "aria-label": text });
  const row = element(
    "div",
    { class: "axis" },
    element("span", {}, text),
    meter,
    button(say("invert"), invert),
  );
  return { axis, meter, row };
}

/**
 * @param {Calibration} calibration
 * @param {(share: number) => void} changed
 */
function deadZone(calibration, changed) {
  const input = /** @type {HTMLInputElement} */ (
    element("input", {
      type: "number",
      min: 0,
      max: PERCENT_MAX,
      value: Math.round(100 * calibration.dead_zone),
    })
  );
  input.addEventListener("change", () => {
    const percent = Math.max(0, Math.min(Number(input.value) || 0, PERCENT_MAX));
    input.value = String(percent);
    changed(percent / 100);
  });
  return element("label", {}, say("dead_zone"), input);
}

/**
 * Do something before each picture as long as `page` is shown.
 * @param {HTMLElement} page
 * @param {() => void} act
 */
function everyFrame(page, act) {
  const tick = () => {
    if (page.isConnected) {
      act();
      requestAnimationFrame(tick);
    }
  };
  requestAnimationFrame(tick);
}
