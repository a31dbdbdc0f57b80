// Driving without a study: drive after drive the car learns, and shows what; or a simulated driver drives.

import { element } from "../dom.js";
import { AfterDrive } from "../cluster/after_drive.js";
import { DriveClient } from "../engine/client.js";
import { connectedDevices } from "../engine/inputs/gamepad.js";
import { readReplay } from "../engine/replay.js";
import { language } from "../language.js";
import { button, buttons, showPage, showProblem } from "./app.js";
import { calibrationOf, inputsOf } from "./devices.js";
import { drive } from "./drive_screen.js";
import { reasonText } from "./pause_dialog.js";
import { unitOf } from "./settings.js";
import { driveSetup, simulatedSetup } from "./setup.js";
import { browserStorage, filesIn, memoryStorage } from "./storage.js";
import { say } from "./words.js";

/** @typedef {import("../types.js").DriveResult} DriveResult */
/** @typedef {import("../types.js").DriveSetup} DriveSetup */
/** @typedef {import("../types.js").Files} Files */
/** @typedef {import("../engine/inputs/inputs.js").Inputs} Inputs */
/** @typedef {import("./app.js").App} App */
/** @typedef {import("./storage.js").Storage} Storage */
/** @typedef {{read: () => Promise<Files>, write: (files: Files) => Promise<void>}} Learned write: these and no others */

const DRIVER_ID = 1;

/**
 * Drive, see what was learned, drive again.
 * @param {App} app
 * @param {() => void} back to the first page
 */
export async function driveFreely(app, back) {
  const inputs = readyInputs();
  const learned = keptLearned(await visitorStorage(), app.road.key);
  await series(app, back, inputs, learned);
}

/**
 * Watch a simulated driver; what is learned of it is gone with the page.
 * @param {App} app
 * @param {() => void} back
 */
export async function demonstrate(app, back) {
  await series(app, back, null, keptLearned(memoryStorage(), app.road.key));
}

/** A device that is connected and set up, else the keyboard: nothing is asked before the first drive. */
function readyInputs() {
  const device = connectedDevices().find((one) => calibrationOf(one) !== null);
  return device ? inputsOf(device.id, calibrationOf(device)) : inputsOf(null);
}

/**
 * Visitors leave nothing in the folder of a study: what they teach stays in the browser.
 * @returns {Promise<Storage>}
 */
async function visitorStorage() {
  return browserStorage().catch(() => memoryStorage());
}

/**
 * @param {Storage} storage
 * @param {string} road its fingerprint: what was learned belongs to a road
 * @returns {Learned}
 */
function keptLearned(storage, road) {
  const folder = `free/${road}/`;
  return {
    read: async () => {
      const files = Object.entries(await filesIn(storage, folder));
      return Object.fromEntries(files.filter(([, bytes]) => bytes.length));
    },
    write: async (files) => {
      for (const path of await storage.list(folder)) {
        if (!(path.slice(folder.length) in files)) {
          await storage.write(path, new Uint8Array()); // an empty file is none
        }
      }
      for (const [name, bytes] of Object.entries(files)) {
        await storage.write(`${folder}${name}`, bytes);
      }
    },
  };
}

/**
 * @param {App} app
 * @param {() => void} back
 * @param {Inputs | null} inputs null: the driver FMU drives
 * @param {Learned} learned
 */
async function series(app, back, inputs, learned) {
  try {
    for (let next = true; next;) {
      const before = await learned.read();
      const setup = freeSetup(app, inputs, before);
      const { result } = await drive(app, {
        setup,
        inputs,
        explanation: "text",
        title: say(inputs ? "drive_at_once" : "demonstration"),
        participant: "",
        phase: "",
        teaches: true,
        shows_keys: inputs !== null,
      });
      await learned.write(result.profiles);
      next = await afterwards(app, setup, result, learned);
    }
    inputs?.keyboard.dispose();
    back();
  } catch (problem) {
    showProblem(app.root, problem);
  }
}

/**
 * @param {App} app
 * @param {Inputs | null} inputs
 * @param {Files} profiles
 * @returns {DriveSetup}
 */
function freeSetup(app, inputs, profiles) {
  const { drives } = app.bundle.plan;
  const learns = drives.find((one) => one.learn && one.apply_learned && one.intervenes);
  const drive = learns ?? drives[0];
  if (!drive) {
    throw new Error("the plan has no drives");
  }
  const who = { driver_id: DRIVER_ID, profiles, settings: app.settings, language: language() };
  return inputs
    ? driveSetup(app.bundle, drive, { ...who, device: inputs.name })
    : simulatedSetup(app.bundle, drive, who);
}

/**
 * Show what happened and what was learned.
 * @param {App} app
 * @param {DriveSetup} setup
 * @param {DriveResult} result
 * @param {Learned} learned
 * @returns {Promise<boolean>} whether to drive again
 */
function afterwards(app, setup, result, learned) {
  return new Promise((resolve) => {
    const panel = element("div", {});
    const end = (/** @type {boolean} */ again) => {
      after?.dispose();
      resolve(again);
    };
    const early = result.ending !== "arrived" && (result.reason || result.ending);
    const page = showPage(
      app,
      say(early ? "ended_early" : "after_title"),
      early && element("p", {}, say("ended_early_why", { reason: reasonText(early) })),
      buttons(
        button(say("drive_again_learned"), () => end(true), "main"),
        button(say("home"), () => end(false)),
        button(say("forget_all"), () => {
          if (confirm(say("forget_all_sure"))) {
            void learned.write({}).then(() => end(true));
          }
        }),
      ),
      panel,
    );
    page.classList.add("wide");
    const after = afterDrive(app, panel, setup, result, learned);
  });
}

/**
 * @param {App} app
 * @param {Element} panel
 * @param {DriveSetup} setup
 * @param {DriveResult} result
 * @param {Learned} learned
 * @returns {AfterDrive | null} null: too little was driven to show
 */
function afterDrive(app, panel, setup, result, learned) {
  if (result.timing.steps < 100) {
    return null;
  }
  const [name] = Object.keys(result.profiles);
  return new AfterDrive(panel, {
    road: app.road,
    frames: readReplay(result.recording).frames,
    before: name ? (setup.profiles[name] ?? null) : null,
    after: name ? (result.profiles[name] ?? null) : null,
    unit: unitOf(app.settings),
    messages: result.messages,
    forget: name ? (places_m) => forgotten(app, setup, result, learned, name, places_m) : null,
  });
}

/**
 * Forget places after the drive: the function itself does it.
 * @param {App} app
 * @param {DriveSetup} setup
 * @param {DriveResult} result
 * @param {Learned} learned
 * @param {string} name of the profile file
 * @param {number[]} places_m
 * @returns {Promise<Uint8Array>}
 */
async function forgotten(app, setup, result, learned, name, places_m) {
  const client = new DriveClient();
  try {
    const from = { ...setup, profiles: result.profiles };
    const files = places_m.length
      ? await client.forget(app.bundle, from, places_m)
      : result.profiles;
    await learned.write(files);
    return /** @type {Uint8Array} */ (files[name]);
  } finally {
    client.dispose();
  }
}
