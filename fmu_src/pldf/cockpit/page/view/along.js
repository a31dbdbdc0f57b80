// What stands beside the road at regular places: posts, rails, lamps.
import { KERB_M, beyondEdge } from "./profile.js";

/** @typedef {import("../engine/road.js").RoadModel} RoadModel */
/** @typedef {import("./mesh.js").MeshBuilder} MeshBuilder */
/** @typedef {import("./profile.js").CrossSection} CrossSection */
/**
 * @typedef {{road: RoadModel, section: CrossSection, solid: MeshBuilder, detail: import("./plants.js").Detail}} Site
 */

const WHITE = 0xf2f2ee;
const STEEL = 0xaab0b4;

/**
 * Stand at a place beside the road.
 * @param {Site} site
 * @param {number} s_m
 * @param {number} left_m
 * @param {number} up_m
 */
export function standAt({ road, solid }, s_m, left_m, up_m = 0) {
  const at = road.at(s_m, left_m);
  return solid.stand({ ...at, z_m: at.z_m + up_m });
}

/** A reflector post on each side. @param {Site} site @param {number} s_m */
export function reflectorPosts(site, s_m) {
  for (const left of [true, false]) {
    const solid = standAt(site, s_m, beyondEdge(site.section, left, 0.7), -0.1);
    if (!site.detail) {
      solid.box([-0.06, -0.07, 0], [0.06, 0.07, 1.08], WHITE);
      continue;
    }
    solid.box([-0.06, -0.07, 0], [0.06, 0.07, 0.78], WHITE);
    solid.box([-0.06, -0.07, 0.78], [0.06, 0.07, 0.98], 0x18191a);
    solid.box([-0.06, -0.07, 0.98], [0.06, 0.07, 1.08], WHITE);
    const amber = left === site.road.side > 0 ? 0xf4f4f4 : 0xffa526;
    solid.face(
      [
        [-0.065, 0.035, 0.82],
        [-0.065, 0.035, 0.95],
        [-0.065, -0.035, 0.95],
        [-0.065, -0.035, 0.82],
      ],
      amber,
      2,
    );
  }
}

/**
 * A steel rail on posts.
 * @param {Site} site
 * @param {number} from_m
 * @param {number} to_m
 * @param {boolean} left
 */
export function guardRail(site, from_m, to_m, left) {
  const at_m = beyondEdge(site.section, left, 1.1);
  for (let s_m = from_m; s_m < to_m; s_m += 4) {
    const next = Math.min(s_m + 4, to_m);
    band(site, s_m, next, at_m, [0.42, 0.74], STEEL, site.detail ? 1 : 1.12);
    if (!site.detail) continue;
    standAt(site, s_m, at_m, -0.2).box([-0.05, -0.06, 0], [0.05, 0.06, 0.85], STEEL);
    if (site.detail === 2)
      band(site, s_m, next, at_m + (left ? -0.02 : 0.02), [0.58, 0.74], STEEL, 1.25);
  }
}

/**
 * An upright band, seen from both sides.
 * @param {Site} site
 * @param {number} from_m
 * @param {number} to_m
 * @param {number} left_m
 * @param {number[]} ups
 * @param {number} hex
 * @param {number} shade
 */
export function band({ road, solid }, from_m, to_m, left_m, [low, high], hex, shade) {
  const [a, b] = [road.at(from_m, left_m), road.at(to_m, left_m)];
  solid.stand({ x_m: 0, y_m: 0, z_m: 0, heading_rad: 0 });
  /** @type {import("./mesh.js").Point[]} */
  const corners = [
    [a.x_m, a.y_m, a.z_m + low],
    [b.x_m, b.y_m, b.z_m + low],
    [b.x_m, b.y_m, b.z_m + high],
    [a.x_m, a.y_m, a.z_m + high],
  ];
  solid.face(corners, hex, shade);
  solid.face([...corners].reverse(), hex, shade);
}

/** A lamp on the pavement. @param {Site} site @param {number} s_m @param {boolean} left */
export function lamp(site, s_m, left) {
  const solid = standAt(site, s_m, beyondEdge(site.section, left, 1.6), KERB_M);
  const inward = left ? -1 : 1;
  solid.cone([0, 0, 0], 0.09, 0.05, 6, 6, 0x59636a);
  const [low, high] = [0, 1.5 * inward].sort((a, b) => a - b);
  solid.box([-0.04, low, 5.9], [0.04, high, 5.98], 0x59636a);
  const [near, far] = [0.9 * inward, 1.6 * inward].sort((a, b) => a - b);
  solid.box([-0.14, near, 5.84], [0.14, far, 6], 0xdfe3e4);
}
