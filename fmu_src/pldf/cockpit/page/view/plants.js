// Trees and bushes of few faces; far ones of fewer.
import { between, chance } from "./chance.js";

/**
 * @typedef {import("./mesh.js").MeshBuilder} MeshBuilder the frame: on the ground, where it grows
 */
/** @typedef {import("./mesh.js").Point} Point */

const TRUNK = 0x5d4a38;
const BIRCH = 0xcfcabd;
const LEAVES = [0x5f8f3a, 0x6f9a3f, 0x507f36, 0x7da448, 0x648a2f];
const NEEDLES = [0x2f5a38, 0x3a6740, 0x2a4f35];
const BUSH = [0x5b8a3c, 0x6f9440, 0x4c7a3a];

// Corners and faces of an icosahedron.
const PHI = (1 + Math.sqrt(5)) / 2;
const CORNERS = /** @type {Point[]} */ (
  [
    [-1, PHI, 0],
    [1, PHI, 0],
    [-1, -PHI, 0],
    [1, -PHI, 0],
    [0, -1, PHI],
    [0, 1, PHI],
    [0, -1, -PHI],
    [0, 1, -PHI],
    [PHI, 0, -1],
    [PHI, 0, 1],
    [-PHI, 0, -1],
    [-PHI, 0, 1],
  ].map((corner) => corner.map((value) => value / Math.hypot(1, PHI)))
);
const FACES = [
  [0, 11, 5],
  [0, 5, 1],
  [0, 1, 7],
  [0, 7, 10],
  [0, 10, 11],
  [1, 5, 9],
  [5, 11, 4],
  [11, 10, 2],
  [10, 7, 6],
  [7, 1, 8],
  [3, 9, 4],
  [3, 4, 2],
  [3, 2, 6],
  [3, 6, 8],
  [3, 8, 9],
  [4, 9, 5],
  [2, 4, 11],
  [6, 2, 10],
  [8, 6, 7],
  [9, 8, 1],
];

/** @typedef {0 | 1 | 2} Detail from far away, from some distance, from near */

/**
 * @param {MeshBuilder} solid
 * @param {number} seed which tree it is
 * @param {Detail} detail
 * @param {number} size 1: of usual height
 */
export function leafTree(solid, seed, detail, size = 1) {
  const height = size * between(6.5, 11, chance(seed, 1));
  const radius = height * between(0.24, 0.32, chance(seed, 2));
  const hex = LEAVES[Math.floor(chance(seed, 3) * LEAVES.length)];
  const trunk = chance(seed, 4) < 0.15 ? BIRCH : TRUNK;
  solid.cone(
    [0, 0, -0.4],
    0.028 * height,
    detail ? 0.018 * height : 0,
    height * 0.55,
    detail === 2 ? 6 : 3,
    trunk,
  );
  if (detail === 0) {
    solid.cone([0, 0, height * 0.55], radius, 0, height * 0.45, 4, hex, 0.95);
    solid.cone([0, 0, height * 0.55], -radius, 0, -height * 0.28, 4, hex, 0.9);
    return;
  }
  crown(solid, [0, 0, height * 0.65], [radius, radius, height * 0.35], hex, seed);
  for (let k = 0; k < (detail === 2 ? 3 : 0); k++) {
    const turn = 2.1 * k + 6 * chance(seed, 5);
    const out = radius * 0.58;
    const part = radius * between(0.55, 0.7, chance(seed, k, 6));
    const up = height * between(0.48, 0.62, chance(seed, k, 7));
    crown(
      solid,
      [out * Math.cos(turn), out * Math.sin(turn), up],
      [part, part, part * 1.05],
      hex,
      seed + k,
    );
  }
}

/** @param {MeshBuilder} solid @param {number} seed @param {Detail} detail */
export function fir(solid, seed, detail, size = 1) {
  const height = size * between(8, 15, chance(seed, 1));
  const radius = height * between(0.17, 0.22, chance(seed, 2));
  const hex = NEEDLES[Math.floor(chance(seed, 3) * NEEDLES.length)];
  if (detail < 2) {
    solid.cone([0, 0, height * 0.08], radius, 0, height * 0.92, detail ? 5 : 3, hex, 0.95);
    return;
  }
  solid.cone([0, 0, -0.4], 0.02 * height, 0.015 * height, height * 0.25, 5, TRUNK);
  for (const [from, share, shade] of [
    [0.1, 1, 0.8],
    [0.32, 0.78, 0.95],
    [0.54, 0.55, 1.05],
    [0.74, 0.32, 1.15],
  ]) {
    solid.cone(
      [0, 0, height * from],
      radius * share,
      0,
      height * 0.38 * (0.6 + share * 0.4),
      7,
      hex,
      shade,
    );
  }
}

/** @param {MeshBuilder} solid @param {number} seed @param {Detail} detail */
export function bush(solid, seed, detail) {
  const radius = between(0.4, 1, chance(seed, 1));
  const hex = BUSH[Math.floor(chance(seed, 3) * BUSH.length)];
  if (detail === 2)
    crown(solid, [0, 0, radius * 0.5], [radius, radius * 0.9, radius * 0.8], hex, seed);
  else solid.cone([0, 0, 0], radius, 0, radius * 1.2, 4, hex);
}

/** High grass beside the road. @param {MeshBuilder} solid @param {number} seed */
export function tuft(solid, seed) {
  const height = between(0.2, 0.5, chance(seed, 1));
  const hex = [0x7fa84c, 0x6f9a44, 0x93a952][Math.floor(chance(seed, 2) * 3)];
  for (let k = 0; k < 3; k++) {
    const turn = 1.6 * k + chance(seed, k, 3);
    const [c, s] = [Math.cos(turn), Math.sin(turn)];
    /** @type {Point[]} */
    const blade = [
      [-0.16 * s, 0.16 * c, -0.05],
      [0.16 * s, -0.16 * c, -0.05],
      [0.12 * c, 0.12 * s, height],
    ];
    solid.face(blade, hex, 1.2);
    solid.face([...blade].reverse(), hex, 1.2);
  }
}

/** A hedge along a garden. @param {MeshBuilder} solid @param {number} length_m */
export function hedge(solid, length_m) {
  solid.box([0, -0.35, -0.3], [length_m, 0.35, 1.1], 0x4c7a3a, 0x5f8f45);
}

/**
 * Uneven leaves, darker below.
 * @param {MeshBuilder} solid
 * @param {Point} middle
 * @param {Point} radii
 * @param {number} hex
 * @param {number} seed
 */
function crown(solid, middle, radii, hex, seed) {
  const corners = CORNERS.map((corner, k) => {
    const rough = between(0.82, 1.16, chance(seed, k, 8));
    return /** @type {Point} */ (corner.map((value, i) => middle[i] + value * radii[i] * rough));
  });
  for (const face of FACES) {
    const up = face.reduce((sum, k) => sum + CORNERS[k][2], 0) / 3;
    solid.face(
      face.map((k) => corners[k]),
      hex,
      0.92 + 0.2 * up,
    );
  }
}
