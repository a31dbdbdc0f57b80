// Storing that does not give up: until it has worked, the page asks what to do, and keeps what it has.

import { choose, showPage, toldBy } from "./app.js";
import { element } from "../dom.js";
import { handOut } from "./hand_out.js";
import { memoryStorage } from "./storage.js";
import { say } from "./words.js";

/** @typedef {import("./app.js").App} App */
/** @typedef {import("./storage.js").Storage} Storage */

/**
 * Do `work` until it succeeds.
 * @template T
 * @param {App} app
 * @param {(storage: Storage) => Promise<T>} work may be done more than once, and into another storage
 * @returns {Promise<T>}
 */
export async function patiently(app, work) {
  for (;;) {
    try {
      return await work(app.storage);
    } catch (problem) {
      await asked(app, work, problem);
    }
  }
}

/**
 * @param {App} app
 * @param {(storage: Storage) => Promise<unknown>} work
 * @param {unknown} problem
 */
async function asked(app, work, problem) {
  const heading = say("not_stored", { problem: toldBy(problem) });
  const choice = await choose(
    app,
    heading,
    [element("p", {}, say("not_stored_way_out"))],
    [
      { text: say("try_again"), choice: "again", kind: "main" },
      { text: say("hand_out"), choice: "zip" },
    ],
  );
  if (choice === "zip") {
    const memory = memoryStorage();
    await work(memory);
    await handOut(memory);
  }
  showPage(app, say("storing"));
}
