// Profiles as the functions keep them (docs/profile-format.md), read and checked.

import {
  CHECKSUM_SIZE,
  COLUMNS,
  FILE_MAX,
  Lines,
  NOTE,
  NUMBER,
  readBlock,
} from "./profile_parts.js";
import { refuse } from "./profile_refused.js";

const KINDS = ["drive", "learn", "forget", "undo", "rollback"];
/** @typedef {"base" | "drive" | "learn" | "forget" | "undo" | "rollback"} Kind */
/** @typedef {import("./profile_parts.js").Column} Column */

/**
 * What was known after one drive; a value per node (metre), or per cell for offsets.
 * @typedef {object} Iteration
 * @property {number} number 0 is the base profile before any learning
 * @property {Kind} kind
 * @property {string} note
 * @property {number} interventions by pedal in the drive
 * @property {Record<string, Float64Array>} columns `learned_mps`, `base_mps`, `offset_mps`, ...
 */

/**
 * Everything that is kept about one driver on one route.
 * @typedef {object} Profile
 * @property {number} driver_id
 * @property {string} route fingerprint
 * @property {number} nodes one per metre
 * @property {Iteration[]} iterations by number, 0 among them
 */

/** @typedef {{kind: Kind, interventions: number, note: string, columns: Column[]}} Head */

/**
 * Return the profile in the bytes of a file, of whatever source: nothing in it is trusted.
 * @param {Uint8Array} data
 * @returns {Profile}
 * @throws {import("./profile_refused.js").ProfileRefused} it is not what a function writes
 */
export function readProfile(data) {
  if (data.length > FILE_MAX) refuse("longer", `byte ${FILE_MAX}`);
  const lines = new Lines(data);
  const version = lines.takeVersion();
  const start = lines.takeStart();
  const heads = version === 1 ? heads1(lines, start.iterations) : heads2(lines, start.iterations);
  const blocks = 1 + heads.reduce((sum, head) => sum + head.columns.length, 0);
  lines.checkWhole(lines.at + blocks * start.stride + CHECKSUM_SIZE);
  let at = lines.at;
  const base = readBlock(data, at, start.nodes, column("base_mps"));
  const iterations = [beginning(base)];
  for (const [index, { columns, ...head }] of heads.entries()) {
    const before = iterationOf({ iterations });
    const values = { ...before.columns };
    for (const read of columns) {
      at += start.stride;
      values[read.name] = readBlock(data, at, start.nodes, read);
      if (version > 1 && same(values[read.name], before.columns[read.name])) {
        refuse("value", `byte ${at}`);
      }
    }
    iterations.push({ number: index + 1, ...head, columns: values });
  }
  return { driver_id: start.driver_id, route: start.route, nodes: start.nodes, iterations };
}

/**
 * Return an iteration of a profile.
 * @param {{iterations: Iteration[]}} profile
 * @param {number} [number] the newest if there is none
 * @returns {Iteration}
 */
export function iterationOf(profile, number = profile.iterations.length - 1) {
  const found = profile.iterations[number];
  if (found === undefined) throw new RangeError(`there is no iteration ${number}`);
  return found;
}

/**
 * Return a column of an iteration.
 * @param {Iteration} iteration
 * @param {string} name
 * @returns {Float64Array}
 */
export function columnOf(iteration, name) {
  const values = iteration.columns[name];
  if (values === undefined) throw new RangeError(`there is no column ${name}`);
  return values;
}

/** @param {Float64Array} base @returns {Iteration} */
function beginning(base) {
  const nothing = new Float64Array(base.length);
  const columns = Object.fromEntries(COLUMNS.map(({ name }) => [name, nothing]));
  Object.assign(columns, { base_mps: base, learned_mps: base });
  return { number: 0, kind: "base", note: "", interventions: 0, columns };
}

/** @param {Lines} lines @param {number} count @returns {Head[]} */
function heads2(lines, count) {
  const blocks = Number(lines.take("blocks ([1-9][0-9]{0,7})")[0]);
  lines.take("block base_mps m/s()");
  const heads = Array.from({ length: count }, (_, index) => head2(lines, index + 1));
  lines.takeEnd();
  const named = heads.reduce((sum, head) => sum + head.columns.length, 1);
  if (named !== blocks) refuse("line", "line 7");
  return heads;
}

/** @param {Lines} lines @param {number} expected number of the iteration @returns {Head} */
function head2(lines, expected) {
  const [number, kind, interventions, note] = lines.take(
    `iteration ${NUMBER} ([a-z]{1,16}) ${NUMBER}${NOTE}`,
  );
  if (Number(number) !== expected) refuse("line", lines.where());
  if (!KINDS.includes(String(kind))) refuse("newer", lines.where());
  /** @type {Column[]} */
  const columns = [];
  while (lines.nextIs("block ")) columns.push(block(lines, columns));
  return {
    kind: /** @type {Kind} */ (kind),
    interventions: Number(interventions),
    note: note ?? "",
    columns,
  };
}

/** @param {Lines} lines @param {Column[]} before those of this iteration so far @returns {Column} */
function block(lines, before) {
  const [name, unit] = lines.take("block ([a-z][a-z0-9_]{0,39}) ([!-~]{1,16})");
  const found = COLUMNS.findIndex((known) => known.name === name);
  const next = COLUMNS[found];
  if (next === undefined) return refuse("newer", lines.where());
  const last = before.at(-1);
  if (unit !== next.unit || (last && COLUMNS.indexOf(last) >= found)) refuse("line", lines.where());
  return next;
}

/** @param {Lines} lines @param {number} count @returns {Head[]} of format 1, which knows no kinds */
function heads1(lines, count) {
  const columns = ["learned_mps", "offset_mps", "drive", "intervention"].map(column);
  const heads = Array.from({ length: count }, (_, index) => {
    const [number, interventions, note] = lines.take(`iteration ${NUMBER} ${NUMBER}${NOTE}`);
    if (Number(number) !== index + 1) refuse("line", lines.where());
    /** @type {Kind} */
    const kind = /^rollback of [0-9]+$/.test(String(note)) ? "rollback" : "drive";
    return { kind, interventions: Number(interventions), note: note ?? "", columns };
  });
  lines.takeEnd();
  return heads;
}

/** @param {string} name @returns {Column} */
function column(name) {
  const found = COLUMNS.find((known) => known.name === name);
  if (found === undefined) throw new RangeError(`there is no column ${name}`);
  return found;
}

/**
 * Tell whether the bits are the same: 0 is not -0.
 * @param {Float64Array | undefined} a
 * @param {Float64Array | undefined} b
 */
function same(a, b) {
  return (
    a === b || (a !== undefined && b !== undefined && a.every((value, i) => Object.is(value, b[i])))
  );
}
