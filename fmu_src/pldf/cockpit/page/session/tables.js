// The tables of a study, made of all its sessions: what `pldf analyse` reads beside the recordings.

import { drivesOf } from "./record.js";

/** @typedef {import("../types.js").Plan} Plan */
/** @typedef {import("../types.js").Questionnaire} Questionnaire */
/** @typedef {import("./record.js").SessionRecord} SessionRecord */
/** @typedef {import("./record.js").Answers} Answers */

// The items that `pldf analyse` scores; a row without one of them would be told as incomplete.
const SCORED = /^(laan|profile)_\d+(_reversed)?$/;
const EXCLUSIONS = "participant,phase,reason";
// How the reasons begin that are written here: such rows go when the person drives on after all.
const STOPPED = "session stopped:";
const STOPPED_ROW = new RegExp(`^[^,]*,[^,]*,"?${STOPPED}`);

/**
 * Return questionnaire.csv: a row per participant and drive; null if nobody answered a scored item.
 * @param {SessionRecord[]} records
 * @param {Questionnaire[]} questionnaires
 * @returns {string | null}
 */
export function questionnaireTable(records, questionnaires) {
  const asked = questionnaires.filter((one) => one.items.some((item) => SCORED.test(item.id)));
  const known = new Set(asked.map((one) => one.id));
  const columns = [...new Set(asked.flatMap((one) => one.items.map((item) => item.id)))];
  const rows = records.flatMap((record) =>
    [...answersByDrive(record, known)].map(([phase, answers]) => [
      record.participant,
      phase,
      ...columns.map((id) => answers[id] ?? ""),
    ]),
  );
  return rows.length ? csv(["participant", "phase", ...columns], rows) : null;
}

/**
 * @param {SessionRecord} record
 * @param {Set<string>} known questionnaires that count
 * @returns {Map<string, Answers>} phase: answers
 */
function answersByDrive(record, known) {
  /** @type {Map<string, Answers>} */
  const rows = new Map();
  for (const one of record.given) {
    if (/^[AB]\d+$/.test(one.after) && known.has(one.questionnaire)) {
      rows.set(one.after, { ...rows.get(one.after), ...one.answers });
    }
  }
  return rows;
}

/**
 * Return answers.csv: every answer in a row of its own, those before and after all drives, too.
 * @param {SessionRecord[]} records
 * @returns {string}
 */
export function answersTable(records) {
  const rows = records.flatMap((record) =>
    record.given.flatMap((one) =>
      Object.entries(one.answers).map(([item, answer]) => [
        record.participant,
        one.after,
        one.questionnaire,
        item,
        answer,
        one.at,
      ]),
    ),
  );
  return csv(["participant", "after", "questionnaire", "item", "answer", "at"], rows);
}

/**
 * Return session.json: all sessions but their answers.
 * @param {SessionRecord[]} records
 * @returns {{format: 1, sessions: Omit<SessionRecord, "given">[]}}
 */
export function sessionSummary(records) {
  return { format: 1, sessions: records.map(({ given: _, ...rest }) => rest) };
}

/**
 * Return exclusions.csv with the drives that people who stopped did not drive.
 *
 * What others wrote there stays. Null: nothing is to be changed.
 * @param {SessionRecord[]} records
 * @param {Plan} plan
 * @param {string | null} old the table as it is
 * @returns {string | null}
 */
export function exclusionsTable(records, plan, old) {
  const lines =
    old === null
      ? []
      : old
          .replace(/^\ufeff/, "")
          .trimEnd()
          .split(/\r?\n/);
  if (lines.length && lines[0] !== EXCLUSIONS) {
    return null; // somebody's own columns: not for a program to add to
  }
  const rows = records.flatMap((record) => notDriven(record, plan));
  const kept = lines.slice(1).filter((line) => !STOPPED_ROW.test(line));
  const told = new Set(kept.map((line) => line.split(",").slice(0, 2).join(",")));
  const ours = rows.filter(([who, phase]) => !told.has(`${who},${phase}`));
  const table = [EXCLUSIONS, ...kept, ...ours.map((row) => row.map(cell).join(","))].join("\n");
  return table === lines.join("\n") || (table === EXCLUSIONS && !lines.length)
    ? null
    : `${table}\n`;
}

/**
 * @param {SessionRecord} record
 * @param {Plan} plan
 * @returns {[string, string, string][]} rows: participant, phase, reason
 */
function notDriven(record, plan) {
  const driven = drivesOf(record);
  const { stopped } = record;
  if (!stopped || driven.size === 0) {
    return [];
  }
  const reason = `${STOPPED} ${stopped.reason || "no reason given"}`.replace(/\s+/g, " ");
  return plan.orders[record.order]
    .filter((phase) => !driven.has(phase))
    .map((phase) => [record.participant, phase, reason]);
}

/**
 * @param {string[]} header
 * @param {(string | number)[][]} rows
 * @returns {string}
 */
function csv(header, rows) {
  return [header, ...rows].map((row) => `${row.map(cell).join(",")}\n`).join("");
}

/** @param {string | number} value */
function cell(value) {
  const text = String(value);
  return /[",;\t\r\n#]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}
