// One FMU in a drive: where the values of its inputs and outputs lie in its memory.

/** @typedef {import("./fmu.js").Fmu} Fmu */
/** @typedef {import("./batch.js").Batch} Batch */
/** @typedef {import("../types.js").Files} Files */
/** @typedef {import("../types.js").Value} Value */
/** @typedef {import("../types.js").Variable} Variable */
/** @typedef {{batch: Batch, at: number}} Place of a value; `batch.values` moves when memory grows */

/** An instance with its values in batches. */
export class DrivenPart {
  /**
   * @param {Fmu} fmu
   * @param {string} name
   * @param {Files} files that it may read
   * @param {string[]} fed names of the inputs that are set at every step
   */
  constructor(fmu, name, files, fed) {
    this.variables = new Map(fmu.model.variables.map((one) => [one.name, one]));
    this.instance = fmu.instantiate(name, files);
    const outputs = named(fmu.model.variables, "output");
    this.texts = outputs.filter((name) => this.variable(name).kind === "String");
    /** @type {Map<string, Place>} */
    this.inputs = new Map();
    /** @type {Map<string, Place>} */
    this.outputs = new Map();
    this.written = this.batches(fed, this.inputs);
    this.readOut = this.batches(
      outputs.filter((name) => !this.texts.includes(name)),
      this.outputs,
    );
  }

  /**
   * @param {string} name
   * @returns {Variable}
   * @throws {RangeError} the FMU has no such variable
   */
  variable(name) {
    const found = this.variables.get(name);
    if (found === undefined) {
      throw new RangeError(`the FMU has no variable ${name}`);
    }
    return found;
  }

  /** Get all outputs that are numbers. */
  read() {
    for (const batch of this.readOut) {
      batch.read();
    }
  }

  /** Set the inputs that are fed. */
  write() {
    for (const batch of this.written) {
      batch.write();
    }
  }

  /**
   * @param {string[]} names
   * @param {Map<string, Place>} places gets where each lies
   * @returns {Batch[]}
   */
  batches(names, places) {
    const kinds = [...new Set(names.map((name) => this.variable(name).kind))];
    return kinds.map((kind) => {
      const members = names.filter((name) => this.variable(name).kind === kind);
      const batch = this.instance.batch(members);
      members.forEach((name, at) => places.set(name, { batch, at }));
      return batch;
    });
  }
}

/**
 * @param {Variable[]} variables
 * @param {Variable["causality"]} causality
 */
export function named(variables, causality) {
  return variables.filter((one) => one.causality === causality).map((one) => one.name);
}
