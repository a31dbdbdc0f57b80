// Several numbers of an FMU that are read or written in one call, in its own memory.

/** @typedef {import("./module.js").Module} Module */
/** @typedef {import("../types.js").Variable} Variable */

/** @type {Record<string, {bytes: number, values: Float64ArrayConstructor | Int32ArrayConstructor}>} */
export const KINDS = {
  Real: { bytes: 8, values: Float64Array },
  Integer: { bytes: 4, values: Int32Array },
  Boolean: { bytes: 4, values: Int32Array },
};

/** Numbers of one kind of one instance, in the order in which they were named. */
export class Batch {
  #module;
  #component;
  #count;
  #kind;
  #references;
  #address;
  #get;
  #set;
  #refused;
  /** @type {Float64Array | Int32Array} */
  #values;

  /**
   * @param {Module} module
   * @param {number} component
   * @param {Variable["kind"]} kind a key of KINDS
   * @param {number[]} references
   * @param {(call: string) => Error} refused
   */
  constructor(module, component, kind, references, refused) {
    this.#module = module;
    this.#component = component;
    this.#kind = kind;
    this.#count = references.length;
    this.#refused = refused;
    this.#get = module.exported(`fmi2Get${kind}`);
    this.#set = module.exported(`fmi2Set${kind}`);
    this.#references = module.allocate(4 * this.#count);
    new Uint32Array(module.memory.buffer, this.#references, this.#count).set(references);
    this.#address = module.allocate(KINDS[kind].bytes * this.#count);
    this.#values = this.#view();
  }

  #view() {
    return new KINDS[this.#kind].values(this.#module.memory.buffer, this.#address, this.#count);
  }

  /**
   * The numbers; ask for them anew after any call: the memory moves when it grows, and what lay in the
   * old one has no length then (to ask the memory itself takes longer than a step).
   */
  get values() {
    if (this.#values.length === 0) this.#values = this.#view();
    return this.#values;
  }

  /** Get all from the FMU into `values`. */
  read() {
    if (this.#get(this.#component, this.#references, this.#count, this.#address) !== 0) {
      throw this.#refused(`fmi2Get${this.#kind}`);
    }
  }

  /** Set all in the FMU to `values`. */
  write() {
    if (this.#set(this.#component, this.#references, this.#count, this.#address) !== 0) {
      throw this.#refused(`fmi2Set${this.#kind}`);
    }
  }

  /** Give its memory back. */
  free() {
    this.#module.free(this.#references);
    this.#module.free(this.#address);
  }
}
