// What all screens of the session know, and how one takes the place of another.

import { element, fill } from "../dom.js";
import { language } from "../language.js";
import { NoWebGLError } from "../view/view.js";
import { say } from "./words.js";

/** @typedef {import("../types.js").Bundle} Bundle */
/** @typedef {import("../engine/road.js").RoadModel} RoadModel */
/** @typedef {import("../cluster/live.js").Live} Live */
/** @typedef {import("./settings.js").Settings} Settings */
/** @typedef {import("./storage.js").Storage} Storage */

/**
 * @typedef {object} App
 * @property {HTMLElement} root where screens are shown
 * @property {Bundle} bundle
 * @property {RoadModel} road
 * @property {Storage} storage
 * @property {Settings} settings
 * @property {Live | null} live null: there is no server to tell
 */

// The second half of a double click is meant for the page before. Keys have no second half.
const MEANT_MS = 500;

/**
 * Show a page of text and buttons; its heading is focused, so that it is read out.
 * @param {App} app
 * @param {string} heading
 * @param {...(Node | string | number | null | undefined | false)} content
 * @returns {HTMLElement} the page
 */
export function showPage(app, heading, ...content) {
  const title = element("h1", { tabindex: -1 }, heading);
  const page = element("div", { class: "page" }, title, ...content);
  fill(app.root, page);
  document.title = say("title");
  scrollTo(0, 0);
  title.focus();
  return page;
}

/**
 * @param {string} text
 * @param {() => void} act
 * @param {string} [kind] "main", "stop" or nothing
 * @returns {HTMLButtonElement}
 */
export function button(text, act, kind = "") {
  const made_ms = performance.now();
  const onclick = (/** @type {MouseEvent} */ event) => {
    if (event.detail === 0 || event.timeStamp > made_ms + MEANT_MS) {
      act();
    }
  };
  const made = element("button", { type: "button", class: kind || false, onclick }, text);
  return /** @type {HTMLButtonElement} */ (made);
}

/** @param {...(Node | null | false | "")} buttons */
export function buttons(...buttons) {
  return element("div", { class: "buttons" }, ...buttons);
}

/**
 * Show a page with one choice among buttons.
 * @template {string} T
 * @param {App} app
 * @param {string} heading
 * @param {(Node | string | null | false)[]} content
 * @param {{text: string, choice: T, kind?: string}[]} choices
 * @param {Node[]} below the buttons
 * @returns {Promise<T>}
 */
export function choose(app, heading, content, choices, below = []) {
  return new Promise((resolve) => {
    const offered = choices.map(({ text, choice, kind }) =>
      button(text, () => resolve(choice), kind ?? ""),
    );
    showPage(app, heading, ...content, buttons(...offered), ...below);
  });
}

/**
 * Return an element with the laboratory's text.
 *
 * The only place where the session makes elements of HTML: the text was made of Markdown by
 * `pldf.cockpit.desk_study`, which lets no HTML of its author through.
 * @param {Record<import("../language.js").Language, string>} html
 */
export function laboratoryText(html) {
  const made = element("div", { class: "laboratory" });
  made.innerHTML = html[language()];
  return made;
}

/**
 * Show what went wrong, in words, and the way out.
 * @param {HTMLElement} root
 * @param {unknown} problem
 */
export function showProblem(root, problem) {
  const content =
    problem instanceof NoWebGLError
      ? [element("p", {}, say("no_webgl"))]
      : [element("p", {}, say("problem_way_out")), element("pre", {}, toldBy(problem))];
  const title = element("h1", {}, say("problem_title"));
  fill(root, element("div", { class: "page", role: "alert" }, title, ...content));
}

/**
 * Return what a problem says of itself.
 * @param {unknown} problem
 * @returns {string}
 */
export function toldBy(problem) {
  return problem instanceof Error ? problem.message : String(problem);
}

/** @returns {string} now, UTC */
export function now() {
  return new Date().toISOString();
}
