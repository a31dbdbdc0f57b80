import assert from "node:assert/strict";
import { test } from "node:test";

import { Braking } from "../../../fmu_src/pldf/cockpit/page/view/braking.js";
import { Motor } from "../../../fmu_src/pldf/cockpit/page/view/motor.js";
import { furnitureOf, signText } from "../../../fmu_src/pldf/cockpit/page/view/plan.js";
import { crossSection } from "../../../fmu_src/pldf/cockpit/page/view/profile.js";
import { Sharpness } from "../../../fmu_src/pldf/cockpit/page/view/sharpness.js";
import { roadModel } from "./road_support.mjs";

const KMH = 1 / 3.6;

/** A curve to the left from 300 to 400 m. @param {number} radius_m @param {number} limit_kmh */
function curvy(radius_m, limit_kmh) {
  const bent = (/** @type {number} */ s) => (s >= 300 && s < 400 ? 1 / radius_m : 0);
  return roadModel(800, { curvature_per_m: bent, limit_mps: () => limit_kmh * KMH });
}

test("a sign stands where a limit begins, with its number", () => {
  const limit_mps = (/** @type {number} */ s) => [100, 80, 50, 80][Math.floor(s / 250)] * KMH;
  const { signs } = furnitureOf(roadModel(999, { limit_mps }));
  const limits = signs.filter((sign) => sign.kind === "limit");
  assert.deepEqual(
    limits.map((sign) => [sign.s_m, sign.text]),
    [
      [25, "100"],
      [250, "80"],
      [500, "50"],
      [750, "80"],
    ],
  );
});

test("a limit of 30 mph is shown as that, one of 50 km/h as 50", () => {
  assert.deepEqual(signText(30 * 0.44704), { text: "30", unit: "mph" });
  assert.deepEqual(signText(50 * KMH), { text: "50", unit: "" });
  assert.deepEqual(signText(120 * KMH), { text: "120", unit: "" });
  assert.deepEqual(signText(5 * KMH), { text: "5", unit: "" });
});

test("a village has its sign at both ends", () => {
  const stretches = [
    { kind: /** @type {const} */ ("village"), from_m: 100, to_m: 300, name: "Au" },
  ];
  const { signs, posts } = furnitureOf(roadModel(500, {}, { stretches }));
  const town = signs.filter((sign) => sign.kind.startsWith("town"));
  assert.deepEqual(
    town.map((sign) => [sign.kind, sign.s_m, sign.text]),
    [
      ["town", 100, "Au"],
      ["town_end", 300, "Au"],
    ],
  );
  assert.ok(posts.every((s_m) => s_m < 100 || s_m >= 300) && posts.length > 3);
});

test("boards stand on the outside of curves that are sharp for their limit, and point into them", () => {
  const { boards, curves, signs, rails } = furnitureOf(curvy(120, 80));
  assert.equal(curves.length, 1);
  assert.ok(curves[0].sharp && curves[0].left);
  assert.ok(
    boards.length >= 3 && boards.every((b) => !b.left && b.to_left && b.s_m > 290 && b.s_m < 410),
  );
  const warning = signs.find((sign) => sign.kind === "curve_left");
  assert.ok(warning && warning.s_m > 150 && warning.s_m < 200);
  assert.ok(rails.every((rail) => !rail.left));
  assert.deepEqual(furnitureOf(curvy(120, 40)).boards, []);
});

test("the cross-section has a line between any two lanes", () => {
  const kinds = (/** @type {Parameters<typeof roadModel>[2]} */ about) =>
    crossSection(roadModel(10, {}, about)).lines.map((line) => [line.at_m, line.kind]);
  assert.deepEqual(kinds({}), [
    [3.5, "edge"],
    [-3.5, "edge"],
    [0, "middle"],
  ]);
  assert.deepEqual(kinds({ lanes_right: 2, lanes_left: 1 }), [
    [3.5, "edge"],
    [-7, "edge"],
    [0, "middle"],
    [-3.5, "lane"],
  ]);
  assert.deepEqual(kinds({ lanes_right: 2, lanes_left: 0, traffic: "LHT" }), [
    [7, "edge"],
    [-0, "edge"],
    [3.5, "lane"],
  ]);
});

test("the motor turns faster with speed within a gear and shifts up", () => {
  const motor = new Motor();
  const gears = [];
  let [before_hz, gear] = [0, 0];
  for (let speed_mps = 0; speed_mps < 40; speed_mps += 0.1) {
    const { motor_hz } = motor.noise({ speed_mps, acceleration_mps2: 1, gas_pedal: 0 });
    assert.ok(motor_hz >= before_hz || motor.gear > gear);
    assert.ok(motor_hz >= 28 && motor_hz < 150);
    if (motor.gear !== gear) gears.push(motor.gear);
    [before_hz, gear] = [motor_hz, motor.gear];
  }
  assert.deepEqual(gears, [1, 2, 3, 4, 5]);
});

test("wind and road are louder the faster one drives, the motor with the foot on the gas", () => {
  const at = (/** @type {number} */ speed_mps, gas_pedal = 0) =>
    new Motor().noise({ speed_mps, acceleration_mps2: 0, gas_pedal });
  assert.ok(at(30).wind > 2 * at(15).wind && at(30).road > at(15).road && at(0).wind === 0);
  assert.ok(at(20, 1).motor > at(20, 0).motor);
});

/** @param {Sharpness} sharpness */
function shown(sharpness) {
  let now_ms = 0;
  return (/** @type {number} */ count, /** @type {number} */ each_ms) => {
    for (let k = 0; k < count; k++) sharpness.frame((now_ms += each_ms));
    return sharpness.ratio;
  };
}

test("a slow machine gets fewer pixels, a fast one all again, a pause changes nothing", () => {
  const frames = shown(new Sharpness(1, true));
  assert.equal(frames(25, 40), 1);
  assert.equal(frames(20, 60), 0.8);
  assert.equal(frames(600, 60), 0.5);
  assert.equal(frames(50, 5000), 0.5);
  assert.equal(frames(1e6, 10), 1);
});

test("with a graphics card the picture is to be smooth, and the pixels do not go to and fro", () => {
  const sharpness = new Sharpness(2, false);
  let [now_ms, changes] = [0, 0];
  for (let frame = 0; frame < 6000; frame++) {
    now_ms += sharpness.ratio > 1.5 ? 30 : 16.7;
    changes += Number(sharpness.frame(now_ms));
  }
  assert.ok(changes >= 2 && changes <= 12, `${changes} changes`);
});

test("a warning stands behind the curve before its own, or not at all", () => {
  const bent = (/** @type {number} */ s) =>
    [300, 420, 490].some((from) => s >= from && s < from + 50) ? 0.01 : 0;
  const { signs } = furnitureOf(
    roadModel(
      800,
      { curvature_per_m: bent, limit_mps: () => 22 },
      {
        stretches: [
          { kind: "bend_left", from_m: 290, to_m: 360, name: "" },
          { kind: "bend_right", from_m: 410, to_m: 480, name: "" },
          { kind: "bend_left", from_m: 485, to_m: 550, name: "" },
        ],
      },
    ),
  );
  const warnings = signs.filter((sign) => sign.kind.startsWith("curve"));
  assert.deepEqual(
    warnings.map((sign) => sign.kind),
    ["curve_left", "curve_right"],
  );
  assert.ok(warnings[1].s_m > 350 && warnings[1].s_m < 360);
});

test("the car ahead shows when it brakes, not when the picture is drawn twice or jumps", () => {
  const braking = new Braking();
  let [s_m, lead_mps] = [0, 20];
  const drive = (/** @type {number} */ frames, /** @type {number} */ accelerates_mps2) => {
    let lit = false;
    for (let k = 0; k < frames; k++) {
      s_m += 20 / 60;
      lead_mps += accelerates_mps2 / 60;
      lit = braking.ahead(s_m, 20, lead_mps);
      assert.equal(braking.ahead(s_m, 20, lead_mps), lit);
    }
    return lit;
  };
  assert.equal(drive(60, 0), false);
  assert.equal(drive(30, -3), true);
  assert.equal(drive(30, -0.3), false);
  s_m = 5;
  lead_mps = 2;
  assert.equal(drive(4, 0), false);
});

test("a screen that shows 30 pictures a second keeps its pixels", () => {
  const frames = shown(new Sharpness(2, false));
  frames(21, 33);
  assert.equal(frames(20, 33), 2);
  assert.equal(frames(2000, 33), 2);
  assert.equal(frames(21, 50), 1.6);
});
