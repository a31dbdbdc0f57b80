// The forms in which the rooms hand things to each other.

/** @typedef {import("./language.js").Language} Language */
/** @typedef {number | boolean | string} Value */
/** @typedef {"vehicle" | "driver" | "pldf" | "lead"} Part name of an FMU in a drive */
/** @typedef {Record<string, Uint8Array>} Files by relative path, with / between folders */

/**
 * A variable of an FMU, as its model description has it. Enumerations are Integers with `items`.
 * @typedef {object} Variable
 * @property {string} name
 * @property {number} reference
 * @property {"Real" | "Integer" | "Boolean" | "String"} kind
 * @property {"parameter" | "input" | "output"} causality
 * @property {Value} start
 * @property {string} unit
 * @property {string[]} items names of an enumeration's values, from 0
 */

/**
 * An FMU as WebAssembly.
 * @typedef {object} Model
 * @property {string} name
 * @property {string} guid
 * @property {string} version
 * @property {Uint8Array} wasm
 * @property {Variable[]} variables
 * @property {Files} resources by path below resources/
 */

/**
 * A road, as prepared for the FMUs, and what else a driver sees of it.
 * @typedef {object} Road
 * @property {string} name
 * @property {string} key fingerprint
 * @property {Uint8Array} prepared docs/native.md
 * @property {number} lane_width_m
 * @property {number} lanes_right in the direction of driving
 * @property {number} lanes_left the other ones
 * @property {"RHT" | "LHT"} traffic side
 * @property {Stretch[]} stretches
 */
/**
 * Where there is a village or a bridge; of a road without a line, to which side it turns.
 * @typedef {{kind: "village" | "bridge" | "bend_left" | "bend_right", from_m: number, to_m: number, name: string}} Stretch
 */

/**
 * One drive of the plan: values of parameters and start values by part and name.
 * @typedef {object} PlannedDrive
 * @property {string} phase A1 .. B3
 * @property {boolean} apply_learned
 * @property {boolean} learn
 * @property {boolean} intervenes the driver may; otherwise he is asked to let it drive
 * @property {Partial<Record<Part, Record<string, Value>>>} values
 */

/**
 * @typedef {object} Plan
 * @property {string} title
 * @property {PlannedDrive[]} drives each phase once
 * @property {{AB: string[], BA: string[]}} orders phases in the order of driving
 * @property {boolean} counterbalanced participants with even numbers get BA
 * @property {number} practice number of practice drives before the first one
 * @property {number} practice_end_m where they end
 * @property {number} step_s
 * @property {number} end_m where a drive ends
 * @property {Record<string, number>} breaks phase: minutes of rest after it
 * @property {("none" | "icon" | "text")[]} explanations conditions, taken in turn by number of the participant (counterbalanced: by pairs of numbers)
 * @property {"assisted" | "person"} steering
 * @property {number} fov_deg horizontal field of view
 */

/** @typedef {{key: string, text: Record<Language, string>}} Option what is stored, what is shown */
/**
 * @typedef {object} Item
 * @property {string} id column of questionnaire.csv
 * @property {"choice" | "scale" | "text" | "number"} kind
 * @property {Record<Language, string>} text
 * @property {Option[]} options of a choice
 * @property {number} boxes of a scale, numbered from 1 on the left (or `low` .. `high` of a number)
 * @property {Record<Language, string>} left beside the first box
 * @property {Record<Language, string>} right beside the last box
 * @property {number} low
 * @property {number} high
 * @property {boolean} required
 * @property {{id: string, is: (string | number)[]} | null} only_if shown only if that item was answered so
 */
/**
 * @typedef {object} Questionnaire
 * @property {string} id
 * @property {Record<Language, string>} title
 * @property {Record<Language, string>} intro
 * @property {string[]} after phases, or "start", "practice", "end", or "A", "B": after the last drive with that system
 * @property {Item[]} items
 */

/**
 * All that the page needs to know: made by `pldf.cockpit.bundle`, where bytes are base64 texts.
 * @typedef {object} Bundle
 * @property {string} version
 * @property {Language} language
 * @property {Record<Part, Model>} models
 * @property {[[Part, string], [Part, string]][]} wires output, input
 * @property {Road} road
 * @property {Plan} plan
 * @property {HmiTexts} texts resources/hmi_texts.json
 * @property {Record<"welcome" | "consent" | "thanks", Record<Language, string>>} pages safe HTML made of Markdown
 * @property {Questionnaire[]} questionnaires
 * @property {Files} beside study file and road, which lie beside the data
 */
/** @typedef {Record<string, any>} HmiTexts */

/**
 * What the person does now.
 * @typedef {object} Controls
 * @property {number} gas_pedal 0..1
 * @property {number} brake_pedal 0..1
 * @property {number} steering -1 (right) .. 1 (left)
 * @property {boolean} resume
 * @property {boolean} cancel
 * @property {boolean} up
 * @property {boolean} down
 * @property {boolean} up_long
 * @property {boolean} down_long
 * @property {boolean} pause_learning a switch: true while it is on
 * @property {boolean} forget_here
 * @property {boolean} undo
 */

/**
 * What a drive is made of; `who` drives: a person, the driver FMU, or a list of recorded inputs.
 * @typedef {object} DriveSetup
 * @property {Partial<Record<Part, Record<string, Value>>>} values
 * @property {Files} profiles files of the profile store, by name
 * @property {"person" | "model" | "inputs"} who
 * @property {InputChange[]} inputs of who = "inputs"
 * @property {boolean} activate the function is switched on by a RESUME at the start
 * @property {number} step_s
 * @property {number} end_m
 * @property {"real" | "fast"} pace in real time or as fast as possible
 * @property {"assisted" | "person"} steering
 * @property {string} device that the person drives with: "keyboard", or the name of the device
 */
/** @typedef {{step: number, name: string, value: number}} InputChange from this step on, an input of the coupling (`driver.gas_pedal`) */

/**
 * A moment of a drive. Values by their names as inputs and outputs of the function
 * (`vehicle.speed_mps`, `driver.gas_pedal`, `hmi.text`, `mode`, ...) and those of the vehicle
 * that the function does not see (`jerk_mps3`); codes for enumerations.
 * @typedef {object} Frame
 * @property {number} time_s
 * @property {number} lateral_m to the left of the lane's middle
 * @property {number} heading_rad against the lane, to the left
 * @property {Record<string, Value>} values
 */

/** @typedef {{time_s: number, lost_s: number, reason: string}} Interruption */
/**
 * @typedef {object} DriveResult
 * @property {string} recording CSV
 * @property {InputChange[]} inputs all that the person did, exactly
 * @property {Files} profiles files of the store after the drive
 * @property {Record<string, Value>} outputs of the function at the end
 * @property {{level: string, part: Part, text: string}[]} messages of the FMUs
 * @property {Interruption[]} interruptions
 * @property {{steps: number, late_steps: number, late_max_ms: number, step_us: number}} timing
 * @property {"arrived" | "stopped" | "stood still" | "failed"} ending
 * @property {string} reason of a stop or failure
 */

export {};
