// All that is kept of one person's session, sessions/P07.json: a value; every change makes a new one.

/** @typedef {import("../types.js").DriveResult} DriveResult */
/** @typedef {import("../types.js").Value} Value */
/** @typedef {import("../types.js").Interruption} Interruption */
/** @typedef {import("../language.js").Language} Language */
/** @typedef {import("./participant.js").Participant} Participant */
/** @typedef {import("./settings.js").Shown} Shown */
/** @typedef {string | number} Answer key of a choice, box of a scale, number, text */
/** @typedef {Record<string, Answer>} Answers by id of the item; what was not answered is not there */

/**
 * @typedef {object} Given answers to one questionnaire
 * @property {string} after phase, "start", "practice" or "end"
 * @property {string} questionnaire
 * @property {string} at when, UTC
 * @property {Answers} answers
 */
/** @typedef {{frames: number, mean_ms: number, max_ms: number, over_50_ms: number}} FrameTiming of what was drawn */
/**
 * @typedef {object} Attempt one drive, whether it was driven to its end or not
 * @property {"practice" | "drive"} kind
 * @property {string} name phase, or number of the practice drive
 * @property {string} began_at UTC
 * @property {string} ended_at UTC; empty if the page was closed while driving
 * @property {DriveResult["ending"] | "cut off"} ending "cut off": the page was closed or reloaded
 * @property {string} reason
 * @property {string} device "keyboard" or the device's name
 * @property {"assisted" | "person"} steering
 * @property {string} file recording; empty if there is none
 * @property {Record<string, Value>} outputs of the function at the end
 * @property {DriveResult["messages"]} messages
 * @property {Interruption[]} interruptions
 * @property {DriveResult["timing"] | null} timing of the steps
 * @property {FrameTiming | null} frames
 * @property {Shown | null} shown picture and sound, as they were set at the end
 */
/** @typedef {{at: string, what: string, step: string}} Note what happened beside the plan */

/**
 * @typedef {object} SessionRecord
 * @property {1} format
 * @property {string} version of the cockpit
 * @property {string} study its title
 * @property {string} participant
 * @property {number} driver_id
 * @property {"AB" | "BA"} order
 * @property {"none" | "icon" | "text"} explanation
 * @property {Language} language
 * @property {string} browser
 * @property {string} screen
 * @property {string} began_at
 * @property {string} step id of the step that the session is at
 * @property {boolean} finished
 * @property {{at: string, reason: string} | null} stopped
 * @property {string} learned_after drive after which the newest profile was stored; empty: none
 * @property {Given[]} given
 * @property {Attempt[]} attempts in the order of driving
 * @property {Note[]} notes
 */

/**
 * @param {Participant} who
 * @param {{version: string, study: string, language: Language, browser: string, screen: string}} about
 * @param {string} step the first one
 * @param {string} now
 * @returns {SessionRecord}
 */
export function newRecord(who, about, step, now) {
  return {
    format: 1,
    ...about,
    participant: who.name,
    driver_id: who.driver_id,
    order: who.order,
    explanation: who.explanation,
    began_at: now,
    step,
    finished: false,
    stopped: null,
    learned_after: "",
    given: [],
    attempts: [],
    notes: [],
  };
}

/**
 * Return the record in a file.
 * @param {Uint8Array} bytes
 * @returns {SessionRecord}
 * @throws {Error} if it is no session of this format
 */
export function parseRecord(bytes) {
  const record = JSON.parse(new TextDecoder().decode(bytes));
  if (record === null || typeof record !== "object" || record.format !== 1) {
    throw new Error("no record of a session, or of another release");
  }
  return record;
}

/**
 * @param {unknown} value
 * @returns {Uint8Array} JSON text
 */
export function jsonBytes(value) {
  return new TextEncoder().encode(`${JSON.stringify(value, null, 1)}\n`);
}

/**
 * Return the record with the answers to a questionnaire, in place of earlier ones.
 * @param {SessionRecord} record
 * @param {Given} given
 * @returns {SessionRecord}
 */
export function withAnswers(record, given) {
  const others = record.given.filter(
    (one) => one.after !== given.after || one.questionnaire !== given.questionnaire,
  );
  return { ...record, given: [...others, given] };
}

/**
 * Return the record with an attempt that begins.
 * @param {SessionRecord} record
 * @param {Pick<Attempt, "kind" | "name" | "began_at" | "device" | "steering">} begun
 * @returns {SessionRecord}
 */
export function withAttempt(record, begun) {
  const attempt = /** @type {Attempt} */ ({
    ...begun,
    ended_at: "",
    ending: "cut off",
    reason: "",
    file: "",
    outputs: {},
    messages: [],
    interruptions: [],
    timing: null,
    frames: null,
    shown: null,
  });
  return { ...record, attempts: [...record.attempts, attempt] };
}

/**
 * Return the record with what the newest attempt came to.
 * @param {SessionRecord} record
 * @param {Partial<Attempt>} ended
 * @returns {SessionRecord}
 */
export function withEnding(record, ended) {
  const last = record.attempts.at(-1);
  return last
    ? { ...record, attempts: [...record.attempts.slice(0, -1), { ...last, ...ended }] }
    : record;
}

/**
 * Return the attempt that was driven to its end, by name of the drive.
 * @param {SessionRecord} record
 * @returns {Map<string, Attempt>}
 */
export function drivesOf(record) {
  const whole = record.attempts.filter((one) => one.kind === "drive" && one.ending === "arrived");
  return new Map(whole.map((one) => [one.name, one]));
}

/**
 * @param {SessionRecord} record
 * @param {string} what
 * @param {string} at
 * @returns {SessionRecord}
 */
export function noted(record, what, at) {
  return { ...record, notes: [...record.notes, { at, what, step: record.step }] };
}
