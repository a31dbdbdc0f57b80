import assert from "node:assert/strict";
import { test } from "node:test";

import { readReplay, ReplayError } from "../../../fmu_src/pldf/cockpit/page/engine/replay.js";

const OURS = `# device: keyboard
time_s,s_m,speed_mps,mode,profile_mps,base_mps,lever_up,hmi_reason,unknown
0.0,1.0,20.0,ACTIVE,23.0,22.0,0,CURVE,x
0.5,11.0,20.5,GAS_OVERRIDE,23.0,22.5,1,LEARNED_FASTER,y
`;

test("a recording of ours is watched under the names of the FMUs", () => {
  const replay = readReplay(OURS);
  assert.deepEqual(replay.comments, ["device: keyboard"]);
  assert.deepEqual(replay.frames[1], {
    time_s: 0.5,
    lateral_m: 0,
    heading_rad: 0,
    values: {
      "vehicle.s_m": 11,
      "vehicle.speed_mps": 20.5,
      mode: 3,
      base_speed_mps: 22.5,
      "lever.up": true,
      "hmi.reason_code": 3,
      "hmi.learned_delta_mps": 0.5,
    },
  });
  assert.equal(replay.at(0.25).values["vehicle.s_m"], 6);
  assert.deepEqual([replay.begin_s, replay.end_s], [0, 0.5]);
});

test("a laboratory's table with semicolons, decimal commas, quotes and codes is one, too", () => {
  const text = `\uFEFFtime_s;"s_m";speed_mps;mode;eligible\r\n\r\n0,0;1,5;20;2;true\r\n"0,1";3,5;20;2;\r\n`;
  const utf16 = new Uint8Array(new Uint16Array([...text].map((one) => one.charCodeAt(0))).buffer);
  for (const file of [new TextEncoder().encode(text), utf16]) {
    const { frames } = readReplay(file);
    assert.deepEqual(
      frames.map((frame) => [frame.time_s, frame.values["vehicle.s_m"], frame.values.mode]),
      [
        [0, 1.5, 2],
        [0.1, 3.5, 2],
      ],
    );
    assert.equal(frames[0].values.eligible, true);
    assert.equal("eligible" in frames[1].values, false);
  }
});

test("a logger that stutters is passed over, and told", () => {
  const text = "time_s,s_m,speed_mps\n0,0,1\n1,1,1\n1,1,1\n0.5,2,1\n0.7,2,1\n2,2,1\n";
  const replay = readReplay(text);
  assert.deepEqual(
    replay.frames.map(({ time_s }) => time_s),
    [0, 1, 2],
  );
  assert.equal(replay.passed_over, 3);
});

/** @type {[string, string, ReplayError["details"]][]} */
const REFUSED = [
  ["time_s,speed\n0,1\n", "missing", { columns: ["s_m", "speed_mps"] }],
  ["", "missing", { columns: ["time_s", "s_m", "speed_mps"] }],
  ["time_s,s_m,speed_mps\n0,0,1\n", "empty", {}],
  ["# a\ntime_s,s_m,speed_mps\n0,0,1\n1,,1\n", "cell", { line: 4, column: "s_m", value: "" }],
  [
    "time_s,s_m,speed_mps,mode\n0,0,1,DRIVING\n1,1,1,ACTIVE\n",
    "cell",
    { line: 2, column: "mode", value: "DRIVING" },
  ],
  ['time_s,s_m,speed_mps\n"0,0,1\n', "table", { value: "line 2: a quote that does not end" }],
];

for (const [text, problem, details] of REFUSED) {
  test(`what cannot be watched is refused: ${problem}, ${JSON.stringify(details)}`, () => {
    assert.throws(
      () => readReplay(text),
      (error) =>
        error instanceof ReplayError &&
        error.problem === problem &&
        JSON.stringify(error.details) === JSON.stringify(details),
    );
  });
}
