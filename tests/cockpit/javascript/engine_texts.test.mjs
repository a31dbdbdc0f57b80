import assert from "node:assert/strict";
import { test } from "node:test";

import { bytesOf, decoded } from "../../../fmu_src/pldf/cockpit/page/engine/bundle.js";
import { inputsCsv, readInputs } from "../../../fmu_src/pldf/cockpit/page/engine/input_changes.js";

test("bytes come back from base64", () => {
  const bytes = Uint8Array.from({ length: 256 }, (_, at) => at);
  assert.deepEqual(bytesOf(Buffer.from(bytes).toString("base64")), bytes);
});

test("a bundle's bytes are decoded wherever they are", () => {
  const text = Buffer.from("road").toString("base64");
  const told = {
    version: "1",
    models: { pldf: { name: "A", wasm: text, resources: { "route/0.prepared": text } } },
    road: { prepared: text },
  };
  const bundle = decoded(/** @type {any} */ (told));
  const road = new TextEncoder().encode("road");
  assert.deepEqual(bundle.models.pldf.wasm, road);
  assert.deepEqual(bundle.models.pldf.resources["route/0.prepared"], road);
  assert.deepEqual(bundle.road.prepared, road);
  assert.equal(bundle.version, "1");
});

test("inputs are read back to the bit", () => {
  const changes = [
    { step: 0, name: "driver.gas_pedal", value: 0.1 + 0.2 },
    { step: 17, name: "lever.up", value: 1 },
    { step: 18, name: "steering", value: -1e-7 },
  ];
  assert.deepEqual(readInputs(inputsCsv(changes)), changes);
  assert.deepEqual(readInputs(inputsCsv([])), []);
});

/** @type {[string, RegExp][]} */
const REFUSED = [
  ["step,name\n", /line 1/],
  ["step,name,value\n1.5,lever.up,1\n", /line 2/],
  ["step,name,value\n1,lever.up,\n", /line 2/],
  ["step,name,value\n1,lever.up,1\n2,lever.up,x\n", /line 3/],
];

for (const [text, told] of REFUSED) {
  test(`a table that is none of ours is refused: ${JSON.stringify(text)}`, () => {
    assert.throws(() => readInputs(text), told);
  });
}
