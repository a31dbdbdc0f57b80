import assert from "node:assert/strict";
import { test } from "node:test";

import { frameAt, Interpolation } from "../../../fmu_src/pldf/cockpit/page/engine/interpolation.js";
import { Lateral } from "../../../fmu_src/pldf/cockpit/page/engine/lateral.js";
import { Person, RELEASED, Repeated } from "../../../fmu_src/pldf/cockpit/page/engine/person.js";

/** @typedef {import("../../../fmu_src/pldf/cockpit/page/types.js").Frame} Frame */

/**
 * @param {number} time_s
 * @param {Frame["values"]} [values]
 * @returns {Frame}
 */
function frame(time_s, values = {}) {
  return {
    time_s,
    lateral_m: 0,
    heading_rad: 0,
    values: { "vehicle.s_m": 20 * time_s, mode: Math.floor(time_s), ...values },
  };
}

/**
 * @param {Frame | null} shown
 * @returns {Frame}
 */
function there(shown) {
  assert.ok(shown);
  return shown;
}

test("between two frames what moves is in between, and all else is as before", () => {
  const shown = there(frameAt([frame(1), frame(1.5), frame(2)], 1.75));
  assert.equal(shown.values["vehicle.s_m"], 35);
  assert.equal(shown.values.mode, 1);
  assert.equal(there(frameAt([frame(1), frame(2)], 0)).time_s, 1);
  assert.equal(there(frameAt([frame(1), frame(2)], 9)).time_s, 2);
  assert.equal(frameAt([], 1), null);
});

test("a car that appears ahead comes from nowhere", () => {
  const before = frame(1, { "lead.present": false, "lead.gap_m": 0 });
  const after = frame(2, { "lead.present": true, "lead.gap_m": 80 });
  assert.equal(there(frameAt([before, after], 1.5)).values["lead.gap_m"], 0);
});

test("jittered messages make a steady picture", () => {
  const shown = new Interpolation();
  /** @type {number[]} */
  const places = [];
  for (let k = 0; k < 300; k += 1) {
    shown.push(frame(0.01 * k), 5000 + 10 * k + 8 * Math.sin(12.9898 * k) ** 2);
    if (k > 50) {
      places.push(Number(there(shown.at(5010 + 10 * k)).values["vehicle.s_m"]));
    }
  }
  const moved = places.slice(1).map((place, at) => place - places[at]);
  assert.ok(Math.max(...moved.map((way) => Math.abs(way - 0.2))) < 0.02, `${moved}`);
});

test("behind a pause the picture goes on at once", () => {
  const shown = new Interpolation();
  [0, 0.01, 0.02].forEach((time_s) => shown.push(frame(time_s), 1000 * time_s));
  [0.03, 0.04, 0.05, 0.06].forEach((time_s) => shown.push(frame(time_s), 60000 + 1000 * time_s));
  const { time_s } = there(shown.at(60070));
  assert.ok(time_s > 0.03 && time_s < 0.06, `${time_s}`);
});

test("what a person does holds from the next step on; a contact between two steps is seen", () => {
  const person = new Person(0.01, false);
  person.advance(0);
  person.take({ ...RELEASED, gas_pedal: 0.3, up: true });
  person.take({ ...RELEASED, gas_pedal: 0.4 });
  person.advance(1);
  person.advance(2);
  assert.deepEqual(person.changes, [
    { step: 1, name: "driver.gas_pedal", value: 0.4 },
    { step: 1, name: "lever.up", value: 1 },
    { step: 2, name: "lever.up", value: 0 },
  ]);
});

test("RESUME is pressed for the person at the start, at the time the driver FMU does it", () => {
  const person = new Person(0.1, true);
  Array.from({ length: 30 }, (_, step) => person.advance(step));
  assert.deepEqual(person.changes, [
    { step: 10, name: "lever.resume", value: 1 },
    { step: 13, name: "lever.resume", value: 0 },
  ]);
});

test("repeated, the inputs are the same at every step", () => {
  const person = new Person(0.01, true);
  for (let step = 0; step < 500; step += 1) {
    person.take({ ...RELEASED, gas_pedal: Math.max(0, Math.sin(step)), undo: step % 7 === 0 });
    person.advance(step);
  }
  const repeated = new Repeated(person.changes);
  const again = Array.from({ length: 500 }, (_, step) => {
    repeated.advance(step);
    return repeated.values.get("driver.gas_pedal");
  });
  assert.equal(again[7], Math.sin(7));
  assert.deepEqual(repeated.changes, person.changes);
});

test("a car that is not steered leaves its lane in a curve, one that is steered stays", () => {
  const curve_per_m = 1 / 300;
  /** @param {number} steering */
  const drive = (steering) => {
    const lateral = new Lateral(() => curve_per_m, { left_m: 5, right_m: 2 });
    for (let k = 0; k < 600; k += 1) {
      lateral.step(steering, 20, 0, 0.01);
    }
    return lateral.lateral_m;
  };
  assert.equal(drive(0), -3); // a left curve carries it out to the right, to the edge and a metre
  assert.ok(Math.abs(drive(curve_per_m / (4 / 400))) < 0.01);
});
