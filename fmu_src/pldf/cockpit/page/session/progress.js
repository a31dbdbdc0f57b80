// Where in the session the person is.

import { element } from "../dom.js";
import { say } from "./words.js";

/** @param {{place: {at: number}, steps: unknown[]}} session */
export function progress({ place, steps }) {
  const now = place.at + 1;
  const text = say("progress", { position: now, of: steps.length });
  const bar = element("progress", { max: steps.length, value: now, "aria-hidden": "true" });
  return element("p", { class: "progress" }, text, bar);
}
