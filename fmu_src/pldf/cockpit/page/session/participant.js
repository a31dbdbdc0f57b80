// Who takes part: a pseudonym with exactly one number, and what follows from the number.

/** @typedef {import("../types.js").Plan} Plan */
/** @typedef {"AB" | "BA"} Order */
/** @typedef {"none" | "icon" | "text"} Explanation */
/**
 * @typedef {object} Participant
 * @property {string} name pseudonym, P07
 * @property {number} driver_id its number: whose profile it is
 * @property {Order} order
 * @property {Explanation} explanation how much the cluster explains
 */

// The profile store names drivers with six digits.
const NUMBER_MAX = 999999;

/**
 * Return the pseudonym meant by what somebody typed: `7` and `07` are P07; null: it is none.
 * @param {string} typed
 * @returns {{name: string, driver_id: number} | null}
 */
export function pseudonym(typed) {
  const parts = /^([A-Za-z]{0,12})[-\s]?(\d{1,6})$/.exec(typed.trim());
  if (!parts) {
    return null;
  }
  const driver_id = Number(parts[2]);
  if (driver_id < 1 || driver_id > NUMBER_MAX) {
    return null;
  }
  const letters = (parts[1] ?? "").toUpperCase() || "P";
  return { name: `${letters}${String(driver_id).padStart(2, "0")}`, driver_id };
}

/**
 * Return who drives in which order and with which explanations; null if `typed` is no pseudonym.
 * @param {string} typed
 * @param {string | null} order AB or BA; else the plan decides
 * @param {Plan} plan
 * @returns {Participant | null}
 */
export function participantOf(typed, order, plan) {
  const who = pseudonym(typed);
  if (!who) {
    return null;
  }
  return {
    ...who,
    order: orderOf(order, who.driver_id, plan),
    explanation: explanationOf(who.driver_id, plan),
  };
}

/**
 * Both orders of a counterbalanced study occur equally often with each condition: two people with
 * numbers in a row have the same one.
 * @param {number} number
 * @param {Plan} plan
 * @returns {Explanation}
 */
function explanationOf(number, { explanations, counterbalanced }) {
  const turn = counterbalanced ? Math.floor((number - 1) / 2) : number - 1;
  return explanations[turn % explanations.length] ?? "text";
}

/**
 * @param {string | null} asked
 * @param {number} number
 * @param {Plan} plan
 * @returns {Order}
 */
function orderOf(asked, number, plan) {
  if (asked === "AB" || asked === "BA") {
    return asked;
  }
  return plan.counterbalanced && number % 2 === 0 ? "BA" : "AB";
}
