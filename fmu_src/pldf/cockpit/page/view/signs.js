// Signs on posts.
import { CircleGeometry, Mesh, PlaneGeometry } from "../vendor/three.js";
import { plateOf } from "./materials.js";
import { toScene } from "./mesh.js";
import { canvas, textureOf } from "./textures.js";

/** @typedef {import("./mesh.js").MeshBuilder} MeshBuilder */
/** @typedef {import("./plan.js").Sign} Sign */

const DISC_M = 0.42; // radius
const DISC_UP_M = 2.45;
const TOWN_SIZE_M = [1.5, 1];
const TRIANGLE_M = 1;
const BOARD_SIZE_M = [0.75, 0.75];
const RED = "#c1121c";
const YELLOW = "#ffd100";
const POST_HEX = 0x9aa0a4;
const BACK_HEX = 0x8a9094;

/** @type {Map<string, import("../vendor/three.js").ShaderMaterial>} */
const materials = new Map();

/**
 * Put up a sign that faces the driver.
 * @param {MeshBuilder} solid its frame: on the ground, where the sign stands, along the road
 * @param {Sign} sign
 * @returns {Mesh}
 */
export function putUp(solid, sign) {
  const disc = sign.kind === "limit";
  const town = sign.kind.startsWith("town");
  const [width, height] = town ? TOWN_SIZE_M : [TRIANGLE_M, TRIANGLE_M];
  const up = town ? 1.9 : DISC_UP_M;
  for (const off of town ? [-0.6, 0.6] : [0]) {
    solid.cone([0.06, off, -0.5], 0.04, 0.04, up + 0.7, 6, POST_HEX);
  }
  const geometry = disc ? new CircleGeometry(DISC_M, 28) : new PlaneGeometry(width, height);
  return facing(solid, new Mesh(geometry, materialOf(sign)), up, disc ? DISC_M : height / 2);
}

/** @param {MeshBuilder} solid @param {boolean} to_left */
export function putUpBoard(solid, to_left) {
  const [width, height] = BOARD_SIZE_M;
  solid.cone([0.06, 0, -0.5], 0.04, 0.04, 2.2, 5, POST_HEX);
  const key = to_left ? "board_left" : "board_right";
  return facing(solid, new Mesh(new PlaneGeometry(width, height), board(key, to_left)), 1.3, 0.375);
}

/** @param {MeshBuilder} solid @param {Mesh} mesh @param {number} up_m @param {number} half_m */
function facing(solid, mesh, up_m, half_m) {
  const { x_m, y_m, z_m, heading_rad } = solid.frame;
  mesh.position.set(...toScene(solid.origin, x_m, y_m, z_m + up_m));
  mesh.rotation.y = heading_rad - Math.PI / 2;
  solid.face(
    [
      [0.04, half_m, up_m - half_m],
      [0.04, half_m, up_m + half_m],
      [0.04, -half_m, up_m + half_m],
      [0.04, -half_m, up_m - half_m],
    ],
    BACK_HEX,
  );
  return mesh;
}

/** @param {Sign} sign */
function materialOf({ kind, text, unit }) {
  return painted(`${kind} ${text} ${unit}`, (pen, size) => {
    if (kind === "limit") limit(pen, size, text, unit);
    else if (kind === "town" || kind === "town_end") town(pen, size, text, kind === "town_end");
    else warning(pen, size, kind === "curve_left");
  });
}

/** @param {string} key @param {boolean} to_left */
function board(key, to_left) {
  return painted(key, (pen, size) => {
    pen.fillStyle = "#ffffff";
    pen.fillRect(0, 0, size, size);
    pen.fillStyle = RED;
    const tip = (/** @type {number} */ x) => (to_left ? x : 1 - x) * size;
    pen.beginPath();
    for (const [x, y] of [
      [0.18, 0.5],
      [0.55, 0.06],
      [0.9, 0.06],
      [0.53, 0.5],
      [0.9, 0.94],
      [0.55, 0.94],
    ]) {
      pen.lineTo(tip(x), y * size);
    }
    pen.fill();
    pen.lineWidth = size * 0.03;
    pen.strokeStyle = RED;
    pen.strokeRect(0, 0, size, size);
  });
}

/** @param {string} key @param {(pen: CanvasRenderingContext2D, size: number) => void} paint */
function painted(key, paint) {
  let found = materials.get(key);
  if (!found) {
    const size = 256;
    const { made, pen } = canvas(size, size);
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    paint(pen, size);
    const map = textureOf(made, { anisotropy: 4 });
    found = plateOf(map);
    materials.set(key, found);
  }
  return found;
}

/**
 * @param {CanvasRenderingContext2D} pen
 * @param {number} size
 * @param {string} text
 * @param {string} unit
 */
function limit(pen, size, text, unit) {
  const middle = size / 2;
  ring(pen, middle, middle, "#ffffff");
  ring(pen, middle, middle * 0.97, RED);
  ring(pen, middle, middle * 0.74, "#ffffff");
  pen.fillStyle = "#111111";
  const height = text.length > 2 ? 0.4 : 0.52;
  pen.font = `bold ${size * height}px "DIN 1451 Std", "Arial Narrow", Arial, sans-serif`;
  pen.fillText(text, middle, middle * (unit ? 0.9 : 1.04), size * 0.66);
  if (!unit) return;
  pen.font = `bold ${size * 0.14}px Arial, sans-serif`;
  pen.fillText(unit, middle, size * 0.73);
}

/**
 * @param {CanvasRenderingContext2D} pen
 * @param {number} middle
 * @param {number} radius
 * @param {string} color
 */
function ring(pen, middle, radius, color) {
  pen.fillStyle = color;
  pen.beginPath();
  pen.arc(middle, middle, radius, 0, 2 * Math.PI);
  pen.fill();
}

/**
 * @param {CanvasRenderingContext2D} pen
 * @param {number} size
 * @param {string} text
 * @param {boolean} end
 */
function town(pen, size, text, end) {
  pen.fillStyle = "#111111";
  pen.fillRect(0, 0, size, size);
  pen.fillStyle = YELLOW;
  pen.fillRect(size * 0.02, size * 0.03, size * 0.96, size * 0.94);
  pen.fillStyle = "#111111";
  pen.font = `bold ${size * 0.26}px Arial, sans-serif`;
  if (text) pen.fillText(text, size / 2, size / 2, size * 0.86);
  else houses(pen, size);
  if (!end) return;
  pen.strokeStyle = RED;
  pen.lineWidth = size * 0.06;
  pen.beginPath();
  pen.moveTo(size * 0.06, size * 0.92);
  pen.lineTo(size * 0.94, size * 0.08);
  pen.stroke();
}

/**
 * A place without a name: its houses.
 * @param {CanvasRenderingContext2D} pen
 * @param {number} size
 */
function houses(pen, size) {
  for (const [x, width, height] of [
    [0.16, 0.2, 0.3],
    [0.4, 0.16, 0.5],
    [0.6, 0.24, 0.34],
  ]) {
    const [left, right, top] = [x * size, (x + width) * size, (0.78 - height) * size];
    pen.fillRect(left, top + 0.12 * size, right - left, height * size - 0.12 * size);
    pen.beginPath();
    pen.moveTo(left - 4, top + 0.125 * size);
    pen.lineTo((left + right) / 2, top);
    pen.lineTo(right + 4, top + 0.125 * size);
    pen.fill();
  }
}

/** @param {CanvasRenderingContext2D} pen @param {number} size @param {boolean} left */
function warning(pen, size, left) {
  const corners = (/** @type {number} */ inset) => {
    pen.beginPath();
    pen.moveTo(size / 2, size * (0.07 + inset));
    pen.lineTo(size * (0.98 - inset * 0.9), size * (0.93 - inset * 0.5));
    pen.lineTo(size * (0.02 + inset * 0.9), size * (0.93 - inset * 0.5));
    pen.closePath();
  };
  pen.fillStyle = RED;
  corners(0);
  pen.fill();
  pen.fillStyle = "#ffffff";
  corners(0.19);
  pen.fill();
  const x = (/** @type {number} */ share) => size * (left ? 1 - share : share);
  pen.strokeStyle = "#111111";
  pen.lineWidth = size * 0.075;
  pen.beginPath();
  pen.moveTo(x(0.44), size * 0.8);
  pen.quadraticCurveTo(x(0.4), size * 0.58, x(0.57), size * 0.47);
  pen.stroke();
  pen.fillStyle = "#111111";
  pen.beginPath();
  pen.moveTo(x(0.64), size * 0.41);
  pen.lineTo(x(0.47), size * 0.43);
  pen.lineTo(x(0.58), size * 0.56);
  pen.fill();
}
