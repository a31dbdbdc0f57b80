// Speed over distance: what was allowed, planned, driven, and is learned for the next drive.

import uPlot from "../vendor/uplot.js";
import { wording } from "../language.js";
import { plotted } from "./story.js";
import { unitText } from "./units.js";

/** @typedef {import("../engine/interventions.js").Intervention} Intervention */
/** @typedef {import("../engine/places.js").Place} Place */
/** @typedef {import("./live.js").Unit} Unit */
/**
 * Speeds per metre, all of one length.
 * @typedef {object} Curves
 * @property {Float64Array} limit_mps
 * @property {Float64Array} base_mps
 * @property {Float64Array} driven_mps
 * @property {Float64Array} last_mps learned for the next drive, or driven after now
 */

// Okabe and Ito's colours, as in the project's report.
const BLACK = "#000000";
const GREY = "#666666";
const BLUE = "#0072B2";
const VERMILLION = "#D55E00";
const FILLS = {
  gas: "rgb(0 158 115 / 32%)",
  brake: "rgb(213 94 0 / 30%)",
  set_speed: "rgb(204 121 167 / 32%)",
};
const HEIGHT_PX = 300;

const words = wording({
  en: {
    distance: "Distance (km)",
    speed: "Speed ({unit})",
    limit: "Limit",
    base: "Without lessons",
    driven: "Driven",
    next: "Next drive",
    profile: "Profile",
    label: "Speed over distance: limit, speed without lessons, driven, learned",
  },
  de: {
    distance: "Weg (km)",
    speed: "Tempo ({unit})",
    limit: "Tempolimit",
    base: "Ohne Gelerntes",
    driven: "Gefahren",
    next: "Nächste Fahrt",
    profile: "Profil",
    label: "Tempo über dem Weg: Limit, Tempo ohne Gelerntes, gefahrenes und gelerntes Tempo",
  },
});

/** The plot; drag to look closer, double click to see all. */
export class SpeedPlot {
  /**
   * @param {HTMLElement} parent
   * @param {Unit} unit
   * @param {"next" | "profile"} last what the fourth curve is
   * @param {(s_m: number | null) => void} [onlook] where the pointer is
   */
  constructor(parent, unit, last, onlook = () => {}) {
    this.parent = parent;
    this.unit = unit;
    this.last = last;
    /** @type {Intervention[]} */
    this.interventions = [];
    /** @type {Place[]} */
    this.places = [];
    parent.setAttribute("role", "img");
    parent.setAttribute("aria-label", words("label"));
    this.plot = new uPlot(this.options(onlook), [[]], parent);
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(parent);
  }

  /**
   * @param {(s_m: number | null) => void} onlook
   * @returns {uPlot.Options}
   */
  options(onlook) {
    const speed = (/** @type {uPlot} */ _, /** @type {number | null} */ value) =>
      value === null ? "–" : value.toFixed(0);
    return {
      width: Math.max(this.parent.clientWidth, 300),
      height: HEIGHT_PX,
      scales: { x: { time: false } },
      axes: [
        { label: words("distance"), stroke: "#333333" },
        { label: words("speed", { unit: unitText(this.unit) }), stroke: "#333333" },
      ],
      series: [
        { label: "km", value: (_, value) => (value === null ? "–" : value.toFixed(2)) },
        {
          label: words("limit"),
          stroke: GREY,
          width: 2,
          paths: uPlot.paths.stepped?.({ align: 1 }),
          value: speed,
        },
        { label: words("base"), stroke: BLUE, width: 1.5, dash: [6, 4], value: speed },
        { label: words("driven"), stroke: BLACK, width: 1.5, value: speed },
        { label: words(this.last), stroke: VERMILLION, width: 2.5, value: speed },
      ],
      hooks: {
        drawClear: [() => this.drawActions()],
        draw: [() => this.drawNumbers()],
        setCursor: [(plot) => onlook(plot.cursor.idx == null ? null : plot.cursor.idx)],
      },
    };
  }

  /**
   * @param {Curves} curves
   * @param {Intervention[]} interventions
   * @param {Place[]} places
   */
  show(curves, interventions, places) {
    this.interventions = interventions;
    this.places = places;
    const kilometres = Array.from(curves.limit_mps, (_, metre) => metre / 1000);
    const speeds = [curves.limit_mps, curves.base_mps, curves.driven_mps, curves.last_mps];
    const { min = 0, max = 0 } = this.plot.scales["x"] ?? {};
    const looked = max > min; // later curves keep the stretch that is looked at
    this.plot.batch(() => {
      this.plot.setData([kilometres, ...speeds.map((values) => plotted(values, this.unit))]);
      if (looked) this.plot.setScale("x", { min, max });
    });
  }

  /** Look closer at a place; at all of the road without one. @param {Place | null} place */
  look(place) {
    const end = (this.plot.data[0].length - 1) / 1000;
    const beside = place === null ? 0 : 0.15 + (place.to_m - place.from_m) / 2000;
    const min = place === null ? 0 : Math.max(place.from_m / 1000 - beside, 0);
    const max = place === null ? end : Math.min(place.to_m / 1000 + beside, end);
    this.plot.setScale("x", { min, max });
  }

  drawActions() {
    const { ctx, bbox } = this.plot;
    for (const { kind, from_m: from, to_m: to } of this.interventions) {
      const [left, right] = [this.pixel(from), this.pixel(to)];
      const begin = Math.max(left, bbox.left);
      const width = Math.min(right, bbox.left + bbox.width) - begin;
      ctx.fillStyle = FILLS[kind];
      if (width > 0) ctx.fillRect(begin, bbox.top, width, bbox.height);
    }
  }

  drawNumbers() {
    const { ctx, bbox } = this.plot;
    ctx.save();
    ctx.font = `bold ${Math.round(13 * devicePixelRatio)}px system-ui, sans-serif`;
    ctx.textAlign = "center";
    ctx.fillStyle = "#333333";
    this.places.forEach((place, i) => {
      const x = this.pixel(place.at_m);
      const height = (1 + (i % 2)) * 16 * devicePixelRatio;
      if (x >= bbox.left && x <= bbox.left + bbox.width)
        ctx.fillText(String(i + 1), x, bbox.top + height);
    });
    ctx.restore();
  }

  /** @param {number} s_m @returns {number} of the canvas */
  pixel(s_m) {
    return this.plot.valToPos(s_m / 1000, "x", true);
  }

  resize() {
    const width = this.parent.clientWidth;
    if (width > 0 && width !== this.plot.width) this.plot.setSize({ width, height: HEIGHT_PX });
  }

  dispose() {
    this.observer.disconnect();
    this.plot.destroy();
  }
}
