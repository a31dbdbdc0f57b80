// What the driver did in a drive, found as `pldf.recordings.interventions` finds it.

/** @typedef {import("../types.js").Frame} Frame */
/**
 * @typedef {object} Intervention
 * @property {"gas" | "brake" | "set_speed"} kind by the brake if the driver braked in it
 * @property {number} first frame of it
 * @property {number} last frame, in which it is over
 * @property {number} from_m
 * @property {number} to_m
 */

const STANDBY = 1;
const ACTIVE = 2;
const GAS_OVERRIDE = 3;
const GAP_S = 0.3; // shorter gaps between pedal interventions merge: pedal bounce
const PRESSED = 0.02; // pedal travel from which a pedal counts as pressed
const OFFSET_TOLERANCE_MPS = 0.5 / 3.6; // learning.offset_tolerance_mps: a smaller one is rounding

/**
 * Return the interventions of a drive by pedal and by lever, in their order.
 * @param {Frame[]} frames
 * @returns {Intervention[]}
 */
export function interventionsOf(frames) {
  const found = [...pedalRuns(frames), ...leverRuns(frames)].map(([kind, first, last]) => ({
    kind,
    first,
    last,
    from_m: value(frames, first, "vehicle.s_m"),
    to_m: value(frames, last, "vehicle.s_m"),
  }));
  return found.sort((a, b) => a.first - b.first);
}

/** @typedef {["gas" | "brake" | "set_speed", number, number]} Run kind, first, last */

/** @param {Frame[]} frames @returns {Run[]} */
function pedalRuns(frames) {
  let activated = false;
  const inactive = frames.map((_, i) => {
    const mode = value(frames, i, "mode");
    activated ||= mode === ACTIVE || mode === GAS_OVERRIDE;
    return activated && (mode === STANDBY || mode === GAS_OVERRIDE);
  });
  /** @type {Run[]} */
  const found = [];
  for (const [from, behind] of trueRuns(inactive)) {
    const start = startOf(frames, from, behind);
    if (start < 0) continue;
    let first = start;
    let braked = frames.slice(start, behind).some((frame) => frame.values["mode"] === STANDBY);
    const before = found.at(-1);
    if (before && time(frames, start) - time(frames, before[2]) < GAP_S) {
      found.pop();
      first = before[1];
      braked ||= before[0] === "brake";
    }
    found.push([braked ? "brake" : "gas", first, Math.min(behind, frames.length - 1)]);
  }
  return found;
}

/**
 * Return the frame at which a pedal made the function inactive, -1 if none did: standby without
 * brake is the lever's doing.
 * @param {Frame[]} frames
 * @param {number} from
 * @param {number} behind
 */
function startOf(frames, from, behind) {
  for (let i = from; i < behind; i += 1) {
    if (value(frames, i, "mode") === GAS_OVERRIDE) return i;
    const before = value(frames, i - 1, "mode");
    const braked = [i, i - 1].some((row) => value(frames, row, "driver.brake_pedal") > PRESSED);
    if ((before === ACTIVE || before === GAS_OVERRIDE) && braked) return i;
  }
  return -1;
}

/** @param {Frame[]} frames @returns {Run[]} where an offset of the set speed was in force */
function leverRuns(frames) {
  const moved = frames.map(
    (_, i) => Math.abs(value(frames, i, "set_speed_offset_mps")) > OFFSET_TOLERANCE_MPS,
  );
  return trueRuns(moved).map(([first, behind]) => [
    "set_speed",
    first,
    Math.min(behind, frames.length - 1),
  ]);
}

/** @param {boolean[]} flags @returns {[number, number][]} first, and the one behind the last */
function trueRuns(flags) {
  /** @type {[number, number][]} */
  const found = [];
  flags.forEach((flag, i) => {
    if (flag && !flags[i - 1]) found.push([i, flags.length]);
    const last = found.at(-1);
    if (!flag && flags[i - 1] && last) last[1] = i;
  });
  return found;
}

/** @param {Frame[]} frames @param {number} i @param {string} name @returns {number} */
function value(frames, i, name) {
  return Number(frames[i]?.values[name] ?? NaN);
}

/** @param {Frame[]} frames @param {number} i @returns {number} */
function time(frames, i) {
  return frames[i]?.time_s ?? NaN;
}
