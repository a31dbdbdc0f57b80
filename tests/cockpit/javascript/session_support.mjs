// A small study for the tests of the guided session.

/** @typedef {import("../../../fmu_src/pldf/cockpit/page/types.js").Plan} Plan */
/** @typedef {import("../../../fmu_src/pldf/cockpit/page/types.js").Item} Item */
/** @typedef {import("../../../fmu_src/pldf/cockpit/page/types.js").Questionnaire} Questionnaire */

/**
 * @param {Partial<Plan>} [more]
 * @returns {Plan}
 */
export function plan(more = {}) {
  const drive = (/** @type {string} */ phase) => ({
    phase,
    apply_learned: phase.startsWith("B"),
    learn: phase !== "A1",
    intervenes: true,
    values: {},
  });
  return {
    title: "a study",
    drives: ["A1", "A2", "B1", "B2"].map(drive),
    orders: { AB: ["A1", "A2", "B1", "B2"], BA: ["A2", "B1", "B2", "A1"] },
    counterbalanced: false,
    practice: 1,
    practice_end_m: 500,
    step_s: 0.01,
    end_m: 4500,
    breaks: {},
    explanations: ["text"],
    steering: "assisted",
    fov_deg: 60,
    ...more,
  };
}

/**
 * @param {Partial<Item>} more
 * @returns {Item}
 */
export function item(more) {
  const nothing = { en: "", de: "" };
  return {
    id: "laan_1",
    kind: "scale",
    text: { en: "words", de: "Worte" },
    options: [],
    boxes: 5,
    left: nothing,
    right: nothing,
    low: 1,
    high: 5,
    required: true,
    only_if: null,
    ...more,
  };
}

/**
 * @param {string} id
 * @param {string[]} after
 * @param {Item[]} [items]
 * @returns {Questionnaire}
 */
export function questionnaire(id, after, items = [item({})]) {
  return { id, after, items, title: { en: id, de: id }, intro: { en: "", de: "" } };
}
