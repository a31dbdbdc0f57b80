// A piece of the road with all that stands beside it.
import { Group } from "../vendor/three.js";
import { guardRail, lamp, reflectorPosts, standAt } from "./along.js";
import { bridges } from "./bridge.js";
import { paintLines } from "./lines.js";
import { MeshBuilder } from "./mesh.js";
import { KERB_M, PAVEMENT_M, beyondEdge } from "./profile.js";
import { grow, vergeAt } from "./scenery.js";
import { putUp, putUpBoard } from "./signs.js";
import { Strips, placesBetween } from "./strips.js";
import { ASPHALT_M, GRASS_M } from "./textures.js";

/** @typedef {import("../engine/road.js").RoadModel} RoadModel */
/** @typedef {import("./along.js").Site} Site */
/** @typedef {import("./lines.js").Marking} Marking */
/** @typedef {import("../vendor/three.js").Material} Material */
/** @typedef {import("../vendor/three.js").ShaderMaterial} ShaderMaterial */
/** @typedef {import("../vendor/three.js").Mesh} Mesh */
/**
 * What all pieces of a road have in common.
 * @typedef {object} Kit
 * @property {RoadModel} road
 * @property {import("./profile.js").CrossSection} section
 * @property {import("./plan.js").Furniture} furniture
 * @property {import("./ground.js").Ground} ground
 * @property {ShaderMaterial} asphalt
 * @property {ShaderMaterial} grass
 * @property {Material} paving
 */

export const PIECE_M = 100;
const LAMP_M = 30;
const VERGE = 0x82aa4c;
const DITCH = 0x6f9844;
const PAVING = 0xb4b2ac;
const KERB = 0xd2d0c8;
const DECK = 0xa8a69f;
const SOLID_LINE_PER_M = 1 / 500; // no overtaking in such a curve
const DECK_SIDE_M = 1.5;
const SIGN_OUT_M = 1.6; // beyond the asphalt
const TOWN_SIGN_OUT_M = 3.2;
const BOARD_OUT_M = 2;

/** @param {Kit} kit @param {number} k which piece @param {import("./plants.js").Detail} detail */
export function piece(kit, k, detail) {
  const { road, section, ground } = kit;
  const [from_m, to_m] = [
    Math.max(k * PIECE_M, ground.from_m),
    Math.min((k + 1) * PIECE_M, ground.to_m),
  ];
  const start = road.at(from_m);
  const origin = { x_m: start.x_m, y_m: start.y_m };
  const solid = new MeshBuilder(origin);
  /** @type {Site} */
  const site = { road, section, solid, detail };
  const group = new Group();
  const put = (/** @type {Mesh | null} */ mesh) => mesh && group.add(mesh);
  surface(kit, solid, from_m, to_m).forEach(put);
  furniture(kit, site, from_m, to_m).forEach(put);
  bridges(site, from_m, to_m);
  const middle = road.at((from_m + to_m) / 2);
  const height = ground.around(middle.x_m, middle.y_m, PIECE_M);
  grow({ site, height, detail }, from_m, to_m);
  put(solid.mesh());
  return { group, origin };
}

/** @param {Kit} kit @param {MeshBuilder} solid @param {number} from_m @param {number} to_m */
function surface(kit, solid, from_m, to_m) {
  const { road, section } = kit;
  const { origin } = solid;
  const [asphalt, grass, paving] = [0, 1, 2].map(() => new Strips(road, origin));
  const cuts = cutsBetween(road, from_m, to_m);
  const left = { left_m: section.left_m, up_m: 0, u: 0 };
  const right = { left_m: -section.right_m, up_m: 0, u: 1 };
  for (let k = 1; k < cuts.length; k++) {
    const places = placesBetween(road, cuts[k - 1], cuts[k]);
    const middle = (cuts[k - 1] + cuts[k]) / 2;
    asphalt.add(places, left, right, 0xe4e6ea, (s) => s / ASPHALT_M);
    paintLines(solid, road, section, markingAt(road, middle), cuts[k - 1], cuts[k]);
    if (road.stretchAt("bridge", middle)) pavement(paving, kit, places, DECK_SIDE_M, DECK);
    else if (road.stretchAt("village", middle)) {
      pavement(paving, kit, places, PAVEMENT_M, PAVING);
      verges(grass, kit, places, PAVEMENT_M, KERB_M);
    } else verges(grass, kit, places, 0, 0);
  }
  return [asphalt.mesh(kit.asphalt), grass.mesh(kit.grass), paving.mesh(kit.paving)];
}

/**
 * Where the cross-section or the lines may change.
 * @param {RoadModel} road
 * @param {number} from_m
 * @param {number} to_m
 * @returns {number[]} in order, with both ends
 */
function cutsBetween(road, from_m, to_m) {
  const spans = road.stretches.filter((each) => each.kind === "bridge" || each.kind === "village");
  const ends = spans.flatMap((each) => [each.from_m, each.to_m]);
  const middle = (from_m + to_m) / 2;
  const inside = [...ends, middle].filter((s_m) => s_m > from_m && s_m < to_m);
  return [from_m, ...new Set(inside.sort((a, b) => a - b)), to_m];
}

/** @param {RoadModel} road @param {number} s_m @returns {Marking} */
function markingAt(road, s_m) {
  if (road.stretchAt("village", s_m)) return "town";
  const places = [s_m - PIECE_M / 2, s_m, s_m + PIECE_M / 2];
  return places.some((at) => Math.abs(road.curvatureAt(at)) > SOLID_LINE_PER_M)
    ? "solid"
    : "dashed";
}

/**
 * @param {Strips} grass
 * @param {Kit} kit
 * @param {number[]} places
 * @param {number} from_m beyond the asphalt
 * @param {number} up_m
 */
function verges(grass, kit, places, from_m, up_m) {
  const outs = [from_m, from_m + 1.3, 9, 13];
  for (const left of [true, false]) {
    for (let k = 1; k < outs.length; k++) {
      const [inner, outer] = [k - 1, k].map((i) => {
        const out_m = outs[i];
        const drop = i === 3 ? -1.7 : vergeAt(out_m);
        const left_m = beyondEdge(kit.section, left, out_m);
        return { left_m, up_m: i === 0 ? up_m : drop, u: left_m / GRASS_M };
      });
      const edges = left ? [outer, inner] : [inner, outer];
      grass.add(places, edges[0], edges[1], k === 2 ? DITCH : VERGE, (s) => s / GRASS_M);
    }
  }
}

/**
 * Raised, with a kerb.
 * @param {Strips} paving
 * @param {Kit} kit
 * @param {number[]} places
 * @param {number} width_m
 * @param {number} hex
 */
function pavement(paving, kit, places, width_m, hex) {
  for (const left of [true, false]) {
    const [foot, top, far] = [
      { left_m: beyondEdge(kit.section, left, 0), up_m: 0, u: 0 },
      { left_m: beyondEdge(kit.section, left, 0.02), up_m: KERB_M, u: 0.1 },
      { left_m: beyondEdge(kit.section, left, width_m), up_m: KERB_M, u: width_m },
    ];
    for (const [inner, outer, color] of /** @type {const} */ ([
      [foot, top, KERB],
      [top, far, hex],
    ])) {
      const edges = left ? [outer, inner] : [inner, outer];
      paving.add(places, edges[0], edges[1], color, (s) => s);
    }
  }
}

/** @param {Kit} kit @param {Site} site @param {number} from_m @param {number} to_m */
function furniture({ furniture: plan, road, section }, site, from_m, to_m) {
  const here = (/** @type {{s_m: number}} */ { s_m }) => s_m >= from_m && s_m < to_m;
  const driven = road.side < 0;
  plan.posts.filter((s_m) => here({ s_m })).forEach((s_m) => reflectorPosts(site, s_m));
  for (const rail of plan.rails) {
    const [begin, end] = [Math.max(rail.from_m, from_m), Math.min(rail.to_m, to_m)];
    if (begin < end) guardRail(site, begin, end, rail.left);
  }
  for (let s_m = from_m; s_m < to_m; s_m += LAMP_M) {
    const left = Math.round(s_m / LAMP_M) % 2 === 0;
    if (road.stretchAt("village", s_m)) lamp(site, s_m, left);
  }
  const signs = plan.signs.filter(here).map((sign) => {
    const out = sign.kind.startsWith("town") ? TOWN_SIGN_OUT_M : SIGN_OUT_M;
    return putUp(standAt(site, sign.s_m, beyondEdge(section, driven, out)), sign);
  });
  const boards = plan.boards.filter(here).map((board) => {
    const solid = standAt(site, board.s_m, beyondEdge(section, board.left, BOARD_OUT_M), -0.1);
    return putUpBoard(solid, board.to_left);
  });
  return [...signs, ...boards];
}
