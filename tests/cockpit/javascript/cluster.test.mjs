// What the cluster shows of numbers, and what it takes for a message.

import assert from "node:assert/strict";
import { test } from "node:test";

import { messageOf } from "../../../fmu_src/pldf/cockpit/page/cluster/live.js";
import {
  changeText,
  distanceText,
  inUnit,
  speedText,
} from "../../../fmu_src/pldf/cockpit/page/cluster/units.js";

test("speeds are whole numbers in the unit of the cluster", () => {
  assert.equal(speedText(50 / 3.6, "KMH"), "50");
  assert.equal(speedText(50 * 0.44704, "MPH"), "50");
  assert.equal(speedText(-0.1, "KMH"), "0");
  assert.equal(speedText(NaN, "KMH"), "–");
  assert.equal(inUnit(10, "KMH"), 36);
});

test("changes have a sign, and what rounds to nothing has none", () => {
  assert.equal(changeText(8 / 3.6, "KMH"), "+8");
  assert.equal(changeText(-8 / 3.6, "KMH"), "−8");
  assert.equal(changeText(0.1, "KMH"), "0");
  assert.equal(changeText(-0.1, "KMH"), "0");
});

test("distances are rounded as one says them", () => {
  assert.equal(distanceText(244, "en"), "240 m");
  assert.equal(distanceText(994.9, "en"), "990 m");
  assert.equal(distanceText(996, "en"), "1.0 km");
  assert.equal(distanceText(2360, "de"), "2,4 km");
});

test("a simulator's message needs no more than values", () => {
  const message = messageOf('{"values": {"vehicle.speed_mps": 12}}');
  assert.deepEqual(message, {
    kind: "frame",
    participant: "",
    phase: "",
    time_s: 0,
    values: { "vehicle.speed_mps": 12 },
  });
});

test("what is no message is none", () => {
  for (const text of [
    "",
    "[",
    "null",
    "7",
    '"a"',
    "{}",
    '{"kind":"frame"}',
    '{"kind":"frame","values":null}',
    '{"kind":"status"}',
    '{"kind":"abort","reason":"sick"}',
    '{"kind":"other","participant":"P07"}',
  ]) {
    assert.equal(messageOf(text), null, text);
  }
});

test("status and abort name their participant", () => {
  const abort = { kind: "abort", participant: "P07", reason: "sick" };
  assert.deepEqual(messageOf(JSON.stringify(abort)), abort);
});
