// How high the land lies: with the road near it, hilly away from it, a valley under bridges.
import { hills, rising } from "./chance.js";
import { BEYOND_M } from "./profile.js";

/** @typedef {import("../engine/road.js").RoadModel} RoadModel */
/**
 * @typedef {{s_m: number, x_m: number, y_m: number, z_m: number, bridge: boolean}} Sample a place on the road
 */
/** @typedef {{distance_m: number, z_m: number, bridge: boolean}} Nearest */
/**
 * @typedef {{x_m: number, y_m: number, cos: number, sin: number, half_m: number, z_m: number}} Valley
 */

/** the land beside the road lies so much lower than the road; the verge reaches down to it */
export const BELOW_ROAD_M = 0.7;
const CELL_M = 250;
const SAMPLE_M = 5;
const FAR_EVERY = 10;
const APART_M = 60;
const NOWHERE_M = 1000; // no road near
const REACH_M = 750; // so far a piece of road has a say in how high the land is
const VALLEY_DEPTH_M = 13;
const VALLEY_REACH_M = 420; // to both sides of the road

/** The land around a road, which goes straight on beyond its ends: no drive begins or ends at nothing. */
export class Ground {
  /** @param {RoadModel} road */
  constructor(road) {
    this.road = road;
    /** @type {Map<string, Sample[]>} places on the road by cell of the land */
    this.cells = new Map();
    for (let s_m = 0; s_m <= road.length_m; s_m += SAMPLE_M) this.#remember(s_m);
    const [before_m, behind_m] = [
      this.#free(0, -1, BEYOND_M.before),
      this.#free(road.length_m, 1, BEYOND_M.behind),
    ];
    /** from where to where there is a road to be seen */
    this.from_m = -before_m;
    this.to_m = road.length_m + behind_m;
    for (let s_m = SAMPLE_M; s_m <= before_m; s_m += SAMPLE_M) this.#remember(-s_m);
    for (let s_m = SAMPLE_M; s_m <= behind_m; s_m += SAMPLE_M) this.#remember(road.length_m + s_m);
    const bridges = road.stretches.filter((each) => each.kind === "bridge");
    /** @type {Valley[]} */
    this.valleys = bridges.map((bridge) => {
      const { x_m, y_m, z_m, heading_rad } = road.at((bridge.from_m + bridge.to_m) / 2);
      const [cos, sin] = [Math.cos(heading_rad), Math.sin(heading_rad)];
      return { x_m, y_m, z_m, cos, sin, half_m: (bridge.to_m - bridge.from_m) / 2 };
    });
  }

  /**
   * How far a road can go on beyond an end before it meets itself.
   * @param {number} end_m
   * @param {1 | -1} way
   * @param {number} most_m
   */
  #free(end_m, way, most_m) {
    for (let far_m = APART_M; far_m < most_m; far_m += SAMPLE_M) {
      const { x_m, y_m } = this.road.at(end_m + way * far_m);
      const near = this.roadNear(x_m, y_m, APART_M);
      if (near.some((each) => Math.hypot(each.x_m - x_m, each.y_m - y_m) < APART_M - SAMPLE_M)) {
        return far_m - APART_M;
      }
    }
    return most_m;
  }

  /** @param {number} s_m */
  #remember(s_m) {
    const { x_m, y_m, z_m } = this.road.at(s_m);
    const bridge = this.road.stretchAt("bridge", s_m) !== undefined;
    const key = this.#key(x_m, y_m);
    const known = this.cells.get(key);
    if (known) known.push({ s_m, x_m, y_m, z_m, bridge });
    else this.cells.set(key, [{ s_m, x_m, y_m, z_m, bridge }]);
  }

  /** @param {number} x_m @param {number} y_m */
  #key(x_m, y_m) {
    return `${Math.floor(x_m / CELL_M)} ${Math.floor(y_m / CELL_M)}`;
  }

  /**
   * Return the pieces of the road that count around a place.
   * @param {number} x_m @param {number} y_m @param {number} reach_m
   * @returns {Sample[]} one per 5 m
   */
  roadNear(x_m, y_m, reach_m) {
    const found = [];
    for (let x = x_m - reach_m; x < x_m + reach_m + CELL_M; x += CELL_M) {
      for (let y = y_m - reach_m; y < y_m + reach_m + CELL_M; y += CELL_M) {
        found.push(...(this.cells.get(this.#key(x, y)) ?? []));
      }
    }
    return found;
  }

  /**
   * Return the function that tells how high the land is within `size_m` of a place.
   * @param {number} x_m @param {number} y_m @param {number} size_m
   * @returns {(x_m: number, y_m: number) => {z_m: number, distance_m: number}}
   */
  around(x_m, y_m, size_m) {
    const near = this.roadNear(x_m, y_m, size_m + 150);
    const far = this.roadNear(x_m, y_m, size_m + REACH_M).filter(
      (each) => Math.round(each.s_m / SAMPLE_M) % FAR_EVERY === 0,
    );
    return (x, y) => this.#height(x, y, near, far);
  }

  /** @param {number} x @param {number} y @param {Sample[]} near @param {Sample[]} far */
  #height(x, y, near, far) {
    const road = nearest(x, y, near);
    const wide = mean(x, y, far);
    const apart = rising(40, 140, road.distance_m);
    const base = near.length ? road.z_m * (1 - apart) + wide * apart : wide;
    const rough = hills(x / 90, y / 90, 1) * 5 + hills(x / 340, y / 340, 2) * 16;
    const z_m = base - BELOW_ROAD_M + (rough + 3) * rising(30, 330, road.distance_m);
    return { z_m: z_m - this.#valley(x, y, road), distance_m: road.distance_m };
  }

  /**
   * How much a valley lowers the land.
   * @param {number} x
   * @param {number} y
   * @param {Nearest} road
   */
  #valley(x, y, road) {
    let depth = 0;
    for (const valley of this.valleys) {
      const [dx, dy] = [x - valley.x_m, y - valley.y_m];
      const across = -dx * valley.sin + dy * valley.cos;
      const along = Math.abs(dx * valley.cos + dy * valley.sin + riverBend(across));
      const banks = 1 - rising(0.35 * valley.half_m, 0.92 * valley.half_m, along);
      const end = 1 - rising(0.6 * VALLEY_REACH_M, VALLEY_REACH_M, Math.abs(across));
      depth = Math.max(depth, VALLEY_DEPTH_M * banks * end);
    }
    return road.bridge ? depth : depth * rising(5, 60, road.distance_m);
  }
}

/** @param {number} x @param {number} y @param {Sample[]} near @returns {Nearest} */
function nearest(x, y, near) {
  let [best, at] = [Infinity, /** @type {Sample | null} */ (null)];
  for (const each of near) {
    const distance = (each.x_m - x) ** 2 + (each.y_m - y) ** 2;
    if (distance < best) [best, at] = [distance, each];
  }
  if (!at) return { distance_m: NOWHERE_M, z_m: 0, bridge: false };
  // Where the road comes by twice, the land lies below the lower one.
  let lowest = at.z_m;
  for (const each of near) {
    const distance = (each.x_m - x) ** 2 + (each.y_m - y) ** 2;
    if (distance < 900 && Math.abs(each.s_m - at.s_m) > 60) lowest = Math.min(lowest, each.z_m);
  }
  return { distance_m: Math.sqrt(best), z_m: lowest, bridge: at.bridge };
}

/**
 * Height of the road, near pieces first.
 * @param {number} x
 * @param {number} y
 * @param {Sample[]} far
 */
function mean(x, y, far) {
  let [sum, weights] = [0, 0];
  for (const each of far) {
    const weight = 1 / ((each.x_m - x) ** 2 + (each.y_m - y) ** 2 + 400) ** 1.5;
    sum += weight * each.z_m;
    weights += weight;
  }
  return weights ? sum / weights : 0;
}

/** How far a river lies off its valley's middle. @param {number} across_m from the bridge */
export function riverBend(across_m) {
  return 14 * Math.sin(across_m / 70) * rising(15, 120, Math.abs(across_m));
}

/** Height of a river below the road on its bridge. */
export const RIVER_BELOW_M = VALLEY_DEPTH_M + BELOW_ROAD_M - 2.2;
