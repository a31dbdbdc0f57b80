// A road as all rooms see it: its line in space per metre, limits, lanes.
import { readPrepared } from "./prepared.js";

/** @typedef {import("../types.js").Road} Road */
/** @typedef {import("../types.js").Stretch} Stretch */
/**
 * @typedef {{x_m: number, y_m: number, z_m: number, heading_rad: number, pitch_rad: number}} Pose
 */
/** @typedef {{from_m: number, to_m: number, limit_mps: number}} LimitSpan */

// A line from a file bends at its knots; a driver's view must not jump there.
const SMOOTHING_M = 4;
const TOWN_LIMIT_MPS = 50 / 3.6;
const TOWN_MIN_M = 150;
const STRAIGHT_PER_M = 1 / 2000;
const LANE_WIDTH_M = 3.5;

/**
 * Return the model of a road.
 * @param {Road} road
 * @returns {RoadModel}
 * @throws {import("./prepared.js").RoadFileError} its bytes are no prepared road
 */
export function roadOf(road) {
  return new RoadModel(road);
}

/**
 * Return what a prepared road alone is for the page: a lane in each direction, traffic on the right.
 * @param {Uint8Array} prepared
 * @param {string} name
 * @returns {Road}
 * @throws {import("./prepared.js").RoadFileError}
 */
export function roadFromPrepared(prepared, name) {
  const { key } = readPrepared(prepared);
  return {
    name,
    key,
    prepared,
    lane_width_m: LANE_WIDTH_M,
    lanes_right: 1,
    lanes_left: 1,
    traffic: "RHT",
    stretches: [],
  };
}

/** The road's line, which parts the directions of traffic, with a node at each metre. */
export class RoadModel {
  /** @param {Road} road */
  constructor(road) {
    const prepared = readPrepared(road.prepared);
    this.name = road.name;
    this.key = prepared.key;
    this.marks = prepared.marks;
    this.limit_mps = prepared.limit_mps;
    this.grade = prepared.grade;
    this.nodes = prepared.grade.length;
    this.length_m = this.nodes - 1;
    this.has_line = prepared.has_line;
    this.lane_width_m = road.lane_width_m;
    this.lanes_right = road.lanes_right;
    this.lanes_left = road.lanes_left;
    /** +1: drives on the right of the line, -1: on the left */
    this.side = road.traffic === "LHT" ? -1 : 1;
    const line = prepared.has_line
      ? smoothLine(prepared.x_m, prepared.y_m)
      : lineOf(signedCurvature(prepared.curvature_per_m, road.stretches));
    this.x_m = line.x_m;
    this.y_m = line.y_m;
    this.heading_rad = line.heading_rad;
    this.z_m = integrated(this.grade);
    /** 1/m, positive to the left @type {Float64Array} */
    this.curvature_per_m = smooth(differences(line.heading_rad));
    /** middle of the lane that is driven, to the left of the line; the outer one of several */
    this.lane_m = -this.side * (road.lanes_right - 0.5) * road.lane_width_m;
    this.limits = limitSpans(prepared.limit_mps);
    this.stretches = withTowns(road.stretches, this.limits);
  }

  /**
   * Return a place beside or on the line.
   * @param {number} s_m beyond the ends the road goes straight on
   * @param {number} left_m to the left of the line
   * @returns {Pose} pitch: upwards
   */
  at(s_m, left_m = 0) {
    const inside = Math.min(Math.max(s_m, 0), this.length_m);
    const heading = blended(this.heading_rad, inside);
    const grade = blended(this.grade, inside);
    const beyond = s_m - inside;
    return {
      x_m: blended(this.x_m, inside) + beyond * Math.cos(heading) - left_m * Math.sin(heading),
      y_m: blended(this.y_m, inside) + beyond * Math.sin(heading) + left_m * Math.cos(heading),
      z_m: blended(this.z_m, inside) + beyond * grade,
      heading_rad: heading,
      pitch_rad: Math.atan(grade),
    };
  }

  /** @param {number} s_m @returns {number} 1/m, positive to the left */
  curvatureAt(s_m) {
    return blended(this.curvature_per_m, Math.min(Math.max(s_m, 0), this.length_m));
  }

  /** @param {number} s_m @returns {number} legal limit, m/s */
  limitAt(s_m) {
    return this.limit_mps[Math.floor(Math.min(Math.max(s_m, 0), this.length_m))];
  }

  /** @param {Stretch["kind"]} kind @param {number} s_m @returns {Stretch | undefined} */
  stretchAt(kind, s_m) {
    return this.stretches.find((e) => e.kind === kind && s_m >= e.from_m && s_m < e.to_m);
  }
}

/** @param {Float64Array} values per metre @param {number} s_m within @returns {number} */
function blended(values, s_m) {
  const before = Math.min(Math.floor(s_m), values.length - 2);
  const share = s_m - before;
  return values[before] * (1 - share) + values[before + 1] * share;
}

/** @param {Float64Array} rates per metre @returns {Float64Array} */
function integrated(rates) {
  const sums = new Float64Array(rates.length);
  for (let i = 1; i < rates.length; i++) sums[i] = sums[i - 1] + (rates[i - 1] + rates[i]) / 2;
  return sums;
}

/** @param {Float64Array} values @returns {Float64Array} change per metre */
function differences(values) {
  const last = values.length - 1;
  return values.map((_, i) => {
    const [before, after] = [Math.max(i - 1, 0), Math.min(i + 1, last)];
    return (values[after] - values[before]) / (after - before);
  });
}

/** Triangular mean over 8 m; ends keep their direction. @param {Float64Array} values */
function smooth(values) {
  const last = values.length - 1;
  /** @param {number} i */
  const beyond = (i) => {
    if (i < 0) return 2 * values[0] - values[Math.min(-i, last)];
    return i > last ? 2 * values[last] - values[Math.max(2 * last - i, 0)] : values[i];
  };
  return values.map((_, i) => {
    let sum = 0;
    for (let k = 1 - SMOOTHING_M; k < SMOOTHING_M; k++) {
      sum += (SMOOTHING_M - Math.abs(k)) * beyond(i + k);
    }
    return sum / (SMOOTHING_M * SMOOTHING_M);
  });
}

/** @param {Float64Array} x_raw @param {Float64Array} y_raw */
function smoothLine(x_raw, y_raw) {
  const [x_m, y_m] = [smooth(x_raw), smooth(y_raw)];
  const [dx, dy] = [differences(x_m), differences(y_m)];
  const heading_rad = new Float64Array(x_m.length);
  for (let i = 0; i < x_m.length; i++) {
    const heading = Math.atan2(dy[i], dx[i]);
    const turns = i ? Math.round((heading_rad[i - 1] - heading) / (2 * Math.PI)) : 0;
    heading_rad[i] = heading + turns * 2 * Math.PI;
  }
  return { x_m, y_m, heading_rad };
}

/** @param {Float64Array} curvature_per_m with signs */
function lineOf(curvature_per_m) {
  const heading_rad = integrated(smooth(curvature_per_m));
  const x_m = integrated(heading_rad.map(Math.cos));
  const y_m = integrated(heading_rad.map(Math.sin));
  return { x_m, y_m, heading_rad };
}

/**
 * A prepared road without a line does not say to which side it turns. Stretches may; else
 * each curve goes to the other side than the one before it.
 * @param {Float64Array} sharpness
 * @param {Stretch[]} stretches
 */
function signedCurvature(sharpness, stretches) {
  const bends = stretches.filter((each) => each.kind.startsWith("bend_"));
  let side = -1;
  return sharpness.map((value, i) => {
    const bend = bends.find((each) => i >= each.from_m && i < each.to_m);
    const begins = value > STRAIGHT_PER_M && (i === 0 || sharpness[i - 1] <= STRAIGHT_PER_M);
    if (bend) side = bend.kind === "bend_left" ? 1 : -1;
    else if (begins && !bends.length) side = -side;
    return side * value;
  });
}

/** @param {Float64Array} limit_mps @returns {LimitSpan[]} */
function limitSpans(limit_mps) {
  /** @type {LimitSpan[]} */
  const spans = [];
  limit_mps.forEach((limit, i) => {
    const last = spans.at(-1);
    if (last?.limit_mps === limit) last.to_m = i;
    else {
      if (last) last.to_m = i;
      spans.push({ from_m: i, to_m: i, limit_mps: limit });
    }
  });
  return spans;
}

/**
 * Houses stand where the road says so; if it says nothing, where the limit is that of towns.
 * @param {Stretch[]} stretches @param {LimitSpan[]} limits @returns {Stretch[]}
 */
function withTowns(stretches, limits) {
  if (stretches.some((each) => each.kind === "village")) return stretches;
  const slow = limits.filter(
    (span) => span.limit_mps < TOWN_LIMIT_MPS + 0.1 && span.to_m - span.from_m >= TOWN_MIN_M,
  );
  const towns = slow.map(({ from_m, to_m }) => ({
    kind: /** @type {const} */ ("village"),
    from_m,
    to_m,
    name: "",
  }));
  return [...stretches, ...towns];
}
