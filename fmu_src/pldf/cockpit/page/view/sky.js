// The sky with clouds and far hills, around everything and so far away that it never comes nearer.
// It is painted without a picture: that takes half of the time on machines without a graphics card.
import { BufferAttribute, BufferGeometry, Mesh } from "../vendor/three.js";
import { between, chance, hills } from "./chance.js";
import { HAZE_HEX, skyPaint } from "./materials.js";
import { rgb } from "./mesh.js";

/** @typedef {[number, number, number]} Color red, green, blue: 0..1 */

export const ZENITH = 0x3f7fc0;
const RADIUS_M = 2000;
const DEGREE = Math.PI / 180;
const SIDES = 48;
// Elevation in degrees, colour of the air there.
const AIR = /** @type {[number, number][]} */ ([
  [-8, HAZE_HEX],
  [0, HAZE_HEX],
  [4, 0xb6d3e6],
  [12, 0x9fc8e6],
  [28, 0x74abdb],
  [55, ZENITH],
  [90, ZENITH],
]);
const CLOUDS = 64;
const PUFF_SIDES = 10;
// Height in degrees, how many hills around, colour; from the farthest on.
const RIDGES = [
  [6.4, 5, 0x93afc4, 1],
  [4.2, 8, 0x7d9fae, 2],
  [2.4, 13, 0x749a8c, 3],
];
const RIDGE_SIDES = 240;
const FOOT_DEG = -0.6;

/** @returns {Mesh} */
export function sky() {
  const paint = new Painter();
  air(paint);
  for (let k = 0; k < CLOUDS; k++) cloud(paint, k);
  for (const [height, waves, hex, seed] of RIDGES) ridge(paint, height, waves, hex, seed);
  const dome = new Mesh(paint.geometry(), skyPaint());
  dome.renderOrder = 2; // only where nothing is before it
  dome.frustumCulled = false;
  return dome;
}

/** Corners by azimuth and elevation in degrees; what comes later is painted over what came before. */
class Painter {
  constructor() {
    /** @type {number[]} */
    this.positions = [];
    /** @type {number[]} */
    this.colors = [];
    /** @type {number[]} */
    this.index = [];
  }

  /**
   * @param {number} azimuth
   * @param {number} elevation
   * @param {Color} color
   * @returns {number} which corner it is
   */
  corner(azimuth, elevation, color) {
    const [a, e] = [azimuth * DEGREE, elevation * DEGREE];
    this.positions.push(
      RADIUS_M * Math.cos(e) * Math.cos(a),
      RADIUS_M * Math.sin(e),
      -RADIUS_M * Math.cos(e) * Math.sin(a),
    );
    this.colors.push(...color);
    return this.positions.length / 3 - 1;
  }

  /** A band between two rows of corners. @param {number[]} low @param {number[]} high */
  band(low, high) {
    for (let k = 1; k < low.length; k++) {
      this.index.push(low[k - 1], low[k], high[k], low[k - 1], high[k], high[k - 1]);
    }
  }

  geometry() {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(this.positions), 3));
    geometry.setAttribute("color", new BufferAttribute(new Float32Array(this.colors), 3));
    geometry.setIndex(this.index);
    return geometry;
  }
}

/** @param {number} sides @returns {number[]} azimuths around, both ends */
function around(sides) {
  return Array.from({ length: sides + 1 }, (_, k) => (360 * k) / sides);
}

/** @param {Painter} paint */
function air(paint) {
  const rows = AIR.map(([elevation, hex]) =>
    around(SIDES).map((azimuth) => paint.corner(azimuth, elevation, rgb(hex))),
  );
  for (let k = 1; k < rows.length; k++) paint.band(rows[k - 1], rows[k]);
}

/** Flat below, round above. @param {Painter} paint @param {number} seed */
function cloud(paint, seed) {
  const azimuth = 360 * chance(seed, 51);
  const elevation = between(6, 34, chance(seed, 52) ** 1.4);
  const size = elevation * between(0.07, 0.13, chance(seed, 53)) + 0.5;
  const puffs = 4 + Math.floor(4 * chance(seed, 54));
  for (let k = 0; k < puffs; k++) {
    const share = (2 * (k + 0.5)) / puffs - 1;
    const wide = size * between(0.8, 1.5, chance(seed, k, 55));
    const high = size * (1.05 - 0.6 * Math.abs(share)) * between(0.7, 1.1, chance(seed, k, 56));
    puff(paint, azimuth + share * size * 2.6, elevation, wide * 1.3, high);
  }
}

/**
 * @param {Painter} paint
 * @param {number} azimuth
 * @param {number} base
 * @param {number} wide
 * @param {number} high degrees
 */
function puff(paint, azimuth, base, wide, high) {
  const [white, grey] = [rgb(0xf7fafc), rgb(0xc9dbe8)];
  const at = (/** @type {number} */ x, /** @type {number} */ y) => {
    const light = Math.min(0.25 + (0.9 * y) / high, 1);
    const color = /** @type {Color} */ (white.map((value, i) => between(grey[i], value, light)));
    return paint.corner(azimuth + x / Math.cos(base * DEGREE), base + y, color);
  };
  const middle = at(0, 0.2 * high);
  const rim = Array.from({ length: PUFF_SIDES + 1 }, (_, k) => {
    const turn = (2 * Math.PI * k) / PUFF_SIDES;
    return at(wide * Math.cos(turn), Math.max(high * Math.sin(turn), -0.14 * high));
  });
  for (let k = 1; k < rim.length; k++) paint.index.push(middle, rim[k - 1], rim[k]);
}

/**
 * Hills, lost in haze below.
 * @param {Painter} paint
 * @param {number} height
 * @param {number} waves
 * @param {number} hex
 * @param {number} seed
 */
function ridge(paint, height, waves, hex, seed) {
  const azimuths = around(RIDGE_SIDES);
  const foot = azimuths.map((azimuth) => paint.corner(azimuth, FOOT_DEG, rgb(HAZE_HEX)));
  const top = azimuths.map((azimuth) => {
    // On a circle, so that both ends meet.
    const [c, s] = [Math.cos(azimuth * DEGREE), Math.sin(azimuth * DEGREE)];
    const wide = hills(c * waves * 0.5 + 20, s * waves * 0.5 + 20, seed);
    const fine = hills(c * waves * 3 + 50, s * waves * 3 + 50, seed + 10);
    return paint.corner(azimuth, height * (0.5 + 0.4 * wide + 0.1 * fine), rgb(hex));
  });
  paint.band(foot, top);
}
