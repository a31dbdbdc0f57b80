// Which items of a questionnaire are shown, and what is missing or cannot be.

/** @typedef {import("../types.js").Item} Item */
/** @typedef {import("./record.js").Answer} Answer */
/** @typedef {import("./record.js").Answers} Answers */

/**
 * Return the items to show: those without a condition, or whose condition an item shown meets.
 * @param {Item[]} items
 * @param {Answers} answers
 * @returns {Item[]}
 */
export function shownItems(items, answers) {
  /** @type {Item[]} */
  const shown = [];
  for (const item of items) {
    const condition = item.only_if;
    const asked = !condition || shown.some((one) => one.id === condition.id);
    const answer = condition ? answers[condition.id] : undefined;
    if (asked && (!condition || (answer !== undefined && condition.is.includes(answer)))) {
      shown.push(item);
    }
  }
  return shown;
}

/**
 * Return what is wrong, by id of the item: required and not answered, or a number out of its range.
 * @param {Item[]} items
 * @param {Answers} answers
 * @returns {Map<string, "missing" | "range">}
 */
export function problemsOf(items, answers) {
  /** @type {Map<string, "missing" | "range">} */
  const problems = new Map();
  for (const item of shownItems(items, answers)) {
    const answer = answers[item.id];
    if (answer === undefined || answer === "") {
      if (item.required) {
        problems.set(item.id, "missing");
      }
    } else if (item.kind === "number" && !inRange(item, answer)) {
      problems.set(item.id, "range");
    }
  }
  return problems;
}

/**
 * @param {Item} item
 * @param {Answer} answer
 */
function inRange(item, answer) {
  return typeof answer === "number" && answer >= item.low && answer <= item.high;
}

/**
 * Return the answers to what is shown: an answer to an item that is hidden again counts no more.
 * @param {Item[]} items
 * @param {Answers} answers
 * @returns {Answers}
 */
export function keptAnswers(items, answers) {
  const kept = shownItems(items, answers)
    .map((item) => [item.id, answers[item.id]])
    .filter(([, answer]) => answer !== undefined && answer !== "");
  return Object.fromEntries(kept);
}
