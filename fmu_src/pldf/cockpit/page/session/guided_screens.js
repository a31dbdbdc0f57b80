// What each step of a session shows, and which event it ends with.

import { button, buttons, choose, laboratoryText, now, showPage } from "./app.js";
import { element, fill } from "../dom.js";
import { askQuestionnaire } from "./questionnaire_form.js";
import { chooseDevice } from "./device_screen.js";
import { driveStep } from "./guided_drive.js";
import { handOut } from "./hand_out.js";
import { fromJson, toJson } from "./saved.js";
import { noted, withAnswers } from "./record.js";
import { progress } from "./progress.js";
import { learnedPanel } from "./see_learned.js";
import { say } from "./words.js";

/** @typedef {import("./flow.js").Event} Event */
/** @typedef {import("./guided.js").Session} Session */
/** @typedef {import("./record.js").Answers} Answers */
/** @typedef {{event: Event, reason: string}} Ended */

/**
 * Show the step that the session is at until it ends.
 * @param {Session} session
 * @returns {Promise<Ended>}
 */
export function screenOf(session) {
  switch (session.step.kind) {
    case "welcome":
      return welcome(session);
    case "consent":
      return consent(session);
    case "questionnaire":
      return questionnaire(session);
    case "device":
      return device(session);
    case "practice":
    case "drive":
      return driveStep(session);
    case "break":
      return rest(session);
    case "thanks":
      return thanks(session);
  }
}

/** @param {Session} session @returns {Promise<Ended>} */
async function welcome(session) {
  const { app } = session;
  const content = [progress(session), laboratoryText(app.bundle.pages.welcome)];
  const event = await choose(app, app.bundle.plan.title, content, [
    { text: say("next"), choice: /** @type {const} */ ("next"), kind: "main" },
  ]);
  return { event, reason: "" };
}

/** @param {Session} session @returns {Promise<Ended>} */
async function consent(session) {
  const { app } = session;
  const content = [progress(session), laboratoryText(app.bundle.pages.consent)];
  const event = await choose(app, app.bundle.plan.title, content, [
    { text: say("agree"), choice: /** @type {const} */ ("agreed"), kind: "main" },
    { text: say("decline"), choice: /** @type {const} */ ("declined") },
  ]);
  if (event === "agreed") {
    session.record = noted(session.record, "agreed", now());
  }
  return { event, reason: event === "declined" ? "did not agree" : "" };
}

/** @param {Session} session @returns {Promise<Ended>} */
async function questionnaire(session) {
  const { app, record, step } = session;
  const asked = app.bundle.questionnaires.find((one) => one.id === step.name);
  if (!asked) {
    throw new Error(`the study has no questionnaire ${step.name}`);
  }
  const key = `pldf-cockpit draft ${record.participant} ${step.id}`;
  const drafted = /** @type {Answers} */ (fromJson(key));
  const draft = (/** @type {Answers} */ answers) => toJson(key, answers);
  const answers = await askQuestionnaire(app, asked, progress(session), draft, drafted);
  const given = { after: step.after, questionnaire: asked.id, at: now(), answers };
  session.record = withAnswers(session.record, given);
  toJson(key, {});
  return { event: "answered", reason: "" };
}

/** @param {Session} session @returns {Promise<Ended>} */
async function device(session) {
  session.inputs = await chooseDevice(session.app);
  return { event: "ready", reason: "" };
}

/** @param {Session} session @returns {Promise<Ended>} */
function rest(session) {
  const ends_ms = Date.now() + session.step.minutes * 60_000;
  return new Promise((resolve) => {
    const left = element("p", { class: "countdown", role: "timer" });
    const next = button(say("next"), () => over("rested"), "main");
    const early = button(say("break_early"), () => over("rested"));
    const stop = button(say("end_session"), () => over("stop"));
    const all = buttons(next, early, stop);
    const text = element("p", {}, say("break_text"));
    showPage(session.app, say("break_title"), progress(session), text, left, all);
    const timer = setInterval(() => tick(), 500);
    const tick = () => {
      const left_s = Math.ceil((ends_ms - Date.now()) / 1000);
      fill(left, left_s > 0 ? say("break_left", clock(left_s)) : say("break_over"));
      next.disabled = left_s > 0;
      early.hidden = left_s <= 0;
    };
    const over = (/** @type {"rested" | "stop"} */ event) => {
      all.remove(); // a second click must not end what comes next
      clearInterval(timer);
      const left_s = Math.round((ends_ms - Date.now()) / 1000);
      if (left_s > 0 && event === "rested") {
        session.record = noted(session.record, `break ended ${left_s} s early`, now());
      }
      resolve({ event, reason: "" });
    };
    tick();
  });
}

/** @param {number} left_s */
function clock(left_s) {
  return { minutes: Math.floor(left_s / 60), seconds: String(left_s % 60).padStart(2, "0") };
}

/** @param {Session} session @returns {Promise<Ended>} */
async function thanks(session) {
  const { app } = session;
  const zip =
    app.storage.kind !== "server" &&
    button(say("hand_out"), () => void handOut(app.storage, app.bundle.beside));
  const away = button(say("home"), () => location.assign(location.pathname));
  const panel = element("div", {});
  const see = button(say("see_learned"), () => {
    see.remove();
    void learnedPanel(app, session.record).then((learned) => fill(panel, learned));
  });
  showPage(
    app,
    app.bundle.plan.title,
    laboratoryText(app.bundle.pages.thanks),
    element("p", { class: zip && "notice" }, say(zip ? "finished_here" : "finished")),
    zip && element("p", {}, say("hand_out_hint")),
    buttons(zip, session.record.learned_after && see, away),
    panel,
  ).classList.add("wide");
  return new Promise(() => {}); // the last step has no end
}
