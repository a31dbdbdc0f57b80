// One FMU in a drive, called as FMI 2.0 says. It has a module, memory and files of its own.

import { Batch, KINDS } from "./batch.js";
import { FmuError } from "./fmu_error.js";

/** @typedef {import("../types.js").Files} Files */
/** @typedef {import("../types.js").Value} Value */
/** @typedef {import("../types.js").Variable} Variable */
/** @typedef {import("./fmu.js").Fmu} Fmu */
/** @typedef {import("./fmu_error.js").Message} Message */
/** @typedef {import("./module.js").Module} Module */

const RESOURCES = "resources";
const CO_SIMULATION = 1;
const FINE = 1; // OK and Warning are: Terminate warns if something was kept in another way
const LEVELS = /** @type {const} */ (["info", "warning", "error", "error", "error"]);

/** One FMU in a drive. Names of variables are those of the model description. */
export class Instance {
  #module;
  #fmu;
  #component = 0;
  /** @type {Message[]} */
  #told = [];

  /**
   * @param {Fmu} fmu
   * @param {Module} module
   * @param {string} name
   * @param {Files} files
   */
  constructor(fmu, module, name, files) {
    this.#fmu = fmu;
    this.#module = module;
    for (const [path, bytes] of Object.entries(fmu.model.resources)) {
      module.writeFile(`${RESOURCES}/${path}`, bytes);
    }
    for (const [path, bytes] of Object.entries(files)) module.writeFile(path, bytes);
    this.#component = this.#instantiate(name);
    if (this.#component === 0) throw this.#refused("fmi2Instantiate");
    this.doStep = module.exported("fmi2DoStep");
  }

  /** @param {string} name */
  #instantiate(name) {
    const module = this.#module;
    const callbacks = module.call("page_callbacks");
    return module.lendText(name, (named) =>
      module.lendText(this.#fmu.model.guid, (guid) =>
        module.lendText(RESOURCES, (resources) =>
          module.call("fmi2Instantiate", named, CO_SIMULATION, guid, resources, callbacks, 0, 1),
        ),
      ),
    );
  }

  /** @param {string} call */
  #refused(call) {
    const before = this.#told.length;
    this.#collect();
    return new FmuError(call, this.#fmu.model.name, this.#told.slice(before));
  }

  #collect() {
    const status = this.#module.allocate(4);
    for (let text = 0; (text = this.#module.call("page_message", status)) !== 0;) {
      const level = LEVELS[this.#module.uint32(status)];
      this.#told.push({ level, text: this.#module.text(text) });
    }
    this.#module.free(status);
  }

  /**
   * @param {string} call
   * @param {...number} values behind the instance
   */
  #must(call, ...values) {
    if (this.#module.call(call, this.#component, ...values) > FINE) throw this.#refused(call);
  }

  /**
   * @param {string} name
   * @returns {Variable}
   */
  variable(name) {
    const found = this.#fmu.variables.get(name);
    if (!found) throw new RangeError(`${this.#fmu.model.name} has no variable ${name}`);
    return found;
  }

  /**
   * @param {string} name
   * @param {Value} value
   * @throws {FmuError} the FMU refuses it
   */
  set(name, value) {
    const variable = this.variable(name);
    if (variable.kind === "String") return this.#setText(variable, String(value));
    const batch = this.batch([name]);
    batch.values[0] = Number(value);
    try {
      batch.write();
    } finally {
      batch.free();
    }
  }

  /** @param {Record<string, Value>} values by name */
  setAll(values) {
    for (const [name, value] of Object.entries(values)) this.set(name, value);
  }

  /**
   * @param {string} name
   * @returns {Value} a boolean of a Boolean, a code of an enumeration
   */
  get(name) {
    const variable = this.variable(name);
    if (variable.kind === "String") return this.#text(variable);
    const batch = this.batch([name]);
    try {
      batch.read();
      return variable.kind === "Boolean" ? batch.values[0] !== 0 : batch.values[0];
    } finally {
      batch.free();
    }
  }

  /**
   * @param {Variable} variable
   * @param {string} text
   */
  #setText(variable, text) {
    const [reference, value] = [this.#numbers(variable.reference), this.#numbers(0)];
    try {
      this.#module.lendText(text, (address) => {
        new DataView(this.#module.memory.buffer).setUint32(value, address, true);
        this.#must("fmi2SetString", reference, 1, value);
      });
    } finally {
      this.#module.free(reference);
      this.#module.free(value);
    }
  }

  /** @param {Variable} variable */
  #text(variable) {
    const [reference, value] = [this.#numbers(variable.reference), this.#numbers(0)];
    try {
      this.#must("fmi2GetString", reference, 1, value);
      return this.#module.text(this.#module.uint32(value));
    } finally {
      this.#module.free(reference);
      this.#module.free(value);
    }
  }

  /** @param {...number} values whole ones */
  #numbers(...values) {
    const address = this.#module.allocate(4 * values.length);
    new Uint32Array(this.#module.memory.buffer, address, values.length).set(values);
    return address;
  }

  /**
   * Several numbers of one kind that are read or written at once, without copies.
   * @param {string[]} names all Real, or all Integer, or all Boolean
   * @returns {Batch}
   */
  batch(names) {
    const variables = names.map((name) => this.variable(name));
    const kind = variables[0]?.kind ?? "Real";
    const other = variables.find((v) => v.kind !== kind || !(kind in KINDS));
    if (other) throw new RangeError(`${other.name} is ${other.kind}, in a batch of ${kind}`);
    const references = variables.map((v) => v.reference);
    return new Batch(this.#module, this.#component, kind, references, (call) =>
      this.#refused(call),
    );
  }

  /** @param {number} [start_s] */
  enterInitialization(start_s = 0) {
    this.#must("fmi2SetupExperiment", 0, 0, start_s, 0, 0);
    this.#must("fmi2EnterInitializationMode");
  }

  exitInitialization() {
    this.#must("fmi2ExitInitializationMode");
  }

  /**
   * @param {number} time_s at which the step begins
   * @param {number} step_s
   */
  step(time_s, step_s) {
    if (this.doStep(this.#component, time_s, step_s, 1) > FINE) throw this.#refused("fmi2DoStep");
  }

  /** End the drive: what it taught is in `files()` then. */
  terminate() {
    this.#must("fmi2Terminate");
  }

  /** Give the instance back; nothing can be asked of it any more. */
  free() {
    this.#module.call("fmi2FreeInstance", this.#component);
    this.#component = 0;
  }

  /** @returns {Files} all but the resources, by path */
  files() {
    const all = Object.entries(this.#module.readFiles());
    return Object.fromEntries(all.filter(([path]) => !path.startsWith(`${RESOURCES}/`)));
  }

  /** @returns {Message[]} all that the FMU said so far, oldest first */
  messages() {
    this.#collect();
    return [...this.#told];
  }

  /** @returns {Uint8Array} all that decides what follows, for `setState` */
  getState() {
    const state = this.#numbers(0, 0);
    this.#must("fmi2GetFMUstate", state);
    const saved = this.#module.uint32(state);
    this.#must("fmi2SerializedFMUstateSize", saved, state + 4);
    const size = this.#module.uint32(state + 4);
    const bytes = this.#module.allocate(size);
    this.#must("fmi2SerializeFMUstate", saved, bytes, size);
    const copy = this.#module.bytes(bytes, size);
    this.#must("fmi2FreeFMUstate", state);
    this.#module.free(bytes);
    this.#module.free(state);
    return copy;
  }

  /**
   * @param {Uint8Array} bytes of `getState` of an instance of the same model
   * @throws {FmuError} they are damaged or of another model
   */
  setState(bytes) {
    const state = this.#numbers(0);
    try {
      this.#module.lend(bytes, (address) =>
        this.#must("fmi2DeSerializeFMUstate", address, bytes.length, state),
      );
      this.#must("fmi2SetFMUstate", this.#module.uint32(state));
      this.#must("fmi2FreeFMUstate", state);
    } finally {
      this.#module.free(state);
    }
  }
}
