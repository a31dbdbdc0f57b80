// The pictograms that the project's table of reasons and events names, drawn in one style:
// 24 units wide, lines of 2, in the colour of the text around them.

import { svg } from "./svg.js";

const RING = "M12 3a9 9 0 1 1 0 18a9 9 0 1 1 0-18z";
const SMALL_RING = "M12 7a7 7 0 1 1 0 14a7 7 0 1 1 0-14z";
const PIN = "M12 22c5-5.5 7.5-9 7.5-12.5a7.5 7.5 0 1 0-15 0c0 3.5 2.5 7 7.5 12.5z";
const UP = "M8.5 11.5l3.5-3.5l3.5 3.5";
const DOWN = "M8.5 8l3.5 3.5l3.5-3.5";
const CURVE = "M7 21v-6c0-6 9-3 9-9v-2M12.5 7.5l3.5-4l3.5 4";
const CAR = "M5 17v-5l2-5h10l2 5v5zM5 12h14M7.5 17v2.5M16.5 17v2.5M8 14.5h1.5M14.5 14.5h1.5";
const TRIANGLE = "M12 3l9.5 17h-19z";

/**
 * Lines of each pictogram; `sign`: there is room for a number in it, at this height.
 * @type {Record<string, {lines: string, sign?: number, dashed?: boolean}>}
 */
const ICONS = {
  limit: { lines: RING, sign: 15.5 },
  curve: { lines: CURVE },
  "limit-ahead": { lines: `${SMALL_RING}M8.5 4l3.5-3l3.5 3`, sign: 17 },
  "learned-faster": { lines: `${PIN}${UP}` },
  "learned-slower": { lines: `${PIN}${DOWN}` },
  "learned-set-speed": { lines: `${PIN}M8.5 8h7M8.5 11.5h7` },
  "set-speed": { lines: "M4 18a9 9 0 1 1 16 0M12 14l4.5-5M12 17.5v3M10 20.5h4" },
  pedal: { lines: "M9 3h6l1.5 12h-9zM8.5 19h7M9.5 7h5M9 11h6" },
  "curve-bound": { lines: `${CURVE}M3 4h8` },
  "limit-bound": { lines: `${SMALL_RING}M4 3h16`, sign: 17 },
  standby: {
    lines: `${RING}M12 10a2 2 0 1 1 0 4a2 2 0 1 1 0-4zM3.5 11l6.5 .5M20.5 11l-6.5 .5M12 14v7`,
  },
  fault: { lines: `${TRIANGLE}M12 9.5v5M12 17v.5` },
  "car-ahead": { lines: CAR },
  off: { lines: "M12 3v8M7 6a8 8 0 1 0 10 0" },
  slower: { lines: "M6 5l6 6l6-6M6 12l6 6l6-6" },
  faster: { lines: "M6 12l6-6l6 6M6 19l6-6l6 6" },
  "temporary-limit": { lines: RING, sign: 15.5, dashed: true },
  "car-ahead-stands": { lines: `${CAR}M9.5 1v4M14.5 1v4` },
  learned: { lines: `${PIN}M8.5 10l2.5 2.5l4.5-5` },
  forgotten: { lines: `${PIN}M9 7l6 6M15 7l-6 6` },
  nothing: { lines: `${RING}M8 12h8` },
  undone: { lines: "M4 10h10a5.5 5.5 0 1 1 0 11h-6M8 5.5l-4.5 4.5l4.5 4.5" },
  paused: { lines: `${RING}M9.5 8.5v7M14.5 8.5v7` },
  resumed: { lines: `${RING}M10 8l6 4l-6 4z` },
  "take-over": {
    lines:
      "M12 5a7 7 0 1 1 0 14a7 7 0 1 1 0-14zM12 8.5v4M12 15.2v.3M4 4.5a11 11 0 0 0 0 15M20 4.5a11 11 0 0 1 0 15",
  },
};

/** Names of all pictograms. */
export const ICON_NAMES = Object.keys(ICONS);

/**
 * Return a pictogram; an unknown name gives an empty one, as the table names none for "no event".
 * @param {string} name
 * @param {string} [number] in a sign
 * @returns {SVGElement}
 */
export function icon(name, number = "") {
  const known = ICONS[name] ?? { lines: "" };
  const lines = svg("path", { d: known.lines });
  if (known.dashed) lines.setAttribute("stroke-dasharray", "3.5 2");
  const drawing = svg("svg", { viewBox: "0 0 24 24", class: "icon", "aria-hidden": "true" }, lines);
  if (known.sign !== undefined && number !== "") {
    const size = number.length > 2 ? 7 : 9;
    drawing.append(
      svg("text", { x: 12, y: known.sign, "font-size": size, "text-anchor": "middle" }, number),
    );
  }
  return drawing;
}
