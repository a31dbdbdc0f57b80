// Times of the FMUs as WebAssembly in V8, the engine of Node.js and Chromium: a bundle in JSON on stdin,
// processor times in seconds as JSON on stdout. A step sets all wired inputs, steps, and gets all outputs of the
// three models, through the page's own code.
import { readFileSync } from "node:fs";

import { decoded } from "../fmu_src/pldf/cockpit/page/engine/bundle.js";
import { Coupling } from "../fmu_src/pldf/cockpit/page/engine/coupling.js";
import { Drive } from "../fmu_src/pldf/cockpit/page/engine/drive.js";
import { Fmu } from "../fmu_src/pldf/cockpit/page/engine/fmu.js";

/** @typedef {import("../fmu_src/pldf/cockpit/page/types.js").Bundle} Bundle */
/** @typedef {import("../fmu_src/pldf/cockpit/page/types.js").DriveSetup} DriveSetup */
/** @typedef {import("../fmu_src/pldf/cockpit/page/types.js").Part} Part */

const ROUNDS = 9;
const STEPS = 20_000;
/** @type {Part[]} */
const PARTS = ["vehicle", "driver", "pldf"];

/** @param {number[]} times */
function median(times) {
  return times.toSorted((a, b) => a - b)[Math.floor(times.length / 2)];
}

/** @param {() => void} work */
function cpuSeconds(work) {
  const begin = process.cpuUsage();
  work();
  return since(begin);
}

/** @param {NodeJS.CpuUsage} begin */
function since(begin) {
  const { user, system } = process.cpuUsage(begin);
  return 1e-6 * (user + system);
}

/**
 * The setup of a drive of the plan, driven by the driver FMU.
 * @param {Bundle} bundle
 * @param {string} phase
 * @returns {DriveSetup}
 */
function setupOf(bundle, phase) {
  const { plan } = bundle;
  const drive = plan.drives.find((one) => one.phase === phase) ?? plan.drives[0];
  const { step_s, end_m } = plan;
  const values = { ...drive.values, pldf: { ...drive.values.pldf, driver_id: 1 } };
  return {
    values,
    profiles: {},
    who: "model",
    inputs: [],
    activate: true,
    step_s,
    end_m,
    pace: "fast",
    steering: "assisted",
    device: "",
  };
}

/**
 * @param {Bundle} bundle
 * @param {Map<Part, Fmu>} fmus
 */
function coupled(bundle, fmus) {
  const coupling = new Coupling(bundle, fmus, setupOf(bundle, "A2"), null);
  coupling.initialize();
  coupling.read();
  return coupling;
}

/**
 * @param {Bundle} bundle
 * @param {Map<Part, Fmu>} fmus
 */
function stepTimes(bundle, fmus) {
  const times = [];
  for (let round = 0; round < ROUNDS; round += 1) {
    const coupling = coupled(bundle, fmus);
    const step_s = bundle.plan.step_s;
    times.push(
      cpuSeconds(() => {
        for (let step = 0; step < STEPS; step += 1) {
          coupling.read();
          coupling.exchange();
          coupling.step(step * step_s, step_s);
        }
      }) / STEPS,
    );
  }
  return median(times);
}

/**
 * What one model needs of that, stepped alone beside the others.
 * @param {Bundle} bundle
 * @param {Map<Part, Fmu>} fmus
 * @param {Part} part
 */
function alone(bundle, fmus, part) {
  const times = [];
  for (let round = 0; round < ROUNDS; round += 1) {
    const one = coupled(bundle, fmus).part(part);
    const step_s = bundle.plan.step_s;
    times.push(
      cpuSeconds(() => {
        for (let step = 0; step < STEPS; step += 1) {
          one.write();
          one.instance.step(step * step_s, step_s);
          one.read();
        }
      }) / STEPS,
    );
  }
  return median(times);
}

/**
 * Whole drives with recording and learning, as the page drives them without a person.
 * @param {Bundle} bundle
 */
async function studyTimes(bundle) {
  const begin = process.cpuUsage();
  let profiles = {};
  let steps = 0;
  for (const { phase } of bundle.plan.drives) {
    const drive = await Drive.begin(bundle, { ...setupOf(bundle, phase), profiles });
    let end = null;
    while (end === null) end = drive.advance();
    steps += drive.steps;
    const timing = { steps: drive.steps, late_steps: 0, late_max_ms: 0, step_us: 0 };
    ({ profiles } = drive.finish(end, [], timing));
  }
  return { study_cpu_s: since(begin), steps };
}

const bundle = decoded(JSON.parse(readFileSync(0, "utf8")));
/** @type {Map<Part, Fmu>} */
const fmus = new Map();
for (const part of PARTS) fmus.set(part, await Fmu.load(bundle.models[part]));
const result = {
  three_models_step_cpu_s: stepTimes(bundle, fmus),
  alone_step_cpu_s: Object.fromEntries(PARTS.map((part) => [part, alone(bundle, fmus, part)])),
  ...(await studyTimes(bundle)),
};
console.log(JSON.stringify(result));
