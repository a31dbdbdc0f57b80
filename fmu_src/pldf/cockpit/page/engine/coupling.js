// What feeds what: the wires between the FMUs, and where the person stands in for the driver FMU.

import { DrivenPart, named } from "./part.js";

/** @typedef {import("../types.js").Bundle} Bundle */
/** @typedef {import("../types.js").DriveSetup} DriveSetup */
/** @typedef {import("../types.js").Files} Files */
/** @typedef {import("../types.js").Part} Part */
/** @typedef {import("../types.js").Value} Value */
/** @typedef {import("./fmu.js").Fmu} Fmu */
/** @typedef {import("./part.js").Place} Place */
/** @typedef {import("./person.js").Driving} Driving */
/** @typedef {{from: Place, to: Place}} Link */
/** @typedef {Pick<Bundle, "models" | "wires" | "road">} DriveBundle what a drive needs of a bundle */

/** The road's file, as parameters `route_file` name it, and the folder of the profile store. */
export const ROAD_FILE = "road.prepared";
export const STORE = "profiles";
/** What the store needs while it writes, and nobody else. */
const LOCK = "pldf-store.lock";
/** The function comes last: it plans its first outputs from where the vehicle is. @type {Part[]} */
const ORDER = ["vehicle", "lead", "driver", "pldf"];

/**
 * Return the parts of a drive in the order in which they are initialized and stepped.
 * @param {DriveSetup} setup
 * @returns {Part[]}
 */
export function partsOf(setup) {
  const absent = new Set([
    ...(setup.values.lead === undefined ? ["lead"] : []),
    ...(setup.who === "model" ? [] : ["driver"]),
  ]);
  return ORDER.filter((part) => !absent.has(part));
}

/** The FMUs of a drive, coupled as the master in Python couples them (Jacobi). */
export class Coupling {
  /**
   * @param {DriveBundle} bundle
   * @param {Map<Part, Fmu>} fmus of `partsOf(setup)`, in their order
   * @param {DriveSetup} setup
   * @param {Driving | null} person null: the driver FMU drives
   */
  constructor(bundle, fmus, setup, person) {
    this.person = person;
    this.wires = bundle.wires.filter(
      ([[source], [target]]) =>
        fmus.has(target) && (fmus.has(source) || (source === "driver" && person !== null)),
    );
    /** @type {Map<Part, DrivenPart>} */
    this.parts = new Map();
    for (const [part, fmu] of fmus) {
      const fed = this.wires.filter((wire) => wire[1][0] === part).map((wire) => wire[1][1]);
      this.parts.set(part, new DrivenPart(fmu, part, filesOf(part, bundle, setup), fed));
    }
    this.link();
    for (const [part, values] of Object.entries(valuesOf(setup))) {
      this.parts.get(/** @type {Part} */ (part))?.instance.setAll(values);
    }
  }

  /** Find both ends of the wires. */
  link() {
    /** @type {Link[]} */
    this.links = [];
    /** @type {{name: string, to: Place}[]} */
    this.pressed = [];
    for (const [[source, output], [target, input]] of this.wires) {
      const to = /** @type {Place} */ (this.part(target).inputs.get(input));
      if (this.parts.has(source)) {
        const from = /** @type {Place} */ (this.part(source).outputs.get(output));
        this.links.push({ from, to });
      } else {
        this.pressed.push({ name: output, to });
      }
    }
  }

  /**
   * @param {Part} name
   * @returns {DrivenPart}
   */
  part(name) {
    return /** @type {DrivenPart} */ (this.parts.get(name));
  }

  /** Make the first outputs fit together: each part knows the outputs of those before it. */
  initialize() {
    for (const part of this.parts.values()) {
      part.instance.enterInitialization();
      part.write();
      part.read();
      this.exchange();
    }
    for (const part of this.parts.values()) {
      part.instance.exitInitialization();
    }
  }

  /** Get the outputs of all parts. */
  read() {
    for (const part of this.parts.values()) {
      part.read();
    }
  }

  /** Put all outputs where they are inputs. */
  exchange() {
    for (const { from, to } of this.links) {
      to.batch.values[to.at] = from.batch.values[from.at];
    }
    for (const { name, to } of this.pressed) {
      to.batch.values[to.at] = this.person?.values.get(name) ?? 0;
    }
  }

  /**
   * Advance all parts, with the inputs that `exchange` has put in place.
   * @param {number} time_s
   * @param {number} step_s
   */
  step(time_s, step_s) {
    for (const part of this.parts.values()) {
      part.write();
      part.instance.step(time_s, step_s);
    }
  }

  /**
   * Return how to read what feeds the function's inputs, by the name of the input.
   * @returns {Map<string, () => number>}
   */
  fed() {
    const reads = new Map();
    for (const [[source, output], [target, input]] of this.wires) {
      if (target === "pldf") {
        const place = this.parts.get(source)?.outputs.get(output);
        reads.set(
          input,
          place === undefined ? () => this.person?.values.get(output) ?? 0 : reading(place),
        );
      }
    }
    return reads;
  }

  /**
   * Return the inputs of the function that nothing feeds.
   * @param {DriveSetup} setup
   * @returns {Map<string, number>}
   */
  unfed(setup) {
    const { variables, inputs } = this.part("pldf");
    const names = named([...variables.values()], "input").filter((name) => !inputs.has(name));
    const given = setup.values.pldf ?? {};
    return new Map(
      names.map((name) => [name, Number(given[name] ?? this.part("pldf").variable(name).start)]),
    );
  }
}

/**
 * @param {Place} place
 * @returns {() => number}
 */
export function reading(place) {
  return () => place.batch.values[place.at];
}

/**
 * @param {DriveSetup} setup
 * @returns {DriveSetup["values"]}
 */
function valuesOf({ values }) {
  return { ...values, pldf: { ...values.pldf, profile_store: STORE } };
}

/**
 * Return the files that a part may read.
 * @param {Part} part
 * @param {DriveBundle} bundle
 * @param {DriveSetup} setup
 * @returns {Files}
 */
export function filesOf(part, bundle, setup) {
  const stored = part === "pldf" ? Object.entries(setup.profiles) : [];
  return {
    [ROAD_FILE]: bundle.road.prepared,
    ...Object.fromEntries(stored.map(([name, bytes]) => [`${STORE}/${name}`, bytes])),
  };
}

/**
 * Return the files of the profile store, by name.
 * @param {Files} files
 * @returns {Files}
 */
export function profilesOf(files) {
  const folder = `${STORE}/`;
  const stored = Object.entries(files).filter(([path]) => path.startsWith(folder));
  const named = stored.map(([path, bytes]) => [path.slice(folder.length), bytes]);
  return Object.fromEntries(named.filter(([name]) => name !== LOCK));
}
