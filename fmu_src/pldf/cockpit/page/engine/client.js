// How the page drives: it starts a drive in a worker, tells it what the person does, and hears frames.

import { workerUrl } from "./worker_url.js";

/** @typedef {import("../types.js").Bundle} Bundle */
/** @typedef {import("../types.js").Controls} Controls */
/** @typedef {import("../types.js").DriveResult} DriveResult */
/** @typedef {import("../types.js").DriveSetup} DriveSetup */
/** @typedef {import("../types.js").Files} Files */
/** @typedef {import("../types.js").Frame} Frame */
/**
 * @template T
 * @typedef {{promise: Promise<T>, keep: (value: T) => void, breakIt: (error: Error) => void}} Waiting
 */
/** @typedef {import("./worker.js").Said} Said */
/** @typedef {import("./worker.js").Told} Told */

/** The page was hidden; browsers then give it little time. */
export const HIDDEN = "hidden";

/**
 * Drives, one after the other. A drive in real time stands until `resume()`: when the person is ready.
 */
export class DriveClient {
  constructor() {
    /** @type {(frame: Frame, now_ms: number) => void} */
    this.onframe = () => {};
    /** @type {(reason: string) => void} "ready", "hidden", "late", or what `pause` was told */
    this.onpaused = () => {};
    /** @type {() => void} */
    this.onresumed = () => {};
    /** @type {(result: DriveResult) => void} */
    this.onended = () => {};
    /** @type {Worker | null} */
    this.worker = null;
    /** @type {DriveSetup | null} of the drive that has begun and not ended */
    this.driving = null;
    /** @type {Waiting<void>} */
    this.started = waiting();
    /** @type {Waiting<Files>} */
    this.forgotten = waiting();
    this.hide = () => {
      if (document.hidden) {
        this.pause(HIDDEN);
      }
    };
  }

  /**
   * Make the FMUs ready; the first frame is given before.
   * @param {Bundle} bundle
   * @param {DriveSetup} setup
   * @returns {Promise<void>}
   * @throws {Error} an FMU refused something: its words
   */
  start(bundle, setup) {
    this.started = waiting();
    this.started.promise.then(
      () => (this.driving = setup),
      () => {},
    );
    document.addEventListener("visibilitychange", this.hide);
    this.tell({ kind: "start", bundle: partOf(bundle), setup });
    return this.started.promise;
  }

  /**
   * Tell what the person does now: with every picture, for a page that says nothing is taken as stuck.
   * @param {Controls} controls
   */
  input(controls) {
    this.tell({ kind: "input", controls });
  }

  /**
   * Let the drive stand.
   * @param {string} reason for the data
   */
  pause(reason) {
    this.tell({ kind: "pause", reason });
  }

  /** Begin, or go on. */
  resume() {
    this.tell({ kind: "resume" });
  }

  /**
   * End the drive here; what was done so far is kept and learned from.
   * @param {string} reason for the data
   */
  stop(reason) {
    this.tell({ kind: "stop", reason });
  }

  /**
   * Return the profiles with what was learned at some places forgotten, one place after the other.
   * @param {Bundle} bundle
   * @param {DriveSetup} setup whose profiles and values of the function count
   * @param {number[]} places_m
   * @returns {Promise<Files>}
   * @throws {Error} an FMU refused something: its words
   */
  forget(bundle, setup, places_m) {
    this.forgotten = waiting();
    this.tell({ kind: "forget", bundle: partOf(bundle), setup, places_m });
    return this.forgotten.promise;
  }

  /** End the worker, whatever it does. */
  dispose() {
    document.removeEventListener("visibilitychange", this.hide);
    this.worker?.terminate();
    this.worker = null;
  }

  /** @param {Told} told */
  tell(told) {
    if (this.worker === null) {
      this.worker = new Worker(workerUrl(), { type: "module" });
      this.worker.onmessage = ({ data }) => this.hear(data);
      this.worker.onerror = (event) => this.lose(event.message);
    }
    this.worker.postMessage(told);
  }

  /** @param {Said} said */
  hear(said) {
    if (said.kind === "frame") {
      this.onframe(said.frame, performance.now());
    } else if (said.kind === "ready") {
      this.started.keep();
    } else if (said.kind === "paused") {
      this.onpaused(said.reason);
    } else if (said.kind === "resumed") {
      this.onresumed();
    } else if (said.kind === "ended") {
      this.end(said.result);
    } else if (said.kind === "forgotten") {
      this.forgotten.keep(said.profiles);
    } else {
      this.refuse(said.reason);
    }
  }

  /** @param {DriveResult} result */
  end(result) {
    document.removeEventListener("visibilitychange", this.hide);
    this.driving = null;
    this.onended(result);
  }

  /** @param {string} reason */
  refuse(reason) {
    document.removeEventListener("visibilitychange", this.hide);
    const error = new Error(reason);
    this.started.breakIt(error);
    this.forgotten.breakIt(error);
  }

  /**
   * The worker is gone, and with it what the drive had recorded.
   * @param {string} reason
   */
  lose(reason) {
    this.refuse(reason);
    if (this.driving !== null) {
      this.end(nothingLeft(this.driving, reason));
    }
    this.dispose();
  }
}

/**
 * Return a promise that waits to be kept; nobody need wait for it.
 * @template T
 */
function waiting() {
  /** @type {(value: T) => void} */
  let keep = () => {};
  /** @type {(error: Error) => void} */
  let breakIt = () => {};
  /** @type {Promise<T>} */
  const promise = new Promise((resolve, reject) => {
    keep = resolve;
    breakIt = reject;
  });
  promise.catch(() => {});
  return { promise, keep, breakIt };
}

/**
 * @param {DriveSetup} setup
 * @param {string} reason
 * @returns {DriveResult}
 */
function nothingLeft({ profiles }, reason) {
  return {
    recording: "",
    inputs: [],
    profiles,
    outputs: {},
    messages: [],
    interruptions: [],
    timing: { steps: 0, late_steps: 0, late_max_ms: 0, step_us: 0 },
    ending: "failed",
    reason,
  };
}

/**
 * @param {Bundle} bundle
 * @returns {import("./coupling.js").DriveBundle}
 */
function partOf({ models, wires, road }) {
  return { models, wires, road };
}
