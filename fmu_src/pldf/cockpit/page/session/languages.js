// The language of the page: as the address says, as it was chosen here before, or the study's.

import { speak } from "../language.js";
import { fromJson, toJson } from "./saved.js";

/** @typedef {import("../language.js").Language} Language */

const KEY = "pldf-cockpit language";
/** @type {Record<Language, string>} each in its own words */
export const LANGUAGES = { en: "English", de: "Deutsch" };

/**
 * @param {Language} first the study's
 * @returns {Language}
 */
export function chosenLanguage(first) {
  const asked = new URLSearchParams(location.search).get("language") ?? fromJson(KEY)["language"];
  return asked === "en" || asked === "de" ? asked : first;
}

/** @param {Language} language */
export function chooseLanguage(language) {
  toJson(KEY, { language });
  speak(language);
}
