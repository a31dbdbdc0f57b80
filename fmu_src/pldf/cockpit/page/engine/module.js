// A module of WebAssembly with its memory: texts, bytes and files in and out of it.

/** @typedef {import("../types.js").Files} Files */
/** @typedef {(...values: number[]) => number} Call */

const encoder = new TextEncoder();
const decoder = new TextDecoder();

/** What build/runtime/page.h and FMI 2.0 offer, around one memory. Addresses are numbers. */
export class Module {
  /** @type {Record<string, Call>} */
  #exports;

  /** @param {WebAssembly.Module} compiled which imports nothing */
  constructor(compiled) {
    const { exports } = new WebAssembly.Instance(compiled, {});
    this.#exports = /** @type {Record<string, Call>} */ (/** @type {unknown} */ (exports));
    this.memory = /** @type {WebAssembly.Memory} */ (exports["memory"]);
    this.call("_initialize");
  }

  /**
   * @param {string} name of an exported function
   * @param {...number} values
   */
  call(name, ...values) {
    return this.#exports[name](...values);
  }

  /**
   * The function itself, for calls that are made in each step.
   * @param {string} name
   */
  exported(name) {
    return this.#exports[name];
  }

  /**
   * @param {number} size in bytes
   * @returns {number} address, aligned for any value
   * @throws {RangeError} the memory is full
   */
  allocate(size) {
    const address = this.call("malloc", Math.max(size, 1));
    if (address === 0) throw new RangeError(`no memory for ${size} bytes`);
    return address;
  }

  /** @param {number} address */
  free(address) {
    this.call("free", address);
  }

  /**
   * Call `use` with the address of these bytes, which are there for as long as it runs.
   * @template T
   * @param {Uint8Array} bytes
   * @param {(address: number) => T} use
   */
  lend(bytes, use) {
    const address = this.allocate(bytes.length);
    try {
      new Uint8Array(this.memory.buffer).set(bytes, address);
      return use(address);
    } finally {
      this.free(address);
    }
  }

  /**
   * The same with a text.
   * @template T
   * @param {string} text
   * @param {(address: number) => T} use
   */
  lendText(text, use) {
    return this.lend(encoder.encode(`${text}\0`), use);
  }

  /** @param {number} address of a text, 0: none */
  text(address) {
    if (address === 0) return "";
    const bytes = new Uint8Array(this.memory.buffer);
    return decoder.decode(bytes.subarray(address, bytes.indexOf(0, address)));
  }

  /**
   * @param {number} address
   * @param {number} size in bytes
   */
  bytes(address, size) {
    return new Uint8Array(this.memory.buffer).slice(address, address + size);
  }

  /** @param {number} address */
  uint32(address) {
    return new DataView(this.memory.buffer).getUint32(address, true);
  }

  /**
   * Put a file there, in place of what has this path.
   * @param {string} path from the root
   * @param {Uint8Array} content
   */
  writeFile(path, content) {
    const written = this.lendText(path, (name) =>
      this.lend(content, (address) => this.call("page_write", name, address, content.length)),
    );
    if (!written) throw new RangeError(`${path}: no memory for ${content.length} bytes`);
  }

  /** @returns {Files} by path from the root */
  readFiles() {
    /** @type {Files} */
    const files = {};
    const size = this.allocate(4);
    for (let index = 0, path = 0; (path = this.call("page_path", index)) !== 0; index++) {
      const address = this.call("page_read", path, size);
      files[this.text(path)] = this.bytes(address, this.uint32(size));
    }
    this.free(size);
    return files;
  }
}
