// Print the interventions that the page finds in each drive of a list of columns.

import { readFileSync } from "node:fs";

import { interventionsOf } from "../../../fmu_src/pldf/cockpit/page/engine/interventions.js";

const NAMES = {
  mode: "mode",
  brake_pedal: "driver.brake_pedal",
  s_m: "vehicle.s_m",
  set_speed_offset_mps: "set_speed_offset_mps",
};

/** @param {Record<string, number[]>} columns */
function framesOf(columns) {
  return (columns.time_s ?? []).map((time_s, row) => ({
    time_s,
    lateral_m: 0,
    heading_rad: 0,
    values: Object.fromEntries(
      Object.entries(NAMES).map(([column, name]) => [name, columns[column]?.[row] ?? 0]),
    ),
  }));
}

const drives = JSON.parse(readFileSync(String(process.argv[2]), "utf-8"));
console.log(
  JSON.stringify(
    drives.map((/** @type {Record<string, number[]>} */ drive) => interventionsOf(framesOf(drive))),
  ),
);
