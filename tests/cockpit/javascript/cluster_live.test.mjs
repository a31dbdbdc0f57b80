// The line to the server: it is made anew when it breaks, and then tells again where the person is.

import assert from "node:assert/strict";
import { beforeEach, mock, test } from "node:test";

import { Live } from "../../../fmu_src/pldf/cockpit/page/cluster/live.js";

/** A WebSocket that does what the test says. */
class Line extends EventTarget {
  static OPEN = 1;
  /** @type {Line[]} */
  static made = [];

  /** @param {URL} address */
  constructor(address) {
    super();
    this.address = address.href;
    this.readyState = 0;
    /** @type {string[]} */
    this.sent = [];
    Line.made.push(this);
  }

  open() {
    this.readyState = Line.OPEN;
    this.dispatchEvent(new Event("open"));
  }

  close() {
    this.readyState = 3;
    this.dispatchEvent(new Event("close"));
  }

  /** @param {string} text */
  send(text) {
    this.sent.push(text);
  }
}

const STATUS = /** @type {any} */ ({ kind: "status", participant: "P07", state: "driving" });
const FRAME = { time_s: 1, values: {} };

/** @returns {Line} the newest one */
const line = () => Line.made.at(-1) ?? assert.fail("no line was made");

beforeEach(() => {
  mock.timers.reset();
  mock.timers.enable({ apis: ["setTimeout"] });
  Line.made = [];
  Object.assign(globalThis, { WebSocket: Line, location: { href: "http://127.0.0.1:81/key/" } });
});

test("the address carries the key of the page", () => {
  new Live(() => {});
  assert.equal(line().address, "ws://127.0.0.1:81/key/api/live");
});

test("what is told while there is no line is lost, but for where the person is", () => {
  const live = new Live(() => {});
  live.send(FRAME);
  live.send(STATUS);
  line().open();
  assert.deepEqual(line().sent, [JSON.stringify(STATUS)]);
  live.send(FRAME);
  assert.equal(line().sent.length, 2);
});

test("a line that breaks is made anew", () => {
  /** @type {boolean[]} */
  const states = [];
  const live = new Live(
    () => {},
    (connected) => states.push(connected),
  );
  line().open();
  live.send(STATUS);
  line().close();
  assert.equal(Line.made.length, 1);
  mock.timers.tick(1000);
  assert.equal(Line.made.length, 2);
  line().open();
  assert.deepEqual(line().sent, [JSON.stringify(STATUS)]);
  assert.deepEqual(states, [true, false, true]);
});

test("who is done makes no new line", () => {
  const live = new Live(() => {});
  line().open();
  live.close();
  mock.timers.tick(5000);
  assert.equal(Line.made.length, 1);
});

test("only messages are handed on", () => {
  /** @type {unknown[]} */
  const heard = [];
  new Live((message) => heard.push(message));
  for (const data of ["nonsense", JSON.stringify(STATUS)]) {
    line().dispatchEvent(new MessageEvent("message", { data }));
  }
  assert.deepEqual(heard, [STATUS]);
});
