// A drive as one row per communication point, and its file: the same bytes that Python writes.

import { COLUMNS, LEARNED_DELTA } from "./columns.js";
import { floatText } from "./numbers.js";

/** @typedef {import("./columns.js").Column} Column */
/** @typedef {() => number} Read */

const ROWS_AT_FIRST = 4096;

/** Rows of numbers that grow. */
class Rows {
  /** @param {number} width */
  constructor(width) {
    this.width = width;
    this.count = 0;
    this.numbers = new Float64Array(ROWS_AT_FIRST * width);
  }

  /** Return where the next row begins; there is room for it. */
  next() {
    const at = this.count * this.width;
    if (at + this.width > this.numbers.length) {
      const more = new Float64Array(2 * this.numbers.length);
      more.set(this.numbers);
      this.numbers = more;
    }
    this.count += 1;
    return at;
  }

  /**
   * @param {number} at number of a column
   * @returns {Float64Array}
   */
  column(at) {
    const values = new Float64Array(this.count);
    for (let row = 0; row < this.count; row += 1) {
      values[row] = this.numbers[row * this.width + at];
    }
    return values;
  }
}

/** What is recorded of a drive. */
export class Recorder {
  /**
   * @param {Map<string, Read>} seen by name of an input or output of the function: its value now
   * @param {Map<string, number>} fixed inputs that nothing feeds
   * @param {number} step_s
   */
  constructor(seen, fixed, step_s) {
    this.step_s = step_s;
    this.fixed = fixed;
    this.names = [...COLUMNS.map((column) => column.source), LEARNED_DELTA].filter((name) =>
      seen.has(name),
    );
    this.reads = this.names.map((name) => /** @type {Read} */ (seen.get(name)));
    this.rows = new Rows(this.names.length);
  }

  /** Take what is seen now as the next row. */
  row() {
    let at = this.rows.next();
    const { numbers } = this.rows;
    for (const read of this.reads) {
      numbers[at] = read();
      at += 1;
    }
  }

  /**
   * Return the columns that there are, in their order.
   * @returns {Map<string, Float64Array>}
   */
  columns() {
    const { count } = this.rows;
    const given = new Map(this.names.map((name, at) => [name, this.rows.column(at)]));
    for (const [name, value] of this.fixed) {
      given.set(name, new Float64Array(count).fill(value));
    }
    const made = new Map();
    for (const { name, source } of COLUMNS) {
      const values = source === "" ? this.derived(name, given) : given.get(source);
      if (values !== undefined) {
        made.set(name, values);
      }
    }
    return made;
  }

  /**
   * @param {string} name
   * @param {Map<string, Float64Array>} given
   */
  derived(name, given) {
    if (name === "time_s") {
      return Float64Array.from({ length: this.rows.count }, (_, step) => step * this.step_s);
    }
    const base = given.get("base_speed_mps");
    const delta = given.get(LEARNED_DELTA);
    return base && delta && base.map((value, row) => value + delta[row]);
  }
}

/**
 * Return a recording's file.
 * @param {Map<string, Float64Array>} columns by name, all of one length
 * @param {string[]} [comments] one line each
 */
export function recordingCsv(columns, comments = []) {
  const kept = COLUMNS.filter((column) => columns.has(column.name));
  const cells = kept.map((column) => cellTexts(column, columns.get(column.name) ?? []));
  const count = cells.length === 0 ? 0 : cells[0].length;
  const lines = comments.map((comment) => `# ${comment.split(/\r\n|\r|\n/).join(" ")}`);
  lines.push(kept.map((column) => column.name).join(","));
  for (let row = 0; row < count; row += 1) {
    lines.push(cells.map((texts) => texts[row]).join(","));
  }
  return `${lines.join("\n")}\n`;
}

/**
 * @param {Column} column
 * @param {ArrayLike<number>} values
 * @returns {string[]}
 */
function cellTexts(column, values) {
  const text = textOf(column);
  return Array.from(values, text);
}

/**
 * @param {Column} column
 * @returns {(value: number) => string}
 */
function textOf(column) {
  if (column.kind === "word") {
    return (code) => column.words[code];
  }
  return column.kind === "number" ? floatText : (value) => String(Math.trunc(value));
}
