// The experimenter's page (experimenter.html): who drives where, and an end to a drive.

import { Desk } from "./cluster/desk.js";
import { Live } from "./cluster/live.js";
import { wantedBy } from "./cluster/second_screen.js";
import { failed } from "./cluster/window.js";
import { loadBundle } from "./engine/bundle.js";
import { roadOf } from "./engine/road.js";
import { speak } from "./language.js";

/** @returns {Promise<string[]>} paths of the recordings that the server has */
async function recordings() {
  const answer = await fetch("api/files/?prefix=recordings/");
  return answer.ok ? answer.json() : [];
}

/** @param {Element} parent */
async function start(parent) {
  const { texts, language, road } = await loadBundle();
  speak(wantedBy(location.search).language ?? language);
  const desk = new Desk(parent, {
    texts,
    road: roadOf(road),
    recordings,
    tell: (message) => live.send(message),
  });
  const live = new Live(
    (message) => desk.take(message),
    (connected) => desk.connect(connected),
  );
}

const parent = document.querySelector("main");
if (parent) start(parent).catch((error) => failed(parent, error));
