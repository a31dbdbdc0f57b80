// An FMU as a module of WebAssembly: FMI 2.0 by names, with files and messages in memory.

/** @typedef {import("../types.js").Files} Files */
/** @typedef {import("../types.js").Model} Model */
/** @typedef {import("../types.js").Value} Value */
/** @typedef {import("../types.js").Variable} Variable */
/** @typedef {{level: "info" | "warning" | "error", text: string}} Message */
/** @typedef {any} Exports */

const CO_SIMULATION = 1;
const OK_MAX = 1;
/** @type {Message["level"][]} */
const LEVELS = ["info", "warning", "error", "error", "error", "info"];
/** @type {Map<string, Promise<WebAssembly.Module>>} */
const compiled = new Map();

/** An FMU refused a call; its own words. */
export class FmuError extends Error {}

/** A model that was compiled. */
export class Fmu {
  /**
   * @param {Model} model
   * @returns {Promise<Fmu>}
   */
  static async load(model) {
    const bytes = /** @type {BufferSource} */ (model.wasm);
    const module = compiled.get(model.guid) ?? WebAssembly.compile(bytes);
    compiled.set(model.guid, module);
    return new Fmu(model, await module);
  }

  /**
   * @param {Model} model
   * @param {WebAssembly.Module} module
   */
  constructor(model, module) {
    this.model = model;
    this.module = module;
  }

  /**
   * @param {string} name
   * @param {Files} files
   */
  instantiate(name, files) {
    return new Instance(this.model, new WebAssembly.Instance(this.module, {}), name, files);
  }
}

/** Values of one kind in the module's memory. */
export class Batch {
  /**
   * @param {Instance} instance
   * @param {Variable[]} variables
   */
  constructor(instance, variables) {
    this.instance = instance;
    this.count = variables.length;
    this.kind = variables[0].kind;
    this.size = this.kind === "Real" ? 8 : 4;
    this.references = instance.copied(Uint32Array.from(variables, (one) => one.reference));
    this.at = instance.room(this.size * this.count);
    this.buffer = new ArrayBuffer(0);
    /** @type {Float64Array | Int32Array} */
    this.view = new Int32Array(0);
  }

  get values() {
    const { buffer } = this.instance.exports.memory;
    if (buffer !== this.buffer) {
      this.buffer = buffer;
      const Kind = this.kind === "Real" ? Float64Array : Int32Array;
      this.view = new Kind(buffer, this.at, this.count);
    }
    return this.view;
  }

  read() {
    this.instance.call(`fmi2Get${this.kind}`, this.references, this.count, this.at);
  }

  write() {
    this.instance.call(`fmi2Set${this.kind}`, this.references, this.count, this.at);
  }
}

/** One instance in a memory of its own. */
export class Instance {
  /**
   * @param {Model} model
   * @param {WebAssembly.Instance} instance
   * @param {string} name
   * @param {Files} files
   */
  constructor(model, instance, name, files) {
    this.exports = /** @type {Exports} */ (instance.exports);
    this.exports._initialize?.();
    this.variables = new Map(model.variables.map((one) => [one.name, one]));
    /** @type {Message[]} */
    this.heard = [];
    for (const [path, bytes] of Object.entries(files)) {
      const at = this.copied(bytes);
      this.exports.page_write(this.text(path), at, bytes.length);
    }
    this.component = this.exports.fmi2Instantiate(
      this.text(name),
      CO_SIMULATION,
      this.text(model.guid),
      this.text("file:///resources"),
      this.exports.page_callbacks(),
      0,
      1,
    );
    this.hear();
    if (this.component === 0) {
      throw new FmuError(this.words());
    }
  }

  /** @param {number} size */
  room(size) {
    return this.exports.malloc(Math.max(8, size));
  }

  /** @param {Uint8Array | Uint32Array} data */
  copied(data) {
    const at = this.room(data.byteLength);
    const bytes = new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
    new Uint8Array(this.exports.memory.buffer, at, data.byteLength).set(bytes);
    return at;
  }

  /** @param {string} text */
  text(text) {
    return this.copied(new TextEncoder().encode(`${text}\0`));
  }

  /** @param {number} at */
  textAt(at) {
    const bytes = new Uint8Array(this.exports.memory.buffer, at);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }

  /**
   * @param {string} name
   * @param {...number} given
   */
  call(name, ...given) {
    const status = this.exports[name](this.component, ...given);
    if (status !== 0) {
      this.hear();
      if (status > OK_MAX) {
        throw new FmuError(this.words());
      }
    }
  }

  words() {
    return this.heard.findLast((message) => message.level === "error")?.text ?? "";
  }

  hear() {
    const status = this.room(4);
    for (let at = this.exports.page_message(status); at !== 0; ) {
      const level = LEVELS[new DataView(this.exports.memory.buffer).getInt32(status, true)];
      this.heard.push({ level, text: this.textAt(at) });
      at = this.exports.page_message(status);
    }
    this.exports.free(status);
  }

  messages() {
    this.hear();
    return this.heard;
  }

  /** @param {string[]} names */
  batch(names) {
    return new Batch(this, names.map((name) => this.variable(name)));
  }

  /** @param {string} name */
  variable(name) {
    const variable = this.variables.get(name);
    if (variable === undefined) {
      throw new FmuError(`there is no variable ${name}`);
    }
    return variable;
  }

  /**
   * @param {string} name
   * @returns {Value}
   */
  get(name) {
    const batch = this.batch([name]);
    batch.read();
    if (batch.kind === "String") {
      const text = this.textAt(batch.values[0]);
      this.exports.free(batch.at);
      this.exports.free(batch.references);
      return text;
    }
    return batch.kind === "Boolean" ? batch.values[0] !== 0 : batch.values[0];
  }

  /**
   * @param {string} name
   * @param {Value} value
   */
  set(name, value) {
    const batch = this.batch([name]);
    batch.values[0] = batch.kind === "String" ? this.text(String(value)) : Number(value);
    batch.write();
  }

  /** @param {Record<string, Value>} values */
  setAll(values) {
    for (const [name, value] of Object.entries(values)) {
      this.set(name, value);
    }
  }

  enterInitialization() {
    this.call("fmi2SetupExperiment", 0, 0, 0, 0, 0);
    this.call("fmi2EnterInitializationMode");
  }

  exitInitialization() {
    this.call("fmi2ExitInitializationMode");
  }

  /**
   * @param {number} time_s
   * @param {number} step_s
   */
  step(time_s, step_s) {
    this.call("fmi2DoStep", time_s, step_s, 1);
  }

  terminate() {
    this.call("fmi2Terminate");
  }

  /** @returns {Files} */
  files() {
    /** @type {Files} */
    const files = {};
    const size = this.room(4);
    for (let index = 0; ; index += 1) {
      const path = this.exports.page_path(index);
      if (path === 0) {
        return files;
      }
      const at = this.exports.page_read(path, size);
      const length = new DataView(this.exports.memory.buffer).getUint32(size, true);
      if (at !== 0) {
        files[this.textAt(path)] = new Uint8Array(this.exports.memory.buffer, at, length).slice();
      }
    }
  }
}
