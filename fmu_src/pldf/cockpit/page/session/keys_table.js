// Which key does what, to look at beside a drive.

import { element } from "../dom.js";
import { say } from "./drive_words.js";

/** @type {[string[], Parameters<typeof say>[0]][]} the keys of engine/inputs/keyboard.js, and ours */
const ROWS = [
  [["↑", "W"], "key_gas"],
  [["↓", "S"], "key_brake"],
  [["←", "→"], "key_steer"],
  [["R"], "key_resume"],
  [["C"], "key_cancel"],
  [["E", "+"], "key_faster"],
  [["Q", "-"], "key_slower"],
  [["P", "F", "U"], "key_teach"],
  [["Esc"], "key_stop"],
];

/**
 * @param {boolean} steered the person steers
 * @param {boolean} teaches the driver's last word is offered
 * @returns {HTMLElement}
 */
export function keysTable(steered, teaches) {
  const idle = [!steered && "key_steer", !teaches && "key_teach"];
  const rows = ROWS.filter(([, word]) => !idle.includes(word)).map(([keys, word]) =>
    element(
      "tr",
      {},
      element("td", {}, ...keys.flatMap((key) => [element("kbd", {}, key), " "])),
      element("td", {}, say(word)),
    ),
  );
  return element("table", { class: "keys" }, ...rows);
}
