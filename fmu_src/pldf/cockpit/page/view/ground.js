// How high the land lies: with the road near it, hilly away from it, a valley under bridges.
import { hills, rising } from "./chance.js";

/** @typedef {import("../engine/road.js").RoadModel} RoadModel */
/** @typedef {{s_m: number, distance_m: number, z_m: number, bridge: boolean}} Nearest */
/** @typedef {{x_m: number, y_m: number, cos: number, sin: number, half_m: number, z_m: number}} Valley */

/** the land beside the road lies so much lower than the road; the verge reaches down to it */
export const BELOW_ROAD_M = 0.7;
const CELL_M = 250;
const SAMPLE_M = 5;
const REACH_M = 750; // so far a piece of road has a say in how high the land is
const VALLEY_DEPTH_M = 13;
const VALLEY_REACH_M = 420; // to both sides of the road

/** The land around a road. */
export class Ground {
  /** @param {RoadModel} road */
  constructor(road) {
    this.road = road;
    /** @type {Map<string, number[]>} places s_m by cell of the land */
    this.cells = new Map();
    for (let s_m = 0; s_m <= road.length_m; s_m += SAMPLE_M) this.#remember(s_m);
    const bridges = road.stretches.filter((each) => each.kind === "bridge");
    /** @type {Valley[]} */
    this.valleys = bridges.map((bridge) => {
      const { x_m, y_m, z_m, heading_rad } = road.at((bridge.from_m + bridge.to_m) / 2);
      const [cos, sin] = [Math.cos(heading_rad), Math.sin(heading_rad)];
      return { x_m, y_m, z_m, cos, sin, half_m: (bridge.to_m - bridge.from_m) / 2 };
    });
  }

  /** @param {number} s_m */
  #remember(s_m) {
    const key = this.#key(this.road.x_m[s_m], this.road.y_m[s_m]);
    const known = this.cells.get(key);
    if (known) known.push(s_m);
    else this.cells.set(key, [s_m]);
  }

  /** @param {number} x_m @param {number} y_m */
  #key(x_m, y_m) {
    return `${Math.floor(x_m / CELL_M)} ${Math.floor(y_m / CELL_M)}`;
  }

  /**
   * Return the pieces of the road that count around a place.
   * @param {number} x_m @param {number} y_m @param {number} reach_m
   * @returns {number[]} places s_m, one per 5 m
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
    const far = this.roadNear(x_m, y_m, size_m + REACH_M).filter((s_m) => s_m % 50 === 0);
    return (x, y) => this.#height(x, y, near, far);
  }

  /** @param {number} x @param {number} y @param {number[]} near @param {number[]} far */
  #height(x, y, near, far) {
    const road = this.#nearest(x, y, near);
    const wide = this.#mean(x, y, far);
    const apart = rising(40, 140, road.distance_m);
    const base = road.s_m < 0 ? wide : road.z_m * (1 - apart) + wide * apart;
    const rough = hills(x / 90, y / 90, 1) * 5 + hills(x / 340, y / 340, 2) * 16;
    const z_m = base - BELOW_ROAD_M + (rough + 3) * rising(30, 330, road.distance_m);
    return { z_m: z_m - this.#valley(x, y, road), distance_m: road.distance_m };
  }

  /** @param {number} x @param {number} y @param {number[]} near @returns {Nearest} */
  #nearest(x, y, near) {
    const { x_m, y_m, z_m } = this.road;
    let [best, at] = [Infinity, -1];
    for (const s_m of near) {
      const distance = (x_m[s_m] - x) ** 2 + (y_m[s_m] - y) ** 2;
      if (distance < best) [best, at] = [distance, s_m];
    }
    if (at < 0) return { s_m: -1, distance_m: 1e3, z_m: 0, bridge: false };
    // Where the road comes by twice, the land lies below the lower one.
    let lowest = z_m[at];
    for (const s_m of near) {
      const distance = (x_m[s_m] - x) ** 2 + (y_m[s_m] - y) ** 2;
      if (distance < 900 && Math.abs(s_m - at) > 60) lowest = Math.min(lowest, z_m[s_m]);
    }
    const bridge = this.road.stretchAt("bridge", at) !== undefined;
    return { s_m: at, distance_m: Math.sqrt(best), z_m: lowest, bridge };
  }

  /** Height of the road, near pieces first. @param {number} x @param {number} y @param {number[]} far */
  #mean(x, y, far) {
    let [sum, weights] = [0, 0];
    for (const s_m of far) {
      const distance = (this.road.x_m[s_m] - x) ** 2 + (this.road.y_m[s_m] - y) ** 2;
      const weight = 1 / (distance + 400) ** 1.5;
      sum += weight * this.road.z_m[s_m];
      weights += weight;
    }
    return weights ? sum / weights : 0;
  }

  /** How much a valley lowers the land. @param {number} x @param {number} y @param {Nearest} road */
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

/** How far a river lies off its valley's middle. @param {number} across_m from the bridge */
export function riverBend(across_m) {
  return 14 * Math.sin(across_m / 70) * rising(15, 120, Math.abs(across_m));
}

/** Height of a river below the road on its bridge. */
export const RIVER_BELOW_M = VALLEY_DEPTH_M + BELOW_ROAD_M - 2.2;
