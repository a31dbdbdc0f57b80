// The hostile drives of the native FMUs, through the page's own code: in Node.js or in a browser.
import { Fmu } from "../../../fmu_src/pldf/cockpit/page/engine/fmu.js";
import { bytesOf } from "../../../fmu_src/pldf/cockpit/page/engine/bundle.js";

/** @typedef {import("../../../fmu_src/pldf/cockpit/page/types.js").Files} Files */
/** @typedef {import("../../../fmu_src/pldf/cockpit/page/types.js").Value} Value */
/** @typedef {import("../../../fmu_src/pldf/cockpit/page/types.js").Variable} Variable */
/** @typedef {import("../../../fmu_src/pldf/cockpit/page/engine/instance.js").Instance} Instance */
/** @typedef {import("../../../fmu_src/pldf/cockpit/page/engine/batch.js").Batch} Batch */

/**
 * One case: bytes are base64.
 * @typedef {object} Case
 * @property {{name: string, guid: string, wasm: string, variables: Variable[], resources: Record<string, string>}} model
 * @property {Record<string, Value>} settings
 * @property {string} script rows of float64: time in s, step in s, all inputs
 * @property {number} drives one after the other, with the files that the one before left
 */

/**
 * Return digests of what each drive returns, and of the files at the end, by path.
 * @param {Case} one
 */
export async function driven(one) {
  const { model, settings } = one;
  const resources = Object.fromEntries(
    Object.entries(model.resources).map(([path, text]) => [path, bytesOf(text)]),
  );
  const fmu = await Fmu.load({ ...model, version: "", wasm: bytesOf(model.wasm), resources });
  const script = new Float64Array(bytesOf(one.script).buffer);
  const results = [];
  /** @type {Files} */
  let files = {};
  for (let drive = 0; drive < one.drives; drive += 1) {
    const instance = fmu.instantiate("drive", files);
    instance.setAll(settings);
    instance.enterInitialization();
    instance.exitInitialization();
    results.push(await digest(rows(instance, model.variables, script)));
    instance.terminate();
    files = instance.files();
    instance.free();
  }
  /** @type {Record<string, string>} */
  const left = {};
  for (const [path, bytes] of Object.entries(files)) left[path] = await digest(bytes);
  return { results, files: left };
}

/**
 * Drive one drive; return all outputs that are numbers, first and after each row.
 * @param {Instance} instance
 * @param {Variable[]} variables
 * @param {Float64Array} script
 */
function rows(instance, variables, script) {
  const inputs = places(instance, variables, "input");
  const outputs = places(instance, variables, "output");
  const width = 2 + inputs.length;
  const results = new Float64Array((script.length / width + 1) * outputs.length);
  read(outputs, results, 0);
  for (let row = 0; row * width < script.length; row += 1) {
    const [time_s, step_s, ...values] = script.subarray(row * width, (row + 1) * width);
    inputs.forEach(({ batch, at }, i) => (batch.values[at] = values[i]));
    new Set(inputs.map(({ batch }) => batch)).forEach((batch) => batch.write());
    if (step_s !== 0) instance.step(time_s, step_s);
    read(outputs, results, (row + 1) * outputs.length);
  }
  return new Uint8Array(results.buffer);
}

/**
 * Return where each variable lies that is a number, a batch per kind.
 * @param {Instance} instance
 * @param {Variable[]} variables
 * @param {Variable["causality"]} causality
 * @returns {{batch: Batch, at: number}[]}
 */
function places(instance, variables, causality) {
  const chosen = variables.filter((v) => v.causality === causality && v.kind !== "String");
  /** @param {Variable} variable */
  const alike = (variable) => chosen.filter((v) => v.kind === variable.kind);
  /** @type {Map<string, Batch>} */
  const batches = new Map();
  for (const v of chosen) {
    if (!batches.has(v.kind)) batches.set(v.kind, instance.batch(alike(v).map((a) => a.name)));
  }
  return chosen.map((v) => ({
    batch: /** @type {Batch} */ (batches.get(v.kind)),
    at: alike(v).indexOf(v),
  }));
}

/**
 * @param {{batch: Batch, at: number}[]} outputs
 * @param {Float64Array} results
 * @param {number} first
 */
function read(outputs, results, first) {
  new Set(outputs.map(({ batch }) => batch)).forEach((batch) => batch.read());
  outputs.forEach(({ batch, at }, i) => (results[first + i] = batch.values[at]));
}

/** @param {Uint8Array} bytes */
async function digest(bytes) {
  const found = new Uint8Array(await crypto.subtle.digest("SHA-256", Uint8Array.from(bytes)));
  return [...found].map((byte) => byte.toString(16).padStart(2, "0")).join("");
}
