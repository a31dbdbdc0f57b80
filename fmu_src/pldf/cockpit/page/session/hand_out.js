// All data of the page as one zip, which `pldf analyse` reads.

import { zipSync } from "../vendor/fflate.js";
import { element } from "../dom.js";
import { filesIn } from "./storage.js";

/** @typedef {import("./storage.js").Storage} Storage */
/** @typedef {import("../types.js").Files} Files */

/**
 * Return files as a zip; the same files give the same bytes.
 * @param {Files} files
 * @returns {Uint8Array}
 */
export function zipped(files) {
  const first = new Date(1980, 0, 1);
  return zipSync(files, { level: 6, mtime: first });
}

/**
 * Let the browser save bytes as a file.
 * @param {string} name
 * @param {Uint8Array} bytes
 */
export function saveAs(name, bytes) {
  const url = URL.createObjectURL(new Blob([/** @type {BlobPart} */ (bytes)]));
  const link = /** @type {HTMLAnchorElement} */ (element("a", { href: url, download: name }));
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 60_000); // browsers may still be reading it
}

/**
 * Hand out all data.
 * @param {Storage} storage
 * @param {Files} [beside] files that lie beside the data
 * @returns {Promise<number>} how many files there were
 */
export async function handOut(storage, beside = {}) {
  const files = await filesIn(storage, "");
  const count = Object.keys(files).length;
  if (count) {
    saveAs("pldf-cockpit.zip", zipped({ ...beside, ...files }));
  }
  return count;
}
