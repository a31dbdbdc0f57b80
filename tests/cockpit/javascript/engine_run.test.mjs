import assert from "node:assert/strict";
import { test } from "node:test";

import { Drive } from "../../../fmu_src/pldf/cockpit/page/engine/drive.js";
import { Person, RELEASED } from "../../../fmu_src/pldf/cockpit/page/engine/person.js";
import { Recorder } from "../../../fmu_src/pldf/cockpit/page/engine/recording.js";
import { Run } from "../../../fmu_src/pldf/cockpit/page/engine/run.js";

const STEP_S = 0.01;

/** A drive of 10 s without FMUs, and the time. */
function standing() {
  const time = { now_ms: 5000 };
  const drive = {
    step_s: STEP_S,
    steps: 0,
    time_s: 0,
    person: new Person(STEP_S, false),
    advance() {
      if (drive.steps === 1000) {
        return { ending: "arrived", reason: "" };
      }
      drive.time_s = drive.steps * STEP_S;
      drive.steps += 1;
      return null;
    },
    /** @type {(...left: unknown[]) => unknown} */
    finish: (end, interruptions, timing) => ({ end, interruptions, timing }),
    /** @type {(...left: unknown[]) => unknown} */
    fail: (reason, interruptions, timing) => ({ reason, interruptions, timing }),
  };
  const run = new Run(/** @type {Drive} */ (/** @type {unknown} */ (drive)), () => time.now_ms);
  return { time, drive, run };
}

test("a drive waits for its driver, and that is no interruption", () => {
  const { time, drive, run } = standing();
  time.now_ms += 60_000;
  run.tick();
  assert.equal(drive.steps, 0);
  run.resume();
  run.tick();
  assert.equal(drive.steps, 1);
  assert.deepEqual(run.interruptions, []);
});

test("a drive that has not begun can be held back, and that is no interruption, either", () => {
  const { time, drive, run } = standing();
  run.pause("hidden");
  run.pause("asked for");
  assert.equal(run.paused?.reason, "hidden");
  time.now_ms += 9000;
  run.resume();
  run.tick();
  assert.deepEqual([drive.steps, run.interruptions], [1, []]);
});

test("in real time 10 s take 10 s, however jittered", () => {
  const { time, drive, run } = standing();
  run.resume();
  let end = null;
  for (let k = 0; end === null; k += 1) {
    time.now_ms += 4 + 30 * Math.sin(12.9898 * k) ** 2;
    end = run.tick();
  }
  assert.deepEqual(end, { ending: "arrived", reason: "" });
  assert.ok(Math.abs(time.now_ms - 5000 - 10_000) < 40, `${time.now_ms}`);
  const { timing, interruptions } = run.finish(end);
  assert.deepEqual(interruptions, []);
  assert.equal(timing.steps, drive.steps);
  assert.ok(timing.late_steps > 500 && timing.late_max_ms < 45);
});

test("a pause is kept with when, how long and why", () => {
  const { time, run } = standing();
  run.resume();
  for (let k = 0; k < 100; k += 1) {
    time.now_ms += 10;
    run.tick();
  }
  run.pause("hidden");
  run.pause("disconnected");
  time.now_ms += 7000;
  run.tick();
  run.resume();
  run.resume();
  const [{ time_s, lost_s, reason }, ...more] = run.interruptions;
  assert.ok(Math.abs(time_s - 1) < 0.015, `${time_s}`);
  assert.deepEqual([lost_s, reason, more], [7, "hidden", []]);
});

test("a pause in which the drive ends is kept, too, and only once", () => {
  const { time, run } = standing();
  run.resume();
  run.pause("hidden");
  time.now_ms += 500;
  const end = { ending: /** @type {const} */ ("stopped"), reason: "unwell" };
  assert.equal(run.finish(end).interruptions.length, 1);
  assert.equal(run.fail("cannot write").interruptions.length, 1);
});

test("who pauses has let go of everything when the drive goes on", () => {
  const { drive, run } = standing();
  run.resume();
  drive.person.take({ ...RELEASED, gas_pedal: 0.7, pause_learning: true });
  run.pause("hidden");
  run.resume();
  drive.person.advance(5);
  assert.deepEqual(drive.person.changes, [{ step: 5, name: "teach.pause", value: 1 }]);
});

test("what is pressed while the drive stands is not done, but for the driver's last word", () => {
  const { drive, run } = standing();
  run.resume();
  run.hear({ ...RELEASED, down: true });
  run.pause("asked for");
  run.hear({ ...RELEASED, gas_pedal: 1, up: true, forget_here: true });
  run.hear({ ...RELEASED });
  run.resume();
  drive.person.advance(7);
  assert.deepEqual(drive.person.changes, [
    { step: 7, name: "lever.down", value: 1 },
    { step: 7, name: "teach.forget_here", value: 1 },
  ]);
});

test("a machine that is too slow for a moment leaves a note, and the drive goes on", () => {
  const { time, drive, run } = standing();
  run.resume();
  run.tick();
  time.now_ms += 420; // of which the first 10 are a step
  run.tick();
  assert.equal(run.paused, null);
  assert.deepEqual(run.interruptions, [{ time_s: 0, lost_s: 0.41, reason: "late" }]);
  assert.equal(drive.steps, 2);
});

test("a machine that stood still for long lets the drive stand, with all the time that was lost", () => {
  const { time, drive, run } = standing();
  run.resume();
  run.tick();
  time.now_ms += 3010;
  run.tick();
  assert.equal(run.paused?.reason, "late");
  assert.equal(drive.steps, 1);
  time.now_ms += 1000;
  run.resume();
  assert.deepEqual(run.interruptions, [{ time_s: 0, lost_s: 4, reason: "late" }]);
});

test("a machine that is always too slow lets the drive stand", () => {
  const { time, run } = standing();
  run.resume();
  for (let k = 0; k < 50 && run.paused === null; k += 1) {
    time.now_ms += 250;
    run.tick();
  }
  assert.equal(run.paused?.reason, "late");
});

test("a page that is stuck lets the drive stand; one that never said anything does not", () => {
  const { time, drive, run } = standing();
  /** @param {number} till_ms */
  const driveTill = (till_ms) => {
    for (; time.now_ms < till_ms; time.now_ms += 10) {
      run.tick();
    }
  };
  const paused = () => run.paused?.reason ?? "";
  run.resume();
  driveTill(8000);
  assert.equal(paused(), "");
  run.hear({ ...RELEASED, gas_pedal: 0.5 });
  driveTill(8900);
  assert.equal(paused(), "");
  assert.equal(drive.person.now.gas_pedal, 0.5);
  driveTill(9100);
  assert.equal(paused(), "late");
  assert.equal(drive.person.now.gas_pedal, 0);
  time.now_ms = 20_000;
  run.resume();
  driveTill(20_500);
  assert.equal(paused(), "");
});

test("as fast as possible nothing is late, and others are heard in between", () => {
  const { time, drive, run } = standing();
  const advance = drive.advance;
  drive.advance = () => {
    time.now_ms += 1;
    return advance();
  };
  run.resume();
  assert.equal(run.hurry(), null);
  assert.ok(drive.steps < 100);
  let end = null;
  while (end === null) {
    end = run.hurry();
  }
  const { timing, interruptions } = run.finish(end);
  assert.deepEqual([timing.late_steps, timing.late_max_ms, interruptions], [0, 0, []]);
  assert.ok(Math.abs(timing.step_us - 1000) < 2);
});

test("a drive whose FMUs answer no more still leaves its recording", () => {
  const silent = () => {
    throw new WebAssembly.RuntimeError("unreachable");
  };
  const drive = Object.assign(Object.create(Drive.prototype), {
    setup: { who: "person", device: "keyboard", steering: "assisted", profiles: { a: 1 } },
    recorder: new Recorder(new Map([["vehicle.s_m", () => 5]]), new Map(), STEP_S),
    driving: new Person(STEP_S, false),
    coupling: { parts: new Map([["pldf", { instance: { messages: silent } }]]) },
  });
  drive.recorder.row();
  const timing = { steps: 1, late_steps: 0, late_max_ms: 0, step_us: 0 };
  const { recording, profiles, ending, messages } = drive.fail("unreachable", [], timing);
  assert.match(recording, /\ntime_s,s_m\n0.0,5.0\n$/);
  assert.deepEqual([profiles, ending, messages], [{ a: 1 }, "failed", []]);
});
