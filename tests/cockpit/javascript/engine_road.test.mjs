import assert from "node:assert/strict";
import { test } from "node:test";

import { crc32 } from "../../../fmu_src/pldf/cockpit/page/engine/crc32.js";
import { readPrepared } from "../../../fmu_src/pldf/cockpit/page/engine/prepared.js";
import { preparedRoad, roadModel, summed } from "./road_support.mjs";

/** @param {number} value @param {number} wanted @param {number} tolerance */
function near(value, wanted, tolerance) {
  assert.ok(Math.abs(value - wanted) <= tolerance, `${value} instead of ${wanted}`);
}

test("the check sum is that of zlib", () => {
  assert.equal(crc32(new TextEncoder().encode("123456789")), 0xcbf43926);
});

test("a prepared road is read with its marks", () => {
  const marks = [
    "mark 0 road 12 Hauptstraße",
    "mark 1230500 road_against 7",
    "mark 5000 sign 50 km/h",
  ];
  const read = readPrepared(preparedRoad(20, { marks, limit_mps: (s) => 10 + s }));
  assert.equal(read.key, "0123456789abcdef");
  assert.deepEqual(read.marks[0], { s_m: 0, kind: "road", name: "12 Hauptstraße" });
  assert.deepEqual(read.marks[1], { s_m: 1230.5, kind: "road_against", name: "7" });
  assert.equal(read.limit_mps[20], 30);
  assert.equal(read.has_line, false);
});

test("what is no prepared road, or a damaged one, is refused with a reason", () => {
  const whole = preparedRoad(20);
  const changed = whole.slice();
  changed[200] ^= 1;
  const text = new TextDecoder("latin1").decode(whole);
  const script = new TextEncoder().encode(text.slice(0, 128).replace("kind route", "kind script"));
  const cases = /** @type {[Uint8Array, RegExp][]} */ ([
    [new TextEncoder().encode("s_m,speed\n1,2\n"), /not a prepared road/],
    [new Uint8Array(), /not a prepared road/],
    [whole.slice(0, 40), /header is cut off/],
    [whole.slice(0, -9), /cut off or too long/],
    [changed, /damaged/],
    [summed([...script]), /a prepared script/],
  ]);
  for (const [bytes, reason] of cases)
    assert.throws(() => readPrepared(bytes), { message: reason });
});

test("the model follows its line, and heights are the sum of grades", () => {
  const radius = 100;
  const road = roadModel(300, {
    x_m: (s) => radius * Math.sin(s / radius),
    y_m: (s) => radius * (1 - Math.cos(s / radius)),
    curvature_per_m: () => 1 / radius,
    grade: (s) => s / 10_000,
  });
  near(road.curvatureAt(150.5), 1 / radius, 1e-4);
  near(road.at(200).heading_rad, 2, 1e-3);
  near(road.at(200).z_m, 2, 1e-6);
  const inside = road.at(150, 10);
  near(Math.hypot(inside.x_m, inside.y_m - radius), radius - 10, 0.05);
  near(road.at(200).pitch_rad, Math.atan(0.02), 1e-9);
});

test("beyond its ends a road goes straight on", () => {
  const road = roadModel(100, { x_m: (s) => s, y_m: () => 0 });
  near(road.at(-20).x_m, -20, 1e-9);
  near(road.at(130, 2).x_m, 130, 1e-9);
  near(road.at(130, 2).y_m, 2, 1e-9);
});

test("the view does not jump where the line bends at a knot", () => {
  const road = roadModel(100, {
    x_m: (s) => (s < 50 ? s : 50 + (s - 50) * Math.cos(0.3)),
    y_m: (s) => (s < 50 ? 0 : (s - 50) * Math.sin(0.3)),
  });
  for (let s_m = 1; s_m <= 100; s_m++) {
    near(road.heading_rad[s_m] - road.heading_rad[s_m - 1], 0, 0.08);
  }
  near(road.heading_rad[100], 0.3, 1e-6);
});

test("a heading may turn round and round without a jump", () => {
  const radius = 30;
  const road = roadModel(400, {
    x_m: (s) => radius * Math.cos(s / radius),
    y_m: (s) => radius * Math.sin(s / radius),
  });
  near(road.heading_rad[400] - road.heading_rad[0], 400 / radius, 0.1);
});

test("without a line the bends' sides come from stretches, else they take turns", () => {
  const made = {
    curvature_per_m: (/** @type {number} */ s) => (s % 100 > 50 && s % 100 < 90 ? 0.01 : 0),
  };
  const turns = roadModel(300, made);
  assert.deepEqual(
    [70, 170, 270].map((s) => Math.sign(turns.curvatureAt(s))),
    [1, -1, 1],
  );
  const bend = (/** @type {number} */ from_m) => ({
    kind: /** @type {const} */ ("bend_right"),
    from_m,
    to_m: from_m + 45,
    name: "",
  });
  const told = roadModel(300, made, { stretches: [bend(48), bend(148), bend(248)] });
  assert.deepEqual(
    [70, 170, 270].map((s) => Math.sign(told.curvatureAt(s))),
    [-1, -1, -1],
  );
});

test("the driven lane is the outer one on the side of the traffic", () => {
  const lane = { lane_width_m: 3, lanes_right: 2, lanes_left: 1 };
  assert.equal(roadModel(10, {}, lane).lane_m, -4.5);
  assert.equal(roadModel(10, {}, { ...lane, traffic: "LHT" }).lane_m, 4.5);
});

test("limits are spans, and slow ones are villages where the road names none", () => {
  const made = {
    limit_mps: (/** @type {number} */ s) => (s >= 100 && s < 400 ? 50 / 3.6 : 100 / 3.6),
  };
  const road = roadModel(600, made);
  assert.deepEqual(
    road.limits.map((span) => [span.from_m, span.to_m]),
    [
      [0, 100],
      [100, 400],
      [400, 600],
    ],
  );
  assert.equal(road.limitAt(399.9), 50 / 3.6);
  assert.equal(road.limitAt(400), 100 / 3.6);
  assert.deepEqual(road.stretchAt("village", 250)?.from_m, 100);
  const named = { kind: /** @type {const} */ ("village"), from_m: 500, to_m: 600, name: "Au" };
  assert.equal(roadModel(600, made, { stretches: [named] }).stretchAt("village", 250), undefined);
});
