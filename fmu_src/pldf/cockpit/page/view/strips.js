// Strips along the road: its surface, verges, kerbs, bridge decks.
import { BufferAttribute, BufferGeometry, Mesh } from "../vendor/three.js";
import { lightAlong, rgb, toScene } from "./mesh.js";

/** @typedef {import("../engine/road.js").RoadModel} RoadModel */
/** @typedef {import("./mesh.js").Origin} Origin */
/** @typedef {{left_m: number, up_m: number, u: number}} Edge of a strip; u: across its picture */

/** Strips with a picture, in one mesh. */
export class Strips {
  /** @param {RoadModel} road @param {Origin} origin */
  constructor(road, origin) {
    this.road = road;
    this.origin = origin;
    /** @type {number[]} */
    this.positions = [];
    /** @type {number[]} */
    this.colors = [];
    /** @type {number[]} */
    this.uvs = [];
    /** @type {number[]} */
    this.index = [];
  }

  /**
   * Add a strip between two edges.
   * @param {number[]} places s_m
   * @param {Edge} left @param {Edge} right
   * @param {number} hex colour with which the picture is multiplied
   * @param {(s_m: number) => number} v along the picture
   */
  add(places, left, right, hex, v) {
    const first = this.positions.length / 3;
    const slope = Math.atan2(right.up_m - left.up_m, left.left_m - right.left_m);
    const color = rgb(hex);
    for (const s_m of places) {
      const { heading_rad } = this.road.at(s_m);
      const normal = [Math.sin(slope), Math.cos(slope)];
      const [n_east, n_north] = [
        normal[0] * Math.sin(heading_rad),
        -normal[0] * Math.cos(heading_rad),
      ];
      // A strip that rises to the right leans to the left.
      const light = lightAlong([-n_east, normal[1], n_north]);
      for (const edge of [left, right]) {
        const at = this.road.at(s_m, edge.left_m);
        this.positions.push(...toScene(this.origin, at.x_m, at.y_m, at.z_m + edge.up_m));
        this.colors.push(color[0] * light, color[1] * light, color[2] * light);
        this.uvs.push(edge.u, v(s_m));
      }
    }
    for (let k = 0; k < places.length - 1; k++) {
      const a = first + 2 * k;
      this.index.push(a, a + 1, a + 3, a, a + 3, a + 2);
    }
  }

  /** @param {import("../vendor/three.js").Material} material @returns {Mesh | null} null: empty */
  mesh(material) {
    if (!this.index.length) return null;
    const geometry = new BufferGeometry();
    const set = (
      /** @type {string} */ name,
      /** @type {number[]} */ values,
      /** @type {number} */ size,
    ) => geometry.setAttribute(name, new BufferAttribute(new Float32Array(values), size));
    set("position", this.positions, 3);
    set("color", this.colors, 3);
    set("uv", this.uvs, 2);
    geometry.setIndex(this.index);
    return new Mesh(geometry, material);
  }
}

const STEP_M = 5;
const BEND_STEP_M = 2;
const BEND_PER_M = 1 / 100;

/**
 * Places close enough for a strip to look round.
 * @param {RoadModel} road @param {number} from_m @param {number} to_m
 * @returns {number[]} both ends are among them
 */
export function placesBetween(road, from_m, to_m) {
  const bent = [from_m, (from_m + to_m) / 2, to_m].some(
    (s_m) => Math.abs(road.curvatureAt(s_m)) > BEND_PER_M,
  );
  const step_m = bent ? BEND_STEP_M : STEP_M;
  const count = Math.max(Math.ceil((to_m - from_m) / step_m), 1);
  return Array.from({ length: count + 1 }, (_, k) => from_m + ((to_m - from_m) * k) / count);
}
