// Drives of the page's engine without a page: a task in JSON on stdin, files into a folder.
//
// The synthetic person presses pedals, lever and buttons by a seed, and is asked at jittered times by a
// clock of its own; pictures are dropped, the machine is too slow once, and the page is hidden once.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";

import { decoded } from "../../../fmu_src/pldf/cockpit/page/engine/bundle.js";
import { Drive } from "../../../fmu_src/pldf/cockpit/page/engine/drive.js";
import { forgetPlaces, undoLesson } from "../../../fmu_src/pldf/cockpit/page/engine/forget.js";
import { inputsCsv } from "../../../fmu_src/pldf/cockpit/page/engine/input_changes.js";
import { RELEASED } from "../../../fmu_src/pldf/cockpit/page/engine/person.js";
import { Run } from "../../../fmu_src/pldf/cockpit/page/engine/run.js";

/** @typedef {import("../../../fmu_src/pldf/cockpit/page/types.js").DriveSetup} DriveSetup */
/** @typedef {import("../../../fmu_src/pldf/cockpit/page/types.js").DriveResult} DriveResult */
/** @typedef {import("../../../fmu_src/pldf/cockpit/page/types.js").Controls} Controls */

const PICTURE_MS = 1000 / 60;
const DROPPED_MS = 80;
const SLOW_MS = 400;
const HIDDEN_MS = 5000;

/**
 * Return numbers from 0 to 1 by chance, the same for a seed.
 * @param {number} seed
 */
function chance(seed) {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/**
 * Return who presses what, by chance, each time it is asked.
 * @param {() => number} random
 * @returns {() => Controls}
 */
function synthetic(random) {
  let [gas, brake, pause] = [0, 0, false];
  return () => {
    gas = Math.max(0, Math.min(1, gas + (gas > 0 ? random() - 0.52 : random() < 0.004 ? 0.2 : 0)));
    brake = Math.max(0, brake > 0 ? brake - 0.01 * random() : random() < 0.0008 ? 0.3 : 0);
    pause = random() < 0.0005 ? !pause : pause;
    return {
      ...RELEASED,
      gas_pedal: 0.4 * gas,
      brake_pedal: brake,
      steering: random() - 0.5,
      resume: random() < 0.01,
      cancel: random() < 0.0004,
      up: random() < 0.003,
      down: random() < 0.003,
      up_long: random() < 0.0004,
      down_long: random() < 0.0004,
      pause_learning: pause,
      forget_here: random() < 0.0003,
      undo: random() < 0.0002,
    };
  };
}

/**
 * Drive in real time, as a worker does, but for the time.
 * @param {Drive} drive
 * @param {number} seed
 */
function inRealTime(drive, seed) {
  const random = chance(seed);
  const person = synthetic(random);
  let now_ms = 1e6;
  const run = new Run(drive, () => now_ms);
  run.resume();
  for (let picture = 1; ; picture += 1) {
    now_ms += PICTURE_MS + 6 * (random() - 0.5);
    now_ms += picture % 50 === 0 ? DROPPED_MS : picture === 333 ? SLOW_MS : 0;
    if (picture === 777) {
      run.pause("hidden");
      now_ms += HIDDEN_MS;
      run.resume();
    }
    drive.person?.take(person());
    const end = run.tick();
    if (end !== null) {
      return run.finish(end);
    }
  }
}

/** @param {Drive} drive */
function asFastAsPossible(drive) {
  const run = new Run(drive, () => performance.now());
  run.resume();
  let end = null;
  while (end === null) {
    end = run.hurry();
  }
  return run.finish(end);
}

/**
 * @param {string} folder
 * @param {DriveResult} result
 */
function keep(folder, result) {
  const { recording, inputs, profiles, ...rest } = result;
  put(join(folder, "recording.csv"), recording);
  put(join(folder, "inputs.csv"), inputsCsv(inputs));
  put(join(folder, "result.json"), JSON.stringify(rest));
  keepProfiles(folder, profiles);
}

/**
 * @param {string} folder
 * @param {Record<string, Uint8Array>} profiles
 */
function keepProfiles(folder, profiles) {
  for (const [name, bytes] of Object.entries(profiles)) {
    put(join(folder, "profiles", name), bytes);
  }
}

/**
 * @param {string} path
 * @param {string | Uint8Array} content
 */
function put(path, content) {
  mkdirSync(dirname(path), { recursive: true });
  writeFileSync(path, content);
}

const task = JSON.parse(readFileSync(0, "utf8"));
const bundle = decoded(JSON.parse(readFileSync(task.bundle, "utf8")));
/** @type {DriveSetup["profiles"]} */
let profiles = {};
for (const { name, seed, forget_m, undo, ...setup } of task.drives) {
  const given = { ...setup, profiles };
  const folder = join(task.folder, name);
  if (forget_m !== undefined || undo) {
    profiles = await (undo ? undoLesson(bundle, given) : forgetPlaces(bundle, given, forget_m));
    keepProfiles(folder, profiles);
    continue;
  }
  const drive = await Drive.begin(bundle, given);
  const result = setup.pace === "fast" ? asFastAsPossible(drive) : inRealTime(drive, seed);
  ({ profiles } = result);
  keep(folder, result);
}
