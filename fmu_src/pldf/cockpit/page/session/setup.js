// From the plan to a drive: what is set in the FMUs, and who drives.

/** @typedef {import("../types.js").Bundle} Bundle */
/** @typedef {import("../types.js").DriveSetup} DriveSetup */
/** @typedef {import("../types.js").Files} Files */
/** @typedef {import("../types.js").Part} Part */
/** @typedef {import("../types.js").PlannedDrive} PlannedDrive */
/** @typedef {import("../types.js").Value} Value */
/** @typedef {import("../language.js").Language} Language */
/** @typedef {import("./settings.js").Settings} Settings */

// LEARN and HMI_LANGUAGE, HMI_UNIT in kernel/codes.py.
const LEARN_OFF = 0;
const LANGUAGE = { en: 0, de: 1 };
const UNIT = { kmh: 0, mph: 1 };

/**
 * Return the planned drive of a phase.
 * @param {Bundle} bundle
 * @param {string} phase
 * @returns {PlannedDrive}
 */
export function planned(bundle, phase) {
  const drive = bundle.plan.drives.find((one) => one.phase === phase);
  if (!drive) {
    throw new Error(`the plan has no drive ${phase}`);
  }
  return drive;
}

/**
 * Return a drive of the plan for one person.
 * @param {Bundle} bundle
 * @param {PlannedDrive} drive
 * @param {{driver_id: number, profiles: Files, device: string, settings: Settings, language: Language}} who
 * @returns {DriveSetup}
 */
export function driveSetup(bundle, drive, who) {
  return {
    values: personal(drive.values, who),
    profiles: who.profiles,
    who: "person",
    inputs: [],
    activate: true,
    step_s: bundle.plan.step_s,
    end_m: bundle.plan.end_m,
    pace: "real",
    steering: who.settings.steering,
    device: who.device,
  };
}

/**
 * Return a drive of the plan that the driver FMU drives.
 * @param {Bundle} bundle
 * @param {PlannedDrive} drive
 * @param {Omit<Parameters<typeof driveSetup>[2], "device">} whose
 * @returns {DriveSetup}
 */
export function simulatedSetup(bundle, drive, whose) {
  const setup = driveSetup(bundle, drive, { ...whose, device: "simulated driver" });
  return { ...setup, who: "model", activate: false, steering: "assisted" };
}

/**
 * Return a practice drive: the first drive of the plan, shorter, of which nothing is learned.
 * @param {Bundle} bundle
 * @param {Parameters<typeof driveSetup>[2]} who
 * @returns {DriveSetup}
 */
export function practiceSetup(bundle, who) {
  const first = bundle.plan.drives[0];
  if (!first) {
    throw new Error("the plan has no drives");
  }
  const setup = driveSetup(bundle, first, { ...who, profiles: {} });
  const pldf = { ...setup.values.pldf, apply_learned: false, learn: LEARN_OFF };
  return { ...setup, values: { ...setup.values, pldf }, end_m: bundle.plan.practice_end_m };
}

/**
 * @param {PlannedDrive["values"]} values
 * @param {Parameters<typeof driveSetup>[2]} who
 * @returns {Partial<Record<Part, Record<string, Value>>>}
 */
function personal(values, who) {
  const pldf = {
    ...values.pldf,
    driver_id: who.driver_id,
    "hmi.language": LANGUAGE[who.language],
    "hmi.unit": UNIT[who.settings.unit],
  };
  return { ...values, pldf };
}
