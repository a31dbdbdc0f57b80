// FMUs as WebAssembly: models of which instances are made.

import { Instance } from "./instance.js";
import { Module } from "./module.js";

/** @typedef {import("../types.js").Files} Files */
/** @typedef {import("../types.js").Model} Model */

/** A model of which instances can be made. */
export class Fmu {
  /** @type {WebAssembly.Module} */
  #compiled;

  /**
   * @param {Model} model
   * @param {WebAssembly.Module} compiled
   */
  constructor(model, compiled) {
    this.model = model;
    this.#compiled = compiled;
    this.variables = new Map(model.variables.map((v) => [v.name, v]));
  }

  /**
   * @param {Model} model
   * @throws {WebAssembly.CompileError} its bytes are no module
   */
  static async load(model) {
    const bytes = /** @type {Uint8Array<ArrayBuffer>} */ (model.wasm);
    return new Fmu(model, await WebAssembly.compile(bytes));
  }

  /**
   * @param {string} name of the instance
   * @param {Files} [files] besides the resources: what parameters such as `route_file` name
   * @throws {FmuError} the FMU refuses
   */
  instantiate(name, files = {}) {
    return new Instance(this, new Module(this.#compiled), name, files);
  }
}
