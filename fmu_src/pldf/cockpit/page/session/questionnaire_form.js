// A questionnaire as a page: native inputs, so that a keyboard suffices and screen readers know them.

import { element, fill } from "../dom.js";
import { language } from "../language.js";
import { keptAnswers, problemsOf, shownItems } from "./answering.js";
import { button, buttons, showPage } from "./app.js";
import { say } from "./words.js";

/** @typedef {import("../types.js").Item} Item */
/** @typedef {import("../types.js").Questionnaire} Questionnaire */
/** @typedef {import("./app.js").App} App */
/** @typedef {import("./record.js").Answers} Answers */

const TEXT_MAX = 5000;

/**
 * Ask a questionnaire.
 * @param {App} app
 * @param {Questionnaire} asked
 * @param {HTMLElement} place where in the session this is
 * @param {(answers: Answers) => void} drafted told every change, so that a reload loses nothing
 * @param {Answers} [before] answers given so far
 * @returns {Promise<Answers>}
 */
export function askQuestionnaire(app, asked, place, drafted, before = {}) {
  return new Promise((resolve) => {
    const form = new Form(asked.items, { ...before }, drafted);
    const done = () => {
      const answers = form.finished();
      if (answers) {
        resolve(answers);
      }
    };
    showPage(
      app,
      asked.title[language()],
      place,
      ...paragraphs(asked.intro[language()]),
      form.list,
      form.told,
      buttons(button(say("next"), done, "main")),
    );
  });
}

/** @param {string} text */
function paragraphs(text) {
  return text
    .split(/\n\s*\n/)
    .filter((part) => part.trim())
    .map((part) => element("p", {}, part));
}

class Form {
  /**
   * @param {Item[]} items
   * @param {Answers} answers
   * @param {(answers: Answers) => void} drafted
   */
  constructor(items, answers, drafted) {
    this.items = items;
    this.answers = answers;
    this.drafted = drafted;
    this.checked = false;
    /** @type {Map<string, {field: HTMLElement, problem: HTMLElement}>} */
    this.fields = new Map();
    this.told = element("p", { class: "problem", "aria-live": "assertive" });
    this.list = element("div", { class: "items" }, ...items.map((item) => this.field(item)));
    this.refresh();
  }

  /** @param {Item} item */
  field(item) {
    const problem = element("p", { class: "problem", id: `problem-${item.id}` });
    const legend = element("legend", {}, item.text[language()]);
    if (!item.required) {
      legend.append(" ", element("small", {}, say("optional")));
    }
    const attributes = { "data-item": item.id, "aria-describedby": `problem-${item.id}` };
    const field = element("fieldset", attributes, legend, this.control(item), problem);
    this.fields.set(item.id, { field, problem });
    return field;
  }

  /** @param {Item} item */
  control(item) {
    switch (item.kind) {
      case "scale":
        return this.scale(item);
      case "choice":
        return this.choice(item);
      case "number":
        return this.number(item);
      default:
        return this.text(item);
    }
  }

  /** @param {Item} item */
  scale(item) {
    const numbers = Array.from({ length: item.boxes }, (_, index) => index + 1);
    const [left, right] = [item.left[language()], item.right[language()]];
    const boxes = numbers.map((number) => {
      const ends = number === 1 ? left : number === item.boxes ? right : "";
      return this.radio(item, number, `${number}${ends ? ` ${ends}` : ""}`, "box", String(number));
    });
    return element(
      "div",
      { class: "scale" },
      element("span", { class: "end left", "aria-hidden": "true" }, left),
      element("span", { class: "boxes" }, ...boxes),
      element("span", { class: "end right", "aria-hidden": "true" }, right),
    );
  }

  /** @param {Item} item */
  choice(item) {
    const options = item.options.map(({ key, text }) =>
      this.radio(item, key, "", "option", text[language()]),
    );
    return element("div", { class: "options" }, ...options);
  }

  /**
   * @param {Item} item
   * @param {string | number} value
   * @param {string} label read out in place of `text`; empty: `text`
   * @param {string} kind
   * @param {string} text
   */
  radio(item, value, label, kind, text) {
    const input = element("input", {
      type: "radio",
      name: item.id,
      value: String(value),
      "aria-label": label || false,
      checked: this.answers[item.id] === value,
      onchange: () => this.answer(item.id, value),
    });
    return element("label", { class: kind }, input, element("span", {}, text));
  }

  /** @param {Item} item */
  number(item) {
    const input = /** @type {HTMLInputElement} */ (
      element("input", {
        type: "number",
        min: item.low,
        max: item.high,
        step: "any",
        "aria-label": item.text[language()],
        value: this.answers[item.id],
      })
    );
    input.addEventListener("input", () =>
      this.answer(item.id, input.value === "" ? "" : Number(input.value)),
    );
    return input;
  }

  /** @param {Item} item */
  text(item) {
    const area = /** @type {HTMLTextAreaElement} */ (
      element("textarea", {
        rows: 4,
        maxlength: TEXT_MAX,
        "aria-label": item.text[language()],
      })
    );
    area.value = String(this.answers[item.id] ?? "");
    area.addEventListener("input", () => this.answer(item.id, area.value));
    return area;
  }

  /**
   * @param {string} id
   * @param {string | number} value
   */
  answer(id, value) {
    this.answers[id] = value;
    this.drafted({ ...this.answers });
    this.refresh();
  }

  /** Show what is asked now, and what is wrong once that was looked at. */
  refresh() {
    const shown = new Set(shownItems(this.items, this.answers).map((item) => item.id));
    const problems = this.checked ? problemsOf(this.items, this.answers) : new Map();
    for (const item of this.items) {
      const { field, problem } = /** @type {{field: HTMLElement, problem: HTMLElement}} */ (
        this.fields.get(item.id)
      );
      field.hidden = !shown.has(item.id);
      field.classList.toggle("wrong", problems.has(item.id));
      fill(problem, problemText(item, problems.get(item.id)));
    }
    fill(this.told, problems.size > 0 && say("to_answer", { count: problems.size }));
    return problems;
  }

  /** @returns {Answers | null} null: something is missing, and is shown */
  finished() {
    this.checked = true;
    const [first] = this.refresh().keys();
    if (first === undefined) {
      return keptAnswers(this.items, this.answers);
    }
    const wrong = this.fields.get(first)?.field;
    wrong?.scrollIntoView({ block: "center" });
    /** @type {HTMLElement | null | undefined} */ (
      wrong?.querySelector("input, textarea")
    )?.focus();
    return null;
  }
}

/**
 * @param {Item} item
 * @param {"missing" | "range" | undefined} problem
 */
function problemText(item, problem) {
  if (problem === "range") {
    return say("out_of_range", { low: item.low, high: item.high });
  }
  return problem === "missing" && say("required");
}
