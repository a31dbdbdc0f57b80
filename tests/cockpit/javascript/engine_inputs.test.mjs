import assert from "node:assert/strict";
import { test } from "node:test";

import {
  Calibrating,
  CONTROLS,
  inverted,
  isPressed,
  STANDARD,
  travelOf,
} from "../../../fmu_src/pldf/cockpit/page/engine/inputs/calibration.js";
import { Lever } from "../../../fmu_src/pldf/cockpit/page/engine/inputs/lever.js";

/** @typedef {import("../../../fmu_src/pldf/cockpit/page/engine/inputs/calibration.js").Calibration} Calibration */
/** @typedef {import("../../../fmu_src/pldf/cockpit/page/engine/inputs/calibration.js").Control} Control */
/** @typedef {import("../../../fmu_src/pldf/cockpit/page/engine/inputs/lever.js").Contact} Contact */

/**
 * @param {number[]} axes
 * @param {number[]} pressed buttons
 */
function device(axes = [0, 1, 1], pressed = []) {
  const buttons = Array.from({ length: 12 }, (_, at) => ({
    value: pressed.includes(at) ? 1 : 0,
    pressed: pressed.includes(at),
  }));
  return { axes, buttons };
}

/**
 * Return how often each contact closes if it is looked at each `every_ms`.
 * @param {Lever} lever
 * @param {number} from_ms
 * @param {number} to_ms
 * @param {number} every_ms
 */
function closings(lever, from_ms, to_ms, every_ms) {
  /** @type {Record<string, number>} */
  const counts = {};
  /** @type {Partial<Record<Contact, boolean>>} */
  let before = {};
  for (let now_ms = from_ms; now_ms < to_ms; now_ms += every_ms) {
    const contacts = lever.contacts(now_ms);
    for (const [name, closed] of Object.entries(contacts)) {
      const opened = !before[/** @type {Contact} */ (name)];
      counts[name] = (counts[name] ?? 0) + Number(closed && opened);
    }
    before = contacts;
  }
  return Object.fromEntries(Object.entries(counts).filter(([, count]) => count > 0));
}

test("let go early the lever makes a short tip, held a long one, once and before it is let go", () => {
  const lever = new Lever();
  lever.hold("up", true, 0);
  assert.deepEqual(closings(lever, 0, 200, 10), {});
  lever.hold("up", false, 200);
  assert.deepEqual(closings(lever, 200, 1000, 10), { up: 1 });
  lever.hold("down", true, 1000);
  assert.deepEqual(closings(lever, 1000, 3000, 10), { down_long: 1 });
  lever.hold("down", false, 3000);
  assert.deepEqual(closings(lever, 3000, 4000, 10), {});
});

test("a long tip is none less if nobody looked while the lever was held", () => {
  const lever = new Lever();
  lever.hold("up", true, 0);
  lever.hold("up", false, 700);
  assert.deepEqual(closings(lever, 700, 2000, 10), { up_long: 1 });
});

test("tips that were made while a picture was missing all count, one after the other", () => {
  const lever = new Lever();
  for (const at of [0, 90, 180]) {
    lever.hold("up", true, at);
    lever.hold("up", false, at + 45);
  }
  assert.deepEqual(closings(lever, 300, 2000, 16), { up: 3 });
});

test("a tip is seen however seldom one looks", () => {
  const lever = new Lever();
  lever.hold("resume", true, 0);
  lever.hold("resume", false, 20);
  assert.deepEqual(closings(lever, 400, 2000, 400), { resume: 1 });
});

test("RESUME acts when it is pressed, and once", () => {
  const lever = new Lever();
  lever.hold("resume", true, 0);
  assert.equal(lever.contacts(1).resume, true);
  lever.hold("resume", true, 900);
  assert.deepEqual(closings(lever, 200, 2000, 10), {});
});

test("each control is found by pressing it, an axis that rests at its end among them", () => {
  const calibrating = new Calibrating(device());
  /** @type {Partial<Record<Control, ReturnType<typeof device>>>} */
  const press = {
    gas: device([0, -1, 1]),
    brake: device([0, 1, -1]),
    steering: device([-1, 1, 1]),
    resume: device([0, 1, 1], [3]),
    up: device([0, 1, 1], [5]),
  };
  for (const control of CONTROLS) {
    assert.equal(calibrating.control, control);
    const pressed = press[control];
    if (pressed) {
      calibrating.look(device());
      assert.equal(calibrating.look(pressed), false);
      assert.equal(calibrating.travel, 1);
      assert.equal(calibrating.look(device()), true);
    } else {
      calibrating.skip();
    }
  }
  const { calibration } = calibrating;
  assert.equal(calibrating.control, null);
  assert.ok(calibrating.complete);
  assert.equal(travelOf(calibration, "gas", device([0, -1, 1])), 1);
  assert.equal(travelOf(calibration, "gas", device()), 0);
  assert.equal(travelOf(calibration, "steering", device([-1, 1, 1])), 1);
  assert.equal(travelOf(calibration, "steering", device([1, 1, 1])), -1);
  assert.equal(isPressed(calibration, "resume", device([0, 1, 1], [3])), true);
  assert.equal(isPressed(calibration, "up", device([0, 1, 1], [3])), false);
  assert.equal(travelOf(calibration, "undo", device([1, 1, 1], [7])), 0);
});

test("a control that is taken is not found again, though its pedal is still pressed", () => {
  const calibrating = new Calibrating(device());
  calibrating.look(device([0, -1, 1]));
  calibrating.look(device([0, 0.4, 1]));
  assert.equal(calibrating.control, "brake");
  assert.equal(calibrating.look(device([0, -1, 1])), false);
  assert.equal(calibrating.travel, 0);
});

test("gas and brake may share an axis, one each way", () => {
  const calibrating = new Calibrating(device([0, 0, 0]));
  for (const pressed of [device([0, -1, 0]), device([0, 1, 0])]) {
    calibrating.look(pressed);
    calibrating.look(device([0, 0, 0]));
  }
  const { calibration } = calibrating;
  assert.equal(calibrating.control, "steering");
  const braking = device([0, 1, 0]);
  assert.equal(travelOf(calibration, "gas", braking), 0);
  assert.equal(travelOf(calibration, "brake", braking), 1);
});

test("without pedals the device cannot drive", () => {
  const calibrating = new Calibrating(device());
  CONTROLS.forEach(() => calibrating.skip());
  assert.equal(calibrating.complete, false);
});

test("the dead zone takes nothing from the rest of the travel", () => {
  /** @type {Calibration} */
  const calibration = {
    dead_zone: 0.1,
    controls: { gas: { kind: "axis", index: 0, rest: 1, full: -1 } },
  };
  /** @param {number} share */
  const travel = (share) => travelOf(calibration, "gas", device([1 - 2 * share]));
  assert.equal(travel(0.09), 0);
  assert.ok(Math.abs(travel(0.55) - 0.5) < 1e-12);
  assert.equal(travel(1), 1);
  assert.equal(travel(1.2), 1);
  assert.equal(travel(-0.5), 0);
});

test("inverted, a pedal rests at its other end and the wheel turns the other way", () => {
  /** @type {Calibration["controls"]} */
  const controls = {
    gas: { kind: "axis", index: 1, rest: -1, full: 1 },
    steering: { kind: "axis", index: 0, rest: 0.1, full: -0.9 },
  };
  const calibration = { dead_zone: 0, controls };
  assert.equal(travelOf(inverted(calibration, "gas"), "gas", device([0, -1, 0])), 1);
  const left = travelOf(calibration, "steering", device([-0.9]));
  assert.equal(travelOf(inverted(calibration, "steering"), "steering", device([-0.9])), -left);
  assert.deepEqual(inverted(inverted(STANDARD, "gas"), "gas"), STANDARD);
});
