// All that the page needs to know, from the page itself or from its server; bytes come as base64.

/** @typedef {import("../types.js").Bundle} Bundle */
/** @typedef {import("../types.js").Model} Model */
/** @typedef {import("../types.js").Part} Part */
/** @typedef {import("../types.js").Road} Road */
/** @typedef {Omit<Model, "wasm" | "resources"> & {wasm: string, resources: Record<string, string>}} ModelAsTold */
/** @typedef {Omit<Road, "prepared"> & {prepared: string}} RoadAsTold */
/** @typedef {Record<string, string>} FilesAsTold */
/**
 * A bundle as JSON tells it: bytes are base64.
 * @typedef {Omit<Bundle, "models" | "road" | "beside"> & {models: Record<Part, ModelAsTold>, road: RoadAsTold,
 *   beside?: FilesAsTold}} BundleAsTold
 */

const IN_PAGE = "bundle";
const ON_SERVER = "api/bundle";

/**
 * Return the bundle of this page.
 * @returns {Promise<Bundle>}
 * @throws {Error} the server does not give it
 */
export async function loadBundle() {
  const there = document.getElementById(IN_PAGE);
  if (there !== null) {
    return decoded(JSON.parse(there.textContent ?? ""));
  }
  const answer = await fetch(ON_SERVER);
  if (!answer.ok) {
    throw new Error(`${ON_SERVER}: ${answer.status} ${answer.statusText}`);
  }
  return decoded(await answer.json());
}

/**
 * Return a bundle with bytes in place of texts of base64.
 * @param {BundleAsTold} told
 * @returns {Bundle}
 */
export function decoded(told) {
  const models = Object.entries(told.models).map(([part, model]) => [part, withBytes(model)]);
  const road = { ...told.road, prepared: bytesOf(told.road.prepared) };
  return { ...told, models: Object.fromEntries(models), road, beside: filesOf(told.beside) };
}

/**
 * @param {FilesAsTold | undefined} texts base64 by path
 * @returns {import("../types.js").Files}
 */
function filesOf(texts) {
  return Object.fromEntries(
    Object.entries(texts ?? {}).map(([path, text]) => [path, bytesOf(text)]),
  );
}

/**
 * @param {ModelAsTold} model
 * @returns {Model}
 */
function withBytes(model) {
  return { ...model, wasm: bytesOf(model.wasm), resources: filesOf(model.resources) };
}

/**
 * Return the bytes that base64 stands for.
 * @param {string} text
 */
export function bytesOf(text) {
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let at = 0; at < bytes.length; at += 1) {
    bytes[at] = characters.charCodeAt(at);
  }
  return bytes;
}
