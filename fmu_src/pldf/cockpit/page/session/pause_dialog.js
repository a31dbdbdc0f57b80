// The drive stands: why, and how it goes on or ends; with a word on how people feel.

import { element, fill } from "../dom.js";
import { button, buttons } from "./app.js";
import { settingsForm } from "./settings_form.js";
import { say } from "./drive_words.js";
import { say as sayPage } from "./words.js";

/** @typedef {import("../engine/inputs/inputs.js").Inputs} Inputs */
/** @typedef {import("./app.js").App} App */

// What is written into the data, whatever language is spoken.
export const REASONS = /** @type {const} */ ({
  unwell: "felt unwell",
  time: "no more time",
  broken: "something did not work",
  other: "other or no reason",
});
const NAMES = /** @type {(keyof typeof REASONS)[]} */ (Object.keys(REASONS));

/**
 * Return a reason of the data in words; what somebody else wrote as it is.
 * @param {string} reason
 * @returns {string}
 */
export function reasonText(reason) {
  const name = NAMES.find((one) => REASONS[one] === reason);
  return name ? sayPage(`reason_${name}`) : reason;
}

export class PauseDialog {
  /**
   * @param {object} does
   * @param {() => void} does.resume
   * @param {(reason: string) => void} does.stop
   * @param {App} does.app
   * @param {() => void} does.changed a setting
   */
  constructor({ resume, stop, app, changed }) {
    this.resume = resume;
    this.stop = stop;
    this.app = app;
    this.changed = changed;
    this.asksWhy = false;
    this.stands = false;
    this.root = /** @type {HTMLDialogElement} */ (element("dialog", { class: "pause" }));
    this.root.addEventListener("cancel", (event) => {
      event.preventDefault();
      this.goOn();
    });
    // Browsers may close it although that was prevented; as long as the drive stands, it is there.
    this.root.addEventListener("close", () => this.stands && this.root.showModal());
  }

  /**
   * @param {string} reason why the drive stands
   * @param {Inputs | null} inputs
   */
  open(reason, inputs) {
    this.inputs = inputs;
    this.stands = true;
    this.told = element("p", {}, pauseText(reason, inputs?.name ?? ""));
    const why = this.asksWhy;
    fill(
      this.root,
      element("h2", {}, why ? sayPage("unwell_title") : say("paused")),
      !why && this.told,
      element("p", { class: "unwell" }, sayPage("unwell")),
      why ? this.reasons() : this.choices(),
      why && buttons(button(say("go_on"), () => this.goOn())),
    );
    if (!this.root.open) {
      this.root.showModal();
    }
  }

  choices() {
    const ask = () => {
      this.asksWhy = true;
      this.open("", this.inputs ?? null);
    };
    const settings = settingsForm(this.app.settings, {
      study: true,
      driving: true,
      changed: this.changed,
    });
    return element(
      "div",
      {},
      buttons(
        button(say("go_on"), () => this.goOn(), "main"),
        button(say("stop"), ask, "stop"),
      ),
      element("details", {}, element("summary", {}, say("settings")), settings),
    );
  }

  reasons() {
    const asked = NAMES.map((name) =>
      button(sayPage(`reason_${name}`), () => {
        this.close();
        this.stop(REASONS[name]);
      }),
    );
    return element("div", { class: "reasons" }, element("p", {}, sayPage("why_stop")), ...asked);
  }

  /** Go on, if the device is there again. */
  goOn() {
    if (this.inputs?.read(performance.now()) === null) {
      fill(/** @type {HTMLElement} */ (this.told), pauseText("disconnected", this.inputs.name));
      return;
    }
    this.close();
    this.resume();
  }

  close() {
    this.asksWhy = false;
    this.stands = false;
    this.root.close();
  }
}

/**
 * @param {string} reason
 * @param {string} device
 */
function pauseText(reason, device) {
  switch (reason) {
    case "hidden":
      return say("paused_hidden");
    case "late":
      return say("paused_late");
    case "disconnected":
      return say("paused_device", { device });
    default:
      return say("paused_person");
  }
}
