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
const FIRST_LINE = 16;
const LF = 10;
const END = [..."end"].map((letter) => letter.charCodeAt(0));

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
  const size = headerSize(bytes);
  const text = new TextDecoder().decode(bytes.subarray(0, size || FIRST_LINE));
  if (!/^PLDF-PREPARED [12]\n/.test(text)) {
    throw new RoadFileError("not a prepared road, or one of a newer release");
  }
  if (!size) throw new RoadFileError("the file's header is cut off");
  return { lines: text.split("\n"), size };
}

/** @param {Uint8Array} bytes @returns {number} with the line "end" and its spaces; 0: it has none */
function headerSize(bytes) {
  for (let at = bytes.indexOf(LF); at >= 0; at = bytes.indexOf(LF, at + 1)) {
    if (END.every((byte, k) => bytes[at + 1 + k] === byte)) return bytes.indexOf(LF, at + 1) + 1;
  }
  return 0;
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
  return Array.from({ length: COLUMNS }, (_, column) => {
    const values = new Float64Array(rows);
    for (let row = 0; row < rows; row++) {
      values[row] = view.getFloat64((column * rows + row) * BYTES, true);
    }
    return values;
  });
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
