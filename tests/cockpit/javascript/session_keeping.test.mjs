// What is stored when: whatever happens between two writes, the same drive begins from the same profile.
import assert from "node:assert/strict";
import test from "node:test";

import {
  allRecords,
  keepDrive,
  keepRecord,
  learnedFiles,
  publishProfiles,
  readRecord,
} from "../../../fmu_src/pldf/cockpit/page/session/keeping.js";
import {
  newRecord,
  withAttempt,
  withEnding,
} from "../../../fmu_src/pldf/cockpit/page/session/record.js";
import {
  memoryStorage,
  serverStorage,
} from "../../../fmu_src/pldf/cockpit/page/session/storage.js";
import { plan } from "./session_support.mjs";

/** @typedef {import("../../../fmu_src/pldf/cockpit/page/types.js").DriveResult} DriveResult */
/** @typedef {import("../../../fmu_src/pldf/cockpit/page/types.js").Bundle} Bundle */

const BUNDLE = /** @type {Bundle} */ (
  /** @type {unknown} */ ({ plan: plan(), questionnaires: [] })
);
const FILE = "driver-000007_route-abc.pldf";

/**
 * @param {string} name
 * @param {number} driver_id
 */
function begun(name, driver_id) {
  const who = {
    name,
    driver_id,
    order: /** @type {const} */ ("AB"),
    explanation: /** @type {const} */ ("text"),
  };
  const about = /** @type {const} */ ({
    version: "1",
    study: "s",
    language: "en",
    browser: "",
    screen: "",
  });
  return newRecord(who, about, "welcome", "t");
}

/**
 * @param {DriveResult["ending"]} ending
 * @param {number} learned
 * @returns {DriveResult}
 */
const result = (ending, learned) => ({
  recording: "time_s\n0\n",
  inputs: [{ step: 3, name: "driver.gas_pedal", value: 0.1 }],
  profiles: { [FILE]: new Uint8Array([learned]) },
  outputs: {},
  messages: [],
  interruptions: [],
  timing: { steps: 1, late_steps: 0, late_max_ms: 0, step_us: 1 },
  ending,
  reason: "",
});

/** @param {string} name */
const drive = (name) =>
  /** @type {const} */ ({
    kind: "drive",
    name,
    began_at: "t",
    device: "keyboard",
    steering: "assisted",
  });

test("a drive that arrived is stored where the analysis looks for it", async () => {
  const storage = memoryStorage();
  const record = withAttempt(begun("P07", 7), drive("A2"));
  assert.equal(
    await keepDrive(storage, record, drive("A2"), result("arrived", 1)),
    "recordings/P07_A2.csv",
  );
  await publishProfiles(storage, { ...record, learned_after: "A2" });
  assert.deepEqual(await storage.list(""), [
    "inputs/P07_A2.csv",
    `profiles/${FILE}`,
    "recordings/P07_A2.csv",
    `sessions/P07/A2/${FILE}`,
  ]);
  const inputs = await storage.read("inputs/P07_A2.csv");
  assert.equal(
    new TextDecoder().decode(inputs ?? undefined),
    "step,name,value\n3,driver.gas_pedal,0.1\n",
  );
});

test("a drive that did not arrive is kept apart and changes no profile", async () => {
  const storage = memoryStorage();
  const first = withAttempt(begun("P07", 7), drive("B1"));
  await keepDrive(storage, first, drive("B1"), result("stopped", 9));
  const second = withAttempt(withEnding(first, { ending: "stopped" }), drive("B1"));
  await keepDrive(storage, second, drive("B1"), result("failed", 9));
  assert.deepEqual(await storage.list(""), [
    "sessions/P07/stopped/B1_1.csv",
    "sessions/P07/stopped/B1_1_inputs.csv",
    "sessions/P07/stopped/B1_2.csv",
    "sessions/P07/stopped/B1_2_inputs.csv",
  ]);
});

test("a drive that failed before its first step leaves no empty file", async () => {
  const storage = memoryStorage();
  const failed = { ...result("failed", 1), recording: "" };
  assert.equal(await keepDrive(storage, begun("P07", 7), drive("A2"), failed), "");
  assert.deepEqual(await storage.list(""), []);
});

test("a practice drive leaves no profile", async () => {
  const storage = memoryStorage();
  const practice = /** @type {const} */ ({ ...drive("1"), kind: "practice" });
  const path = await keepDrive(storage, begun("P07", 7), practice, result("arrived", 1));
  assert.equal(path, "practice/P07_1.csv");
  assert.deepEqual(await storage.list("sessions/"), []);
  const twice = withAttempt(withAttempt(begun("P07", 7), practice), practice);
  assert.equal(
    await keepDrive(storage, twice, practice, result("arrived", 1)),
    "practice/P07_1_2.csv",
  );
});

test("after a crash between drive and record, the drive begins from what was learned before", async () => {
  const storage = memoryStorage();
  const before = { ...begun("P07", 7), learned_after: "A2" };
  await keepDrive(storage, before, drive("A2"), result("arrived", 2));
  await keepRecord(storage, before, BUNDLE);
  await keepDrive(storage, before, drive("B1"), result("arrived", 3)); // and here the page is closed
  const found = await readRecord(storage, "P07");
  assert.ok(found);
  assert.deepEqual(await learnedFiles(storage, found), { [FILE]: new Uint8Array([2]) });
});

test("nothing is learned before the first drive that learns", async () => {
  assert.deepEqual(await learnedFiles(memoryStorage(), begun("P07", 7)), {});
});

test("tables are made of all sessions", async () => {
  const storage = memoryStorage();
  await keepRecord(storage, begun("P07", 7), BUNDLE);
  await keepRecord(storage, begun("P08", 8), BUNDLE);
  assert.deepEqual(
    (await allRecords(storage)).map((one) => one.participant),
    ["P07", "P08"],
  );
  const summary = JSON.parse(
    new TextDecoder().decode((await storage.read("session.json")) ?? undefined),
  );
  assert.equal(summary.sessions.length, 2);
  assert.equal(await storage.read("questionnaire.csv"), null);
});

test("a shared table on the server is made anew when another page was quicker", async () => {
  const server = { bytes: new TextEncoder().encode("one"), tag: 1, puts: 0 };
  const original = globalThis.fetch;
  globalThis.fetch = async (_, init) => {
    if (init?.method !== "PUT") {
      return new Response(server.bytes, { headers: { ETag: `"${server.tag}"` } });
    }
    server.puts += 1;
    if (server.puts === 1) {
      server.bytes = new TextEncoder().encode("one two"); // the other page
      server.tag += 1;
    }
    if (new Headers(init.headers).get("If-Match") !== `"${server.tag}"`) {
      return new Response("", { status: 412 });
    }
    server.bytes = /** @type {Uint8Array<ArrayBuffer>} */ (init.body);
    return new Response(null, { status: 204 });
  };
  try {
    await serverStorage("http://h/t/api/files/").update("session.json", async (old) =>
      new TextEncoder().encode(`${new TextDecoder().decode(old ?? undefined)} three`),
    );
  } finally {
    globalThis.fetch = original;
  }
  assert.equal(new TextDecoder().decode(server.bytes), "one two three");
});
