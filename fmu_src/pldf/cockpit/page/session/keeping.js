// What is stored when: each drive before the next begins, and the tables made of all sessions.

import { inputsCsv } from "../engine/input_changes.js";
import { answersTable, exclusionsTable, questionnaireTable, sessionSummary } from "./tables.js";
import { jsonBytes, parseRecord } from "./record.js";
import { filesIn } from "./storage.js";

/** @typedef {import("../types.js").Bundle} Bundle */
/** @typedef {import("../types.js").DriveResult} DriveResult */
/** @typedef {import("../types.js").Files} Files */
/** @typedef {import("./record.js").Attempt} Attempt */
/** @typedef {import("./record.js").SessionRecord} SessionRecord */
/** @typedef {import("./storage.js").Storage} Storage */

const text = new TextEncoder();

/** @param {string} participant */
export function recordPath(participant) {
  return `sessions/${participant}.json`;
}

/**
 * @param {Storage} storage
 * @param {string} participant
 * @returns {Promise<SessionRecord | null>} null: this person has not begun
 * @throws {Error} if the file is there and cannot be read
 */
export async function readRecord(storage, participant) {
  const bytes = await storage.read(recordPath(participant));
  return bytes ? parseRecord(bytes) : null;
}

/**
 * @param {Storage} storage
 * @returns {Promise<SessionRecord[]>} all sessions, by name
 */
export async function allRecords(storage) {
  const paths = await storage.list("sessions/");
  const records = [];
  for (const path of paths.filter((one) => /^sessions\/[^/]+\.json$/.test(one))) {
    const bytes = await storage.read(path);
    if (bytes) {
      records.push(parseRecord(bytes));
    }
  }
  return records;
}

/**
 * Return who else has this person's number: they would share one profile.
 * @param {Storage} storage
 * @param {{name: string, driver_id: number}} who
 * @returns {Promise<string | null>}
 */
export async function otherWithNumber(storage, { name, driver_id }) {
  const records = await allRecords(storage);
  const other = records.find((one) => one.driver_id === driver_id && one.participant !== name);
  return other?.participant ?? null;
}

/**
 * Store a session's record and the tables that are made of all records.
 * @param {Storage} storage
 * @param {SessionRecord} record
 * @param {Bundle} bundle
 */
export async function keepRecord(storage, record, bundle) {
  await storage.write(recordPath(record.participant), jsonBytes(record));
  await keepTables(storage, bundle);
}

/**
 * @param {Storage} storage
 * @param {Bundle} bundle
 */
async function keepTables(storage, bundle) {
  /** @type {[string, (records: SessionRecord[], old: string | null) => string | null][]} */
  const tables = [
    ["questionnaire.csv", (records) => questionnaireTable(records, bundle.questionnaires)],
    ["answers.csv", (records) => answersTable(records)],
    ["exclusions.csv", (records, old) => exclusionsTable(records, bundle.plan, old)],
    ["session.json", (records) => `${JSON.stringify(sessionSummary(records), null, 1)}\n`],
  ];
  for (const [path, make] of tables) {
    // Read anew at each try: another page may have stored its session meanwhile.
    await storage.update(path, async (old) => {
      const made = make(await allRecords(storage), old ? new TextDecoder().decode(old) : null);
      return made === null ? null : text.encode(made);
    });
  }
}

/**
 * Store what a drive left behind, all but the record; return the recording's path, empty: none.
 *
 * The same drive stored twice leaves the same files, so it may be interrupted anywhere.
 * @param {Storage} storage
 * @param {SessionRecord} record
 * @param {Pick<Attempt, "kind" | "name">} attempt
 * @param {DriveResult} result
 * @returns {Promise<string>}
 */
export async function keepDrive(storage, record, attempt, result) {
  if (!result.recording) {
    return ""; // the drive failed before its first step
  }
  const [path, inputs] = pathsOf(record, attempt, result.ending === "arrived");
  await storage.write(path, text.encode(result.recording));
  await storage.write(inputs, text.encode(inputsCsv(result.inputs)));
  if (attempt.kind === "drive" && result.ending === "arrived") {
    for (const [name, bytes] of Object.entries(result.profiles)) {
      await storage.write(`${learnedFolder(record.participant, attempt.name)}${name}`, bytes);
    }
  }
  return path;
}

/**
 * @param {SessionRecord} record
 * @param {Pick<Attempt, "kind" | "name">} attempt
 * @param {boolean} arrived
 * @returns {[string, string]} of recording and inputs
 */
function pathsOf(record, attempt, arrived) {
  const name = `${record.participant}_${attempt.name}`;
  const number = record.attempts.filter((one) => one.name === attempt.name).length;
  if (attempt.kind === "practice") {
    const again = number > 1 ? `_${number}` : "";
    return [`practice/${name}${again}.csv`, `practice/${name}${again}_inputs.csv`];
  }
  if (arrived) {
    return [`recordings/${name}.csv`, `inputs/${name}.csv`];
  }
  const stopped = `sessions/${record.participant}/stopped/${attempt.name}_${number}`;
  return [`${stopped}.csv`, `${stopped}_inputs.csv`];
}

/**
 * @param {string} participant
 * @param {string} phase
 */
function learnedFolder(participant, phase) {
  return `sessions/${participant}/${phase}/`;
}

/**
 * Return the profile files as they were after the newest drive that learned; none before it.
 * @param {Storage} storage
 * @param {SessionRecord} record
 * @returns {Promise<Files>}
 */
export async function learnedFiles(storage, record) {
  if (!record.learned_after) {
    return {};
  }
  return filesIn(storage, learnedFolder(record.participant, record.learned_after));
}

/**
 * Put what was learned so far into profiles/, where the analysis looks for it.
 * @param {Storage} storage
 * @param {SessionRecord} record
 */
export async function publishProfiles(storage, record) {
  for (const [name, bytes] of Object.entries(await learnedFiles(storage, record))) {
    await storage.write(`profiles/${name}`, bytes);
  }
}
