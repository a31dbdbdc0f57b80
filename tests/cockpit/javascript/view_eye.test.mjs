import assert from "node:assert/strict";
import { test } from "node:test";

import { PerspectiveCamera, Vector3 } from "../../../fmu_src/pldf/cockpit/page/vendor/three.js";
import { look, setLens } from "../../../fmu_src/pldf/cockpit/page/view/eye.js";
import { roadModel } from "./road_support.mjs";

const SIGHT = { s_m: 50, speed_mps: 0, lateral_m: 0, heading_rad: 0, lead: null };

/** @param {number} value @param {number} wanted @param {number} tolerance */
function near(value, wanted, tolerance = 1e-6) {
  assert.ok(Math.abs(value - wanted) <= tolerance, `${value} instead of ${wanted}`);
}

/**
 * Where something far away is in the picture: -1 .. 1 to the right, and up.
 * @param {PerspectiveCamera} camera
 * @param {number} east
 * @param {number} up
 * @param {number} north
 */
function seen(camera, east, up, north) {
  camera.updateMatrixWorld();
  return new Vector3(east, up, -north).add(camera.position).project(camera);
}

/** @param {number} fov_deg @param {number} width @param {number} height */
function eastward(fov_deg, width, height) {
  const camera = new PerspectiveCamera();
  setLens(camera, fov_deg, width, height, "cockpit");
  look(camera, roadModel(200, { x_m: (s) => s }), SIGHT, "cockpit", true);
  return camera;
}

test("what lies at half the field of view is at the picture's edge, whatever its shape", () => {
  for (const [fov_deg, width, height] of [
    [60, 1280, 720],
    [90, 1280, 720],
    [45, 800, 1200],
    [110, 3000, 600],
  ]) {
    const half = Math.tan((fov_deg * Math.PI) / 360);
    near(seen(eastward(fov_deg, width, height), 1000, 0, -1000 * half).x, 1);
    near(seen(eastward(fov_deg, width, height), 1000, 0, 500 * half).x, -0.5);
  }
});

test("the horizon lies at the same height of the picture in every lens, and is no slope", () => {
  for (const fov_deg of [40, 60, 100]) {
    const camera = eastward(fov_deg, 1280, 720);
    near(seen(camera, 1e6, 0, 0).y, 1 - 2 * 0.43);
    near(seen(camera, 1e6, 0, 4e5).y, seen(camera, 1e6, 0, -4e5).y);
  }
});

test("upright things stay upright", () => {
  const camera = eastward(60, 1280, 720);
  near(seen(camera, 20, -1, 5).x, seen(camera, 20, 4, 5).x);
});

test("the eye turns with the car, climbs with the road, and sits towards the middle", () => {
  const road = roadModel(200, { x_m: (s) => s, grade: () => 0.05 });
  const camera = new PerspectiveCamera();
  setLens(camera, 60, 1280, 720, "cockpit");
  const turned = { ...SIGHT, heading_rad: 0.1 };
  const origin = look(camera, road, turned, "cockpit", true);
  const far = seen(camera, 1000 * Math.cos(0.1), 50, 1000 * Math.sin(0.1));
  near(far.x, 0, 1e-3);
  near(far.y, 1 - 2 * 0.43, 1e-3);
  near(origin.x_m, 48);
  near(origin.y_m, -1.75 + 0.36);
  near(camera.position.y, 48 * 0.05 + 1.22);
});

test("with reduced motion the picture stays still when the car brakes or turns", () => {
  const road = roadModel(200, { x_m: (s) => s });
  const pitch = (/** @type {boolean} */ still) => {
    const camera = new PerspectiveCamera();
    look(camera, road, { ...SIGHT, speed_mps: 20, acceleration_mps2: -4 }, "cockpit", still);
    return camera.rotation.x;
  };
  near(pitch(true), 0);
  assert.ok(pitch(false) < -0.005);
});

test("from behind one sees the car in the middle", () => {
  const road = roadModel(200, { x_m: (s) => s });
  const camera = new PerspectiveCamera();
  setLens(camera, 60, 1280, 720, "chase");
  const origin = look(camera, road, SIGHT, "chase", false);
  const car = new Vector3(48 - origin.x_m, 0.7, origin.y_m + 1.75).project(camera);
  near(car.x, 0, 1e-3);
  assert.ok(car.y < 0 && car.y > -0.9);
});
