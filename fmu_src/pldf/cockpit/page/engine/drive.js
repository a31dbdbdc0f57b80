// One drive of the coupled FMUs, step by step, as the master in Python drives it; no clock, no DOM.

import { Coupling, partsOf, profilesOf, reading } from "./coupling.js";
import { Lateral } from "./lateral.js";
import { Person, Repeated } from "./person.js";
import { Recorder, recordingCsv } from "./recording.js";
import { roadOf } from "./road.js";
import { Fmu } from "./fmu.js";

/** @typedef {import("../types.js").DriveResult} DriveResult */
/** @typedef {import("../types.js").DriveSetup} DriveSetup */
/** @typedef {import("../types.js").Frame} Frame */
/** @typedef {import("../types.js").Interruption} Interruption */
/** @typedef {import("../types.js").Part} Part */
/** @typedef {import("../types.js").Value} Value */
/** @typedef {import("./coupling.js").DriveBundle} DriveBundle */
/** @typedef {{ending: DriveResult["ending"], reason: string}} End */

// When a drive is over, as in Python (cosim/drive_limits.py).
const STANDSTILL_MPS = 0.1;
const STANDSTILL_MAX_S = 60;
const SLOWEST_MPS = 10 / 3.6;

/** A drive from its start to its end. */
export class Drive {
  /**
   * Return a drive whose FMUs are ready for the first step.
   * @param {DriveBundle} bundle
   * @param {DriveSetup} setup
   * @returns {Promise<Drive>}
   * @throws {import("./fmu_error.js").FmuError} an FMU refused a value or a call
   */
  static async begin(bundle, setup) {
    /** @type {Map<Part, Fmu>} */
    const fmus = new Map();
    for (const part of partsOf(setup)) {
      fmus.set(part, await Fmu.load(bundle.models[part]));
    }
    return new Drive(bundle, fmus, setup);
  }

  /**
   * @param {DriveBundle} bundle
   * @param {Map<Part, Fmu>} fmus
   * @param {DriveSetup} setup
   */
  constructor(bundle, fmus, setup) {
    const { who, step_s } = setup;
    this.setup = setup;
    this.step_s = step_s;
    this.person = who === "person" ? new Person(step_s, setup.activate) : null;
    this.driving = who === "inputs" ? new Repeated(setup.inputs) : this.person;
    this.coupling = new Coupling(bundle, fmus, setup, this.driving);
    this.coupling.initialize();
    const seen = this.coupling.fed();
    for (const [name, place] of this.coupling.part("pldf").outputs) {
      seen.set(name, reading(place));
    }
    this.fixed = this.coupling.unfed(setup);
    this.recorder = new Recorder(seen, this.fixed, step_s);
    this.shown = shownOf(this.coupling, seen);
    const { outputs } = this.coupling.part("vehicle");
    this.s_m = reading(/** @type {import("./part.js").Place} */ (outputs.get("s_m")));
    this.speed_mps = reading(/** @type {import("./part.js").Place} */ (outputs.get("speed_mps")));
    this.lateral = lateralOf(bundle);
    this.steps = 0;
    this.moved = 0; // last step at which the vehicle moved
    this.time_s = 0;
    this.coupling.read();
  }

  /**
   * Make one step, unless the drive is at its end.
   * @returns {End | null} how the drive ended
   */
  advance() {
    this.time_s = this.steps * this.step_s;
    this.coupling.read();
    const end = this.end();
    if (end !== null) {
      return end;
    }
    this.driving?.advance(this.steps);
    this.recorder.row();
    this.coupling.exchange();
    this.coupling.step(this.time_s, this.step_s);
    if (this.setup.steering === "person") {
      const steering = this.driving?.values.get("steering") ?? 0;
      this.lateral.step(steering, this.speed_mps(), this.s_m(), this.step_s);
    }
    this.steps += 1;
    return null;
  }

  /** @returns {End | null} */
  end() {
    const s_m = this.s_m();
    if (s_m >= this.setup.end_m) {
      return { ending: "arrived", reason: "" };
    }
    this.moved = this.speed_mps() > STANDSTILL_MPS ? this.steps : this.moved;
    if ((this.steps - this.moved) * this.step_s > STANDSTILL_MAX_S) {
      const reason = `stood still for ${STANDSTILL_MAX_S} s at ${s_m.toFixed(0)} m`;
      return { ending: "stood still", reason };
    }
    const time_max_s = STANDSTILL_MAX_S + this.setup.end_m / SLOWEST_MPS;
    if (this.steps >= Math.ceil(time_max_s / this.step_s)) {
      const reason = `only at ${s_m.toFixed(0)} m after ${time_max_s.toFixed(0)} s`;
      return { ending: "stood still", reason };
    }
    return null;
  }

  /**
   * Return what there is to see at the last communication point.
   * @returns {Frame}
   */
  frame() {
    /** @type {Record<string, Value>} */
    const values = Object.fromEntries(this.fixed);
    for (const [name, read] of this.shown) {
      values[name] = read();
    }
    const { lateral_m, heading_rad } = this.lateral;
    return { time_s: this.time_s, lateral_m, heading_rad, values };
  }

  /**
   * Terminate the FMUs, which is when they learn, and return what the drive leaves.
   * @param {End} end
   * @param {Interruption[]} interruptions
   * @param {DriveResult["timing"]} timing
   * @returns {DriveResult}
   */
  finish(end, interruptions, timing) {
    for (const part of this.coupling.parts.values()) {
      part.instance.terminate();
    }
    const profiles = profilesOf(this.coupling.part("pldf").instance.files());
    const left = this.left(end, interruptions, timing);
    return { ...left, profiles, outputs: this.outputs(), messages: this.messages() };
  }

  /**
   * Return what a drive leaves that failed: nothing was learned, and the FMUs need not answer.
   * @param {string} reason
   * @param {Interruption[]} interruptions
   * @param {DriveResult["timing"]} timing
   * @returns {DriveResult}
   */
  fail(reason, interruptions, timing) {
    const left = this.left({ ending: "failed", reason }, interruptions, timing);
    try {
      return { ...left, messages: this.messages() };
    } catch {
      return left;
    }
  }

  /**
   * @param {End} end
   * @param {Interruption[]} interruptions
   * @param {DriveResult["timing"]} timing
   * @returns {DriveResult}
   */
  left({ ending, reason }, interruptions, timing) {
    return {
      recording: recordingCsv(this.recorder.columns(), comments(this.setup, interruptions)),
      inputs: this.driving?.changes ?? [],
      profiles: this.setup.profiles,
      outputs: {},
      messages: [],
      interruptions,
      timing,
      ending,
      reason,
    };
  }

  /** @returns {Record<string, Value>} */
  outputs() {
    const function_ = this.coupling.part("pldf");
    function_.read();
    /** @type {Record<string, Value>} */
    const values = {};
    for (const [name, place] of function_.outputs) {
      values[name] = valueOf(function_.variable(name), reading(place)());
    }
    for (const name of function_.texts) {
      values[name] = function_.instance.get(name);
    }
    return values;
  }

  /** @returns {DriveResult["messages"]} */
  messages() {
    return [...this.coupling.parts].flatMap(([part, { instance }]) =>
      instance.messages().map(({ level, text }) => ({ level, part, text })),
    );
  }
}

/**
 * @param {Coupling} coupling
 * @param {Map<string, () => number>} seen
 * @returns {Map<string, () => Value>}
 */
function shownOf(coupling, seen) {
  const { variables, texts, instance } = coupling.part("pldf");
  /** @type {Map<string, () => Value>} */
  const shown = new Map();
  for (const [name, read] of seen) {
    const isFlag = variables.get(name)?.kind === "Boolean";
    shown.set(name, isFlag ? () => read() !== 0 : read);
  }
  for (const name of texts) {
    shown.set(name, () => instance.get(name));
  }
  for (const [name, place] of coupling.part("vehicle").outputs) {
    if (!seen.has(`vehicle.${name}`)) {
      shown.set(name, reading(place));
    }
  }
  return shown;
}

/**
 * @param {import("../types.js").Variable} variable
 * @param {number} number
 * @returns {Value}
 */
function valueOf({ kind }, number) {
  return kind === "Boolean" ? number !== 0 : number;
}

/** @param {DriveBundle} bundle */
function lateralOf({ road }) {
  const model = roadOf(road);
  const { lane_width_m, lanes_left, lanes_right } = model;
  const near_m = 0.5 * lane_width_m;
  const far_m = (lanes_left + lanes_right) * lane_width_m - near_m;
  const [left_m, right_m] = model.side > 0 ? [far_m, near_m] : [near_m, far_m];
  return new Lateral((s_m) => model.curvatureAt(s_m), { left_m, right_m });
}

/**
 * Return what a recording says of its drive beside its columns.
 * @param {DriveSetup} setup
 * @param {Interruption[]} interruptions
 */
function comments({ who, device, steering }, interruptions) {
  const driven = who === "person" ? [`device: ${device}`, `steering: ${steering}`] : [];
  const lost = interruptions.map(
    ({ time_s, lost_s, reason }) =>
      `interrupted at ${time_s.toFixed(2)} s for ${lost_s.toFixed(3)} s: ${reason}`,
  );
  return [...driven, ...lost];
}
