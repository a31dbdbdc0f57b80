// Where the files of a session are kept: in one folder on the server's disk, or in the browser.

/** @typedef {import("../types.js").Files} Files */
/**
 * @typedef {object} Storage
 * @property {"server" | "browser" | "memory"} kind memory: gone when the page is closed
 * @property {(path: string) => Promise<Uint8Array | null>} read null: there is none
 * @property {(path: string, bytes: Uint8Array) => Promise<void>} write whole or not at all; resolves when safe
 * @property {(prefix: string) => Promise<string[]>} list paths that begin so, sorted
 * @property {(path: string, change: (old: Uint8Array | null) => Promise<Uint8Array | null>) => Promise<void>} update
 *   writes what `change` makes of the file as it is; asks again if others wrote meanwhile; null: nothing
 */

// So often a shared table is tried again that other pages write, too.
const TRIES_MAX = 20;
const DATABASE = "pldf-cockpit";
const FILES = "files";

/**
 * Return the files whose paths begin with `folder`, by what follows it.
 * @param {Storage} storage
 * @param {string} folder
 * @returns {Promise<Files>}
 */
export async function filesIn(storage, folder) {
  /** @type {Files} */
  const files = {};
  for (const path of await storage.list(folder)) {
    const bytes = await storage.read(path);
    if (bytes) {
      files[path.slice(folder.length)] = bytes;
    }
  }
  return files;
}

/**
 * Return the server's folder as storage.
 * @param {string} base address of `api/files/`
 * @returns {Storage}
 */
export function serverStorage(base) {
  /** @param {string} path */
  const address = (path) => `${base}${path.split("/").map(encodeURIComponent).join("/")}`;
  /** @type {Storage["list"]} */
  const list = async (prefix) => {
    const response = await fetch(`${base}?prefix=${encodeURIComponent(prefix)}`, {
      cache: "no-store",
    });
    return (await (await accepted(response)).json()).sort();
  };
  return {
    kind: "server",
    read: async (path) => (await fetched(address(path))).bytes,
    list,
    write: async (path, bytes) => {
      await accepted(await put(address(path), bytes, {}));
    },
    update: (path, change) => updated(address(path), change),
  };
}

/** @typedef {{bytes: Uint8Array | null, tag: string | null}} Found null: there is none */

/**
 * @param {string} url
 * @returns {Promise<Found>}
 */
async function fetched(url) {
  const response = await fetch(url, { cache: "no-store" });
  if (response.status === 204) {
    return { bytes: null, tag: null };
  }
  const bytes = new Uint8Array(await (await accepted(response)).arrayBuffer());
  return { bytes, tag: response.headers.get("ETag") };
}

/**
 * @param {string} url
 * @param {(old: Uint8Array | null) => Promise<Uint8Array | null>} change
 */
async function updated(url, change) {
  for (let tries = 0; tries < TRIES_MAX; tries += 1) {
    const old = await fetched(url);
    const bytes = await change(old.bytes);
    if (!bytes) {
      return;
    }
    const response = await put(
      url,
      bytes,
      old.tag ? { "If-Match": old.tag } : { "If-None-Match": "*" },
    );
    if (response.status !== 412) {
      await accepted(response);
      return;
    }
  }
  throw new Error(`${url}: others write it all the time`);
}

/**
 * @param {string} url
 * @param {Uint8Array} bytes
 * @param {Record<string, string>} headers
 */
function put(url, bytes, headers) {
  return fetch(url, {
    method: "PUT",
    headers: { "Content-Type": "application/octet-stream", ...headers },
    body: /** @type {BodyInit} */ (bytes),
  });
}

/** @param {Response} response */
async function accepted(response) {
  if (response.ok) {
    return response;
  }
  const told = await response.json().catch(() => ({})); // what is no JSON is not from our server
  throw new Error(told.error ?? `${response.status} ${response.statusText}`);
}

/**
 * Return the browser's own data base as storage.
 * @returns {Promise<Storage>}
 * @throws {unknown} if this browser keeps no data for the page
 */
export async function browserStorage() {
  const base = await settled(openBase());
  // Else a browser that is short of space may clear it; where it asks, the person decides.
  void navigator.storage?.persist?.();
  /** @param {IDBTransactionMode} mode */
  const files = (mode) =>
    base.transaction(FILES, mode, { durability: "strict" }).objectStore(FILES);
  /** @type {Storage["read"]} */
  const read = async (path) => (await settled(files("readonly").get(path))) ?? null;
  /** @type {Storage["write"]} */
  const write = (path, bytes) =>
    new Promise((resolve, reject) => {
      const store = files("readwrite");
      store.put(bytes, path);
      store.transaction.oncomplete = () => resolve();
      store.transaction.onabort = () => reject(store.transaction.error);
    });
  return {
    kind: "browser",
    read,
    write,
    list: async (prefix) => {
      const keys = await settled(files("readonly").getAllKeys());
      return keys
        .map(String)
        .filter((path) => path.startsWith(prefix))
        .sort();
    },
    update: locked(read, write),
  };
}

function openBase() {
  const request = indexedDB.open(DATABASE, 1);
  request.onupgradeneeded = () => request.result.createObjectStore(FILES);
  return request;
}

/**
 * @template T
 * @param {IDBRequest<T>} request
 * @returns {Promise<T>}
 */
function settled(request) {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });
}

/**
 * @param {Storage["read"]} read
 * @param {Storage["write"]} write
 * @returns {Storage["update"]}
 */
function locked(read, write) {
  return async (path, change) => {
    const work = async () => {
      const bytes = await change(await read(path));
      if (bytes) {
        await write(path, bytes);
      }
    };
    // Pages opened from a file have no locks in some browsers; there one page writes at a time.
    await (navigator.locks ? navigator.locks.request(`${DATABASE} ${path}`, work) : work());
  };
}

/**
 * Return a storage that is gone when the page is closed, for browsers that keep no data.
 * @returns {Storage}
 */
export function memoryStorage() {
  /** @type {Map<string, Uint8Array>} */
  const files = new Map();
  /** @type {Storage["write"]} */
  const write = async (path, bytes) => {
    files.set(path, bytes.slice());
  };
  return {
    kind: "memory",
    read: async (path) => files.get(path)?.slice() ?? null,
    write,
    list: async (prefix) => [...files.keys()].filter((path) => path.startsWith(prefix)).sort(),
    update: async (path, change) => {
      const bytes = await change(files.get(path) ?? null);
      if (bytes) {
        await write(path, bytes);
      }
    },
  };
}
