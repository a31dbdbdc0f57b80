// What both formats of a profile file are made of: lines of text, blocks of float64, a checksum.
// It reads what `pldf.profiles.file_parts` reads, and refuses what that refuses.

import { crc32 } from "./crc32.js";
import { refuse } from "./profile_refused.js";

const ALIGNMENT = 64;
const NODES_MAX = 10_000_000;
const COUNT_MAX = 999_999_999;
const SPEED_MAX_MPS = 200;
const EVIDENCE_MAX = 2.2;
const BOUNDS = 6;
const LINE_MAX = 128;
const MAGIC = "PLDF-PROFILE ";
export const CHECKSUM_SIZE = 15;
export const FILE_MAX = 2 ** 32;
export const NUMBER = "(0|[1-9][0-9]{0,8})";
export const NOTE = "(?: ([!-~](?:[ -~]{0,78}[!-~])?))?";

/** @typedef {{name: string, unit: string, low: number, high: number, whole: boolean}} Column */
/** @typedef {{driver_id: number, route: string, nodes: number, iterations: number, stride: number}} Start */

/** Of an iteration, in the order of its blocks. */
export const COLUMNS = [
  "base_mps",
  "learned_mps",
  "offset_mps",
  "drive",
  "intervention",
  "lessons",
  "bound",
  "evidence_faster",
  "evidence_slower",
  "pending_faster",
  "pending_slower",
  "pending_faster_mps",
  "pending_slower_mps",
  "offset_evidence_faster",
  "offset_evidence_slower",
  "offset_pending_faster",
  "offset_pending_slower",
  "offset_pending_faster_mps",
  "offset_pending_slower_mps",
].map(columnOf);

/** @param {string} name @returns {Column} */
function columnOf(name) {
  if (name.endsWith("_mps")) {
    const low = name.startsWith("offset_") ? -SPEED_MAX_MPS : 0;
    return { name, unit: "m/s", low, high: SPEED_MAX_MPS, whole: false };
  }
  if (name.includes("evidence")) {
    return { name, unit: "1", low: 0, high: EVIDENCE_MAX, whole: false };
  }
  return { name, unit: "1", low: 0, high: name === "bound" ? BOUNDS - 1 : COUNT_MAX, whole: true };
}

/** Walks through the header line by line and knows where it is. */
export class Lines {
  /** @param {Uint8Array} data */
  constructor(data) {
    this.data = data;
    this.at = 0;
    this.number = 0;
  }

  /**
   * Return the groups of `pattern` in the next line.
   * @param {string} pattern of the whole line
   * @returns {string[]}
   */
  take(pattern) {
    const rest = latin(this.data.subarray(this.at, this.at + LINE_MAX));
    const end = rest.indexOf("\n");
    this.number += 1;
    if (end < 0 && this.data.length - this.at < LINE_MAX) refuse("truncated", this.where());
    const match = end < 0 ? null : new RegExp(`^${pattern}$`).exec(rest.slice(0, end));
    if (match === null) return refuse("line", this.where());
    this.at += end + 1;
    return match.slice(1).map((group) => group ?? "");
  }

  /** @param {string} word @returns {boolean} whether the next line begins with it */
  nextIs(word) {
    return latin(this.data.subarray(this.at, this.at + word.length)) === word;
  }

  /** @returns {number} version of the format in the first line: 1 or 2 */
  takeVersion() {
    this.number = 1;
    const magic = latin(this.data.subarray(0, MAGIC.length));
    if (magic.length < MAGIC.length && MAGIC.startsWith(magic)) refuse("truncated", this.where());
    if (magic !== MAGIC) refuse("foreign", this.where());
    this.number = 0;
    const version = Number(this.take(MAGIC + NUMBER)[0]);
    if (version > 2) refuse("newer", this.where());
    if (version < 1) refuse("line", this.where());
    return version;
  }

  /** @returns {Start} what every format has behind the first line */
  takeStart() {
    const driver = Number(this.take(`driver ${NUMBER}`)[0]);
    const route = String(this.take("route ([0-9a-f]{16})")[0]);
    const nodes = Number(this.take(`nodes ${NUMBER}`)[0]);
    if (nodes < 3 || nodes > NODES_MAX) refuse("line", this.where());
    this.take("step_m (1)");
    const iterations = Number(this.take("iterations (0|[1-9][0-9]{0,5})")[0]);
    const stride = ALIGNMENT * Math.ceil((8 * nodes) / ALIGNMENT);
    return { driver_id: driver, route, nodes, iterations, stride };
  }

  /** Take the last line of the header; the blocks begin behind it. */
  takeEnd() {
    const spaces = String(this.take("end( {0,63})")[0]).length;
    if (spaces !== (ALIGNMENT - ((this.at - spaces) % ALIGNMENT)) % ALIGNMENT) {
      refuse("line", this.where());
    }
  }

  /** Refuse the file unless it has this size and its checksum is right. @param {number} size */
  checkWhole(size) {
    const { data } = this;
    if (data.length < size) refuse("truncated", `byte ${data.length}`);
    if (data.length > size) refuse("longer", `byte ${size}`);
    const end = data.length - CHECKSUM_SIZE;
    const line = `crc32 ${crc32(data.subarray(0, end)).toString(16).padStart(8, "0")}\n`;
    if (latin(data.subarray(end)) !== line) refuse("damaged", `byte ${end}`);
  }

  /** @returns {string} the line taken last, for errors */
  where() {
    return `line ${this.number}`;
  }
}

/**
 * Return the block that begins at byte `at` of the file.
 * @param {Uint8Array} data of the whole file
 * @param {number} at
 * @param {number} nodes
 * @param {Column} column what it must hold
 * @returns {Float64Array}
 */
export function readBlock(data, at, nodes, column) {
  const view = new DataView(data.buffer, data.byteOffset + at, 8 * nodes);
  const values = new Float64Array(nodes);
  for (let node = 0; node < nodes; node += 1) {
    const value = view.getFloat64(8 * node, true);
    const good = value >= column.low && value <= column.high;
    if (!good || (column.whole && !Number.isInteger(value))) {
      refuse("value", `byte ${at + 8 * node}`);
    }
    values[node] = value;
  }
  const end = at + 8 * nodes;
  const fill = data.subarray(end, end + ((ALIGNMENT - (end % ALIGNMENT)) % ALIGNMENT));
  if (fill.some((byte) => byte !== 0)) refuse("value", `byte ${end}`);
  return values;
}

/** @param {Uint8Array} bytes @returns {string} a character per byte */
function latin(bytes) {
  return String.fromCharCode(...bytes);
}
