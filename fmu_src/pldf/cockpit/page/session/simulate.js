// All drives of the plan by a simulated driver, as fast as this computer can, to watch and compare.

import { DriveClient } from "../engine/client.js";
import { readProfile } from "../engine/profile.js";
import { readReplay } from "../engine/replay.js";
import { element } from "../dom.js";
import { language } from "../language.js";
import { button, showPage, showProblem } from "./app.js";
import { saveAs, zipped } from "./hand_out.js";
import { watch } from "./replay_screen.js";
import { planned, simulatedSetup } from "./setup.js";
import { say } from "./words.js";

/** @typedef {import("../types.js").DriveResult} DriveResult */
/** @typedef {import("../types.js").DriveSetup} DriveSetup */
/** @typedef {import("../types.js").Files} Files */
/** @typedef {import("../types.js").PlannedDrive} PlannedDrive */
/** @typedef {import("./app.js").App} App */
/** @typedef {{results: [string, DriveResult][], profiles: Files}} Driven by phase; the last profiles */

const DRIVER_ID = 1;
const ZIP = "pldf-simulated.zip";

/**
 * Simulate a participant, then show all drives.
 * @param {App} app
 * @param {() => void} back to the first page
 */
export async function simulate(app, back) {
  try {
    const driven = await drivenAll(app);
    const profiles = Object.entries(driven.profiles).map(([name, bytes]) => ({
      name,
      bytes,
      profile: readProfile(bytes),
    }));
    const recordings = driven.results.map(([name, result]) => ({
      name,
      replay: readReplay(result.recording),
    }));
    const dropped = { recordings, profiles, road: null, refused: [] };
    const save = () => saveAs(ZIP, zipped(filesOf(driven)));
    watch(app, dropped, back, [], [button(say("simulation_save"), save)]);
  } catch (problem) {
    showProblem(app.root, problem);
  }
}

/**
 * Return the drives as files of a study; the data of people are in another place.
 * @param {Driven} driven
 * @returns {Files}
 */
function filesOf({ results, profiles }) {
  const recordings = results.map(([phase, { recording }]) => [
    `recordings/S0${DRIVER_ID}_${phase}.csv`,
    new TextEncoder().encode(recording),
  ]);
  const learned = Object.entries(profiles).map(([name, bytes]) => [`profiles/${name}`, bytes]);
  return Object.fromEntries([...recordings, ...learned]);
}

/**
 * @param {App} app
 * @returns {Promise<Driven>}
 */
async function drivenAll(app) {
  /** @type {[string, DriveResult][]} */
  const results = [];
  /** @type {Files} */
  let profiles = {};
  const phases = app.bundle.plan.orders.AB;
  const bar = element("progress", {
    max: phases.length,
    value: 0,
    "aria-label": say("simulation"),
  });
  showPage(app, say("simulation"), bar);
  for (const phase of phases) {
    const drive = planned(app.bundle, phase);
    const result = await drivenFast(app, simulated(app, drive, profiles));
    if (result.ending === "failed") {
      throw new Error(`${phase}: ${result.reason}`);
    }
    profiles = drive.learn ? result.profiles : profiles;
    results.push([phase, result]);
    bar.setAttribute("value", String(results.length));
  }
  return { results, profiles };
}

/**
 * Return a drive of the plan that the driver FMU drives in this road's car.
 * @param {App} app
 * @param {PlannedDrive} drive
 * @param {Files} profiles
 * @returns {DriveSetup}
 */
function simulated(app, drive, profiles) {
  const who = { driver_id: DRIVER_ID, profiles, settings: app.settings, language: language() };
  return { ...simulatedSetup(app.bundle, drive, who), pace: "fast" };
}

/**
 * @param {App} app
 * @param {DriveSetup} setup
 * @returns {Promise<DriveResult>}
 */
async function drivenFast(app, setup) {
  const client = new DriveClient();
  try {
    /** @type {Promise<DriveResult>} */
    const ended = new Promise((resolve) => {
      client.onended = resolve;
    });
    await client.start(app.bundle, setup);
    return await ended;
  } finally {
    client.dispose();
  }
}
