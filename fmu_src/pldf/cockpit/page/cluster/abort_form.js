// Ending somebody's drive: asked for twice, and never without a reason.

import { element } from "../dom.js";
import { wording } from "../language.js";
import { say } from "./svg.js";

const words = wording({
  en: {
    abort: "End this drive …",
    reason: "Why does it end?",
    sick: "Motion sickness",
    wish: "The participant wishes it",
    fault: "Technical fault",
    other: "Another reason:",
    own: "Reason in words",
    sure: "End it now",
    back: "Let it go on",
    sent: "Told to the participant's page.",
    missing: "Please say why.",
  },
  de: {
    abort: "Diese Fahrt beenden …",
    reason: "Warum endet sie?",
    sick: "Übelkeit",
    wish: "Wunsch der Person",
    fault: "Technische Störung",
    other: "Anderer Grund:",
    own: "Grund in Worten",
    sure: "Jetzt beenden",
    back: "Weiterfahren lassen",
    sent: "Der Seite der Person mitgeteilt.",
    missing: "Bitte einen Grund nennen.",
  },
});

let forms = 0;

/** A button that opens the question. */
export class AbortForm {
  /** @param {(reason: string) => void} abort */
  constructor(abort) {
    forms += 1;
    const name = `abort-${forms}`;
    const known = /** @type {const} */ (["sick", "wish", "fault"]);
    this.radios = [...known.map((key) => radio(name, words(key))), radio(name, "")];
    this.own = /** @type {HTMLInputElement} */ (
      element("input", { type: "text", maxlength: "200", "aria-label": words("own") })
    );
    this.own.addEventListener("input", () => this.radios.at(-1)?.click());
    this.note = element("p", { role: "status" });
    this.opener = /** @type {HTMLButtonElement} */ (
      element("button", { type: "button", onclick: () => this.open(true) }, words("abort"))
    );
    this.form = /** @type {HTMLFormElement} */ (
      element(
        "form",
        { hidden: true, onsubmit: (/** @type {Event} */ event) => this.submit(event, abort) },
        element(
          "fieldset",
          {},
          element("legend", {}, words("reason")),
          ...known.map((key, i) => element("label", {}, this.radios[i], words(key))),
          element("label", {}, this.radios.at(-1), words("other")),
          this.own,
        ),
        element("button", { class: "desk-abort" }, words("sure")),
        element("button", { type: "button", onclick: () => this.open(false) }, words("back")),
      )
    );
    this.root = element("div", { class: "desk-end" }, this.opener, this.form, this.note);
  }

  /** @param {boolean} open */
  open(open) {
    this.form.hidden = !open;
    this.opener.hidden = open;
    say(this.note, "");
    (open ? this.radios[0] : this.opener)?.focus();
  }

  /** @param {Event} event @param {(reason: string) => void} abort */
  submit(event, abort) {
    event.preventDefault();
    const chosen = this.radios.find((one) => one.checked);
    const reason = (chosen?.value || (chosen ? this.own.value : "")).trim();
    if (reason === "") {
      say(this.note, words("missing"));
      return;
    }
    abort(reason);
    this.open(false);
    say(this.note, words("sent"));
  }

  /** @param {boolean} on whether there is a drive to end */
  enable(on) {
    this.opener.disabled = !on;
    if (!on && !this.form.hidden) this.open(false);
  }
}

/** @param {string} name @param {string} value @returns {HTMLInputElement} */
function radio(name, value) {
  return /** @type {HTMLInputElement} */ (element("input", { type: "radio", name, value }));
}
