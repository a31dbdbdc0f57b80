// A step of the session in which is driven: said what it is, driven, stored; or driven again.

import { choose, now } from "./app.js";
import { element } from "../dom.js";
import { connectedDevices } from "../engine/inputs/gamepad.js";
import { KEYBOARD } from "../engine/inputs/inputs.js";
import { calibrationOf, inputsOf } from "./devices.js";
import { canPractise } from "./flow.js";
import { drive } from "./drive_screen.js";
import { chooseDevice } from "./device_screen.js";
import { keepDrive, learnedFiles } from "./keeping.js";
import { keysTable } from "./keys_table.js";
import { language } from "../language.js";
import { patiently } from "./patiently.js";
import { REASONS, reasonText } from "./pause_dialog.js";
import { progress } from "./progress.js";
import { driveSetup, planned, practiceSetup } from "./setup.js";
import { shownBy } from "./settings.js";
import { settingsForm } from "./settings_form.js";
import { withAttempt, withEnding } from "./record.js";
import { say } from "./words.js";
import { say as sayDrive } from "./drive_words.js";

/** @typedef {import("../types.js").DriveSetup} DriveSetup */
/** @typedef {import("../engine/inputs/inputs.js").Inputs} Inputs */
/** @typedef {import("./drive_screen.js").Driven} Driven */
/** @typedef {import("./guided.js").Session} Session */
/** @typedef {import("./guided_screens.js").Ended} Ended */
/** @typedef {import("./record.js").Attempt} Attempt */

/**
 * Drive the drive that the session is at, and store it.
 * @param {Session} session
 * @returns {Promise<Ended>}
 */
export async function driveStep(session) {
  const inputs = session.inputs ?? (await rememberedInputs(session));
  session.inputs = inputs;
  const choice = await introduced(session);
  if (choice === "stop" || choice === "practise") {
    return { event: choice, reason: "" };
  }
  if (choice === "device") {
    session.inputs = null;
    inputs.keyboard.dispose();
    session.inputs = await chooseDevice(session.app);
    return { event: "again", reason: "" };
  }
  const setup = await setupOf(session, inputs);
  const { kind, name } = drivenNow(session);
  const begun = { kind, name, began_at: now(), device: inputs.name, steering: setup.steering };
  await session.keep(withAttempt(session.record, begun));
  const driven = await driveNow(session, setup, inputs);
  await stored(session, driven);
  if (driven.result.ending === "arrived") {
    return { event: "stored", reason: "" };
  }
  return endedEarly(session, driven.result.reason || driven.result.ending);
}

/**
 * Return what the person drove with before the page was opened again, if it is there.
 * @param {Session} session
 * @returns {Promise<Inputs>}
 */
async function rememberedInputs({ app, record }) {
  const name = record.attempts.at(-1)?.device;
  if (name === KEYBOARD) {
    return inputsOf(null);
  }
  const device = connectedDevices().find((one) => one.id === name);
  const calibration = device ? calibrationOf(device) : null;
  return device && calibration ? inputsOf(device.id, calibration) : chooseDevice(app);
}

/** @param {Session} session @returns {Pick<Attempt, "kind" | "name">} */
function drivenNow({ step }) {
  return { kind: step.kind === "practice" ? "practice" : "drive", name: step.name };
}

/** @param {Session} session @returns {string} */
function titleOf({ app, step, record }) {
  if (step.kind === "practice") {
    return say("practice_title", { number: step.name });
  }
  const phases = app.bundle.plan.orders[record.order];
  const number = phases.indexOf(step.name) + 1;
  return say("drive_title", { number, of: phases.length });
}

/**
 * Say what the drive is.
 * @param {Session} session
 */
function introduced(session) {
  const { app, step, record } = session;
  const practises = step.kind === "practice";
  const task = practises ? say("practice_text") : taskOf(session);
  const cutOff = record.attempts.at(-1)?.ending === "cut off";
  const practise = { text: say("practise_again"), choice: /** @type {const} */ ("practise") };
  return choose(
    app,
    titleOf(session),
    [
      progress(session),
      cutOff ? element("p", { class: "notice" }, say("cut_off")) : null,
      element("p", { class: "task" }, task),
      record.explanation === "text" && element("p", {}, say("explained_text")),
      element("p", { class: "unwell" }, say("unwell")),
    ],
    [
      { text: say("start_drive"), choice: /** @type {const} */ ("start"), kind: "main" },
      { text: sayDrive("change_device"), choice: /** @type {const} */ ("device") },
      ...(canPractise(session.steps, session.place) ? [practise] : []),
      { text: say("end_session"), choice: /** @type {const} */ ("stop") },
    ],
    [
      folded(sayDrive("keys_title"), keysOf(session), practises),
      folded(sayDrive("settings"), settingsForm(app.settings, { study: true }), false),
    ],
  );
}

/** @param {Session} session */
function keysOf({ app, step }) {
  const teaches = step.kind === "drive" && planned(app.bundle, step.name).learn;
  return keysTable(app.bundle.plan.steering === "person", teaches);
}

/**
 * @param {string} title
 * @param {Node} content
 * @param {boolean} open
 */
function folded(title, content, open) {
  return element("details", { open }, element("summary", {}, title), content);
}

/** @param {Session} session */
function taskOf({ app, step }) {
  return planned(app.bundle, step.name).intervenes ? say("drive_text") : say("watch_text");
}

/**
 * @param {Session} session
 * @param {Inputs} inputs
 * @returns {Promise<DriveSetup>}
 */
async function setupOf({ app, step, record }, inputs) {
  const { plan } = app.bundle;
  // Of a study, everybody steers and sees the same.
  const settings = { ...app.settings, steering: plan.steering };
  const who = { driver_id: record.driver_id, device: inputs.name, settings, language: language() };
  if (step.kind === "practice") {
    return practiceSetup(app.bundle, { ...who, profiles: {} });
  }
  const profiles = await patiently(app, (storage) => learnedFiles(storage, record));
  return driveSetup(app.bundle, planned(app.bundle, step.name), { ...who, profiles });
}

/**
 * @param {Session} session
 * @param {DriveSetup} setup
 * @param {Inputs} inputs
 * @returns {Promise<Driven>}
 */
async function driveNow(session, setup, inputs) {
  const { app, record, step } = session;
  const practice = step.kind === "practice";
  // What is changed while driving stays; the field of view is the plan's.
  app.settings.fov_deg = app.bundle.plan.fov_deg;
  const driven = await drive(app, {
    setup,
    inputs,
    explanation: record.explanation,
    title: titleOf(session),
    participant: record.participant,
    phase: practice ? "" : step.name,
    teaches: !practice && planned(app.bundle, step.name).learn,
    shows_keys: practice,
    stoppable: (stop) => {
      session.stopDrive = stop;
    },
    tell: (state, reason) => session.tell(state, { reason }),
  });
  session.stopDrive = null;
  session.tell("between", { reason: driven.result.reason });
  return driven;
}

/**
 * Store a drive and its record; nothing else is shown before that is done.
 * @param {Session} session
 * @param {Driven} driven
 */
async function stored(session, { result, frames }) {
  const { app, record, step } = session;
  const attempt = drivenNow(session);
  const arrived = result.ending === "arrived";
  const learns = arrived && step.kind === "drive" && planned(app.bundle, step.name).learn;
  const ended = {
    ended_at: now(),
    ending: result.ending,
    reason: result.reason,
    outputs: result.outputs,
    messages: result.messages,
    interruptions: result.interruptions,
    timing: result.timing,
    frames,
    shown: shownBy(app.settings),
  };
  session.record = await patiently(app, async (storage) => {
    const file = await keepDrive(storage, record, attempt, result);
    const kept = withEnding(record, { ...ended, file });
    return learns ? { ...kept, learned_after: step.name } : kept;
  });
  if (!arrived) {
    await session.keep(session.record);
  }
}

/**
 * @param {Session} session
 * @param {string} reason
 * @returns {Promise<Ended>}
 */
async function endedEarly({ app }, reason) {
  const content = [
    element("p", {}, say("ended_early_why", { reason: reasonText(reason) })),
    element("p", {}, say("unwell")),
  ];
  // Nobody who feels unwell is asked to drive again by the larger button.
  const unwell = reason === REASONS.unwell;
  const again = { text: say("drive_again"), choice: /** @type {const} */ ("again") };
  const stop = { text: say("end_session"), choice: /** @type {const} */ ("stop") };
  const choices = unwell ? [{ ...stop, kind: "main" }, again] : [{ ...again, kind: "main" }, stop];
  const event = await choose(app, say("ended_early"), content, choices);
  return { event, reason: event === "stop" ? reason : "" };
}
