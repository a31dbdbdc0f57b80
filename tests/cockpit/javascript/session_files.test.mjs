// Files that are dropped on the page, recordings compared, and what is kept in the browser and read again.
import assert from "node:assert/strict";
import test from "node:test";

import { STANDARD } from "../../../fmu_src/pldf/cockpit/page/engine/inputs/calibration.js";
import { ByDistance, speedsAt } from "../../../fmu_src/pldf/cockpit/page/session/comparing.js";
import { isCalibration } from "../../../fmu_src/pldf/cockpit/page/session/devices.js";
import { kindOf, readDropped } from "../../../fmu_src/pldf/cockpit/page/session/dropped.js";
import { FrameTimes } from "../../../fmu_src/pldf/cockpit/page/session/frame_times.js";
import { zipped } from "../../../fmu_src/pldf/cockpit/page/session/hand_out.js";
import { prepareOnServer } from "../../../fmu_src/pldf/cockpit/page/session/road_upload.js";
import { unzipSync } from "../../../fmu_src/pldf/cockpit/page/vendor/fflate.js";

const bytes = (/** @type {string} */ text) => new TextEncoder().encode(text);

test("a file is told by its name, a table by its columns", () => {
  const kind = (/** @type {string} */ name, content = "") =>
    kindOf({ name, bytes: bytes(content) });
  assert.equal(kind("a.PLDF"), "profile");
  assert.equal(kind("a.prepared"), "prepared");
  assert.equal(kind("a.xodr"), "road");
  assert.equal(kind("a.csv", "# comment\ns_m,curvature_per_m,speed_limit_mps\n"), "road");
  assert.equal(kind("a.csv", "time_s,s_m,speed_mps,curvature_per_m\n"), "recording");
});

test("each file that cannot be read is told, the others are taken", async () => {
  const good = { name: "good.csv", bytes: bytes("time_s,s_m,speed_mps\n0,0,10\n1,10,10\n") };
  const files = ["bad.csv", "bad.pldf", "bad.prepared", "road.xodr"].map((name) => ({
    name,
    bytes: bytes("nothing"),
  }));
  const dropped = await readDropped([...files, good], null);
  assert.deepEqual(
    dropped.refused.map(({ name }) => name),
    files.map(({ name }) => name),
  );
  assert.deepEqual(
    dropped.recordings.map(({ name }) => name),
    ["good.csv"],
  );
  assert.equal(dropped.road, null);
});

test("a recording by distance: what was passed first counts, outside there is nothing", () => {
  const frames = [
    [0, 0, 10],
    [1, 10, 20],
    [2, 8, 5], // it rolled back
    [3, 30, 10],
  ].map(([time_s, s_m, speed_mps]) => ({
    time_s,
    lateral_m: 0,
    heading_rad: 0,
    values: { "vehicle.s_m": s_m, "vehicle.speed_mps": speed_mps },
  }));
  const recording = new ByDistance(frames);
  assert.deepEqual(recording.at(5), { time_s: 0.5, speed_mps: 15 });
  assert.deepEqual(recording.at(10), { time_s: 1, speed_mps: 20 });
  assert.deepEqual(recording.at(20), { time_s: 2.5, speed_mps: 7.5 });
  assert.equal(recording.at(-1), null);
  assert.equal(recording.at(30.1), null);
  assert.deepEqual(speedsAt(recording, [0, 10, 40], 3.6), [36, 72, null]);
});

test("the server is asked again with the way through a network, until it knows a road", async () => {
  /** @type {string[]} */
  const asked = [];
  const answers = [
    { error: "which?", options: { start_road: "w" } },
    { error: "and then?", options: { start_road: "w", via: "s" } },
    { road: { name: "net", prepared: btoa("road") }, end_m: 5, start_speed_mps: 1 },
  ];
  const original = globalThis.fetch;
  globalThis.fetch = async (url) => {
    asked.push(String(url));
    return Response.json(answers[asked.length - 1]);
  };
  try {
    const road = await prepareOnServer(async ({ options }) => options)({
      name: "a b.xodr",
      bytes: bytes("x"),
    });
    assert.equal(new TextDecoder().decode(road.road.prepared), "road");
  } finally {
    globalThis.fetch = original;
  }
  assert.deepEqual(asked, [
    "api/road?name=a+b.xodr",
    "api/road?name=a+b.xodr&start_road=w",
    "api/road?name=a+b.xodr&start_road=w&via=s",
  ]);
});

test("a calibration that was kept is used only if one can drive with it", () => {
  const kept = () => JSON.parse(JSON.stringify(STANDARD));
  assert.ok(isCalibration(kept()));
  const without = kept();
  delete without.controls.brake;
  const stuck = kept();
  stuck.controls.gas.full = stuck.controls.gas.rest;
  for (const wrong of [
    null,
    3,
    {},
    { controls: {} },
    { ...kept(), dead_zone: 0.6 },
    without,
    stuck,
  ]) {
    assert.equal(isCalibration(wrong), false);
  }
});

test("pictures are timed from one to the next, not over a pause", () => {
  const times = new FrameTimes();
  for (const now_ms of [0, 20, 80]) {
    times.drawn(now_ms);
  }
  times.interrupted(1080); // the picture stood for a second, then the drive did
  for (const now_ms of [5000, 5010]) {
    times.drawn(now_ms);
  }
  assert.deepEqual(times.timing, { frames: 4, mean_ms: 272.5, max_ms: 1000, over_50_ms: 2 });
});

test("the same files give the same zip", () => {
  const files = { "recordings/P07_A1.csv": bytes("a"), "sessions/P07.json": bytes("{}") };
  const zip = zipped(files);
  assert.deepEqual(zip, zipped({ ...files }));
  assert.deepEqual({ ...unzipSync(zip) }, files);
});
