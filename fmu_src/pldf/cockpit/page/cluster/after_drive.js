// After the drive: what happened, and what was learned, place by place, to keep or to forget.

import { element, fill } from "../dom.js";
import { interventionsOf } from "../engine/interventions.js";
import { placesOf } from "../engine/places.js";
import { columnOf, iterationOf, readProfile } from "../engine/profile.js";
import { wording } from "../language.js";
import { PlaceList } from "./place_list.js";
import { RouteMap } from "./route_map.js";
import { SpeedPlot } from "./speed_plot.js";
import { perMetre, summary } from "./story.js";

/** @typedef {import("../types.js").DriveResult} DriveResult */
/** @typedef {import("../types.js").Frame} Frame */
/** @typedef {import("../engine/places.js").Place} Place */
/** @typedef {import("../engine/profile.js").Profile} Profile */
/** @typedef {import("../engine/road.js").RoadModel} RoadModel */
/**
 * @typedef {object} Drive
 * @property {RoadModel} road
 * @property {Frame[]} frames of the drive, from its recording
 * @property {Uint8Array | null} before profile file before it, null: there was none
 * @property {Uint8Array | null} after profile file after it
 * @property {import("./live.js").Unit} unit
 * @property {DriveResult["messages"]} [messages] of the FMUs
 * @property {((places_m: number[]) => Promise<Uint8Array>) | null} forget makes, of the file `after`, the
 *   one in which these places are forgotten one after the other, keeps and returns it; null: nobody may
 */

const words = wording({
  en: {
    title: "What happened, and what was learned",
    map: "Map of the road with {count} numbered places",
    told: "What the function says of each intervention",
    begin: "● start",
    end: "■ end",
    gas: "gas pedal",
    brake: "brake",
    set_speed: "set speed moved",
    failed: "This could not be forgotten: {reason} What was learned is as before; try it again.",
  },
  de: {
    title: "Was geschah, und was gelernt wurde",
    map: "Karte der Strecke mit {count} nummerierten Stellen",
    told: "Was die Funktion zu jedem Eingriff sagt (englisch)",
    begin: "● Beginn",
    end: "■ Ende",
    gas: "Gaspedal",
    brake: "Bremse",
    set_speed: "Setztempo verstellt",
    failed:
      "Das ließ sich nicht vergessen: {reason} Das Gelernte ist wie zuvor; bitte noch einmal versuchen.",
  },
});

/** Shows a drive in `parent`; `dispose` when it is taken away. */
export class AfterDrive {
  /** @param {Element} parent @param {Drive} drive @throws {Error} a profile file is damaged */
  constructor(parent, drive) {
    this.drive = drive;
    const { road, frames, before, after, unit } = drive;
    const nodes = road.nodes;
    this.interventions = interventionsOf(frames);
    this.profile = after && readProfile(after);
    this.known = before ? iterationOf(readProfile(before)).number : 0;
    this.places = this.profile ? this.placesIn(this.profile) : [];
    this.driven = perMetre(frames, nodes);
    this.planned = perMetre(frames, nodes, "base_speed_mps");
    this.list = new PlaceList(this.places, unit, this.known, {
      choose: (place) => this.choose(place),
      change: drive.forget && ((forgotten) => this.forget(forgotten)),
    });
    this.map = new RouteMap(road, words("map", { count: this.places.length }));
    const plot = element("div", { class: "after-plot" });
    this.summary = element("p", { class: "after-summary", "aria-live": "polite" });
    this.error = element("p", { class: "after-error", role: "alert" });
    this.root = element(
      "section",
      { class: "after" },
      element("h2", {}, words("title")),
      this.summary,
      element("div", { class: "after-map" }, this.map.drawing, legend()),
      plot,
      this.error,
      this.list.root,
      outcomes(drive.messages ?? []),
    );
    fill(parent, this.root);
    this.plot = new SpeedPlot(plot, unit, "next", (s_m) => this.map.mark(s_m));
    this.show(this.profile);
  }

  /** @param {Profile | null} profile as it is now */
  show(profile) {
    const { road } = this.drive;
    const left = profile ? this.placesIn(profile) : [];
    const gone = (/** @type {Place} */ place) => !left.some((other) => isSame(place, other));
    const newest = profile && iterationOf(profile);
    this.plot.show(
      {
        limit_mps: road.limit_mps,
        base_mps: newest ? columnOf(newest, "base_mps") : this.planned,
        driven_mps: this.driven,
        last_mps: newest ? columnOf(newest, "learned_mps") : new Float64Array(road.nodes).fill(NaN),
      },
      this.interventions,
      this.places,
    );
    fill(this.summary, summary(this.interventions, left));
    this.map.show(this.places, gone);
    this.list.show(gone);
  }

  /** @param {Profile} profile @returns {Place[]} */
  placesIn(profile) {
    return placesOf(profile, this.drive.road.limit_mps, this.known);
  }

  /** @param {Place | null} place */
  choose(place) {
    this.map.choose(place && this.places.indexOf(place) + 1);
    this.plot.look(place);
  }

  /**
   * Forget these places and keep all others.
   * @param {Place[]} forgotten
   * @returns {Promise<boolean>} whether it was done
   */
  async forget(forgotten) {
    fill(this.error);
    try {
      if (!this.drive.forget) return false;
      this.show(readProfile(await this.drive.forget(forgotten.map((place) => place.at_m))));
      return true;
    } catch (error) {
      fill(
        this.error,
        words("failed", { reason: error instanceof Error ? error.message : String(error) }),
      );
      return false;
    }
  }

  dispose() {
    this.plot.dispose();
    this.root.remove();
  }
}

/**
 * Tell whether a place is still there: what is forgotten beside it may have moved its ends.
 * @param {Place} place
 * @param {Place} other
 */
function isSame(place, other) {
  const overlap = other.from_m <= place.at_m && place.at_m <= other.to_m;
  return overlap && place.by === other.by && place.waits === other.waits;
}

/** @param {DriveResult["messages"]} messages @returns {HTMLElement | null} null: it says nothing */
function outcomes(messages) {
  const told = messages.filter(({ part }) => part === "pldf").map(({ text }) => text);
  if (told.length === 0) return null;
  const list = element("ul", { lang: "en" }, ...told.map((text) => element("li", {}, text)));
  return element("details", {}, element("summary", {}, words("told")), list);
}

function legend() {
  const kinds = /** @type {const} */ (["gas", "brake", "set_speed"]);
  return element(
    "p",
    { class: "after-legend" },
    element("span", {}, words("begin")),
    element("span", {}, words("end")),
    ...kinds.map((kind) =>
      element("span", { class: "after-kind", "data-kind": kind }, words(kind)),
    ),
  );
}
