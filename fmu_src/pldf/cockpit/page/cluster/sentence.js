// What the cluster says, by the project's table of reasons and events: which row, whether it may be
// shown under a condition, and its words.

/** @typedef {import("../types.js").Value} Value */
/** @typedef {import("../types.js").HmiTexts} HmiTexts */
/** @typedef {import("../language.js").Language} Language */
/** @typedef {import("./live.js").Explanation} Explanation */
/** @typedef {Record<string, Value>} Values */
/**
 * A row of the table.
 * @typedef {object} Row
 * @property {string} name
 * @property {string} icon
 * @property {number} priority 1 is the most urgent
 * @property {string} EN
 * @property {string} DE
 */

const NUMBERS = ["speed", "base", "limit", "drive"];

// Who has to act now, and what answers a button, is told to everybody: nobody could drive without.
// All other rows explain why the car does what it does.
const OPERATION = new Set([
  "OVERRIDE",
  "STANDBY",
  "FAULT",
  "OFF",
  "HELD",
  "TAKE_OVER",
  "FORGOTTEN",
  "NOTHING_TO_FORGET",
  "UNDONE",
  "NOTHING_TO_UNDO",
  "PAUSED",
  "RESUMED",
]);

/**
 * Return the row that is said now; null if the values name none.
 * @param {HmiTexts} texts
 * @param {Values} values
 * @returns {Row | null}
 */
export function rowOf(texts, values) {
  if (values["hmi.take_over"] === true) return named(texts, "TAKE_OVER");
  const sentence = values["hmi.sentence"];
  if (sentence !== undefined) {
    return rows(texts).find((row) => row.sentence === Number(sentence)) ?? null;
  }
  const event = Number(values["hmi.event"] ?? 0);
  if (event > 0) return texts["events"]?.[event] ?? null;
  const reason = values["hmi.reason_code"] ?? values["hmi.reason"];
  return reason === undefined ? null : (texts["reasons"]?.[Number(reason)] ?? null);
}

/**
 * Return the sentence that belongs to a row, in the language of the page: made of the table and its
 * numbers, or as the FMU says it (hmi.text) where its numbers are not at hand.
 * @param {Row} row
 * @param {Values} values
 * @param {Language} language
 * @returns {string}
 */
export function sentenceOf(row, values, language) {
  const spoken = values["hmi.text"];
  const told = values["hmi.sentence"] !== undefined || row.name === "TAKE_OVER";
  if (!told && typeof spoken === "string" && spoken !== "") return spoken;
  const drive = Number(values["hmi.sentence_drive"] ?? 0);
  const text = row[language === "de" ? "DE" : "EN"].replace(/\[(.*?)\]/g, drive > 0 ? "$1" : "");
  return NUMBERS.reduce(
    (so, name) => so.replace(`{${name}}`, String(values[`hmi.sentence_${name}`] ?? "–")),
    text,
  );
}

/**
 * Tell what of a row is shown to somebody who is given this amount of explanation.
 * @param {Row} row
 * @param {Explanation} explanation
 * @returns {{icon: boolean, text: boolean}}
 */
export function shown(row, explanation) {
  if (OPERATION.has(row.name)) return { icon: true, text: true };
  return { icon: explanation !== "none", text: explanation === "text" };
}

/** @param {HmiTexts} texts @returns {(Row & {sentence: number})[]} */
function rows(texts) {
  return [...(texts["reasons"] ?? []), ...(texts["events"] ?? [])];
}

/** @param {HmiTexts} texts @param {string} name @returns {Row | null} */
function named(texts, name) {
  return rows(texts).find((row) => row.name === name) ?? null;
}
