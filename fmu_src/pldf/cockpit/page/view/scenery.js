// What grows and stands beside the road, by chance that is the same on every visit.
import { standAt } from "./along.js";
import { between, chance, hills } from "./chance.js";
import { church, house } from "./houses.js";
import { bush, fir, hedge, leafTree, tuft } from "./plants.js";
import { PAVEMENT_M, beyondEdge } from "./profile.js";

/** @typedef {import("./along.js").Site} Site */
/** @typedef {import("./mesh.js").MeshBuilder} MeshBuilder */
/** @typedef {(x_m: number, y_m: number) => {z_m: number, distance_m: number}} Height */
/** @typedef {{site: Site, height: Height, detail: Detail}} Scene */
/** @typedef {import("./plants.js").Detail} Detail */
/** @typedef {"forest" | "avenue" | "meadow" | "village" | "bridge"} Country */

const CLEAR_M = 4.4; // nothing grows nearer to the asphalt: the law's, and room for posts and signs
const HOUSE_M = 17;
const BUILDING_M = [13, 10]; // along the road, away from it
const MIX_M = 320; // so long forest, avenue or meadow last

/** @param {Site["road"]} road @param {number} s_m @param {boolean} left @returns {Country} */
export function countryAt(road, s_m, left) {
  if (road.stretchAt("bridge", s_m)) return "bridge";
  if (road.stretchAt("village", s_m)) return "village";
  const kind = hills(s_m / MIX_M, left ? 0.3 : 5.3, 7) + 0.25 * hills(s_m / 70, left ? 2 : 9, 8);
  if (kind > 0.22) return "forest";
  return kind < -0.3 ? "avenue" : "meadow";
}

/** @param {Scene} scene @param {number} from_m @param {number} to_m */
export function grow(scene, from_m, to_m) {
  for (let s_m = from_m; s_m < to_m; s_m += 1) {
    for (const left of [true, false]) {
      const seed = 2 * s_m + (left ? 1 : 0);
      const country = countryAt(scene.site.road, s_m, left);
      GROWTH[country](scene, s_m, left, seed);
    }
  }
}

/** @type {Record<Country, (scene: Scene, s_m: number, left: boolean, seed: number) => void>} */
const GROWTH = {
  forest(scene, s_m, left, seed) {
    for (let row = 0; row < 4; row++) {
      const own = seed * 8 + row;
      if (chance(own, 60) > 0.17) continue;
      const out = CLEAR_M + 1.5 + row * 6 + 5 * chance(own, 61);
      plant(scene, s_m, left, out, (solid) => {
        const needles = hills(s_m / 60, row, 9) > -0.1;
        // Behind the first rows little is seen of a tree.
        const detail = row < 2 ? scene.detail : Math.min(scene.detail, 1);
        (needles ? fir : leafTree)(solid, own, /** @type {Detail} */ (detail));
      });
    }
    edge(scene, s_m, left, seed);
  },
  avenue(scene, s_m, left, seed) {
    if (s_m % 14 === (left ? 0 : 7)) {
      plant(scene, s_m, left, CLEAR_M + 0.6, (solid) => leafTree(solid, seed, scene.detail, 1.05));
    }
    edge(scene, s_m, left, seed);
  },
  meadow(scene, s_m, left, seed) {
    if (chance(seed, 70) < 0.02) {
      const out = CLEAR_M + 1 + 22 * chance(seed, 71) ** 2;
      plant(scene, s_m, left, out, (solid) => leafTree(solid, seed, scene.detail));
    }
    if (scene.detail && s_m % 4 === 0 && hills(s_m / 120, left ? 3 : 8, 11) > 0.1)
      fence(scene, s_m, left);
    edge(scene, s_m, left, seed);
  },
  village(scene, s_m, left, seed) {
    const village = scene.site.road.stretchAt("village", s_m);
    const inside = village ? Math.min(s_m - village.from_m, village.to_m - s_m) : 0;
    if (inside < 14) return;
    const away = left ? 1 : -1;
    if (s_m % HOUSE_M === (left ? 0 : 8)) {
      const out = between(4.5, 8, chance(seed, 80));
      build(scene, s_m, left, out, (solid) => house(solid, seed, away));
      plant(scene, s_m, left, 2.7, (solid) => hedge(solid, 9 + 3 * chance(seed, 81)));
      plant(scene, s_m + 13, left, out + 4, (solid) => leafTree(solid, seed, scene.detail, 0.7));
      build(scene, s_m, left, 28 + 8 * chance(seed, 82), (solid) => house(solid, seed + 1, away));
    }
    const middle = village && Math.round((village.from_m + village.to_m) / 2) === s_m;
    if (middle && !left) build(scene, s_m, left, 24, (solid) => church(solid, away));
  },
  bridge() {},
};

/**
 * Bushes and high grass at the side of the road.
 * @param {Scene} scene
 * @param {number} s_m
 * @param {boolean} left
 * @param {number} seed
 */
function edge(scene, s_m, left, seed) {
  if (scene.detail && chance(seed, 90) < 0.035) {
    plant(scene, s_m, left, CLEAR_M + 4 * chance(seed, 91), (solid) =>
      bush(solid, seed, scene.detail),
    );
  }
  if (scene.detail === 2 && chance(seed, 92) < 0.45) {
    plant(scene, s_m, left, 1.4 + 3 * chance(seed, 93), (solid) => tuft(solid, seed));
  }
}

/** A pasture's fence, 4 m of it. @param {Scene} scene @param {number} s_m @param {boolean} left */
function fence(scene, s_m, left) {
  plant(scene, s_m, left, CLEAR_M + 2.4, (solid) => {
    solid.box([-0.06, -0.06, -0.3], [0.06, 0.06, 1.25], 0x8a7358);
    if (scene.detail < 2) return;
    for (const up of [0.6, 1.05]) solid.box([0, -0.03, up], [4, 0.03, up + 0.1], 0x9a8468);
  });
}

/**
 * Stand on the ground beside the road; nothing where the road comes by again.
 * @param {Scene} scene @param {number} s_m @param {boolean} left @param {number} out_m beyond the asphalt
 * @param {(solid: MeshBuilder) => void} raise
 */
function plant({ site, height }, s_m, left, out_m, raise) {
  const left_m = beyondEdge(site.section, left, out_m);
  const { x_m, y_m } = site.road.at(s_m, left_m);
  const land = height(x_m, y_m);
  if (land.distance_m < Math.abs(left_m) - 1) return;
  const solid = standAt(site, s_m, left_m);
  const verge = Math.max(land.z_m, solid.frame.z_m + vergeAt(out_m));
  raise(solid.stand({ ...solid.frame, z_m: out_m < VERGE_M ? verge : land.z_m }));
}

/**
 * The same for what is so large that the road could come by at its other end.
 * @param {Scene} scene @param {number} s_m @param {boolean} left @param {number} out_m
 * @param {(solid: MeshBuilder) => void} raise
 */
function build(scene, s_m, left, out_m, raise) {
  const { road, section } = scene.site;
  const { x_m, y_m, heading_rad } = road.at(s_m, beyondEdge(section, left, out_m));
  const [cos, sin] = [Math.cos(heading_rad), Math.sin(heading_rad)];
  const deep = left ? BUILDING_M[1] : -BUILDING_M[1];
  const clear_m = Math.max(section.left_m, section.right_m) + PAVEMENT_M;
  const free = [
    [BUILDING_M[0], 0],
    [BUILDING_M[0], deep],
    [0, deep],
  ].every(
    ([a, l]) => scene.height(x_m + a * cos - l * sin, y_m + a * sin + l * cos).distance_m > clear_m,
  );
  if (free) plant(scene, s_m, left, out_m, raise);
}

const VERGE_M = 9;
/** Height of the verge against the road's edge. @param {number} out_m */
export function vergeAt(out_m) {
  return -0.03 - 0.075 * Math.min(out_m, VERGE_M);
}
