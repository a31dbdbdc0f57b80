// Where the driver's eyes are, and what lens shows the road as large as it is.
import { MathUtils } from "../vendor/three.js";

/** @typedef {import("../engine/road.js").RoadModel} RoadModel */
/** @typedef {import("../vendor/three.js").PerspectiveCamera} PerspectiveCamera */
/** @typedef {"cockpit" | "chase"} CameraName */
/**
 * What is seen, from the frame of a drive.
 * @typedef {object} Sight
 * @property {number} s_m front bumper
 * @property {number} speed_mps
 * @property {number} lateral_m to the left of the lane's middle
 * @property {number} heading_rad against the lane, to the left
 * @property {{gap_m: number, speed_mps?: number} | null} lead the car ahead, bumper to bumper; with its
 *   speed it shows when it brakes
 * @property {number} [acceleration_mps2] 0 if absent
 */

const EYE_BEHIND_M = 2; // of the front bumper
const EYE_UP_M = 1.22;
const EYE_ASIDE_M = 0.36; // towards the middle of the road
const CHASE_BEHIND_M = 18;
const CHASE_UP_M = 3.8; // so that the car is seen above the cluster
const CHASE_DOWN_RAD = 0.02;
// A body gives way a little: a car of 4 Hz is felt, not measured.
const DIVE_RAD_PER_MPS2 = 0.0035;
const ROLL_RAD_PER_MPS2 = 0.0045;
const SHAKE_M = 0.004;
// Where the horizon of a level road lies, from above: less sky, more road.
const HORIZON = { cockpit: 0.43, chase: 0.28 };

/**
 * Set the lens so that straight ahead `fov_deg` are seen from left to right. The horizon is moved by
 * shifting the picture, not by looking down: upright things stay upright.
 * @param {PerspectiveCamera} camera @param {number} fov_deg @param {number} width @param {number} height
 * @param {CameraName} name
 */
export function setLens(camera, fov_deg, width, height, name) {
  camera.aspect = width / height;
  const half = Math.tan(MathUtils.degToRad(fov_deg) / 2);
  camera.fov = 2 * MathUtils.radToDeg(Math.atan(half / camera.aspect));
  camera.setViewOffset(width, height, 0, (0.5 - HORIZON[name]) * height, width, height);
}

/**
 * Place and turn a camera; the scene's zero is at `origin`.
 * @param {PerspectiveCamera} camera @param {RoadModel} road @param {Sight} sight
 * @param {CameraName} name @param {boolean} still without the body's movements
 * @returns {{x_m: number, y_m: number}} origin: the eye, so that numbers stay small
 */
export function look(camera, road, sight, name, still) {
  const aside = road.lane_m + sight.lateral_m;
  const behind = name === "chase" ? CHASE_BEHIND_M : EYE_BEHIND_M;
  const left = name === "chase" ? aside : aside + road.side * EYE_ASIDE_M;
  const at = road.at(sight.s_m - behind, left);
  const body = still ? STILL : movements(road, sight);
  const up = name === "chase" ? CHASE_UP_M : EYE_UP_M + body.up_m;
  camera.rotation.order = "YXZ";
  const heading =
    name === "chase" ? chaseHeading(road, sight, at) : at.heading_rad + sight.heading_rad;
  const pitch = at.pitch_rad + (name === "chase" ? -CHASE_DOWN_RAD : body.pitch_rad);
  camera.rotation.set(pitch, heading - Math.PI / 2, name === "chase" ? 0 : body.roll_rad);
  camera.position.set(0, at.z_m + up, 0);
  camera.updateMatrixWorld();
  return { x_m: at.x_m, y_m: at.y_m };
}

const STILL = { up_m: 0, pitch_rad: 0, roll_rad: 0 };

/** @param {RoadModel} road @param {Sight} sight */
function movements(road, { s_m, speed_mps, acceleration_mps2 = 0 }) {
  const lateral_mps2 = road.curvatureAt(s_m) * speed_mps ** 2;
  const rough =
    Math.sin(s_m * 1.9) * 0.5 + Math.sin(s_m * 0.83 + 1) * 0.35 + Math.sin(s_m * 4.3) * 0.15;
  return {
    up_m: SHAKE_M * rough * Math.min(speed_mps / 25, 1.2),
    pitch_rad: DIVE_RAD_PER_MPS2 * Math.max(Math.min(acceleration_mps2, 4), -8),
    roll_rad: -ROLL_RAD_PER_MPS2 * Math.max(Math.min(lateral_mps2, 6), -6),
  };
}

/**
 * From behind one looks at where the car is.
 * @param {RoadModel} road
 * @param {Sight} sight
 * @param {{x_m: number, y_m: number}} eye
 */
function chaseHeading(road, sight, eye) {
  const car = road.at(sight.s_m + 3, road.lane_m + sight.lateral_m);
  return Math.atan2(car.y_m - eye.y_m, car.x_m - eye.x_m);
}
