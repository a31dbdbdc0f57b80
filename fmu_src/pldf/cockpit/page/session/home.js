// The first page: drive at once, take part in the study, watch what was driven, take the data along.

import { element, fill } from "../dom.js";
import { language } from "../language.js";
import { button, showPage } from "./app.js";
import { chooseDevice } from "./device_screen.js";
import { demonstrate, driveFreely } from "./free.js";
import { handOut } from "./hand_out.js";
import { otherWithNumber } from "./keeping.js";
import { LANGUAGES, chooseLanguage } from "./languages.js";
import { participantOf } from "./participant.js";
import { replayCard } from "./drop.js";
import { settingsForm } from "./settings_form.js";
import { simulate } from "./simulate.js";
import { say } from "./words.js";

/** @typedef {import("../language.js").Language} Language */
/** @typedef {import("./app.js").App} App */

const CURVES = 1.15;

/** @param {App} app */
export function home(app) {
  const back = () => home(app);
  const server = app.storage.kind === "server";
  const page = showPage(
    app,
    say("title"),
    languages(app),
    element("p", {}, say("about")),
    element(
      "div",
      { class: "cards" },
      card(
        "drive_at_once",
        element("p", {}, say("drive_at_once_hint", { minutes: minutesOf(app) })),
        button(say("drive_at_once"), () => void driveFreely(app, back), "main"),
      ),
      card(
        "demonstration",
        element("p", {}, say("demonstration_hint")),
        button(say("demonstration"), () => void demonstrate(app, back)),
      ),
      takePart(app),
      card(
        "simulation",
        element("p", {}, say("simulation_hint")),
        button(say("simulation_start"), () => void simulate(app, back)),
      ),
      replayCard(app, back),
      card(
        "settings",
        settingsForm(app.settings, { study: false }),
        button(say("set_up_device"), () => void chooseDevice(app).then(back)),
      ),
      server ? windows() : data(app),
    ),
  );
  page.classList.add("home");
  page.querySelector(".card")?.classList.add("first");
}

/**
 * @param {Parameters<typeof say>[0]} heading
 * @param {...Node} content
 */
export function card(heading, ...content) {
  return element("section", { class: "card" }, element("h2", {}, say(heading)), ...content);
}

/** How long a drive takes at the limits, and a little more for curves. @param {App} app */
function minutesOf({ road, bundle }) {
  const driven = road.limit_mps.slice(0, Math.ceil(bundle.plan.end_m));
  const at_limits_s = driven.reduce((sum, limit_mps) => sum + 1 / limit_mps, 0);
  return Math.max(1, Math.round((CURVES * at_limits_s) / 60));
}

/** @param {App} app */
function languages(app) {
  const all = /** @type {[Language, string][]} */ (Object.entries(LANGUAGES));
  const offered = all.map(([key, name]) => {
    const made = button(name, () => {
      chooseLanguage(key);
      home(app);
    });
    made.lang = key;
    made.setAttribute("aria-pressed", String(key === language()));
    return made;
  });
  return element(
    "div",
    { class: "languages", role: "group", "aria-label": say("language") },
    ...offered,
  );
}

/** @param {App} app */
function takePart(app) {
  const field = /** @type {HTMLInputElement} */ (
    element("input", { name: "p", autocomplete: "off", required: true, maxlength: 20 })
  );
  const order = /** @type {HTMLSelectElement} */ (
    element(
      "select",
      { name: "order", "aria-label": say("order") },
      element("option", { value: "" }, say("order_plan")),
      ...["AB", "BA"].map((one) => element("option", { value: one }, one)),
    )
  );
  const problem = element("p", { class: "problem", role: "alert" });
  const submit = (/** @type {Event} */ event) => {
    event.preventDefault();
    begun(app, field.value, order.value).then(
      (wrong) => fill(problem, wrong),
      (error) => fill(problem, say("not_stored", { problem: String(error) })),
    );
  };
  const form = element(
    "form",
    { onsubmit: submit },
    element("label", {}, say("pseudonym"), field),
    element("details", {}, element("summary", {}, say("order")), order),
    problem,
    element("button", { class: "main" }, say("begin")),
  );
  return card("take_part", element("p", {}, app.bundle.plan.title), form);
}

/**
 * Begin a session: the address then says whose it is, so that a reload goes on with it.
 * @param {App} app
 * @param {string} typed
 * @param {string} order
 * @returns {Promise<string>} what is wrong
 */
async function begun(app, typed, order) {
  const who = participantOf(typed, order, app.bundle.plan);
  if (!who) {
    return say("pseudonym_wrong");
  }
  const other = await otherWithNumber(app.storage, who);
  if (other) {
    return say("pseudonym_taken", { other });
  }
  const asked = new URLSearchParams({ p: who.name, language: language(), ...(order && { order }) });
  location.search = asked.toString();
  return "";
}

function windows() {
  const link = (/** @type {string} */ href, /** @type {string} */ text) =>
    element("p", {}, element("a", { href, target: "_blank", rel: "noreferrer" }, text));
  return card(
    "windows",
    link("experimenter.html", say("experimenter")),
    link("cluster.html", say("second_screen")),
  );
}

/** @param {App} app */
function data(app) {
  const told = element("p", { role: "status" });
  const out = async () => {
    const count = await handOut(app.storage, app.bundle.beside);
    fill(told, !count && say("nothing_kept"));
  };
  const where = app.storage.kind === "memory" ? say("data_memory") : say("data_here");
  return card(
    "data",
    element("p", {}, where),
    button(say("hand_out"), () => void out()),
    element("p", {}, say("hand_out_hint")),
    told,
  );
}
