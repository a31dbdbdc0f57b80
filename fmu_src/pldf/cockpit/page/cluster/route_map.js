// The road from above, with what was learned along it.

import { svg, update } from "./svg.js";

/** @typedef {import("../engine/places.js").Place} Place */
/** @typedef {{x_m: ArrayLike<number>, y_m: ArrayLike<number>}} Line */

const WIDTH = 1000;
const MARGIN = 46;
const STEP_M = 4; // of the drawn line
const BADGE = 19;

/** A map whose long side lies level. */
export class RouteMap {
  /** @param {Line} line @param {string} label */
  constructor(line, label) {
    const { points, height } = level(line);
    this.points = points;
    this.places = svg("g");
    const [begin, end] = [points[0] ?? [0, 0], points.at(-1) ?? [0, 0]];
    this.drawing = svg(
      "svg",
      { class: "map", viewBox: `0 0 ${WIDTH} ${height}`, role: "img", "aria-label": label },
      svg("path", { class: "map-road", d: this.path(0, points.length - 1) }),
      svg("circle", { class: "map-begin", cx: begin[0], cy: begin[1], r: 9 }),
      svg("rect", { class: "map-end", x: end[0] - 8, y: end[1] - 8, width: 16, height: 16 }),
      this.places,
    );
    this.car = svg("circle", { class: "map-car", r: 11, visibility: "hidden" });
    this.drawing.append(this.car);
  }

  /**
   * Show places, numbered as they come; the one chosen stands out.
   * @param {Place[]} places
   * @param {(place: Place) => boolean} forgotten
   */
  show(places, forgotten) {
    const state = places.map((place, i) => ({
      "data-kind": kindOf(place),
      "data-forgotten": String(forgotten(place)),
      "data-number": i + 1,
    }));
    const lines = places.map((place, i) =>
      svg("path", { class: "map-place", d: this.path(place.from_m, place.to_m), ...state[i] }),
    );
    const wideFirst = lines.filter((_, i) => places[i]?.by === "lever");
    this.places.replaceChildren(...wideFirst, ...lines.filter((line) => !wideFirst.includes(line)));
    places.forEach((place, i) => {
      const [x, y] = this.beside(place.at_m, i);
      this.places.append(
        svg("circle", { class: "map-badge", cx: x, cy: y, r: BADGE, ...state[i] }),
        svg("text", { class: "map-number", x: x, y: y + 7, ...state[i] }, String(i + 1)),
      );
    });
  }

  /** @param {number | null} number of the place that is looked at */
  choose(number) {
    for (const drawn of this.places.children) {
      update(drawn, {
        "data-chosen": String(drawn.getAttribute("data-number") === String(number)),
      });
    }
  }

  /** @param {number | null} s_m where to show a car */
  mark(s_m) {
    const at = s_m === null ? undefined : this.points[Math.round(Math.max(s_m, 0))];
    update(this.car, { visibility: at ? "visible" : "hidden" });
    if (at) update(this.car, { cx: at[0], cy: at[1] });
  }

  /** @param {number} from_m @param {number} to_m @returns {string} */
  path(from_m, to_m) {
    const drawn = [];
    for (let i = from_m; i < to_m; i += STEP_M) drawn.push(this.points[i]);
    drawn.push(this.points[to_m]);
    return `M${drawn
      .filter((point) => point !== undefined)
      .map((point) => point.join(" "))
      .join("L")}`;
  }

  /**
   * Return a point beside the road, on one side of it and the other in turn.
   * @param {number} s_m
   * @param {number} index
   * @returns {[number, number]}
   */
  beside(s_m, index) {
    const last = this.points.length - 1;
    const [x, y] = this.points[s_m] ?? [0, 0];
    const [ax, ay] = this.points[Math.max(s_m - 20, 0)] ?? [0, 0];
    const [bx, by] = this.points[Math.min(s_m + 20, last)] ?? [0, 0];
    const length = Math.hypot(bx - ax, by - ay) || 1;
    const off = (index % 2 === 0 ? 1 : -1) * (BADGE + 9);
    return [round(x + (off * (by - ay)) / length), round(y - (off * (bx - ax)) / length)];
  }
}

/** @param {Place} place @returns {string} */
function kindOf(place) {
  if (place.waits) return "waits";
  if (place.by === "lever") return "lever";
  return place.change_mps > 0 ? "faster" : "slower";
}

/**
 * Return the line in the units of the drawing, turned so that its long side lies level.
 * @param {Line} line
 * @returns {{points: [number, number][], height: number}}
 */
function level({ x_m, y_m }) {
  const [x, y] = [Array.from(x_m), Array.from(y_m)];
  const angle = direction(x, y);
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  const along = x.map((value, i) => cos * value + sin * (y[i] ?? 0));
  const across = x.map((value, i) => sin * value - cos * (y[i] ?? 0)); // down, as drawings count
  const [left, right] = ends(along);
  const [top, bottom] = ends(across);
  const scale = (WIDTH - 2 * MARGIN) / Math.max(right - left, 1);
  return {
    points: along.map((value, i) => [
      round(MARGIN + scale * (value - left)),
      round(MARGIN + scale * ((across[i] ?? 0) - top)),
    ]),
    height: round(2 * MARGIN + scale * (bottom - top)),
  };
}

/** @param {number[]} x @param {number[]} y @returns {number} angle of the longest extent, in rad */
function direction(x, y) {
  const [mx, my] = [mean(x), mean(y)];
  const xx = mean(x.map((value) => (value - mx) ** 2));
  const yy = mean(y.map((value) => (value - my) ** 2));
  const xy = mean(x.map((value, i) => (value - mx) * ((y[i] ?? 0) - my)));
  const angle = 0.5 * Math.atan2(2 * xy, xx - yy);
  const forward =
    Math.cos(angle) * ((x.at(-1) ?? 0) - (x[0] ?? 0)) +
    Math.sin(angle) * ((y.at(-1) ?? 0) - (y[0] ?? 0));
  return forward < 0 ? angle + Math.PI : angle; // it begins on the left
}

/** @param {number[]} values @returns {[number, number]} */
function ends(values) {
  return values.reduce(
    ([low, high], value) => [Math.min(low, value), Math.max(high, value)],
    [Infinity, -Infinity],
  );
}

/** @param {number[]} values */
function mean(values) {
  return values.reduce((sum, value) => sum + value, 0) / values.length;
}

/** @param {number} value */
function round(value) {
  return Math.round(10 * value) / 10;
}
