// Lines painted on the road.
import { rgb, toScene } from "./mesh.js";
import { placesBetween } from "./strips.js";

/** @typedef {import("../engine/road.js").RoadModel} RoadModel */
/** @typedef {import("./mesh.js").MeshBuilder} MeshBuilder */
/** @typedef {import("./profile.js").CrossSection} CrossSection */
/**
 * @typedef {"dashed" | "solid" | "town"} Marking of the middle: overtaking or not; none at the edges
 */

const PERIOD_M = 12; // a dash and the gap behind it
const DASH_M = 4;
const WIDTH_M = { edge: 0.15, middle: 0.14, lane: 0.14 };
const UP_M = 0.015;
const PAINT = rgb(0xeeeee8);

/**
 * @param {MeshBuilder} solid @param {RoadModel} road @param {CrossSection} section
 * @param {Marking} marking @param {number} from_m @param {number} to_m
 */
export function paintLines(solid, road, section, marking, from_m, to_m) {
  for (const { at_m, kind } of section.lines) {
    if (kind === "edge" && marking === "town") continue;
    const half_m = WIDTH_M[kind] / 2;
    if (kind === "edge" || (kind === "middle" && marking === "solid")) {
      stroke(solid, road, at_m, half_m, from_m, to_m);
    } else dashes(from_m, to_m).forEach(([a, b]) => stroke(solid, road, at_m, half_m, a, b));
  }
}

/**
 * @param {number} from_m
 * @param {number} to_m
 * @returns {[number, number][]} the parts of dashes that lie between
 */
function dashes(from_m, to_m) {
  /** @type {[number, number][]} */
  const found = [];
  for (let s_m = Math.floor(from_m / PERIOD_M) * PERIOD_M; s_m < to_m; s_m += PERIOD_M) {
    const [begin, end] = [Math.max(s_m, from_m), Math.min(s_m + DASH_M, to_m)];
    if (begin < end) found.push([begin, end]);
  }
  return found;
}

/**
 * @param {MeshBuilder} solid
 * @param {RoadModel} road
 * @param {number} at_m
 * @param {number} half_m
 * @param {number} from_m
 * @param {number} to_m
 */
function stroke(solid, road, at_m, half_m, from_m, to_m) {
  const places = placesBetween(road, from_m, to_m);
  const edges = places.map((s_m) =>
    [at_m + half_m, at_m - half_m].map((left_m) => {
      const { x_m, y_m, z_m } = road.at(s_m, left_m);
      return toScene(solid.origin, x_m, y_m, z_m + UP_M);
    }),
  );
  for (let k = 1; k < edges.length; k++) {
    const [[a, b], [d, c]] = [edges[k - 1], edges[k]];
    for (const corner of [a, b, c, a, c, d]) {
      solid.positions.push(...corner);
      solid.colors.push(...PAINT);
    }
  }
}
