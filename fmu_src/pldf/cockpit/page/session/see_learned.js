// What the car learned from a person, shown to the person at the end of the session.

import { AfterDrive } from "../cluster/after_drive.js";
import { readReplay } from "../engine/replay.js";
import { element } from "../dom.js";
import { learnedFiles } from "./keeping.js";
import { drivesOf } from "./record.js";
import { unitOf } from "./settings.js";

/** @typedef {import("./app.js").App} App */
/** @typedef {import("./record.js").SessionRecord} SessionRecord */

/**
 * Return a panel with the newest drive that was learned from; null if there is none.
 * @param {App} app
 * @param {SessionRecord} record
 * @returns {Promise<HTMLElement | null>}
 */
export async function learnedPanel(app, record) {
  const drives = drivesOf(record);
  const drive = drives.get(record.learned_after);
  const recording = drive && (await app.storage.read(drive.file));
  if (!recording) {
    return null;
  }
  const before = { ...record, learned_after: learnedBefore(app, record, [...drives.keys()]) };
  const panel = element("div", {});
  new AfterDrive(panel, {
    road: app.road,
    frames: readReplay(recording).frames,
    before: await profileOf(app, before),
    after: await profileOf(app, record),
    unit: unitOf(app.settings),
    messages: drive.messages,
    forget: null, // in a study, the drives are what is learned
  });
  return panel;
}

/**
 * Return the drive before the newest one that was learned from; empty if there is none.
 * @param {App} app
 * @param {SessionRecord} record
 * @param {string[]} driven in order
 */
function learnedBefore({ bundle }, record, driven) {
  const learning = bundle.plan.drives.filter((one) => one.learn).map((one) => one.phase);
  const before = driven.slice(0, driven.indexOf(record.learned_after));
  return before.findLast((phase) => learning.includes(phase)) ?? "";
}

/**
 * @param {App} app
 * @param {SessionRecord} record
 */
async function profileOf(app, record) {
  const [bytes] = Object.values(await learnedFiles(app.storage, record));
  return bytes ?? null;
}
