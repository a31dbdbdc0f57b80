// What somebody dropped on the page: a recording, a profile or a road, told apart by what is in the file.

import { readProfile } from "../engine/profile.js";
import { readReplay } from "../engine/replay.js";
import { RoadModel, roadFromPrepared } from "../engine/road.js";

/** @typedef {import("../types.js").Road} Road */
/** @typedef {import("../engine/profile.js").Profile} Profile */
/** @typedef {import("../engine/replay.js").Replay} Replay */

/** @typedef {{name: string, bytes: Uint8Array}} NamedBytes */
/** @typedef {{road: Road, end_m: number, start_speed_mps: number}} NewRoad */
/**
 * @typedef {object} Dropped
 * @property {{name: string, replay: Replay}[]} recordings
 * @property {{name: string, profile: Profile, bytes: Uint8Array}[]} profiles
 * @property {NewRoad | null} road
 * @property {{name: string, problem: unknown}[]} refused
 */

// Comfortable in a curve at the start of a road: m/s^2.
const START_LATERAL_MPS2 = 1.5;

/**
 * Read files.
 * @param {NamedBytes[]} files
 * @param {((file: NamedBytes) => Promise<NewRoad>) | null} prepare makes a road of a file of a laboratory;
 *   null: there is no server that could
 * @returns {Promise<Dropped>}
 */
export async function readDropped(files, prepare) {
  /** @type {Dropped} */
  const dropped = { recordings: [], profiles: [], road: null, refused: [] };
  for (const file of files) {
    try {
      await take(dropped, file, prepare);
    } catch (problem) {
      dropped.refused.push({ name: file.name, problem });
    }
  }
  return dropped;
}

/**
 * @param {Dropped} dropped
 * @param {NamedBytes} file
 * @param {Parameters<typeof readDropped>[1]} prepare
 */
async function take(dropped, file, prepare) {
  const { name, bytes } = file;
  switch (kindOf(file)) {
    case "recording":
      dropped.recordings.push({ name, replay: readReplay(bytes) });
      break;
    case "profile":
      dropped.profiles.push({ name, profile: readProfile(bytes), bytes });
      break;
    case "prepared":
      dropped.road = preparedRoad(bytes, name);
      break;
    default:
      if (!prepare) {
        throw new NeedsServer();
      }
      dropped.road = await prepare(file);
  }
}

/** Only the server reads such a file, and there is none. */
export class NeedsServer extends Error {}

/**
 * Return what a file is: by its name, and a CSV by its columns.
 * @param {NamedBytes} file
 * @returns {"recording" | "profile" | "prepared" | "road"}
 */
export function kindOf({ name, bytes }) {
  const ending = name.toLowerCase().split(".").at(-1);
  if (ending === "pldf") {
    return "profile";
  }
  if (ending === "prepared") {
    return "prepared";
  }
  const isTable = ending === "csv" || ending === "txt" || ending === "tsv";
  return isTable && !isRoadTable(bytes) ? "recording" : "road";
}

/**
 * Tell whether a table is a road's: its first line that is no comment names a curvature and no time.
 * @param {Uint8Array} bytes
 */
function isRoadTable(bytes) {
  const begin = new TextDecoder().decode(bytes.subarray(0, 20_000));
  const header = begin.split(/\r?\n/).find((line) => line.trim() && !line.startsWith("#")) ?? "";
  return header.includes("curvature_per_m") && !header.includes("time_s");
}

/**
 * @param {Uint8Array} bytes
 * @param {string} name
 * @returns {NewRoad}
 */
function preparedRoad(bytes, name) {
  const road = roadFromPrepared(bytes, name.replace(/\.[^.]*$/, ""));
  const model = new RoadModel(road);
  const curvature = Math.abs(model.curvature_per_m[0] ?? 0);
  const curve_mps = Math.sqrt(START_LATERAL_MPS2 / Math.max(curvature, 1e-6));
  return {
    road,
    end_m: model.length_m,
    start_speed_mps: Math.min(model.limit_mps[0] ?? 0, curve_mps),
  };
}
