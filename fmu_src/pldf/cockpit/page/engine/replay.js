// A recording as it can be watched again: ours, a laboratory's, or that of a simulated driver.

import { COLUMN_OF, LEARNED_DELTA } from "./columns.js";
import { numberOf, readTable, textOf } from "./csv_table.js";
import { frameAt } from "./interpolation.js";

/** @typedef {import("../types.js").Frame} Frame */
/** @typedef {import("../types.js").Value} Value */
/** @typedef {import("./columns.js").Column} Column */
/** @typedef {import("./csv_table.js").Table} Table */

const NEEDED = ["time_s", "s_m", "speed_mps"];
/** @type {Record<string, number>} */
const FLAGS = { 1: 1, true: 1, yes: 1, 0: 0, false: 0, no: 0, "1.0": 1, "0.0": 0 };

/** A file that cannot be watched; `problem` and `details` say why, for whoever words it. */
export class ReplayError extends Error {
  /**
   * @param {"missing" | "cell" | "empty" | "table"} problem
   * @param {{columns?: string[], line?: number, column?: string, value?: string}} details
   */
  constructor(problem, details) {
    super(`${problem}: ${JSON.stringify(details)}`);
    this.problem = problem;
    this.details = details;
  }
}

/** A recording. */
export class Replay {
  /**
   * @param {Frame[]} frames in the order of time
   * @param {string[]} comments of the file
   * @param {number} passed_over rows whose time was not behind that of the row before
   */
  constructor(frames, comments, passed_over) {
    this.frames = frames;
    this.comments = comments;
    this.passed_over = passed_over;
  }

  /** When it begins. */
  get begin_s() {
    return this.frames[0].time_s;
  }

  /** When it ends. */
  get end_s() {
    return this.frames[this.frames.length - 1].time_s;
  }

  /**
   * Return what there was to see.
   * @param {number} time_s
   * @returns {Frame}
   */
  at(time_s) {
    return /** @type {Frame} */ (frameAt(this.frames, time_s));
  }
}

/**
 * Return a recording that can be watched.
 * @param {Uint8Array | string} file CSV; its columns are named as ours, further ones are passed over
 * @returns {Replay}
 * @throws {ReplayError}
 */
export function readReplay(file) {
  const table = tableOf(typeof file === "string" ? file : textOf(file));
  const missing = NEEDED.filter((name) => !table.names.includes(name));
  if (missing.length > 0) {
    throw new ReplayError("missing", { columns: missing });
  }
  const columns = table.names.map((name) => COLUMN_OF.get(name));
  const all = table.rows.map((_, row) => frameOf(table, row, columns));
  const frames = inTime(all);
  if (frames.length < 2) {
    throw new ReplayError("empty", {});
  }
  return new Replay(frames, table.comments, all.length - frames.length);
}

/** @param {string} text */
function tableOf(text) {
  try {
    return readTable(text);
  } catch (error) {
    throw new ReplayError("table", { value: error instanceof Error ? error.message : "" });
  }
}

/**
 * Return the frames that come later than all before them.
 * @param {Frame[]} all
 */
function inTime(all) {
  let latest_s = -Infinity;
  return all.filter(({ time_s }) => {
    const later = time_s > latest_s;
    latest_s = Math.max(latest_s, time_s);
    return later;
  });
}

/**
 * @param {Table} table
 * @param {number} row
 * @param {(Column | undefined)[]} columns
 * @returns {Frame}
 */
function frameOf(table, row, columns) {
  /** @type {Record<string, Value>} */
  const values = {};
  let [time_s, base_mps, profile_mps] = [NaN, NaN, NaN];
  columns.forEach((column, at) => {
    if (column === undefined) {
      return;
    }
    const number = cellNumber(table, row, column, at);
    time_s = column.name === "time_s" ? number : time_s;
    base_mps = column.name === "base_mps" ? number : base_mps;
    profile_mps = column.name === "profile_mps" ? number : profile_mps;
    if (column.source !== "" && !Number.isNaN(number)) {
      values[column.source] = column.kind === "flag" ? number !== 0 : number;
    }
  });
  if (Number.isFinite(profile_mps - base_mps)) {
    values[LEARNED_DELTA] = profile_mps - base_mps;
  }
  return { time_s, lateral_m: 0, heading_rad: 0, values };
}

/**
 * Return the number or code in a cell; NaN where it is empty and need not be there.
 * @param {Table} table
 * @param {number} row
 * @param {Column} column
 * @param {number} at
 */
function cellNumber(table, row, column, at) {
  const cell = (table.rows[row][at] ?? "").trim();
  const number = meaning(column, cell);
  if (Number.isFinite(number) || (cell === "" && !NEEDED.includes(column.name))) {
    return number;
  }
  throw new ReplayError("cell", { line: table.lines[row], column: column.name, value: cell });
}

/**
 * @param {Column} column
 * @param {string} cell
 */
function meaning(column, cell) {
  if (column.kind === "flag") {
    return FLAGS[cell.toLowerCase()] ?? NaN;
  }
  const code = column.kind === "word" ? column.words.indexOf(cell.toUpperCase()) : -1;
  return code >= 0 ? code : numberOf(cell);
}
