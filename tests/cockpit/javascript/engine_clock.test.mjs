import assert from "node:assert/strict";
import { test } from "node:test";

import { CATCH_UP_MAX_MS, StepClock } from "../../../fmu_src/pldf/cockpit/page/engine/clock.js";

const STEP_S = 0.01;

function started() {
  const clock = new StepClock(STEP_S);
  clock.start(1000);
  return clock;
}

test("the first step is due at once, and each at its time", () => {
  const clock = started();
  assert.equal(clock.due(1000).steps, 1);
  assert.equal(clock.due(1009.9).steps, 0);
  assert.equal(clock.due(1010.1).steps, 1);
});

test("a jittered hour has exactly the steps of an hour, none swallowed", () => {
  const clock = started();
  let steps = 0;
  let lost_ms = 0;
  for (let k = 0; k < 3600 * 60; k += 1) {
    const jitter_ms = 9 * Math.sin(12.9898 * k) ** 2;
    const due = clock.due(1000 + (k * 1000) / 60 + jitter_ms);
    steps += due.steps;
    lost_ms += due.lost_ms;
  }
  assert.equal(lost_ms, 0);
  assert.ok(Math.abs(steps - 3600 / STEP_S) <= 3, `${steps}`);
});

test("a delay that can be caught up is caught up, with its size", () => {
  const clock = started();
  clock.due(1000);
  const due = clock.due(1010 + 70);
  assert.deepEqual(due, { steps: 8, late_ms: 70, lost_ms: 0 });
  assert.equal(clock.due(1081).steps, 0);
});

test("a longer one is lost, and told with its size; the drive goes on from there", () => {
  const clock = started();
  clock.due(1000);
  const due = clock.due(1010 + CATCH_UP_MAX_MS + 250);
  assert.deepEqual(due, { steps: 1, late_ms: 350, lost_ms: 350 });
  assert.equal(clock.due(1360 + 9).steps, 0);
  assert.equal(clock.due(1360 + 10).steps, 1);
});

test("before it was started nothing is due", () => {
  assert.equal(new StepClock(STEP_S).due(5).steps, 0);
});

test("steps longer than what is caught up are no loss", () => {
  const clock = new StepClock(0.5);
  clock.start(0);
  assert.equal(clock.due(0).steps, 1);
  assert.deepEqual(clock.due(700), { steps: 1, late_ms: 200, lost_ms: 0 });
});
