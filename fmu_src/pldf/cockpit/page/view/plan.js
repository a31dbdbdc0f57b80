// What stands along a road, and where: from its limits, curves, villages and bridges alone.
import { BEYOND_M } from "./profile.js";

/** @typedef {import("../engine/road.js").RoadModel} RoadModel */
/**
 * @typedef {{from_m: number, to_m: number, left: boolean, sharp: boolean}} Curve that asks for less speed than its limit
 */
/**
 * @typedef {object} Sign
 * @property {number} s_m
 * @property {"limit" | "town" | "town_end" | "curve_left" | "curve_right"} kind
 * @property {string} text number of a limit, name of a place
 * @property {string} unit below a number that is no km/h
 */
/**
 * @typedef {{s_m: number, left: boolean, to_left: boolean}} Board chevrons on the `left` or right side that point to one side
 */
/** @typedef {{from_m: number, to_m: number, left: boolean}} Rail */
/**
 * @typedef {{signs: Sign[], boards: Board[], rails: Rail[], posts: number[], curves: Curve[]}} Furniture
 */

const KMH_PER_MPS = 3.6;
const MPH_PER_MPS = 3600 / 1609.344;
const FIRST_SIGN_M = 25; // the driver begins at 0 and shall read it
const CURVE_MPS2 = 2.2; // lateral acceleration at the limit from which a curve is felt
const SHARP_MPS2 = 3;
const SAME_CURVE_M = 20;
const WARNING_M = 120;
const WARNING_MIN_M = 40; // nearer to the curve a warning is none
const BOARD_M = 20;
const RAIL_BEFORE_BRIDGE_M = 60;
const POST_M = 50;
const POST_CURVE_M = 25;
const POST_BEND_M = 12.5;

/**
 * @param {RoadModel} road
 * @returns {Furniture} each list in order
 */
export function furnitureOf(road) {
  const curves = curvesOf(road);
  return {
    curves,
    signs: [...limitSigns(road), ...townSigns(road), ...warnings(road, curves)].sort(
      (a, b) => a.s_m - b.s_m,
    ),
    boards: curves.filter((curve) => curve.sharp).flatMap(boardsOf),
    rails: [...curves.map(railOf), ...bridgeRails(road)],
    posts: postsOf(road),
  };
}

/**
 * What a sign with a limit shows: km/h, or mph where the limit is a round number of these.
 * @param {number} limit_mps
 * @returns {{text: string, unit: string}}
 */
export function signText(limit_mps) {
  const [kmh, mph] = [limit_mps * KMH_PER_MPS, limit_mps * MPH_PER_MPS];
  const miles = !isRound(kmh) && isRound(mph);
  return { text: String(Math.round(miles ? mph : kmh)), unit: miles ? "mph" : "" };
}

/** @param {number} value */
function isRound(value) {
  return Math.abs(value - 5 * Math.round(value / 5)) < 0.2;
}

/** @param {RoadModel} road @returns {Sign[]} */
function limitSigns(road) {
  return road.limits.map((span) => ({
    s_m: Math.max(span.from_m, FIRST_SIGN_M),
    kind: /** @type {const} */ ("limit"),
    ...signText(span.limit_mps),
  }));
}

/** @param {RoadModel} road @returns {Sign[]} */
function townSigns(road) {
  return road.stretches
    .filter((each) => each.kind === "village")
    .flatMap(({ from_m, to_m, name }) => [
      { s_m: from_m, kind: /** @type {const} */ ("town"), text: name, unit: "" },
      { s_m: to_m, kind: /** @type {const} */ ("town_end"), text: name, unit: "" },
    ]);
}

/** @param {RoadModel} road @returns {Curve[]} */
function curvesOf(road) {
  /** @type {(Curve & {strongest: number})[]} */
  const found = [];
  road.curvature_per_m.forEach((curvature, s_m) => {
    const felt = Math.abs(curvature) * road.limit_mps[s_m] ** 2;
    if (felt < CURVE_MPS2) return;
    const last = found.at(-1);
    if (last && last.left === curvature > 0 && s_m - last.to_m < SAME_CURVE_M) {
      last.to_m = s_m;
      last.strongest = Math.max(last.strongest, felt);
    } else
      found.push({ from_m: s_m, to_m: s_m, left: curvature > 0, sharp: false, strongest: felt });
  });
  return found.map(({ strongest, ...curve }) => ({ ...curve, sharp: strongest >= SHARP_MPS2 }));
}

/** @param {RoadModel} road @param {Curve[]} curves @returns {Sign[]} */
function warnings(road, curves) {
  return curves.flatMap((curve, k) => {
    // Behind the curve before it, or it would speak of that one.
    const behind_m = k ? curves[k - 1].to_m + 5 : 2 * FIRST_SIGN_M;
    const s_m = Math.max(curve.from_m - WARNING_M, behind_m);
    const hidden = road.limits.some((span) => Math.abs(span.from_m - s_m) <= 10);
    if (!curve.sharp || hidden || curve.from_m - s_m < WARNING_MIN_M) return [];
    const kind = /** @type {"curve_left" | "curve_right"} */ (
      curve.left ? "curve_left" : "curve_right"
    );
    return [{ s_m, kind, text: "", unit: "" }];
  });
}

/** On the outside of a curve. @param {Curve} curve @returns {Board[]} */
function boardsOf(curve) {
  const count = Math.max(Math.floor((curve.to_m - curve.from_m) / BOARD_M), 1);
  return Array.from({ length: count }, (_, k) => ({
    s_m: curve.from_m + ((curve.to_m - curve.from_m) * (k + 0.7)) / count,
    left: !curve.left,
    to_left: curve.left,
  }));
}

/** @param {Curve} curve @returns {Rail} */
function railOf(curve) {
  return { from_m: Math.max(curve.from_m - 10, 0), to_m: curve.to_m + 10, left: !curve.left };
}

/** @param {RoadModel} road @returns {Rail[]} */
function bridgeRails(road) {
  return road.stretches
    .filter((each) => each.kind === "bridge")
    .flatMap(({ from_m, to_m }) =>
      [true, false].flatMap((left) => [
        { from_m: Math.max(from_m - RAIL_BEFORE_BRIDGE_M, 0), to_m: from_m, left },
        { from_m: to_m, to_m: Math.min(to_m + RAIL_BEFORE_BRIDGE_M, road.length_m), left },
      ]),
    );
}

/** @param {RoadModel} road @returns {number[]} */
function postsOf(road) {
  const posts = [];
  const end_m = road.length_m + BEYOND_M.behind;
  for (let s_m = POST_BEND_M - BEYOND_M.before; s_m < end_m; s_m += postSpacing(road, s_m)) {
    if (!road.stretchAt("village", s_m) && !road.stretchAt("bridge", s_m)) posts.push(s_m);
  }
  return posts;
}

/** @param {RoadModel} road @param {number} s_m */
function postSpacing(road, s_m) {
  const curvature = Math.abs(road.curvatureAt(s_m));
  if (curvature > 1 / 100) return POST_BEND_M;
  return curvature > 1 / 400 ? POST_CURVE_M : POST_M;
}
