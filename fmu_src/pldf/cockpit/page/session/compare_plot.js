// Speeds of recordings and profiles over distance, in one plot.

import uPlot from "../vendor/uplot.js";
import { columnOf, iterationOf } from "../engine/profile.js";
import { inUnit, unitText } from "../cluster/units.js";
import { speedsAt } from "./comparing.js";
import { say } from "./replay_words.js";

/** @typedef {import("../engine/profile.js").Profile} Profile */
/** @typedef {import("../cluster/live.js").Unit} Unit */
/** @typedef {import("./comparing.js").ByDistance} ByDistance */
/** @typedef {{label: string, values: (number | null)[], dashed: boolean}} Line */

// Okabe and Ito's colours, as in the project's report.
const COLOURS = ["#000000", "#D55E00", "#0072B2", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"];
const PLACES_EVERY_M = 2;
const HEIGHT_PX = 280;

/**
 * Draw recordings and profiles.
 * @param {HTMLElement} parent
 * @param {number} length_m of the road
 * @param {{name: string, by_distance: ByDistance}[]} recordings
 * @param {{name: string, profile: Profile}[]} profiles
 * @param {Unit} unit
 * @returns {uPlot}
 */
export function comparePlot(parent, length_m, recordings, profiles, unit) {
  const count = Math.floor(length_m / PLACES_EVERY_M) + 1;
  const places_m = Array.from({ length: count }, (_, index) => index * PLACES_EVERY_M);
  const lines = [
    ...recordings.map(({ name, by_distance }) => ({
      label: name,
      values: speedsAt(by_distance, places_m, inUnit(1, unit)),
      dashed: false,
    })),
    ...profiles.flatMap(({ name, profile }) => profileLines(name, profile, places_m, unit)),
  ];
  const series = lines.map(({ label, dashed }, index) => ({
    label,
    stroke: COLOURS[index % COLOURS.length],
    width: 2,
    ...(dashed && { dash: [6, 4] }),
  }));
  const options = {
    width: Math.max(parent.clientWidth, 300),
    height: HEIGHT_PX,
    scales: { x: { time: false } },
    axes: [{ label: say("distance") }, { label: say("speed_axis", { unit: unitText(unit) }) }],
    series: [{ label: "km" }, ...series],
  };
  const kilometres = places_m.map((s_m) => s_m / 1000);
  return new uPlot(options, [kilometres, ...lines.map(({ values }) => values)], parent);
}

/**
 * Return how a profile is called beside its line: of driver-000007_route-92a6126a3ee130f8.pldf the number.
 * @param {string} name of the file
 */
function shortName(name) {
  return name.replace(/^driver-0*(\d+)_route-.*$/, "$1").replace(/\.pldf$/, "");
}

/**
 * @param {string} name
 * @param {Profile} profile
 * @param {number[]} places_m
 * @param {Unit} unit
 * @returns {Line[]}
 */
function profileLines(name, profile, places_m, unit) {
  const newest = iterationOf(profile);
  /** @param {Float64Array} column */
  const values = (column) =>
    places_m.map((s_m) => (s_m < column.length ? inUnit(column[s_m] ?? 0, unit) : null));
  return [
    {
      label: `${shortName(name)}, ${say("learned")}`,
      values: values(columnOf(newest, "learned_mps")),
      dashed: false,
    },
    {
      label: `${shortName(name)}, ${say("base")}`,
      values: values(columnOf(newest, "base_mps")),
      dashed: true,
    },
  ];
}
