// A road of a laboratory is made ready by the server, which may have to be told the way through it.

import { element, fill } from "../dom.js";
import { bytesOf } from "../engine/bundle.js";
import { say } from "./replay_words.js";

/** @typedef {import("./dropped.js").NamedBytes} NamedBytes */
/** @typedef {import("./dropped.js").NewRoad} NewRoad */
/** @typedef {Record<string, string>} Way options of `pldf route`, such as start_road */
/** @typedef {{error: string, options: Way}} Question what the server wants to know, and what it would take */

/**
 * Return what makes a road of a file.
 * @param {(question: Question) => Promise<Way>} ask
 * @returns {(file: NamedBytes) => Promise<NewRoad>}
 */
export function prepareOnServer(ask) {
  return async (file) => {
    let answer = await sent(file, {});
    while (answer.options) {
      const question = { error: answer.error, options: answer.options };
      answer = await sent(file, await ask(question));
    }
    if (answer.error) {
      throw new Error(answer.error);
    }
    const prepared = bytesOf(answer.road.prepared);
    return { ...answer, road: { ...answer.road, prepared } };
  };
}

/**
 * @param {NamedBytes} file
 * @param {Way} way
 */
async function sent({ name, bytes }, way) {
  const asked = new URLSearchParams({ name, ...way });
  const body = /** @type {BodyInit} */ (bytes);
  const response = await fetch(`api/road?${asked}`, { method: "POST", body });
  const answer = await response.json().catch(() => null);
  if (answer === null) {
    throw new Error(`${response.status} ${response.statusText}`);
  }
  return answer;
}

/**
 * Ask how to drive through a road network.
 * @param {HTMLElement} parent
 * @param {Question} question
 * @returns {Promise<Way>}
 */
export function askWay(parent, { error, options }) {
  return new Promise((resolve) => {
    const fields = Object.entries(options).map(([name, value]) => {
      const input = /** @type {HTMLInputElement} */ (element("input", { name, value }));
      return { name, input, label: element("label", {}, say("way", { name }), input) };
    });
    const submit = (/** @type {Event} */ event) => {
      event.preventDefault();
      const given = fields.filter(({ input }) => input.value.trim());
      resolve(Object.fromEntries(given.map(({ name, input }) => [name, input.value.trim()])));
    };
    const form = element(
      "form",
      { onsubmit: submit },
      element("p", { class: "notice" }, error),
      ...fields.map(({ label }) => label),
      element("button", { class: "main" }, say("try_again")),
    );
    fill(parent, form);
    fields[0]?.input.focus();
  });
}
