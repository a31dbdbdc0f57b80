// Read the profiles in a folder as the page does; print what is in each, or why it is refused.

import { createHash } from "node:crypto";
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";

import { readProfile } from "../../../fmu_src/pldf/cockpit/page/engine/profile.js";
import { ProfileRefused } from "../../../fmu_src/pldf/cockpit/page/engine/profile_refused.js";

/** @param {Uint8Array} data */
function told(data) {
  try {
    const { iterations, ...start } = readProfile(data);
    return { ...start, iterations: iterations.map(toldIteration) };
  } catch (error) {
    if (error instanceof ProfileRefused) return { refused: error.reason, where: error.where };
    throw error;
  }
}

/** @param {import("../../../fmu_src/pldf/cockpit/page/engine/profile.js").Iteration} iteration */
function toldIteration({ columns, ...head }) {
  const sum = createHash("sha256");
  for (const values of Object.values(columns)) sum.update(new Uint8Array(values.buffer));
  return { ...head, sum: sum.digest("hex") };
}

const folder = String(process.argv[2]);
const names = readdirSync(folder).sort();
console.log(JSON.stringify(names.map((name) => told(readFileSync(join(folder, name))))));
