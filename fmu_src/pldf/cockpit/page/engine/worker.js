// The worker: drives while the page draws. Its messages are those that `client.js` sends and hears.

import { Drive } from "./drive.js";
import { forgetPlaces } from "./forget.js";
import { Run } from "./run.js";

/** @typedef {import("../types.js").Controls} Controls */
/** @typedef {import("../types.js").DriveResult} DriveResult */
/** @typedef {import("../types.js").DriveSetup} DriveSetup */
/** @typedef {import("../types.js").Files} Files */
/** @typedef {import("../types.js").Frame} Frame */
/** @typedef {import("./coupling.js").DriveBundle} DriveBundle */
/** @typedef {import("./drive.js").End} End */

/**
 * @typedef {{kind: "start", bundle: DriveBundle, setup: DriveSetup}
 *   | {kind: "input", controls: Controls}
 *   | {kind: "pause", reason: string}
 *   | {kind: "resume"}
 *   | {kind: "stop", reason: string}
 *   | {kind: "forget", bundle: DriveBundle, setup: DriveSetup, places_m: number[]}} Told
 */
/**
 * @typedef {{kind: "ready"}
 *   | {kind: "frame", frame: Frame}
 *   | {kind: "paused", reason: string}
 *   | {kind: "resumed"}
 *   | {kind: "ended", result: DriveResult}
 *   | {kind: "forgotten", profiles: Files}
 *   | {kind: "failed", reason: string}} Said
 */

/** Timers are asked for more often than steps are due: how late they are is the clock's matter. */
const TICK_MS = 4;

const page = /** @type {MessagePort} */ (/** @type {unknown} */ (globalThis));

/** @type {Run | null} */
let run = null;
/** @type {ReturnType<typeof setInterval> | undefined} */
let timer;

/** @param {Said} said */
function say(said) {
  page.postMessage(said);
}

/**
 * @param {DriveBundle} bundle
 * @param {DriveSetup} setup
 */
async function start(bundle, setup) {
  clearInterval(timer);
  const drive = await Drive.begin(bundle, setup);
  const started = new Run(drive, () => performance.now());
  run = started;
  say({ kind: "frame", frame: drive.frame() });
  say({ kind: "ready" });
  if (setup.pace === "fast") {
    resume();
  } else {
    say({ kind: "paused", reason: started.paused?.reason ?? "" });
  }
  timer = setInterval(() => beat(started), setup.pace === "fast" ? 0 : TICK_MS);
}

/** @param {Run} now */
function beat(now) {
  const stood = now.paused !== null;
  const before = now.drive.steps;
  try {
    const end = now.drive.setup.pace === "fast" ? now.hurry() : now.tick();
    if (now.drive.steps > before) {
      say({ kind: "frame", frame: now.drive.frame() });
    }
    if (end !== null) {
      finish(now, end);
    } else if (!stood && now.paused !== null) {
      say({ kind: "paused", reason: now.paused.reason });
    }
  } catch (error) {
    leave(now.fail(wordsOf(error)));
  }
}

/**
 * @param {Run} now
 * @param {End} end
 */
function finish(now, end) {
  try {
    leave(now.finish(end));
  } catch (error) {
    leave(now.fail(wordsOf(error)));
  }
}

/** @param {DriveResult} result */
function leave(result) {
  clearInterval(timer);
  run = null;
  say({ kind: "ended", result });
}

/** @param {string} reason told even if the drive stands already: the page may be about to go on */
function pause(reason) {
  if (run !== null) {
    run.pause(reason);
    say({ kind: "paused", reason });
  }
}

function resume() {
  run?.resume();
  say({ kind: "resumed" });
}

/** @param {string} reason */
function stop(reason) {
  if (run !== null) {
    finish(run, { ending: "stopped", reason });
  }
}

/** @param {() => Promise<void>} action */
async function attempt(action) {
  try {
    await action();
  } catch (error) {
    say({ kind: "failed", reason: wordsOf(error) });
  }
}

/** @param {unknown} error */
function wordsOf(error) {
  return error instanceof Error ? error.message : String(error);
}

page.onmessage = ({ data }) => {
  const told = /** @type {Told} */ (data);
  if (told.kind === "start") {
    attempt(() => start(told.bundle, told.setup));
  } else if (told.kind === "input") {
    run?.hear(told.controls);
  } else if (told.kind === "pause") {
    pause(told.reason);
  } else if (told.kind === "resume") {
    resume();
  } else if (told.kind === "stop") {
    stop(told.reason);
  } else {
    attempt(async () => {
      const profiles = await forgetPlaces(told.bundle, told.setup, told.places_m);
      say({ kind: "forgotten", profiles });
    });
  }
};
