// What is seen and heard of a moment, of a drive or of a recording.

import { Sound } from "../view/sound.js";
import { View } from "../view/view.js";
import { reducedMotion } from "./settings.js";

/** @typedef {import("../types.js").Frame} Frame */
/** @typedef {import("../types.js").Value} Value */
/** @typedef {import("../engine/road.js").RoadModel} RoadModel */
/** @typedef {import("./settings.js").Settings} Settings */

export class Scene {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {RoadModel} road
   * @param {Settings} settings
   */
  constructor(canvas, road, settings) {
    this.canvas = canvas;
    this.road = road;
    this.view = viewOf(canvas, road, settings);
    this.sound = soundOf(settings);
  }

  /**
   * Take over changed settings.
   * @param {Settings} settings
   */
  set(settings) {
    this.view.options.mirror = settings.mirror;
    this.view.options.reducedMotion = reducedMotion(settings);
    this.view.camera = settings.camera;
    if (settings.sound !== (this.sound !== null)) {
      this.sound?.dispose();
      this.sound = soundOf(settings);
    }
  }

  /**
   * @param {Frame} frame
   * @param {boolean} paused then it is silent
   */
  draw(frame, paused) {
    const { values } = frame;
    const speed_mps = number(values["vehicle.speed_mps"]);
    const acceleration_mps2 = number(values["vehicle.acceleration_mps2"]);
    const present = Boolean(values["lead.present"]);
    this.view.draw({
      s_m: number(values["vehicle.s_m"]),
      speed_mps,
      acceleration_mps2,
      lateral_m: frame.lateral_m,
      heading_rad: frame.heading_rad,
      lead: present
        ? { gap_m: number(values["lead.gap_m"]), speed_mps: number(values["lead.speed_mps"]) }
        : null,
    });
    this.sound?.play({
      speed_mps: paused ? 0 : speed_mps,
      acceleration_mps2,
      gas_pedal: number(values["driver.gas_pedal"]),
      running: !paused,
    });
  }

  resize() {
    this.view.resize();
  }

  dispose() {
    this.view.dispose();
    this.sound?.dispose();
  }
}

/**
 * @param {HTMLCanvasElement} canvas
 * @param {RoadModel} road
 * @param {Settings} settings
 */
function viewOf(canvas, road, settings) {
  const { fov_deg, camera, mirror } = settings;
  return new View(canvas, road, {
    fov_deg,
    camera,
    mirror,
    reducedMotion: reducedMotion(settings),
  });
}

/**
 * Browsers let no page sound before it was touched.
 * @param {Settings} settings
 */
function soundOf({ sound }) {
  return sound && navigator.userActivation?.hasBeenActive !== false ? new Sound() : null;
}

/** @param {Value | undefined} value */
function number(value) {
  return typeof value === "number" && Number.isFinite(value) ? value : 0;
}
