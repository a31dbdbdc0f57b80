// The columns of a recording, in their order: the same as in Python, which a test holds.

const MODES = ["OFF", "STANDBY", "ACTIVE", "GAS_OVERRIDE", "FAULT"];
const REASONS = [
  "LIMIT",
  "CURVE",
  "COASTING_TO_LIMIT",
  "LEARNED_FASTER",
  "LEARNED_SLOWER",
  "LEARNED_OFFSET",
  "MANUAL_SET",
  "OVERRIDE",
  "CAP_CURVE",
  "CAP_LEGAL",
  "STANDBY",
  "FAULT",
  "FOLLOWING",
  "OFF",
  "SLOWING_DOWN",
  "SPEEDING_UP",
  "TEMPORARY_LIMIT",
  "HELD",
];
const EVENTS = [
  "NONE",
  "LEARNED",
  "FORGOTTEN",
  "NOTHING_TO_FORGET",
  "UNDONE",
  "NOTHING_TO_UNDO",
  "PAUSED",
  "RESUMED",
  "NEW_LIMIT",
  "TAKE_OVER",
];

/**
 * @typedef {object} Column
 * @property {string} name
 * @property {"number" | "flag" | "whole" | "word"} kind
 * @property {string} source input or output of the function, empty if it is derived
 * @property {string[]} words of a word, by code
 */

/**
 * @param {string} name
 * @param {Column["kind"]} kind
 * @param {string} source
 * @param {string[]} [words]
 * @returns {Column}
 */
function column(name, kind, source, words = []) {
  return { name, kind, source, words };
}

/** Added to `base_mps` it is `profile_mps`. */
export const LEARNED_DELTA = "hmi.learned_delta_mps";

export const COLUMNS = Object.freeze([
  column("time_s", "number", ""),
  column("s_m", "number", "vehicle.s_m"),
  column("speed_mps", "number", "vehicle.speed_mps"),
  column("acceleration_mps2", "number", "vehicle.acceleration_mps2"),
  column("mode", "word", "mode", MODES),
  column("gas_pedal", "number", "driver.gas_pedal"),
  column("brake_pedal", "number", "driver.brake_pedal"),
  column("set_speed_mps", "number", "set_speed_mps"),
  column("set_speed_offset_mps", "number", "set_speed_offset_mps"),
  column("profile_mps", "number", ""),
  column("base_mps", "number", "base_speed_mps"),
  column("limit_mps", "number", "limit_mps"),
  column("eligible", "flag", "eligible"),
  column("vehicle_x_m", "number", "vehicle.x_m"),
  column("vehicle_y_m", "number", "vehicle.y_m"),
  column("lever_resume", "flag", "lever.resume"),
  column("lever_cancel", "flag", "lever.cancel"),
  column("lever_up", "flag", "lever.up"),
  column("lever_down", "flag", "lever.down"),
  column("lever_up_long", "flag", "lever.up_long"),
  column("lever_down_long", "flag", "lever.down_long"),
  column("teach_pause", "flag", "teach.pause"),
  column("teach_forget_here", "flag", "teach.forget_here"),
  column("teach_undo", "flag", "teach.undo"),
  column("lead_present", "flag", "lead.present"),
  column("lead_gap_m", "number", "lead.gap_m"),
  column("lead_speed_mps", "number", "lead.speed_mps"),
  column("limit_override_mps", "number", "limit.override_mps"),
  column("acceleration_request_mps2", "number", "acceleration_request_mps2"),
  column("hmi_reason", "word", "hmi.reason_code", REASONS),
  column("hmi_event", "word", "hmi.event", EVENTS),
  column("hmi_learned_in_drives", "whole", "hmi.learned_in_drives"),
  column("hmi_confidence", "number", "hmi.confidence"),
  column("hmi_take_over", "flag", "hmi.take_over"),
  column("following_limits", "flag", "following.limits"),
  column("following_time_gap_s", "number", "following.time_gap_s"),
  column("hmi_sentence", "whole", "hmi.sentence"),
  column("hmi_sentence_speed", "whole", "hmi.sentence_speed"),
  column("hmi_sentence_base", "whole", "hmi.sentence_base"),
  column("hmi_sentence_limit", "whole", "hmi.sentence_limit"),
  column("hmi_sentence_drive", "whole", "hmi.sentence_drive"),
]);

/** @type {Map<string, Column>} */
export const COLUMN_OF = new Map(COLUMNS.map((one) => [one.name, one]));
