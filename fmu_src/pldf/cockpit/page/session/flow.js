// The guided session as a state machine: which steps there are, and what leads from one to the next.
// An event that a step does not know changes nothing.

/** @typedef {import("../types.js").Plan} Plan */
/** @typedef {import("../types.js").Questionnaire} Questionnaire */
/** @typedef {import("./participant.js").Order} Order */
/** @typedef {"welcome" | "consent" | "questionnaire" | "device" | "practice" | "drive" | "break" | "thanks"} Kind */
/** @typedef {"next" | "agreed" | "declined" | "answered" | "ready" | "stored" | "again" | "practise" | "rested" | "stop" | "go_on"} Event */

/**
 * @typedef {object} Step
 * @property {string} id unique within a session: "drive A1", "questionnaire A2 acceptance"
 * @property {Kind} kind
 * @property {string} after of a questionnaire: phase, "start", "practice" or "end"; of a break: phase
 * @property {string} name phase of a drive, number of a practice drive, id of a questionnaire
 * @property {number} minutes of a break
 */
/** @typedef {{at: number, stopped: boolean}} Place number of the step, and whether the session was stopped there */

/** @type {Record<Kind, Partial<Record<Event, "on" | "stay" | "stop" | "practice">>>} */
const MOVES = {
  welcome: { next: "on", stop: "stop" },
  consent: { agreed: "on", declined: "stop", stop: "stop" },
  questionnaire: { answered: "on", stop: "stop" },
  device: { ready: "on", stop: "stop" },
  practice: { stored: "on", again: "stay", stop: "stop" },
  drive: { stored: "on", again: "stay", practise: "practice", stop: "stop" },
  break: { rested: "on", stop: "stop" },
  thanks: {},
};

/**
 * Return the steps of a session.
 * @param {Plan} plan
 * @param {Questionnaire[]} questionnaires
 * @param {Order} order
 * @returns {Step[]}
 */
export function stepsOf(plan, questionnaires, order) {
  /** @param {string[]} when the first one is kept with the answers */
  const asked = (...when) =>
    questionnaires
      .filter((one) => one.after.some((after) => when.includes(after)))
      .map((one) =>
        step("questionnaire", `${when[0]} ${one.id}`, { after: when[0], name: one.id }),
      );
  const practice = Array.from({ length: plan.practice }, (_, index) =>
    step("practice", String(index + 1), { name: String(index + 1) }),
  );
  const phases = plan.orders[order];
  const drives = phases.flatMap((phase, index) => [
    step("drive", phase, { name: phase }),
    ...asked(phase, ...(isLastOfSystem(phases, index) ? [phase.slice(0, 1)] : [])),
    ...rest(plan, phase, index === phases.length - 1),
  ]);
  return [
    step("welcome"),
    step("consent"),
    ...asked("start"),
    step("device"),
    ...practice,
    ...(practice.length ? asked("practice") : []),
    ...drives,
    ...asked("end"),
    step("thanks"),
  ];
}

/**
 * @param {string[]} phases
 * @param {number} index
 */
function isLastOfSystem(phases, index) {
  const system = phases[index]?.slice(0, 1) ?? "";
  return !phases.slice(index + 1).some((phase) => phase.startsWith(system));
}

/**
 * @param {Kind} kind
 * @param {string} [what]
 * @param {Partial<Step>} [more]
 * @returns {Step}
 */
function step(kind, what = "", more = {}) {
  return { id: `${kind} ${what}`.trim(), kind, after: "", name: "", minutes: 0, ...more };
}

/**
 * @param {Plan} plan
 * @param {string} phase
 * @param {boolean} last
 */
function rest(plan, phase, last) {
  const minutes = plan.breaks[phase] ?? 0;
  return minutes > 0 && !last ? [step("break", phase, { after: phase, minutes })] : [];
}

/**
 * Return where an event leads; the same place if the step does not know it.
 * @param {Step[]} steps
 * @param {Place} place
 * @param {Event} event
 * @returns {Place}
 */
export function moved(steps, place, event) {
  if (place.stopped) {
    return event === "go_on" ? { ...place, stopped: false } : place;
  }
  const kind = steps[place.at]?.kind ?? "thanks";
  switch (MOVES[kind][event]) {
    case "on":
      return { at: Math.min(place.at + 1, steps.length - 1), stopped: false };
    case "practice":
      return canPractise(steps, place) ? { at: lastPractice(steps), stopped: false } : place;
    case "stop":
      return { ...place, stopped: true };
    default:
      return place;
  }
}

/**
 * Tell whether the person may practise once more: before the first drive that counts.
 * @param {Step[]} steps
 * @param {Place} place
 */
export function canPractise(steps, place) {
  const first = steps.findIndex((one) => one.kind === "drive");
  return place.at === first && lastPractice(steps) >= 0;
}

/** @param {Step[]} steps */
function lastPractice(steps) {
  return steps.findLastIndex((one) => one.kind === "practice");
}

/**
 * Return the place of the step with this id; the first one if there is none.
 * @param {Step[]} steps
 * @param {string} id
 * @param {boolean} stopped
 * @returns {Place}
 */
export function placeOf(steps, id, stopped) {
  return {
    at: Math.max(
      0,
      steps.findIndex((one) => one.id === id),
    ),
    stopped,
  };
}
