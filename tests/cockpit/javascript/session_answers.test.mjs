// Questionnaires: which items are shown, what is missing, and the tables made of the answers.
import assert from "node:assert/strict";
import test from "node:test";

import {
  keptAnswers,
  problemsOf,
  shownItems,
} from "../../../fmu_src/pldf/cockpit/page/session/answering.js";
import {
  newRecord,
  withAnswers,
  withAttempt,
  withEnding,
} from "../../../fmu_src/pldf/cockpit/page/session/record.js";
import {
  answersTable,
  exclusionsTable,
  questionnaireTable,
  sessionSummary,
} from "../../../fmu_src/pldf/cockpit/page/session/tables.js";
import { item, plan, questionnaire } from "./session_support.mjs";

/** @typedef {import("../../../fmu_src/pldf/cockpit/page/session/record.js").SessionRecord} SessionRecord */

const ABOUT = /** @type {const} */ ({
  version: "1",
  study: "a study",
  language: "en",
  browser: "",
  screen: "",
});

/** @param {string} name */
function record(name, driver_id = 7) {
  const who = {
    name,
    driver_id,
    order: /** @type {const} */ ("AB"),
    explanation: /** @type {const} */ ("text"),
  };
  return newRecord(who, ABOUT, "welcome", "2026-01-02T03:04:05Z");
}

/**
 * @param {SessionRecord} one
 * @param {string} after
 * @param {Record<string, string | number>} answers
 */
const answered = (one, after, answers, questionnaire = "laan") =>
  withAnswers(one, { after, questionnaire, at: "t", answers });

/**
 * @param {SessionRecord} one
 * @param {string[]} names
 */
function driven(one, names) {
  return names.reduce((known, name) => {
    const begun = {
      kind: /** @type {const} */ ("drive"),
      name,
      began_at: "t",
      device: "keyboard",
      steering: /** @type {const} */ ("assisted"),
    };
    return withEnding(withAttempt(known, begun), { ending: "arrived" });
  }, one);
}

const ITEMS = [
  item({
    id: "drives",
    kind: "choice",
    options: ["yes", "no"].map((key) => ({ key, text: { en: key, de: key } })),
  }),
  item({ id: "km", kind: "number", low: 0, high: 100, only_if: { id: "drives", is: ["yes"] } }),
  item({ id: "why", kind: "text", required: false, only_if: { id: "km", is: [0] } }),
];

test("an item with a condition is shown only while the item it hangs on is shown and answered so", () => {
  const ids = (/** @type {Record<string, string | number>} */ answers) =>
    shownItems(ITEMS, answers).map((one) => one.id);
  assert.deepEqual(ids({}), ["drives"]);
  assert.deepEqual(ids({ drives: "no", km: 0 }), ["drives"]);
  assert.deepEqual(ids({ drives: "yes" }), ["drives", "km"]);
  assert.deepEqual(ids({ drives: "yes", km: 0 }), ["drives", "km", "why"]);
});

test("what is required and shown must be answered, numbers within their range", () => {
  assert.deepEqual([...problemsOf(ITEMS, {})], [["drives", "missing"]]);
  assert.deepEqual([...problemsOf(ITEMS, { drives: "yes", km: 101 })], [["km", "range"]]);
  assert.deepEqual([...problemsOf(ITEMS, { drives: "yes", km: "" })], [["km", "missing"]]);
  assert.equal(problemsOf(ITEMS, { drives: "yes", km: 0 }).size, 0);
});

test("answers to what is hidden again do not count", () => {
  assert.deepEqual(keptAnswers(ITEMS, { drives: "no", km: 5, why: "x" }), { drives: "no" });
});

test("questionnaire.csv has a row per participant and drive with scored items, escaped", () => {
  const asked = [
    questionnaire(
      "laan",
      ["A2", "B2"],
      [item({ id: "laan_1" }), item({ id: "comment", kind: "text" })],
    ),
    questionnaire("before", ["start"], [item({ id: "age", kind: "number" })]),
  ];
  const one = answered(record("P07"), "A2", { laan_1: 2, comment: 'said "so", and\nmore' });
  const two = answered(answered(record("P08", 8), "start", { age: 30 }, "before"), "B2", {
    laan_1: 5,
  });
  assert.equal(
    questionnaireTable([one, two], asked),
    'participant,phase,laan_1,comment\nP07,A2,2,"said ""so"", and\nmore"\nP08,B2,5,\n',
  );
  assert.equal(questionnaireTable([record("P07")], asked), null);
});

test("answers given again replace the first ones; answers.csv has all of them", () => {
  const twice = answered(answered(record("P07"), "A2", { laan_1: 2 }), "A2", { laan_1: 3 });
  const more = answered(twice, "start", { age: 30 }, "before");
  assert.equal(
    answersTable([more]),
    "participant,after,questionnaire,item,answer,at\nP07,A2,laan,laan_1,3,t\nP07,start,before,age,30,t\n",
  );
});

test("session.json says everything but the answers", () => {
  const [only] = sessionSummary([answered(record("P07"), "A2", { laan_1: 2 })]).sessions;
  assert.equal(only?.participant, "P07");
  assert.ok(only && !("given" in only));
});

test("who stops is excluded for what was not driven, until the person drives on", () => {
  const half = driven(record("P07"), ["A1", "A2"]);
  const stopped = { ...half, stopped: { at: "t", reason: 'felt "sick", really' } };
  const table = exclusionsTable([stopped], plan(), null);
  assert.equal(
    table,
    "participant,phase,reason\n" +
      'P07,B1,"session stopped: felt ""sick"", really"\nP07,B2,"session stopped: felt ""sick"", really"\n',
  );
  assert.equal(exclusionsTable([stopped], plan(), table), null);
  const whole = driven(half, ["B1"]);
  const again = { ...whole, stopped: { at: "t", reason: "time" } };
  assert.equal(
    exclusionsTable([again], plan(), table),
    "participant,phase,reason\nP07,B2,session stopped: time\n",
  );
  assert.equal(
    exclusionsTable([driven(whole, ["B2"])], plan(), table),
    "participant,phase,reason\n",
  );
});

test("what the laboratory wrote into exclusions.csv stays as it is", () => {
  const by_hand = "participant,phase,reason\nP07,B1,wheel was loose\nP03,,asked to be taken out\n";
  const half = { ...driven(record("P07"), ["A1", "A2"]), stopped: { at: "t", reason: "time" } };
  assert.equal(
    exclusionsTable([half], plan(), by_hand),
    `${by_hand}P07,B2,session stopped: time\n`,
  );
  assert.equal(exclusionsTable([half], plan(), "who;drive;why\n"), null);
  assert.equal(exclusionsTable([record("P07")], plan(), by_hand), null);
  assert.equal(exclusionsTable([record("P07")], plan(), null), null);
});
