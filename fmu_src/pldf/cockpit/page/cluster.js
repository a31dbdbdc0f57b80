// The page of the instrument cluster alone (cluster.html).

import { Live } from "./cluster/live.js";
import { SecondScreen, wantedBy } from "./cluster/second_screen.js";
import { failed } from "./cluster/window.js";
import { loadBundle } from "./engine/bundle.js";

/** A tablet that fell asleep shows nothing; where a browser does not allow it, people set it. */
async function stayAwake() {
  try {
    await navigator.wakeLock.request("screen");
  } catch {
    // not allowed here, or not now
  }
}

/** @param {Element} parent */
async function start(parent) {
  const { texts, language } = await loadBundle();
  const screen = new SecondScreen(parent, texts, wantedBy(location.search), language);
  new Live(
    (message) => screen.take(message),
    (connected) => screen.connect(connected),
  );
  document.addEventListener("visibilitychange", () => void stayAwake());
  await stayAwake();
}

const parent = document.querySelector("main");
if (parent) start(parent).catch((error) => failed(parent, error));
