// What the windows beside the drive have in common.

import { element, fill } from "../dom.js";
import { wording } from "../language.js";

const words = wording({
  en: {
    failed:
      "This page cannot start: {reason}. Is pldf cockpit still running? Then load the page again.",
  },
  de: {
    failed:
      "Diese Seite kann nicht beginnen: {reason}. Läuft pldf cockpit noch? Dann die Seite neu laden.",
  },
});

/**
 * Say why a page does not start, and what to do.
 * @param {Element} parent
 * @param {unknown} error
 */
export function failed(parent, error) {
  const reason = error instanceof Error ? error.message : String(error);
  fill(parent, element("p", { role: "alert" }, words("failed", { reason })));
}
