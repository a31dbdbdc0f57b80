// Small things that this browser remembers. Where it remembers none, the page works all the same.

/**
 * Return what was saved under `key`; an empty object if nothing, or nothing that can be read.
 * @param {string} key
 * @returns {Record<string, unknown>}
 */
export function fromJson(key) {
  try {
    const saved = JSON.parse(localStorage.getItem(key) ?? "{}");
    return saved !== null && typeof saved === "object" ? saved : {};
  } catch {
    return {}; // no storage at all, or somebody else's text
  }
}

/**
 * @param {string} key
 * @param {unknown} value
 */
export function toJson(key, value) {
  try {
    localStorage.setItem(key, JSON.stringify(value));
  } catch {
    // No storage, or it is full: then the next visit asks again.
  }
}
