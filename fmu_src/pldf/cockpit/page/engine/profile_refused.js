// Why a profile file is not used, in words.

import { wording } from "../language.js";

const words = wording({
  en: {
    foreign: "This is no profile of the driving function. Choose a file that ends with .pldf.",
    newer: "A newer release wrote this profile. Update this one to read it.",
    truncated: "The profile is cut off. Copy the file again.",
    longer: "Something stands behind the end of the profile. Copy the file again.",
    damaged: "The profile is damaged: its checksum is wrong. Copy the file again.",
    line: "The profile is damaged: its header is not as it should be. Copy the file again.",
    value: "The profile holds a value that is not possible. Copy the file again.",
    place: "({where})",
  },
  de: {
    foreign: "Das ist kein Profil der Fahrfunktion. Wählen Sie eine Datei, die auf .pldf endet.",
    newer: "Eine neuere Ausgabe hat dieses Profil geschrieben. Zum Lesen bitte aktualisieren.",
    truncated: "Das Profil ist abgeschnitten. Bitte die Datei noch einmal kopieren.",
    longer: "Hinter dem Ende des Profils steht noch etwas. Bitte die Datei noch einmal kopieren.",
    damaged:
      "Das Profil ist beschädigt: Die Prüfsumme stimmt nicht. Bitte die Datei noch einmal kopieren.",
    line: "Das Profil ist beschädigt: Der Kopf ist nicht, wie er sein soll. Bitte die Datei noch einmal kopieren.",
    value:
      "Im Profil steht ein Wert, den es nicht geben kann. Bitte die Datei noch einmal kopieren.",
    place: "({where})",
  },
});

/** @typedef {"foreign" | "newer" | "truncated" | "longer" | "damaged" | "line" | "value"} Refusal */

/** A profile that is not used: the message says why and what to do, `where` is its line or byte. */
export class ProfileRefused extends Error {
  /** @param {Refusal} reason @param {string} where */
  constructor(reason, where) {
    super(`${words(reason)} ${words("place", { where })}`);
    this.name = "ProfileRefused";
    this.reason = reason;
    this.where = where;
  }
}

/** @param {Refusal} reason @param {string} where @returns {never} */
export function refuse(reason, where) {
  throw new ProfileRefused(reason, where);
}
