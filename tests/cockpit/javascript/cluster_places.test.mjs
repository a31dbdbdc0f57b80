// Where something is learned, what a drive was per metre, and what other windows know of it.

import assert from "node:assert/strict";
import { test } from "node:test";

import { phasesOf } from "../../../fmu_src/pldf/cockpit/page/cluster/desk.js";
import { wantedBy } from "../../../fmu_src/pldf/cockpit/page/cluster/second_screen.js";
import {
  actions,
  lesson,
  perMetre,
  since,
  summary,
  whereabouts,
} from "../../../fmu_src/pldf/cockpit/page/cluster/story.js";
import { Watched } from "../../../fmu_src/pldf/cockpit/page/cluster/watched.js";
import { COLUMNS } from "../../../fmu_src/pldf/cockpit/page/engine/profile_parts.js";
import { placesOf, runs } from "../../../fmu_src/pldf/cockpit/page/engine/places.js";

const NODES = 400;
const KMH = 1 / 3.6;
const LIMIT_MPS = new Float64Array(NODES).fill(100 * KMH).fill(70 * KMH, 200);

/** @typedef {import("../../../fmu_src/pldf/cockpit/page/engine/profile.js").Iteration} Iteration */

/**
 * An iteration with the limit as base profile, and `changes` [column, from, behind, value].
 * @param {number} number
 * @param {[string, number, number, number][]} changes
 * @returns {Iteration}
 */
function iteration(number, changes) {
  const columns = Object.fromEntries(COLUMNS.map(({ name }) => [name, new Float64Array(NODES)]));
  columns.base_mps = LIMIT_MPS.slice();
  columns.learned_mps = LIMIT_MPS.slice();
  for (const [name, from, behind, value] of changes) {
    const values = columns[name];
    assert.ok(values);
    for (let i = from; i < behind; i += 1)
      values[i] = name === "learned_mps" ? (LIMIT_MPS[i] ?? 0) + value : value;
  }
  return { number, kind: number ? "drive" : "base", note: "", interventions: 0, columns };
}

/** @param {...[string, number, number, number][]} iterations */
function places(...iterations) {
  const made = [iteration(0, []), ...iterations.map((changes, i) => iteration(i + 1, changes))];
  return placesOf({ driver_id: 7, route: "", nodes: NODES, iterations: made }, LIMIT_MPS);
}

/** @param {number} from @param {number} behind @param {number} kmh @param {number} drive @returns {[string, number, number, number][]} */
function pedal(from, behind, kmh, drive) {
  return [
    ["learned_mps", from, behind, kmh * KMH],
    ["drive", from, behind, drive],
    ["intervention", from, behind, 1],
    ["lessons", from, behind, drive],
  ];
}

test("a lesson by pedal is a place, where it deviates most", () => {
  const [found, ...others] = places(pedal(50, 90, 8, 1), [
    ...pedal(50, 90, 8, 2),
    ["learned_mps", 60, 61, 9 * KMH],
  ]);
  assert.deepEqual(others, []);
  assert.ok(found);
  const { by, waits, from_m, to_m, at_m, iterations, lessons } = found;
  assert.deepEqual(
    { by, waits, from_m, to_m, at_m, iterations, lessons },
    { by: "pedal", waits: false, from_m: 50, to_m: 89, at_m: 60, iterations: [2], lessons: 2 },
  );
  assert.ok(Math.abs(found.change_mps - 9 * KMH) < 1e-9);
  assert.equal(lesson(found, "KMH"), "+9 km/h: 109 instead of 100");
  assert.equal(whereabouts(found), "0.05 to 0.09 km");
  assert.equal(since(found, 1), "new from this drive");
  assert.equal(since(found, 2), "learned in drive 2");
});

test("faster and slower are two places, and a deviation that the function ignores is none", () => {
  const found = places([
    ...pedal(50, 90, 8, 1),
    ...pedal(90, 120, -6, 1),
    ...pedal(130, 140, 0.9, 1),
  ]);
  assert.deepEqual(
    found.map((place) => [place.from_m, place.to_m, Math.sign(place.change_mps)]),
    [
      [50, 89, 1],
      [90, 119, -1],
    ],
  );
});

test("a set speed is a place under each limit, and moves no pedal's place beyond its own", () => {
  const taught = /** @type {[string, number, number, number][]} */ ([
    ["offset_mps", 0, 300, 5 * KMH],
    ["learned_mps", 0, 300, 5 * KMH],
    ["drive", 0, 300, 1],
  ]);
  const found = places(taught, [...taught, ...pedal(100, 150, 5.5, 2), ...pedal(120, 140, 12, 2)]);
  assert.deepEqual(
    found.map((place) => [place.by, place.from_m, place.to_m, ...place.iterations]),
    [
      ["lever", 0, 199, 1],
      ["pedal", 120, 139, 2],
      ["lever", 200, 299, 1],
    ],
  );
  assert.equal(found[2] && lesson(found[2], "KMH"), "+5 km/h: set speed 75 at limit 70");
});

test("what waits for more evidence is shown as that", () => {
  const found = places([
    ["pending_slower", 20, 40, 2],
    ["pending_slower_mps", 20, 40, 92 * KMH],
    ["offset_pending_faster", 200, 400, 1],
    ["offset_pending_faster_mps", 200, 400, 5 * KMH],
  ]);
  assert.deepEqual(
    found.map((place) => [place.by, place.waits, place.from_m, place.to_m, place.lessons]),
    [
      ["pedal", true, 20, 39, 2],
      ["lever", true, 200, 399, 1],
    ],
  );
  assert.equal(
    found[0] && lesson(found[0], "KMH"),
    "−8 km/h: noted, not driven before you have shown it again",
  );
  assert.equal(found[0] && since(found[0], 0), "shown in 2 of your drives");
  assert.equal(
    summary([], found),
    "You let the car drive by itself. Nothing is learned on this road yet. 2 more wait to be shown again.",
  );
});

test("what pedals changed in the drive is a place, even within the set speed's part", () => {
  const taught = /** @type {[string, number, number, number][]} */ ([
    ["offset_mps", 0, 200, 10 * KMH],
    ["learned_mps", 0, 200, 10 * KMH],
    ["drive", 0, 200, 1],
  ]);
  const iterations = [
    iteration(0, []),
    iteration(1, taught),
    iteration(2, [...taught, ...pedal(50, 90, 6, 2)]),
  ];
  const profile = { driver_id: 7, route: "", nodes: NODES, iterations };
  const at = (/** @type {number} */ known) =>
    placesOf(profile, LIMIT_MPS, known).map((place) => [place.by, place.from_m, place.to_m]);
  assert.deepEqual(at(1), [
    ["lever", 0, 199],
    ["pedal", 50, 89],
  ]);
  assert.deepEqual(at(2), [["lever", 0, 199]]);
});

test("runs are of one value other than nought", () => {
  assert.deepEqual(runs([0, 1, 1, 2, 0, 0, 1]), [
    [1, 2],
    [3, 3],
    [6, 6],
  ]);
  assert.deepEqual(runs([]), []);
});

/** @param {number} time_s @param {number} s_m @param {number} speed_mps */
const frame = (time_s, s_m, speed_mps) => ({
  time_s,
  lateral_m: 0,
  heading_rad: 0,
  values: { "vehicle.s_m": s_m, "vehicle.speed_mps": speed_mps },
});

test("speeds lie between those of the frames, and nowhere else", () => {
  const speeds = perMetre([frame(0, 1.5, 10), frame(1, 3.5, 14), frame(2, 3.5, 14)], 6);
  assert.deepEqual([...speeds], [NaN, NaN, 11, 13, NaN, NaN]);
});

test("interventions are counted by kind", () => {
  const acted = (/** @type {"gas" | "brake" | "set_speed"} */ kind) => ({
    kind,
    first: 0,
    last: 1,
    from_m: 0,
    to_m: 1,
  });
  assert.equal(
    actions([acted("set_speed"), acted("gas"), acted("gas")]),
    "gas pedal 2×, set speed 1×",
  );
  assert.equal(actions([]), "");
});

/** @param {string} phase @param {number} time_s */
const told = (phase, time_s) => ({ participant: "P07", phase, time_s, values: { mode: 2 } });

test("another drive begins with another phase, or when time begins anew", () => {
  const watched = new Watched("P07");
  watched.take(told("A1", 0), 0);
  watched.take(told("A1", 0.05), 50);
  assert.equal(watched.frames.length, 2);
  watched.take(told("A2", 0.1), 100);
  assert.equal(watched.frames.length, 1);
  watched.take(told("A2", 0), 150);
  assert.equal(watched.frames.length, 1);
});

test("what was told two seconds ago is not of now, but in a pause", () => {
  const watched = new Watched("");
  assert.equal(watched.isFresh(0), false);
  watched.take(told("", 1), 1000);
  assert.equal(watched.isFresh(2900), true);
  assert.equal(watched.isFresh(3000), false);
  watched.take(/** @type {any} */ ({ kind: "status", participant: "", state: "paused" }), 2000);
  assert.equal(watched.isFresh(9000), true);
});

test("an address asks for what there is, in whatever case", () => {
  assert.deepEqual(wantedBy("?participant=P07&explanation=ICON&unit=mph&language=de"), {
    participant: "P07",
    explanation: "icon",
    unit: "MPH",
    language: "de",
  });
  assert.deepEqual(wantedBy("?explanation=much&language=fr"), {
    participant: null,
    explanation: null,
    unit: null,
    language: null,
  });
});

test("drives are those of one participant", () => {
  const paths = [
    "recordings/P07_A2.csv",
    "recordings/P07_A1.csv",
    "recordings/P070_A1.csv",
    "recordings/P07_A1.txt",
  ];
  assert.deepEqual(phasesOf(paths, "P07"), ["A1", "A2"]);
});
