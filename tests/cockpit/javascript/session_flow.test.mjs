// The guided session as a state machine: its steps, what leads on, and what changes nothing.
import assert from "node:assert/strict";
import test from "node:test";

import { moved, placeOf, stepsOf } from "../../../fmu_src/pldf/cockpit/page/session/flow.js";
import {
  participantOf,
  pseudonym,
} from "../../../fmu_src/pldf/cockpit/page/session/participant.js";
import { plan, questionnaire } from "./session_support.mjs";

/** @param {import("../../../fmu_src/pldf/cockpit/page/session/flow.js").Step[]} steps */
const ids = (steps) => steps.map((step) => step.id);

test("the steps are those of the plan, in the order of the person", () => {
  const asked = [questionnaire("laan", ["A2", "B2"]), questionnaire("last", ["end"])];
  assert.deepEqual(ids(stepsOf(plan({ breaks: { A2: 5, B2: 5 } }), asked, "AB")), [
    "welcome",
    "consent",
    "device",
    "practice 1",
    "drive A1",
    "drive A2",
    "questionnaire A2 laan",
    "break A2",
    "drive B1",
    "drive B2",
    "questionnaire B2 laan",
    "questionnaire end last",
    "thanks",
  ]);
  const other = ids(stepsOf(plan(), [], "BA")).filter((id) => id.startsWith("drive"));
  assert.deepEqual(other, ["drive A2", "drive B1", "drive B2", "drive A1"]);
});

test("a questionnaire after a system is asked after its last drive in the order of the person", () => {
  const asked = [questionnaire("laan", ["A", "B"])];
  const after = (/** @type {"AB" | "BA"} */ order) =>
    stepsOf(plan(), asked, order)
      .filter((step) => step.kind === "questionnaire")
      .map((step) => step.after);
  assert.deepEqual(after("AB"), ["A2", "B2"]);
  assert.deepEqual(after("BA"), ["B2", "A1"]);
});

test("the same questionnaire is asked once after a drive that is named twice", () => {
  const steps = stepsOf(plan(), [questionnaire("laan", ["A", "A2"])], "AB");
  assert.equal(steps.filter((step) => step.kind === "questionnaire").length, 1);
});

test("each event leads on only from the steps that know it", () => {
  const steps = stepsOf(plan(), [questionnaire("laan", ["A1"])], "AB");
  const leads = {
    welcome: "next",
    consent: "agreed",
    questionnaire: "answered",
    device: "ready",
    practice: "stored",
    drive: "stored",
    break: "rested",
    thanks: "",
  };
  const events = /** @type {const} */ ([
    "next",
    "agreed",
    "answered",
    "ready",
    "stored",
    "again",
    "rested",
    "go_on",
  ]);
  for (const [at, step] of steps.entries()) {
    for (const event of events) {
      const expected = leads[step.kind] === event ? at + 1 : at;
      assert.deepEqual(moved(steps, { at, stopped: false }, event), {
        at: expected,
        stopped: false,
      });
    }
  }
});

test("one practises once more before the first drive only, and only if the plan has practice", () => {
  const asked = [questionnaire("ssq", ["practice"])];
  const steps = stepsOf(plan({ practice: 2 }), asked, "AB");
  const last = steps.findIndex((step) => step.id === "practice 2");
  for (const [at, step] of steps.entries()) {
    const expected = step.id === "drive A1" ? last : at;
    assert.equal(moved(steps, { at, stopped: false }, "practise").at, expected, step.id);
  }
  const without = stepsOf(plan({ practice: 0 }), [], "AB");
  const first = without.findIndex((step) => step.kind === "drive");
  assert.equal(moved(without, { at: first, stopped: false }, "practise").at, first);
});

test("a session can be stopped at every step but the last, goes on there, and knows nothing else", () => {
  const steps = stepsOf(plan(), [], "AB");
  for (const at of steps.keys()) {
    const stopped = moved(steps, { at, stopped: false }, "stop");
    assert.equal(stopped.stopped, at !== steps.length - 1);
    if (stopped.stopped) {
      assert.deepEqual(moved(steps, stopped, "stored"), stopped);
      assert.deepEqual(moved(steps, stopped, "go_on"), { at, stopped: false });
    }
  }
  const declined = moved(steps, { at: 1, stopped: false }, "declined");
  assert.deepEqual(declined, { at: 1, stopped: true });
});

test("a step is found again by its id", () => {
  const steps = stepsOf(plan(), [], "AB");
  for (const [at, step] of steps.entries()) {
    assert.deepEqual(placeOf(steps, step.id, true), { at, stopped: true });
  }
});

test("a pseudonym has letters and one number; what else could be a name is refused", () => {
  assert.deepEqual(pseudonym("07"), { name: "P07", driver_id: 7 });
  assert.deepEqual(pseudonym(" p7 "), { name: "P07", driver_id: 7 });
  assert.deepEqual(pseudonym("VP-112"), { name: "VP112", driver_id: 112 });
  for (const none of ["", "Anna", "Anna Meier 7", "P7b2", "../P7", "P0", "P1234567", "7.5"]) {
    assert.equal(pseudonym(none), null, none);
  }
});

test("order and explanation follow from the number, if the address does not say the order", () => {
  const study = plan({ counterbalanced: true, explanations: ["none", "icon", "text"] });
  const of = (/** @type {string} */ typed, /** @type {string | null} */ order = null) => {
    const who = participantOf(typed, order, study);
    return [who?.order, who?.explanation];
  };
  assert.deepEqual(
    ["1", "2", "3", "4", "5", "6", "7"].map((typed) => of(typed)),
    [
      ["AB", "none"],
      ["BA", "none"],
      ["AB", "icon"],
      ["BA", "icon"],
      ["AB", "text"],
      ["BA", "text"],
      ["AB", "none"],
    ],
  );
  assert.deepEqual(of("4", "AB"), ["AB", "icon"]);
  assert.equal(participantOf("2", null, plan())?.order, "AB");
});

test("in a study with one order the explanations change with each number", () => {
  const study = plan({ counterbalanced: false, explanations: ["none", "text"] });
  const told = ["1", "2", "3"].map((typed) => participantOf(typed, null, study)?.explanation);
  assert.deepEqual(told, ["none", "text", "none"]);
});
