// How wide the road is, and what lies beside it.

/** @typedef {import("../engine/road.js").RoadModel} RoadModel */
/**
 * @typedef {{at_m: number, kind: "edge" | "middle" | "lane"}} Line to the left of the road's line
 */
/**
 * @typedef {{left_m: number, right_m: number, lines: Line[]}} CrossSection how far the asphalt goes to both sides
 */

export const MARGIN_M = 0.5; // asphalt beyond the edge line
export const PAVEMENT_M = 2;
export const KERB_M = 0.12;
export const PARAPET_M = 1.1;
/** so far the road is drawn beyond its ends: what a mirror shows at the start, what is in sight at the end */
export const BEYOND_M = { before: 300, behind: 1300 };

/** @param {RoadModel} road @returns {CrossSection} */
export function crossSection(road) {
  const along = road.lanes_right * road.lane_width_m;
  const against = road.lanes_left * road.lane_width_m;
  const [right, left] = road.side > 0 ? [along, against] : [against, along];
  /** @type {Line[]} */
  const lines = [
    { at_m: left, kind: "edge" },
    { at_m: -right, kind: "edge" },
  ];
  for (let at = left - road.lane_width_m; at > -right + 0.1; at -= road.lane_width_m) {
    lines.push({ at_m: at, kind: Math.abs(at) < 0.1 ? "middle" : "lane" });
  }
  return { left_m: left + MARGIN_M, right_m: right + MARGIN_M, lines };
}

/**
 * Edge of the asphalt.
 * @param {CrossSection} section
 * @param {boolean} left
 * @param {number} out_m beyond it
 */
export function beyondEdge(section, left, out_m) {
  return left ? section.left_m + out_m : -section.right_m - out_m;
}
