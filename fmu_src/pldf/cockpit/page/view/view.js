// What the driver sees: the room's front door.
import { Color, PerspectiveCamera, Scene, WebGLRenderer } from "../vendor/three.js";
import { Braking, brakes } from "./braking.js";
import { CAR_LENGTH_M, Car } from "./car.js";
import { look, setLens } from "./eye.js";
import { Interior } from "./interior.js";
import { SIGHT_M } from "./materials.js";
import { rgb } from "./mesh.js";
import { Mirror } from "./mirror.js";
import { Sharpness, isSoftware } from "./sharpness.js";
import { ZENITH, sky } from "./sky.js";
import { World } from "./world.js";

/** @typedef {import("../engine/road.js").RoadModel} RoadModel */
/** @typedef {import("./eye.js").CameraName} CameraName */
/** @typedef {import("./eye.js").Sight} Sight */
/**
 * @typedef {object} ViewOptions
 * @property {number} fov_deg what is seen from left to right
 * @property {CameraName} camera
 * @property {boolean} mirror
 * @property {boolean} reducedMotion the picture does not move with the car's body
 */

const NEAR_M = 0.3;
const OWN_PAINT = 0x2d5f8f;
const LEAD_PAINT = 0xb9402f;

/** The browser cannot draw in three dimensions: the page says so and what to do. */
export class NoWebGLError extends Error {}

/** Draws a road into a canvas. */
export class View {
  /**
   * @param {HTMLCanvasElement} canvas as large as the page's style makes it
   * @param {RoadModel} road
   * @param {ViewOptions} options may be changed at any time, followed by `resize()`
   */
  constructor(canvas, road, options) {
    this.canvas = canvas;
    this.road = road;
    this.options = options;
    const software = isSoftware(canvas);
    this.renderer = rendererFor(canvas, !software);
    this.sharpness = new Sharpness(software ? 1 : Math.min(devicePixelRatio, 2), software);
    this.lens = new PerspectiveCamera(50, 1, NEAR_M, 2.2 * SIGHT_M);
    this.scene = new Scene();
    this.scene.background = new Color(...rgb(ZENITH));
    this.sky = sky();
    this.world = new World(road, software ? 1 : 8);
    this.own = new Car(OWN_PAINT);
    this.ahead = new Car(LEAD_PAINT);
    this.braking = new Braking();
    this.interior = new Interior(road.side);
    this.mirror = new Mirror(road.side);
    // A picture in the mirror costs as many corners as that of the road.
    this.mirrorEvery = software ? 4 : 2;
    this.scene.add(this.sky, this.world.group, this.own.mesh, this.ahead.mesh, this.interior.group);
    this.frames = 0;
    this.resize();
  }

  /** Which camera; it counts from the next frame on. @param {CameraName} name */
  set camera(name) {
    this.options.camera = name;
    this.resize();
  }

  get camera() {
    return this.options.camera;
  }

  /** After a change of the canvas' size or of the options. */
  resize() {
    const [width, height] = [this.canvas.clientWidth || 1, this.canvas.clientHeight || 1];
    this.renderer.setPixelRatio(this.sharpness.ratio);
    this.renderer.setSize(width, height, false);
    setLens(this.lens, this.options.fov_deg, width, height, this.options.camera);
    this.mirror.resize(width, height);
  }

  /** @param {Sight} sight */
  draw(sight) {
    if (this.sharpness.frame(performance.now())) this.resize();
    this.world.surround(sight.s_m);
    const { camera, reducedMotion, mirror } = this.options;
    const origin = look(this.lens, this.road, sight, camera, reducedMotion);
    this.world.shift(origin);
    this.sky.position.copy(this.lens.position);
    this.#cars(sight, origin);
    const shown = mirror && camera === "cockpit";
    if (shown && this.frames % this.mirrorEvery === 0) this.#lookBack();
    this.interior.group.visible = camera === "cockpit";
    this.interior.follow(this.lens);
    this.interior.steer(this.road.curvatureAt(sight.s_m) + sight.heading_rad * 0.02);
    this.renderer.render(this.scene, this.lens);
    if (shown) this.mirror.show(this.renderer);
    this.frames += 1;
  }

  /** Give the memory back; nothing can be drawn afterwards. */
  dispose() {
    this.world.dispose();
    this.mirror.dispose();
    this.interior.dispose();
    this.sky.geometry.dispose();
    for (const car of [this.own, this.ahead]) car.dispose();
    this.renderer.dispose();
    // Browsers keep few of these pictures alive, and a study has many drives.
    this.renderer.forceContextLoss();
  }

  /** @param {Sight} sight @param {{x_m: number, y_m: number}} origin */
  #cars(sight, origin) {
    const left_m = this.road.lane_m + sight.lateral_m;
    this.own.mesh.visible = this.options.camera === "chase";
    this.own.brake(brakes(sight.acceleration_mps2 ?? 0));
    this.#park(this.own.mesh, sight.s_m, left_m, sight.heading_rad, origin);
    this.ahead.mesh.visible = sight.lead !== null;
    if (!sight.lead) return;
    const { s_m, speed_mps, lead } = sight;
    this.ahead.brake(this.braking.ahead(s_m, speed_mps, lead.speed_mps ?? 0));
    const front_m = s_m + lead.gap_m + CAR_LENGTH_M;
    this.#park(this.ahead.mesh, front_m, this.road.lane_m, 0, origin);
  }

  /**
   * @param {import("../vendor/three.js").Mesh} mesh
   * @param {number} front_m
   * @param {number} left_m
   * @param {number} turn
   * @param {{x_m: number, y_m: number}} origin
   */
  #park(mesh, front_m, left_m, turn, origin) {
    const [front, rear] = [
      this.road.at(front_m, left_m),
      this.road.at(front_m - CAR_LENGTH_M, left_m),
    ];
    mesh.position.set(front.x_m - origin.x_m, front.z_m, origin.y_m - front.y_m);
    const heading = Math.atan2(front.y_m - rear.y_m, front.x_m - rear.x_m) + turn;
    mesh.rotation.order = "YXZ";
    mesh.rotation.set(front.pitch_rad, heading - Math.PI / 2, 0);
  }

  #lookBack() {
    this.interior.group.visible = false;
    this.mirror.see(this.renderer, this.scene, this.lens);
  }
}

/**
 * The browser need not look through an opaque picture; three alone makes transparent ones.
 * @param {HTMLCanvasElement} canvas @param {boolean} antialias
 */
function rendererFor(canvas, antialias) {
  const context = canvas.getContext("webgl2", {
    alpha: false,
    antialias,
    stencil: false,
    powerPreference: "high-performance",
  });
  if (!context) throw new NoWebGLError("this browser shows no 3D pictures (WebGL 2)");
  return new WebGLRenderer({ canvas, context, antialias });
}
