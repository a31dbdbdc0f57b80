// The page: what it needs is loaded, and then the address says what is shown.

import { element } from "./dom.js";
import { speak } from "./language.js";
import { loadBundle } from "./engine/bundle.js";
import { roadOf } from "./engine/road.js";
import { Live } from "./cluster/live.js";
import { showPage, showProblem, toldBy } from "./session/app.js";
import { guide } from "./session/guided.js";
import { home } from "./session/home.js";
import { chosenLanguage } from "./session/languages.js";
import { participantOf } from "./session/participant.js";
import { readSettings } from "./session/settings.js";
import { browserStorage, memoryStorage, serverStorage } from "./session/storage.js";
import { say } from "./session/words.js";

/** @typedef {import("./session/app.js").App} App */
/** @typedef {import("./session/storage.js").Storage} Storage */

const root = /** @type {HTMLElement} */ (document.getElementById("page"));
// The exported page has all in itself, and no server to talk to.
const exported = document.getElementById("bundle") !== null;

/** @returns {Promise<Storage>} */
async function storageOf() {
  if (!exported) {
    return serverStorage(new URL("api/files/", location.href).href);
  }
  try {
    return await browserStorage();
  } catch {
    return memoryStorage(); // the first page says so
  }
}

/** @returns {Promise<App>} */
async function appOf() {
  const bundle = await loadBundle();
  speak(chosenLanguage(bundle.language));
  return {
    root,
    bundle,
    road: roadOf(bundle.road),
    storage: await storageOf(),
    settings: readSettings(bundle.plan),
    live: exported ? null : new Live(() => {}),
  };
}

async function start() {
  root.append(element("p", { class: "page" }, say("loading")));
  const app = await appOf();
  const address = new URLSearchParams(location.search);
  const typed = address.get("p");
  if (typed === null) {
    home(app);
    return;
  }
  const who = participantOf(typed, address.get("order"), app.bundle.plan);
  if (who) {
    await guide(app, who);
  } else {
    showPage(app, typed, element("p", { class: "problem" }, say("pseudonym_wrong")));
  }
}

/** @param {unknown} problem that nobody expected: said beside what is shown, which may still work */
function told(problem) {
  const words = `${say("problem_title")}: ${toldBy(problem)}. ${say("problem_way_out")}`;
  document.body.append(element("p", { class: "banner", role: "alert" }, words));
}

addEventListener("error", ({ error, message }) => {
  // A browser's notice that something grew while it was measured: it is drawn a frame later.
  if (!message.startsWith("ResizeObserver loop")) {
    told(error ?? message);
  }
});
addEventListener("unhandledrejection", (event) => told(event.reason));
start().catch((problem) => showProblem(root, problem));
