// Bridges: railings, piers, and a river below.
import { band, standAt } from "./along.js";
import { RIVER_BELOW_M, riverBend } from "./ground.js";
import { KERB_M, PARAPET_M, beyondEdge } from "./profile.js";
import { placesBetween } from "./strips.js";

/** @typedef {import("./along.js").Site} Site */

const CONCRETE = 0xb9b6ae;
const WATER = 0x7fa9bf;
const DECK_M = 1.4;
const PIER_M = 36; // from one to the next
const FIRST_PIER_M = 20;
const PIER_DEEP_M = 16;
const RIVER_HALF_M = 14;
const RIVER_REACH_M = 400; // to both sides
const RIVER_STEP_M = 20;

/** @param {Site} site @param {number} from_m @param {number} to_m */
export function bridges(site, from_m, to_m) {
  const { road } = site;
  for (const bridge of road.stretches.filter((each) => each.kind === "bridge")) {
    const [begin, end] = [Math.max(bridge.from_m, from_m), Math.min(bridge.to_m, to_m)];
    if (begin >= end) continue;
    railing(site, begin, end);
    const first =
      bridge.from_m +
      FIRST_PIER_M +
      PIER_M * Math.ceil((begin - bridge.from_m - FIRST_PIER_M) / PIER_M);
    for (let s_m = first; s_m < end; s_m += PIER_M) pier(site, s_m, PIER_DEEP_M);
    const middle = (bridge.from_m + bridge.to_m) / 2;
    if (middle >= begin && middle < end) river(site, middle);
  }
}

/** @param {Site} site @param {number} s_m */
function river({ road, solid }, s_m) {
  solid.stand(road.at(s_m));
  const z_m = -RIVER_BELOW_M;
  for (let across = -RIVER_REACH_M; across < RIVER_REACH_M; across += RIVER_STEP_M) {
    const [near, far] = [-riverBend(across), -riverBend(across + RIVER_STEP_M)];
    solid.face(
      [
        [near - RIVER_HALF_M, across, z_m],
        [near + RIVER_HALF_M, across, z_m],
        [far + RIVER_HALF_M, across + RIVER_STEP_M, z_m],
        [far - RIVER_HALF_M, across + RIVER_STEP_M, z_m],
      ],
      WATER,
    );
  }
}

/**
 * Parapet with a hand rail, on both sides of a bridge, and the deck's side.
 * @param {Site} site
 * @param {number} from_m
 * @param {number} to_m
 */
function railing(site, from_m, to_m) {
  for (const left of [true, false]) {
    const at_m = beyondEdge(site.section, left, 1.3);
    const step_m = site.detail ? 2.5 : 10;
    for (let s_m = from_m; s_m < to_m; s_m += step_m) {
      const next = Math.min(s_m + step_m, to_m);
      standAt(site, s_m, at_m, KERB_M).box([-0.04, -0.04, 0], [0.04, 0.04, PARAPET_M], 0x5d7f8c);
      for (const up of site.detail ? [0.35, 0.65, 0.95] : [0.95]) {
        band(site, s_m, next, at_m, [up, up + 0.07], 0x6f93a0, 1);
      }
    }
    const places = placesBetween(site.road, from_m, to_m);
    for (let k = 1; k < places.length; k++) {
      const side_m = at_m + (left ? 0.2 : -0.2);
      band(site, places[k - 1], places[k], side_m, [-DECK_M, KERB_M + 0.12], CONCRETE, 1);
    }
  }
}

/** Piers under a bridge. @param {Site} site @param {number} s_m @param {number} depth_m */
function pier(site, s_m, depth_m) {
  const solid = standAt(site, s_m, (site.section.left_m - site.section.right_m) / 2, -DECK_M);
  const half = (site.section.left_m + site.section.right_m) / 2 - 1;
  solid.box([-0.7, -half, -depth_m], [0.7, half, 0], CONCRETE);
}
