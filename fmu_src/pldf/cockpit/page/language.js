// Words in English and German: each room has a table of its own, all are asked in one way.

/** @typedef {"en" | "de"} Language */
/** @typedef {Record<string, string>} Words {name} in a text is replaced */

/** @type {Language} */
let spoken = "en";

/** @returns {Language} */
export function language() {
  return spoken;
}

/** @param {Language} chosen */
export function speak(chosen) {
  spoken = chosen;
  document.documentElement.lang = chosen;
}

/**
 * Return how to say the texts of a table in the language that is spoken when it is asked.
 * @template {Words} T
 * @param {{en: T, de: {[K in keyof T]: string}}} table
 * @returns {(key: keyof T & string, values?: Record<string, string | number>) => string}
 */
export function wording(table) {
  return (key, values = {}) =>
    table[spoken][key].replace(/\{(\w+)\}/g, (whole, name) => String(values[name] ?? whole));
}
