import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";

import { STANDARD } from "../../../fmu_src/pldf/cockpit/page/engine/inputs/calibration.js";
import {
  connectedDevices,
  deviceNamed,
  GamepadInput,
} from "../../../fmu_src/pldf/cockpit/page/engine/inputs/gamepad.js";
import { Inputs } from "../../../fmu_src/pldf/cockpit/page/engine/inputs/inputs.js";
import { Keyboard } from "../../../fmu_src/pldf/cockpit/page/engine/inputs/keyboard.js";

const PAD = "a pad";
/** @type {{id: string, connected: boolean, axes: number[], buttons: {value: number, pressed: boolean}[]}[]} */
let pads = [];

Object.defineProperty(globalThis.navigator, "getGamepads", { value: () => [null, ...pads] });

beforeEach(() => {
  const buttons = Array.from({ length: 16 }, () => ({ value: 0, pressed: false }));
  pads = [{ id: PAD, connected: true, axes: [0, 0, 0, 0], buttons }];
});

/** A window in which keys are pressed. */
function keys() {
  const target = new EventTarget();
  const keyboard = new Keyboard(/** @type {Window} */ (/** @type {unknown} */ (target)));
  /**
   * @param {"keydown" | "keyup" | "blur"} kind
   * @param {string} [code]
   * @param {number} [at_ms]
   * @param {object} [more]
   */
  const send = (kind, code = "", at_ms = 0, more = {}) => {
    const event = new Event(kind, { cancelable: true });
    for (const [name, value] of Object.entries({ code, timeStamp: at_ms, ...more })) {
      Object.defineProperty(event, name, { value });
    }
    target.dispatchEvent(event);
    return event;
  };
  return { keyboard, send };
}

/**
 * Read each 10 ms.
 * @param {Keyboard} keyboard
 * @param {number} from_ms
 * @param {number} to_ms
 */
function readTill(keyboard, from_ms, to_ms) {
  let controls = keyboard.read(from_ms);
  for (let now_ms = from_ms; now_ms <= to_ms; now_ms += 10) {
    controls = keyboard.read(now_ms);
  }
  return controls;
}

test("a key is a foot that needs time, and lets go quicker than it presses", () => {
  const { keyboard, send } = keys();
  keyboard.read(0);
  send("keydown", "ArrowUp", 0);
  const half = readTill(keyboard, 0, 500).gas_pedal;
  assert.ok(half > 0.3 && half < 0.4, `${half}`);
  assert.equal(readTill(keyboard, 500, 3000).gas_pedal, 1);
  send("keyup", "ArrowUp", 3000);
  assert.equal(readTill(keyboard, 3000, 3350).gas_pedal, 0);
});

test("a picture that comes late does not press a pedal through the floor", () => {
  const { keyboard, send } = keys();
  keyboard.read(0);
  send("keydown", "ArrowDown", 0);
  assert.ok(keyboard.read(5000).brake_pedal < 0.1);
});

test("both ways at once is straight on", () => {
  const { keyboard, send } = keys();
  keyboard.read(0);
  send("keydown", "ArrowLeft");
  assert.equal(readTill(keyboard, 0, 2000).steering, 1);
  send("keydown", "KeyD");
  assert.equal(readTill(keyboard, 2000, 4000).steering, 0);
});

test("a key that is held speaks once", () => {
  const { keyboard, send } = keys();
  send("keydown", "KeyP");
  send("keydown", "KeyP", 500, { repeat: true });
  assert.equal(keyboard.read(600).pause_learning, true);
  send("keyup", "KeyP");
  send("keydown", "KeyP");
  assert.equal(keyboard.read(700).pause_learning, false);
});

test("a button is seen though it was pressed and let go between two pictures", () => {
  const { keyboard, send } = keys();
  send("keydown", "KeyF");
  send("keyup", "KeyF");
  assert.equal(keyboard.read(10).forget_here, true);
  assert.equal(keyboard.read(20).forget_here, false);
  keyboard.push("undo");
  assert.equal(keyboard.read(30).undo, true);
  assert.equal(keyboard.read(40).undo, false);
});

test("keys that are written, or mean something to the browser, drive no car", () => {
  const { keyboard, send } = keys();
  const written = { target: { matches: (/** @type {string} */ what) => what.includes("input") } };
  assert.equal(send("keydown", "KeyF", 0, written).defaultPrevented, false);
  assert.equal(send("keydown", "KeyR", 0, { ctrlKey: true }).defaultPrevented, false);
  assert.equal(send("keydown", "Tab").defaultPrevented, false);
  assert.equal(send("keydown", "PageUp").defaultPrevented, true);
  const { forget_here, resume } = keyboard.read(10);
  assert.deepEqual([forget_here, resume], [false, false]);
});

test("a window that is left lets all keys go, and one that is gone hears none", () => {
  const { keyboard, send } = keys();
  send("keydown", "ArrowUp");
  send("blur");
  assert.equal(readTill(keyboard, 0, 500).gas_pedal, 0);
  keyboard.dispose();
  send("keydown", "KeyP");
  assert.equal(keyboard.read(600).pause_learning, false);
});

test("the lever by keys: short, long, resume", () => {
  const { keyboard, send } = keys();
  send("keydown", "KeyE", 0);
  send("keyup", "KeyE", 120);
  assert.equal(keyboard.read(130).up, true);
  send("keydown", "KeyQ", 300);
  assert.equal(readTill(keyboard, 300, 820).down_long, true);
  send("keyup", "KeyQ", 900);
  send("keydown", "KeyR", 1000);
  assert.equal(readTill(keyboard, 1000, 1070).resume, true);
});

test("with a device its pedals count, and the levers of both", () => {
  const { keyboard, send } = keys();
  const inputs = new Inputs(keyboard, new GamepadInput(PAD, STANDARD));
  assert.equal(inputs.name, PAD);
  pads[0].buttons[7].value = 1;
  pads[0].axes[0] = -1;
  send("keydown", "ArrowDown");
  send("keydown", "KeyR", 5);
  readTill(keyboard, 0, 0);
  const controls = inputs.read(10);
  assert.ok(controls);
  const { gas_pedal, brake_pedal, steering, resume } = controls;
  assert.deepEqual([gas_pedal, brake_pedal, steering, resume], [1, 0, 1, true]);
});

test("learning is paused by either, and goes on by either", () => {
  const { keyboard, send } = keys();
  const inputs = new Inputs(keyboard, new GamepadInput(PAD, STANDARD));
  const paused = () => inputs.read(0)?.pause_learning;
  assert.equal(paused(), false);
  send("keydown", "KeyP");
  assert.equal(paused(), true);
  pads[0].buttons[3].value = 1;
  assert.equal(paused(), false);
  assert.equal(paused(), false);
  pads[0].buttons[3].value = 0;
  keyboard.push("pause_learning");
  assert.equal(paused(), true);
  inputs.begin();
  assert.equal(paused(), false);
});

test("a device that is gone is told", () => {
  const { keyboard } = keys();
  const inputs = new Inputs(keyboard, new GamepadInput(PAD, STANDARD));
  pads[0].connected = false;
  assert.equal(inputs.read(0), null);
  assert.equal(new Inputs(keyboard).read(0)?.gas_pedal, 0);
});

test("pedals with a plug of their own are one device with the wheel, however they were plugged in", () => {
  const [wheel] = pads;
  const pedals = { ...wheel, id: "THE pedals", axes: [0.25], buttons: [] };
  pads = [wheel, pedals];
  assert.deepEqual(
    connectedDevices().map(({ id }) => id),
    [PAD, "THE pedals", `THE pedals + ${PAD}`],
  );
  pads = [pedals, wheel];
  assert.equal(deviceNamed(`THE pedals + ${PAD}`)?.axes[0], 0.25);
  pads = [pedals];
  assert.equal(deviceNamed(`THE pedals + ${PAD}`), null);
  assert.equal(deviceNamed(PAD), null);
});
