// One person's session: where the flow stands is shown, what happens is kept, and then it goes on.

import { placesOf } from "../engine/places.js";
import { readProfile } from "../engine/profile.js";
import { moved, placeOf, stepsOf } from "./flow.js";
import { choose, now, showPage } from "./app.js";
import { element } from "../dom.js";
import {
  keepRecord,
  learnedFiles,
  otherWithNumber,
  publishProfiles,
  readRecord,
} from "./keeping.js";
import { newRecord, noted } from "./record.js";
import { patiently } from "./patiently.js";
import { reasonText } from "./pause_dialog.js";
import { readSettings, unitOf } from "./settings.js";
import { screenOf } from "./guided_screens.js";
import { language } from "../language.js";
import { say } from "./words.js";

/** @typedef {import("./app.js").App} App */
/** @typedef {import("./flow.js").Event} Event */
/** @typedef {import("./flow.js").Step} Step */
/** @typedef {import("./participant.js").Participant} Participant */
/** @typedef {import("./record.js").SessionRecord} SessionRecord */
/** @typedef {import("../cluster/live.js").StatusMessage} StatusMessage */
/** @typedef {import("../engine/inputs/inputs.js").Inputs} Inputs */

/**
 * Lead one person through the session, from where the person is.
 * @param {App} app
 * @param {Participant} who
 */
export async function guide(app, who) {
  const alone = await held(`pldf-cockpit session ${who.name}`);
  const other = alone && (await patiently(app, (storage) => otherWithNumber(storage, who)));
  if (!alone || other) {
    showPage(app, other ? say("pseudonym_taken", { other }) : say("other_tab"));
    return;
  }
  const settings = readSettings(app.bundle.plan, who.name);
  const session = await Session.open({ ...app, settings }, who);
  await session.run();
}

/**
 * Return whether this page alone leads the session; as long as it is open.
 * @param {string} name
 * @returns {Promise<boolean>}
 */
function held(name) {
  if (!navigator.locks) {
    return Promise.resolve(true); // an address that is not safe: the experimenter was warned
  }
  return new Promise((resolve) => {
    void navigator.locks.request(name, { ifAvailable: true }, (lock) => {
      resolve(lock !== null);
      return lock ? new Promise(() => {}) : undefined;
    });
  });
}

export class Session {
  /**
   * @param {App} app
   * @param {SessionRecord} record
   */
  constructor(app, record) {
    this.app = app;
    this.record = record;
    const { plan, questionnaires } = app.bundle;
    this.steps = stepsOf(plan, questionnaires, record.order);
    /** @type {Inputs | null} what the person drives with */
    this.inputs = null;
    /** @type {((reason: string) => void) | null} ends the drive that goes on */
    this.stopDrive = null;
    /** @type {(reason: string) => void} */
    this.leave = () => {};
    this.learned = 0;
  }

  /**
   * @param {App} app
   * @param {Participant} who
   */
  static async open(app, who) {
    const found = await patiently(app, (storage) => readRecord(storage, who.name));
    const { plan, version } = app.bundle;
    const about = {
      version,
      study: plan.title,
      language: language(),
      browser: navigator.userAgent,
      screen: `${screen.width} x ${screen.height}, ${devicePixelRatio}`,
    };
    const record = found ?? newRecord(who, about, "welcome", now());
    const session = new Session(app, record);
    if (record.study !== plan.title || !session.steps.some(({ id }) => id === record.step)) {
      throw new Error(say("study_changed", { study: record.study, step: record.step }));
    }
    if (found) {
      await patiently(app, (storage) => publishProfiles(storage, record));
      session.record = noted(record, "opened again", now());
      await session.countLearned();
    }
    return session;
  }

  get place() {
    return placeOf(this.steps, this.record.step, this.record.stopped !== null);
  }

  /** @returns {Step} */
  get step() {
    return /** @type {Step} */ (this.steps[this.place.at]);
  }

  async run() {
    if (this.app.live) {
      this.app.live.onmessage = (message) => {
        if (message.kind === "abort" && message.participant === this.record.participant) {
          this.abort(message.reason);
        }
      };
    }
    while (this.step.kind !== "thanks") {
      this.tell("between");
      await (this.record.stopped ? this.halted() : this.once());
    }
    this.tell("ended");
    await screenOf(this);
  }

  /** Show the step the session is at, and go where its end leads. */
  async once() {
    /** @type {Promise<{event: Event, reason: string}>} */
    const left = new Promise((resolve) => {
      this.leave = (reason) => resolve({ event: "stop", reason });
    });
    const { event, reason } = await Promise.race([screenOf(this), left]);
    await this.go(event, reason);
  }

  /**
   * @param {Event} event
   * @param {string} reason of a stop
   */
  async go(event, reason) {
    const place = moved(this.steps, this.place, event);
    const step = /** @type {Step} */ (this.steps[place.at]);
    const stopped = place.stopped ? (this.record.stopped ?? { at: now(), reason }) : null;
    await this.keep({ ...this.record, step: step.id, stopped, finished: step.kind === "thanks" });
  }

  /**
   * Keep the record, before anything else is shown.
   * @param {SessionRecord} record
   */
  async keep(record) {
    this.record = record;
    await patiently(this.app, async (storage) => {
      await keepRecord(storage, record, this.app.bundle);
      await publishProfiles(storage, record);
    });
    await this.countLearned();
  }

  /** How many places are learned now: the experimenter sees it. */
  async countLearned() {
    const files = await patiently(this.app, (storage) => learnedFiles(storage, this.record));
    const [bytes] = Object.values(files);
    const places = bytes ? placesOf(readProfile(bytes), this.app.road.limit_mps) : [];
    this.learned = places.filter((place) => !place.waits).length;
  }

  /** The session was stopped: it can go on there, now or another time. */
  async halted() {
    const declined = this.step.kind === "consent";
    const text = declined ? say("declined") : say("stopped_text");
    const reason = this.record.stopped?.reason;
    const choice = await choose(
      this.app,
      say(declined ? "thanks_title" : "stopped_title"),
      [
        element("p", {}, text),
        reason ? element("p", {}, say("ended_early_why", { reason: reasonText(reason) })) : null,
        declined ? null : element("p", {}, say("unwell")),
      ],
      [
        { text: say(declined ? "back" : "stopped_go_on"), choice: "go_on" },
        { text: say("home"), choice: "home" },
      ],
    );
    if (choice === "home") {
      location.assign(location.pathname);
      await new Promise(() => {}); // the page is left
    }
    await this.go("go_on", "");
  }

  /** @param {string} reason of the experimenter */
  abort(reason) {
    this.record = noted(this.record, `experimenter: ${reason}`, now());
    if (this.stopDrive) {
      this.stopDrive(reason);
    } else {
      this.leave(reason);
    }
  }

  /**
   * Tell the experimenter where the person is.
   * @param {StatusMessage["state"]} state
   * @param {Partial<StatusMessage>} [more]
   */
  tell(state, more = {}) {
    const { record, app } = this;
    app.live?.send({
      kind: "status",
      participant: record.participant,
      phase: this.step.kind === "drive" ? this.step.name : "",
      place: this.step.id,
      position: this.place.at + 1,
      of: this.steps.length,
      state,
      reason: record.stopped?.reason ?? "",
      order: record.order,
      explanation: record.explanation,
      unit: unitOf(app.settings),
      language: language(),
      learned_places: this.learned,
      end_m: app.bundle.plan.end_m,
      ...more,
    });
  }
}
