// A recording is watched as if one sat in the car; others of the same road are compared with it.

import { element, fill } from "../dom.js";
import { Cluster } from "../cluster/cluster.js";
import { speedText, unitText } from "../cluster/units.js";
import { button } from "./app.js";
import { comparePlot } from "./compare_plot.js";
import { ByDistance } from "./comparing.js";
import { Pedals } from "./pedals.js";
import { Scene } from "./scene.js";
import { unitOf } from "./settings.js";
import { say } from "./replay_words.js";

/** @typedef {import("../types.js").Frame} Frame */
/** @typedef {import("../engine/replay.js").Replay} Replay */
/** @typedef {import("../cluster/live.js").Unit} Unit */
/** @typedef {import("./app.js").App} App */
/** @typedef {import("./dropped.js").Dropped} Dropped */
/** @typedef {{name: string, replay: Replay, by_distance: ByDistance}} Watched */

const RATES = [1, 2, 4, 8];

/**
 * Show recordings and profiles.
 * @param {App} app
 * @param {Dropped} dropped at least one recording or profile
 * @param {() => void} back
 * @param {HTMLElement[]} notes what else is to be said
 * @param {HTMLElement[]} more what else can be done
 */
export function watch(app, dropped, back, notes = [], more = []) {
  const watched = dropped.recordings.map(({ name, replay }) => ({
    name,
    replay,
    by_distance: new ByDistance(replay.frames),
  }));
  new ReplayScreen(app, watched, dropped.profiles, back, notes, more);
}

class ReplayScreen {
  /**
   * @param {App} app
   * @param {Watched[]} watched
   * @param {Dropped["profiles"]} profiles
   * @param {() => void} back
   * @param {HTMLElement[]} notes
   * @param {HTMLElement[]} more
   */
  constructor(app, watched, profiles, back, notes, more) {
    this.app = app;
    this.watched = watched;
    this.profiles = profiles;
    /** @type {Unit} */
    this.unit = unitOf(app.settings);
    this.more = more;
    this.playing = false;
    this.rate = 1;
    this.time_s = 0;
    this.last_ms = NaN;
    this.now = watched[0];
    this.pedals = new Pedals();
    this.leave = () => {
      this.close();
      back();
    };
    const plot = element("div", {});
    const drawn = element("div", { class: "replay-plot" }, plot);
    const page = element("div", { class: "replay" }, ...this.scenery(), drawn);
    page.append(...notes, ...this.doubts());
    fill(app.root, page);
    this.plot = comparePlot(plot, app.road.length_m, watched, profiles, this.unit);
    this.onresize = () => {
      this.scene?.resize();
      this.plot.setSize({ width: plot.clientWidth, height: this.plot.height });
    };
    addEventListener("resize", this.onresize);
    this.begin();
  }

  /** @returns {HTMLElement[]} view, cluster and controls; with profiles alone, a way back */
  scenery() {
    const back = button(say("back"), this.leave);
    if (!this.now) {
      return [element("div", { class: "replay-head" }, element("h1", {}, say("compared")), back)];
    }
    this.canvas = /** @type {HTMLCanvasElement} */ (element("canvas", { class: "drive-view" }));
    const dashboard = element("div", { class: "drive-cluster" });
    this.compared = element("p", { class: "replay-compared", "aria-live": "off" });
    this.cluster = new Cluster(dashboard, this.app.bundle.texts, {
      explanation: "text",
      unit: this.unit,
    });
    const bottom = element("div", { class: "drive-bottom" }, dashboard);
    return [
      element("div", { class: "replay-scene" }, this.canvas, this.pedals.root, bottom),
      this.bar(back),
      this.compared,
    ];
  }

  /** @param {HTMLElement} back */
  bar(back) {
    const rates = RATES.map((rate) => element("option", { value: rate }, `${rate} x`));
    const rate = /** @type {HTMLSelectElement} */ (
      element("select", { "aria-label": say("rate") }, ...rates)
    );
    rate.addEventListener("change", () => {
      this.rate = Number(rate.value);
    });
    this.slider = /** @type {HTMLInputElement} */ (
      element("input", { type: "range", step: 0.05, "aria-label": say("time") })
    );
    this.slider.addEventListener("input", () => {
      this.time_s = Number(this.slider?.value);
    });
    this.play = button(say("stop"), () => this.toggle());
    return element(
      "div",
      { class: "replay-bar" },
      this.play,
      this.slider,
      rate,
      this.chooser(),
      ...this.more,
      back,
    );
  }

  /** Which of several recordings is watched. */
  chooser() {
    const options = this.watched.map(({ name }, index) =>
      element("option", { value: index }, name),
    );
    const select = /** @type {HTMLSelectElement} */ (
      element(
        "select",
        { "aria-label": say("follow"), hidden: this.watched.length < 2 },
        ...options,
      )
    );
    select.addEventListener("change", () => this.change(Number(select.value)));
    return select;
  }

  /** Profiles of another road. */
  doubts() {
    return this.profiles
      .filter(({ profile }) => profile.route !== this.app.road.key)
      .map(({ name }) => element("p", { class: "notice" }, say("road_differs", { name })));
  }

  begin() {
    if (!this.now || !this.canvas) {
      return;
    }
    this.scene = new Scene(this.canvas, this.app.road, this.app.settings);
    this.playing = true;
    this.change(0);
    this.picture = requestAnimationFrame((now_ms) => this.draw(now_ms));
  }

  /** @param {number} index of the recording to watch; at the same place of the road */
  change(index) {
    const before = this.now?.replay.at(this.time_s).values["vehicle.s_m"];
    const first = this.now === this.watched[index];
    this.now = this.watched[index] ?? this.now;
    if (!this.now || !this.slider) {
      return;
    }
    const { replay, by_distance } = this.now;
    const place = first ? null : by_distance.at(Number(before));
    this.time_s = place?.time_s ?? replay.begin_s;
    this.slider.min = String(replay.begin_s);
    this.slider.max = String(replay.end_s);
  }

  toggle() {
    this.playing = !this.playing;
    if (this.playing && this.now && this.time_s >= this.now.replay.end_s) {
      this.time_s = this.now.replay.begin_s;
    }
  }

  /** @param {number} now_ms */
  draw(now_ms) {
    this.picture = requestAnimationFrame((next_ms) => this.draw(next_ms));
    const passed_s = Number.isFinite(this.last_ms) ? (now_ms - this.last_ms) / 1000 : 0;
    this.last_ms = now_ms;
    const { now, slider, play } = this;
    if (!now || !slider || !play) {
      return;
    }
    if (this.playing) {
      this.time_s = Math.min(this.time_s + passed_s * this.rate, now.replay.end_s);
      this.playing = this.time_s < now.replay.end_s;
      slider.value = String(this.time_s);
    }
    fill(play, say(this.playing ? "stop" : "play"));
    const frame = now.replay.at(this.time_s);
    this.scene?.draw(frame, !this.playing);
    this.cluster?.show(frame.values);
    this.pedals.show(frame);
    this.compare(frame);
  }

  /**
   * Say how fast the others were where this one is, and how long before or after.
   * @param {Frame} frame
   */
  compare(frame) {
    const { now, compared } = this;
    if (!now || !compared || this.watched.length < 2) {
      return;
    }
    const s_m = Number(frame.values["vehicle.s_m"]);
    const told = this.watched
      .filter((one) => one !== now)
      .flatMap((one) => this.beside(one, s_m, this.time_s - now.replay.begin_s));
    const text = told.join(" · ");
    if (compared.textContent !== text) {
      fill(compared, text);
    }
  }

  /**
   * @param {Watched} other
   * @param {number} s_m
   * @param {number} passed_s since the beginning
   * @returns {string[]}
   */
  beside({ name, replay, by_distance }, s_m, passed_s) {
    const passing = by_distance.at(s_m);
    if (!passing) {
      return [];
    }
    const ahead_s = passed_s - (passing.time_s - replay.begin_s);
    const seconds = Math.abs(ahead_s).toFixed(1);
    const ahead = say(seconds === "0.0" ? "level" : ahead_s > 0 ? "ahead" : "behind", { seconds });
    const speed = `${speedText(passing.speed_mps, this.unit)} ${unitText(this.unit)}`;
    return [say("at_place", { name, speed, ahead })];
  }

  close() {
    cancelAnimationFrame(this.picture ?? 0);
    removeEventListener("resize", this.onresize);
    this.scene?.dispose();
    this.plot.destroy();
  }
}
