// Where the worker's module is: beside this one, or in the one file of the export.

/** @returns {string | URL} */
export function workerUrl() {
  const loaded = /** @type {{pldfModules?: Record<string, string>}} */ (globalThis).pldfModules;
  return loaded?.["engine/worker.js"] ?? new URL("./worker.js", import.meta.url);
}
