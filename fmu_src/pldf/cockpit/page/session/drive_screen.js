// A drive on the screen: view, cluster and sound show it, the inputs drive it, pause and stop are always there.

import { element, fill } from "../dom.js";
import { Buttons } from "../cluster/buttons.js";
import { Cluster } from "../cluster/cluster.js";
import { FRAME_MS } from "../cluster/live.js";
import { DriveClient } from "../engine/client.js";
import { Interpolation } from "../engine/interpolation.js";
import { button } from "./app.js";
import { keysTable } from "./keys_table.js";
import { FrameTimes } from "./frame_times.js";
import { Pedals } from "./pedals.js";
import { PauseDialog } from "./pause_dialog.js";
import { Scene } from "./scene.js";
import { unitOf } from "./settings.js";
import { say } from "./drive_words.js";

/** @typedef {import("../types.js").DriveResult} DriveResult */
/** @typedef {import("../types.js").DriveSetup} DriveSetup */
/** @typedef {import("../types.js").Frame} Frame */
/** @typedef {import("../engine/inputs/inputs.js").Inputs} Inputs */
/** @typedef {import("./app.js").App} App */
/** @typedef {import("./participant.js").Explanation} Explanation */
/** @typedef {import("./record.js").FrameTiming} FrameTiming */

/** @typedef {{result: DriveResult, frames: FrameTiming}} Driven */
/**
 * @typedef {object} DriveOptions
 * @property {DriveSetup} setup
 * @property {Inputs | null} inputs null: nobody drives, it is watched
 * @property {Explanation} explanation
 * @property {string} title
 * @property {string} participant empty: nobody else is told
 * @property {string} phase
 * @property {boolean} teaches the driver's last word is offered
 * @property {boolean} shows_keys which key does what is shown for the first seconds
 * @property {(stop: (reason: string) => void) => void} [stoppable]
 * @property {(state: "driving" | "paused", reason: string) => void} [tell]
 */

// The pedals are read more often than pictures come: a slow picture is no slow foot.
const INPUT_MS = 10;
const COUNTDOWN_S = 3;
const KEYS_SHOWN_S = 12;

/**
 * Drive a drive; the promise resolves when it has ended, however it has.
 * @param {App} app
 * @param {DriveOptions} options
 * @returns {Promise<Driven>}
 */
export function drive(app, options) {
  return new DriveScreen(app, options).driven();
}

class DriveScreen {
  /**
   * @param {App} app
   * @param {DriveOptions} options
   */
  constructor(app, options) {
    this.app = app;
    this.options = options;
    this.client = new DriveClient();
    this.between = new Interpolation();
    this.times = new FrameTimes();
    this.paused = true;
    this.told_ms = -Infinity;
    this.keysSeen = false;
    const cluster = element("div", { class: "drive-cluster" });
    const words = element("div", { class: "drive-words" });
    this.count = element("p", { class: "drive-count", "aria-live": "assertive" });
    this.canvas = /** @type {HTMLCanvasElement} */ (element("canvas", { class: "drive-view" }));
    this.dialog = new PauseDialog({
      resume: () => void this.resume(),
      stop: (reason) => this.client.stop(reason),
      app,
      changed: () => this.scene.set(app.settings),
    });
    const steered = options.setup.steering === "person";
    const keys = element("div", { class: "drive-keys" }, keysTable(steered, options.teaches));
    this.keys = keys;
    this.keys.hidden = !options.shows_keys;
    const bottom = element("div", { class: "drive-bottom" }, cluster, words);
    /** @type {Pedals | null} what is done by somebody else */
    this.pedals = options.inputs ? null : new Pedals();
    const beside = this.pedals?.root ?? keys;
    const shown = [this.canvas, this.top(), beside, this.count, bottom, this.dialog.root];
    this.root = element("div", { class: "drive", tabindex: -1 }, ...shown);
    fill(app.root, this.root);
    this.scene = new Scene(this.canvas, app.road, app.settings);
    const unit = unitOf(app.settings);
    this.cluster = new Cluster(cluster, app.bundle.texts, {
      explanation: options.explanation,
      unit,
    });
    this.buttons = options.teaches && options.inputs ? this.teaching(words, options.inputs) : null;
  }

  top() {
    const ask = () => this.ask();
    return element(
      "div",
      { class: "drive-top" },
      element("h1", {}, this.options.title),
      this.options.inputs && button(say("keys_title"), () => this.toggleKeys()),
      button(say("pause"), () => this.client.pause("asked for by the person")),
      button(say("stop"), ask, "stop"),
    );
  }

  toggleKeys() {
    this.keys.hidden = !this.keys.hidden;
    this.root.focus(); // the next key is meant for the car
  }

  /**
   * @param {Element} parent
   * @param {Inputs} inputs
   */
  teaching(parent, inputs) {
    return new Buttons(parent, (word) => inputs.keyboard.push(word));
  }

  /** The person wants to stop: the car stands still at once, then it is asked why. */
  ask() {
    this.dialog.asksWhy = true;
    this.client.pause("stop asked for");
  }

  /** @returns {Promise<Driven>} */
  driven() {
    return new Promise((resolve, reject) => {
      const ended = (/** @type {DriveResult} */ result) => {
        this.close();
        resolve({ result, frames: this.times.timing });
      };
      this.client.onframe = (frame) => this.take(frame);
      this.client.onpaused = (reason) => this.halt(reason);
      this.client.onended = ended;
      this.options.stoppable?.((reason) => this.client.stop(reason));
      this.listen();
      this.start().catch((problem) => {
        this.close();
        reject(problem);
      });
    });
  }

  async start() {
    this.options.inputs?.begin();
    fill(this.count, say("starting"));
    await this.client.start(this.app.bundle, this.options.setup);
    await this.resume();
  }

  listen() {
    this.timer = setInterval(() => this.read(), INPUT_MS);
    this.onkey = (/** @type {KeyboardEvent} */ event) => this.key(event);
    this.onleave = (/** @type {BeforeUnloadEvent} */ event) => event.preventDefault();
    this.onresize = () => this.scene.resize();
    addEventListener("keydown", this.onkey);
    addEventListener("beforeunload", this.onleave);
    addEventListener("resize", this.onresize);
    this.picture = requestAnimationFrame((now_ms) => this.draw(now_ms));
  }

  close() {
    clearInterval(this.timer);
    clearTimeout(this.counting);
    cancelAnimationFrame(this.picture ?? 0);
    removeEventListener("keydown", /** @type {(event: KeyboardEvent) => void} */ (this.onkey));
    removeEventListener("beforeunload", /** @type {(event: Event) => void} */ (this.onleave));
    removeEventListener("resize", /** @type {() => void} */ (this.onresize));
    this.dialog.close();
    this.scene.dispose();
    this.client.dispose();
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (event.key === "Escape" && !this.dialog.root.open) {
      event.preventDefault();
      this.client.pause("asked for by the person");
    }
  }

  /** Hand what the person does to the drive. */
  read() {
    const { inputs } = this.options;
    const controls = inputs?.read(performance.now());
    if (controls === null && !this.paused) {
      this.client.pause("disconnected");
    } else if (controls) {
      this.client.input(controls);
    }
  }

  /** @param {Frame} frame */
  take(frame) {
    const now_ms = performance.now();
    this.between.push(frame, now_ms);
    if (this.options.shows_keys && frame.time_s > KEYS_SHOWN_S && !this.keysSeen) {
      this.keysSeen = true;
      this.keys.hidden = true;
    }
    if (now_ms - this.told_ms >= FRAME_MS && this.options.participant) {
      this.told_ms = now_ms;
      const { participant, phase } = this.options;
      const { time_s, values } = frame;
      this.app.live?.send({ kind: "frame", participant, phase, time_s, values });
    }
  }

  /** @param {number} now_ms */
  draw(now_ms) {
    this.picture = requestAnimationFrame((next_ms) => this.draw(next_ms));
    const frame = this.between.at(performance.now());
    if (frame) {
      this.scene.draw(frame, this.paused);
      this.cluster.show(frame.values);
      this.buttons?.show(frame.values);
      this.pedals?.show(frame);
    }
    if (!this.paused) {
      this.times.drawn(now_ms);
    }
  }

  /** @param {string} reason why the drive stands */
  halt(reason) {
    if (reason === "ready") {
      return; // the countdown lets it begin
    }
    clearTimeout(this.counting);
    this.paused = true;
    this.times.interrupted(performance.now());
    fill(this.count);
    this.options.tell?.("paused", reason);
    this.dialog.open(reason, this.options.inputs);
  }

  /** Count down and go on: hands and feet want to be in their places. */
  resume() {
    this.root.focus();
    return new Promise((resolve) => {
      const count = (/** @type {number} */ left_s) => {
        fill(this.count, left_s > 0 ? left_s : "");
        if (left_s > 0) {
          this.counting = setTimeout(() => count(left_s - 1), 1000);
          return;
        }
        this.paused = false;
        this.options.tell?.("driving", "");
        this.client.resume();
        resolve(undefined);
      };
      count(this.options.inputs ? COUNTDOWN_S : 0);
    });
  }
}
