// What a person did, as a table: it is all that is needed to drive the same drive again.

import { floatText } from "./numbers.js";

/** @typedef {import("../types.js").InputChange} InputChange */

const HEADER = "step,name,value";

/**
 * Return the file of `changes`.
 * @param {InputChange[]} changes
 */
export function inputsCsv(changes) {
  const lines = changes.map(({ step, name, value }) => `${step},${name},${floatText(value)}`);
  return `${[HEADER, ...lines].join("\n")}\n`;
}

/**
 * Return what a file of `inputsCsv` holds.
 * @param {string} text
 * @returns {InputChange[]}
 * @throws {RangeError} a line is none of ours; names it
 */
export function readInputs(text) {
  const [header, ...lines] = text.trimEnd().split(/\r?\n/);
  if (header !== HEADER) {
    throw new RangeError(`line 1: ${header} instead of ${HEADER}`);
  }
  return lines.map((line, at) => {
    const [step, name, value] = line.split(",");
    const change = { step: Number(step), name, value: Number(value) };
    if (!name || !value || !Number.isInteger(change.step) || !Number.isFinite(change.value)) {
      throw new RangeError(`line ${at + 2}: ${line} is no step, name and value`);
    }
    return change;
  });
}
