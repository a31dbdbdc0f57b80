// The land in square tiles: fine ones near the driver, coarse ones far away.
import { BufferAttribute, BufferGeometry, Mesh } from "../vendor/three.js";
import { chance, hills } from "./chance.js";
import { SOLID } from "./materials.js";
import { lightOn, rgb, toScene } from "./mesh.js";

/** @typedef {import("./ground.js").Ground} Ground */

export const TILE_M = 200;
const FINE_CELLS = 10;
const COARSE_CELLS = 4;
const COARSE_BELOW_M = 0.6; // far away the land must not come through the road
const FIELD_M = 85;
// Meadows, grain, rape, ploughed land.
const FIELDS = [0x86b04e, 0x7aa748, 0x93b757, 0x6f9d45, 0xcdb765, 0xa9b552, 0x9a8059, 0x80ab4c];
const NEAR_ROAD = 0x82aa4c;
const RIVERBED = 0x7d9a50;

/**
 * @param {Ground} ground
 * @param {number} i @param {number} j which tile, to the east and to the north
 * @param {boolean} fine
 */
export function tile(ground, i, j, fine) {
  const origin = { x_m: i * TILE_M, y_m: j * TILE_M };
  const cells = fine ? FINE_CELLS : COARSE_CELLS;
  const corners = cornersOf(ground, origin, cells, fine ? 0 : COARSE_BELOW_M);
  const count = cells * cells * 6;
  const positions = new Float32Array(3 * count);
  const colors = new Float32Array(3 * count);
  let at = 0;
  const add = (/** @type {Corner[]} */ face, /** @type {number} */ hex) => {
    const uneven = 0.82 + 0.05 * chance(at, i, j); // as light as the verge with its picture
    const light = uneven * lightOn(face[0].at, face[1].at, face[2].at);
    const color = rgb(hex);
    for (const corner of face) {
      positions.set(corner.at, 3 * at);
      for (let k = 0; k < 3; k++) colors[3 * at + k] = color[k] * light;
      at++;
    }
  };
  for (let row = 0; row < cells; row++) {
    for (let column = 0; column < cells; column++) {
      const low = row * (cells + 1) + column;
      const [a, b, c, d] = [low, low + 1, low + cells + 2, low + cells + 1].map((k) => corners[k]);
      const hex = colorOf(a, origin);
      add([a, b, c], hex);
      add([a, c, d], hex);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setAttribute("color", new BufferAttribute(colors, 3));
  const mesh = new Mesh(geometry, SOLID);
  mesh.renderOrder = 1; // after what stands on it: nothing is painted twice
  return { mesh, origin };
}

/** @typedef {{at: import("./mesh.js").Point, distance_m: number}} Corner */

/**
 * @param {Ground} ground
 * @param {{x_m: number, y_m: number}} origin
 * @param {number} cells
 * @param {number} below_m
 * @returns {Corner[]}
 */
function cornersOf(ground, origin, cells, below_m) {
  const half = TILE_M / 2;
  const height = ground.around(origin.x_m + half, origin.y_m + half, half * 1.5);
  const corners = [];
  for (let row = 0; row <= cells; row++) {
    for (let column = 0; column <= cells; column++) {
      const x = origin.x_m + (column * TILE_M) / cells;
      const y = origin.y_m + (row * TILE_M) / cells;
      const { z_m, distance_m } = height(x, y);
      corners.push({ at: toScene(origin, x, y, z_m - below_m), distance_m });
    }
  }
  return corners;
}

/** @param {Corner} corner @param {{x_m: number, y_m: number}} origin */
function colorOf(corner, origin) {
  if (corner.distance_m < 24) return NEAR_ROAD;
  const [x, y] = [origin.x_m + corner.at[0], origin.y_m - corner.at[2]];
  // Fields lie askew, each with a colour of its own.
  const i = Math.floor((x * 0.94 + y * 0.34) / FIELD_M);
  const j = Math.floor((y * 0.94 - x * 0.34) / (FIELD_M * 0.7));
  const wild = hills(x / 130, y / 130, 21) > 0.25;
  return wild ? RIVERBED : FIELDS[Math.floor(chance(i, j, 22) * FIELDS.length)];
}
