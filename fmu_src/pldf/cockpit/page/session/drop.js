// Files are dropped or chosen: recordings and profiles are watched, a road is driven on from then on.

import { element, fill } from "../dom.js";
import { roadOf } from "../engine/road.js";
import { NeedsServer, readDropped } from "./dropped.js";
import { watch } from "./replay_screen.js";
import { askWay, prepareOnServer } from "./road_upload.js";
import { refusalText, say } from "./replay_words.js";

/** @typedef {import("./app.js").App} App */
/** @typedef {import("./dropped.js").Dropped} Dropped */
/** @typedef {import("./dropped.js").NewRoad} NewRoad */

/**
 * Return the card of the first page on which files are dropped.
 * @param {App} app
 * @param {() => void} back to the first page
 * @returns {HTMLElement}
 */
export function replayCard(app, back) {
  const input = /** @type {HTMLInputElement} */ (
    element("input", {
      type: "file",
      multiple: true,
      accept: ".csv,.tsv,.txt,.pldf,.prepared,.xodr",
      "aria-label": say("choose_files"),
    })
  );
  const told = element("div", { role: "alert" });
  const made = element(
    "section",
    { class: "card" },
    element("h2", {}, say("replay")),
    element("p", {}, say("replay_hint")),
    input,
    told,
  );
  const take = (/** @type {Iterable<File>} */ files) => void taken(app, back, [...files], told);
  input.addEventListener("change", () => take(input.files ?? []));
  allowDrop(made, take);
  return made;
}

/**
 * @param {HTMLElement} zone
 * @param {(files: Iterable<File>) => void} take
 */
function allowDrop(zone, take) {
  const over = (/** @type {boolean} */ on) => zone.classList.toggle("dropping", on);
  zone.addEventListener("dragover", (event) => {
    event.preventDefault();
    over(true);
  });
  zone.addEventListener("dragleave", () => over(false));
  zone.addEventListener("drop", (event) => {
    event.preventDefault();
    over(false);
    take(event.dataTransfer?.files ?? []);
  });
}

/**
 * @param {App} app
 * @param {() => void} back
 * @param {File[]} files
 * @param {HTMLElement} told
 */
async function taken(app, back, files, told) {
  fill(told, element("p", {}, say("reading")));
  const named = await Promise.all(
    files.map(async (file) => ({ name: file.name, bytes: await bytesOf(file) })),
  );
  const onServer = app.storage.kind === "server";
  const prepare = onServer ? prepareOnServer((options) => askWay(told, options)) : null;
  const dropped = await readDropped(named, prepare);
  if (dropped.road) {
    driveOn(app, dropped.road);
  }
  const refused = dropped.refused.map(({ name, problem }) =>
    element("p", { class: "problem" }, `${name}: ${refusedText(problem)}`),
  );
  fill(told, ...refused, dropped.road && newRoadText(app));
  if (dropped.recordings.length || dropped.profiles.length) {
    watch(app, dropped, back, refused);
  }
}

/** @param {File} file */
async function bytesOf(file) {
  return new Uint8Array(await file.arrayBuffer());
}

/** @param {unknown} problem */
function refusedText(problem) {
  return problem instanceof NeedsServer ? say("needs_server") : refusalText(problem);
}

/** @param {App} app */
function newRoadText(app) {
  return element("p", { role: "status" }, say("new_road", { name: app.road.name }));
}

/**
 * From now on, drive on this road: until the page is loaded anew.
 * @param {App} app
 * @param {NewRoad} found
 */
export function driveOn(app, { road, end_m, start_speed_mps }) {
  const { plan } = app.bundle;
  const drives = plan.drives.map((one) => ({
    ...one,
    values: {
      ...one.values,
      vehicle: { ...one.values.vehicle, start_speed_mps },
    },
  }));
  const practice_end_m = Math.min(plan.practice_end_m, end_m);
  app.bundle = { ...app.bundle, road, plan: { ...plan, drives, end_m, practice_end_m } };
  app.road = roadOf(road);
}
