// A car of plain faces: that of the driver, seen from behind, and the one ahead.
import { MeshBuilder } from "./mesh.js";

/** @typedef {import("./mesh.js").Point} Point */

export const CAR_LENGTH_M = 4.4;
const HALF_M = 0.88;
const GLASS = 0x2b3640;
const TYRE = 0x1c1d1f;
const TRIM = 0x33373a;

/** @typedef {import("../vendor/three.js").Mesh} Mesh */

/** A car with its front bumper at zero; ahead is -z. */
export class Car {
  /** @param {number} hex paint */
  constructor(hex) {
    this.mesh = built((solid) => car(solid, hex));
    this.lights = built(brakeLights);
    this.mesh.add(this.lights);
  }

  /** @param {boolean} lit */
  brake(lit) {
    this.lights.visible = lit;
  }

  dispose() {
    this.mesh.geometry.dispose();
    this.lights.geometry.dispose();
  }
}

/** @param {(solid: MeshBuilder) => void} build @returns {Mesh} */
function built(build) {
  const solid = new MeshBuilder({ x_m: 0, y_m: 0 });
  // Ahead is north of the model: -z in the scene.
  build(solid.stand({ x_m: 0, y_m: 0, z_m: 0, heading_rad: Math.PI / 2 }));
  const mesh = solid.mesh();
  if (!mesh) throw new Error("a car without faces");
  return mesh;
}

/** @param {MeshBuilder} solid */
function brakeLights(solid) {
  for (const [low, high, up] of [
    [-0.84, -0.48, 0.66],
    [0.48, 0.84, 0.66],
    [-0.2, 0.2, 1.3],
  ]) {
    const behind = up > 1 ? -3.75 : -4.45;
    solid.face(
      [
        [behind, high, up],
        [behind, low, up],
        [behind, low, up + (up > 1 ? 0.05 : 0.22)],
        [behind, high, up + (up > 1 ? 0.05 : 0.22)],
      ],
      0xff2a1c,
      1.5,
    );
  }
}

/** @param {MeshBuilder} solid @param {number} hex paint */
function car(solid, hex) {
  shadow(solid);
  body(solid, hex);
  cabin(solid, hex);
  lights(solid);
  for (const ahead of [-0.85, -3.55]) {
    for (const side of [-1, 1]) wheel(solid, ahead, side);
  }
}

/** On the road below, in two steps. @param {MeshBuilder} solid */
function shadow(solid) {
  for (const [out, up, hex] of [
    [0.05, 0.03, 0x4a4b4e],
    [-0.12, 0.04, 0x2c2d2f],
  ]) {
    const [front, rear, half] = [0.02 + out, -CAR_LENGTH_M - out, HALF_M + out];
    solid.face(
      [
        [rear, -half, up],
        [front, -half, up],
        [front, half, up],
        [rear, half, up],
      ],
      hex,
      0.9,
    );
  }
}

/** @param {MeshBuilder} solid @param {number} hex */
function body(solid, hex) {
  const ring = [
    [-4.4, 0.24],
    [0, 0.22],
    [0, 0.62],
    [-0.25, 0.78],
    [-1.35, 0.93],
    [-4.1, 0.98],
    [-4.4, 0.9],
  ];
  shell(solid, ring, HALF_M, HALF_M * 0.94, hex);
  solid.box([-3.95, -HALF_M - 0.01, 0.22], [-0.4, HALF_M + 0.01, 0.4], TRIM);
}

/** @param {MeshBuilder} solid @param {number} hex */
function cabin(solid, hex) {
  const half = HALF_M * 0.9;
  const top = HALF_M * 0.7;
  /** @type {Point[]} front below, front above, back above, back below; right side */
  const right = [
    [-1.3, -half, 0.92],
    [-2, -top, 1.44],
    [-3.5, -top, 1.46],
    [-4.25, -half, 0.96],
  ];
  const left = right.map(([a, l, u]) => /** @type {Point} */ ([a, -l, u]));
  solid.face([right[0], left[0], left[1], right[1]], GLASS, 1.2);
  solid.face([left[3], right[3], right[2], left[2]], GLASS, 1.2);
  solid.face([right[3], right[0], right[1], right[2]], GLASS);
  solid.face([left[0], left[3], left[2], left[1]], GLASS);
  solid.face([right[1], left[1], left[2], right[2]], hex, 1.05);
}

/**
 * Upright outline, the same on both sides, narrower above.
 * @param {MeshBuilder} solid
 * @param {number[][]} ring
 * @param {number} low_half
 * @param {number} high_half
 * @param {number} hex
 */
function shell(solid, ring, low_half, high_half, hex) {
  const half = (/** @type {number} */ up) => low_half + ((high_half - low_half) * (up - 0.3)) / 0.7;
  const right = ring.map(([a, u]) => /** @type {Point} */ ([a, -half(u), u]));
  const left = ring.map(([a, u]) => /** @type {Point} */ ([a, half(u), u]));
  solid.face(right, hex);
  solid.face([...left].reverse(), hex);
  for (let k = 0; k < ring.length; k++) {
    const next = (k + 1) % ring.length;
    solid.face([right[k], left[k], left[next], right[next]], hex);
  }
}

/** @param {MeshBuilder} solid */
function lights(solid) {
  for (const side of [-1, 1]) {
    const [low, high] = [0.5 * side, 0.82 * side].sort((a, b) => a - b);
    solid.box([-4.43, low, 0.68], [-4.3, high, 0.86], 0xc01818);
    solid.box([-0.1, low, 0.52], [0.02, high, 0.64], 0xf5f3e6);
  }
  solid.box([-4.42, -0.27, 0.5], [-4.3, 0.27, 0.62], 0xf4f4f0);
}

/** @param {MeshBuilder} solid @param {number} ahead @param {number} side */
function wheel(solid, ahead, side) {
  const radius = 0.32;
  const out = side * (HALF_M + 0.02);
  const at = (/** @type {number} */ turn, /** @type {number} */ left) =>
    /** @type {Point} */ ([
      ahead + radius * Math.cos(turn),
      left,
      radius + radius * Math.sin(turn),
    ]);
  const turns = Array.from({ length: 12 }, (_, k) => (2 * Math.PI * k) / 12);
  const rim = turns.map((turn) => at(turn, out));
  solid.face(side < 0 ? rim : [...rim].reverse(), TYRE, 1.3);
  const hub = turns.map(
    (turn) =>
      /** @type {Point} */ ([
        ahead + 0.2 * Math.cos(turn),
        out + 0.005 * side,
        radius + 0.2 * Math.sin(turn),
      ]),
  );
  solid.face(side < 0 ? hub : [...hub].reverse(), 0xa9adb0);
  for (let k = 0; k < 12; k++) {
    const [a, b] = [turns[k], turns[(k + 1) % 12]];
    const inner = out - 0.2 * side;
    const tread = [at(a, out), at(b, out), at(b, inner), at(a, inner)];
    solid.face(side < 0 ? tread.reverse() : tread, TYRE, 1.2);
  }
}
