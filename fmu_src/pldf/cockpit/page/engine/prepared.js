// Reads a prepared road: a header of lines, then columns of float64 (docs/native.md, "Prepared files").
import { crc32 } from "./crc32.js";

/** @typedef {{s_m: number, kind: "road" | "road_against" | "sign", name: string}} Mark */
/**
 * @typedef {object} Prepared values per metre, from 0 on
 * @property {string} key fingerprint
 * @property {boolean} has_line
 * @property {Mark[]} marks
 * @property {Float64Array} limit_mps
 * @property {Float64Array} curvature_per_m the sharpest of the metre, without sign
 * @property {Float64Array} grade
 * @property {Float64Array} x_m
 * @property {Float64Array} y_m
 */

const COLUMNS = 5;
const BYTES = 8;
const TAIL = 15; // "crc32 01234567\n"
const HEADER_MAX = 1 << 24;

/** A file that is no prepared road, or a damaged one; `reason` in plain English for a message. */
export class RoadFileError extends Error {}

/**
 * @param {Uint8Array} bytes
 * @returns {Prepared}
 * @throws {RoadFileError}
 */
export function readPrepared(bytes) {
  const { lines, size } = header(bytes);
  const kind = value(lines, "kind");
  if (kind !== "route") throw new RoadFileError(`a prepared ${kind}, not a road`);
  const rows = count(lines, "rows");
  if (count(lines, "columns") !== COLUMNS) throw new RoadFileError("not the columns of a road");
  if (rows < 2) throw new RoadFileError("a road of less than 2 m");
  const body = size + COLUMNS * rows * BYTES;
  if (bytes.length !== body + TAIL) throw new RoadFileError("the file is cut off or too long");
  checkSum(bytes, body);
  const [limit_mps, curvature_per_m, grade, x_m, y_m] = columns(bytes, size, rows);
  const has_line = value(lines, "line") === "1";
  const key = value(lines, "key");
  return { key, has_line, marks: marksOf(lines), limit_mps, curvature_per_m, grade, x_m, y_m };
}

/** @param {Uint8Array} bytes @returns {{lines: string[], size: number}} up to the line "end" */
function header(bytes) {
  const text = new TextDecoder().decode(bytes.subarray(0, HEADER_MAX));
  if (!/^PLDF-PREPARED [12]\n/.test(text)) {
    throw new RoadFileError("not a prepared road, or one of a newer release");
  }
  const end = /\nend *\n/.exec(text);
  if (!end) throw new RoadFileError("the file's header is cut off");
  const whole = text.slice(0, end.index + end[0].length);
  return { lines: whole.split("\n"), size: new TextEncoder().encode(whole).length };
}

/** @param {string[]} lines @param {string} name @returns {string} */
function value(lines, name) {
  const line = lines.find((each) => each.startsWith(`${name} `));
  if (line === undefined) throw new RoadFileError(`the line "${name}" is missing`);
  return line.slice(name.length + 1);
}

/** @param {string[]} lines @param {string} name @returns {number} */
function count(lines, name) {
  const number = Number(value(lines, name));
  if (!Number.isInteger(number) || number < 0) throw new RoadFileError(`"${name}" is no number`);
  return number;
}

/** @param {Uint8Array} bytes @param {number} body where the check sum begins */
function checkSum(bytes, body) {
  const told = new TextDecoder().decode(bytes.subarray(body));
  const sum = crc32(bytes.subarray(0, body)).toString(16).padStart(8, "0");
  if (told !== `crc32 ${sum}\n`) throw new RoadFileError("the file is damaged (check sum)");
}

/**
 * @param {Uint8Array} bytes
 * @param {number} start
 * @param {number} rows
 * @returns {Float64Array[]}
 */
function columns(bytes, start, rows) {
  const view = new DataView(bytes.buffer, bytes.byteOffset + start);
  return Array.from({ length: COLUMNS }, (_, column) =>
    Float64Array.from({ length: rows }, (_value, row) =>
      view.getFloat64((column * rows + row) * BYTES, true),
    ),
  );
}

/** @param {string[]} lines @returns {Mark[]} */
function marksOf(lines) {
  return lines.flatMap((line) => {
    const found = /^mark (\d+) (road|road_against|sign) (.+)$/.exec(line);
    if (!found) return [];
    const kind = /** @type {Mark["kind"]} */ (found[2]);
    return [{ s_m: Number(found[1]) / 1000, kind, name: found[3] }];
  });
}
