// What the page writes of numbers and recordings: a task in JSON on stdin, the texts on stdout.
import { readFileSync } from "node:fs";

import { COLUMNS } from "../../../fmu_src/pldf/cockpit/page/engine/columns.js";
import { floatText } from "../../../fmu_src/pldf/cockpit/page/engine/numbers.js";
import { recordingCsv } from "../../../fmu_src/pldf/cockpit/page/engine/recording.js";

/** @param {string} hex little-endian */
const numbersOf = (hex) => new Float64Array(new Uint8Array(Buffer.from(hex, "hex")).buffer);

const task = JSON.parse(readFileSync(0, "utf8"));
if (task.kind === "columns") {
  process.stdout.write(JSON.stringify(COLUMNS));
} else if (task.kind === "numbers") {
  process.stdout.write(Array.from(numbersOf(task.hex), floatText).join("\n"));
} else {
  const columns = new Map();
  for (const [name, hex] of Object.entries(task.columns)) {
    columns.set(name, numbersOf(hex));
  }
  process.stdout.write(recordingCsv(columns, task.comments));
}
