// The words around recordings, profiles and roads of a laboratory.

import { wording } from "../language.js";
import { ReplayError } from "../engine/replay.js";
import { toldBy } from "./app.js";

const en = {
  replay: "Watch what was driven",
  replay_hint:
    "Drop files here or choose them: recordings (.csv), learned profiles (.pldf), a road to drive on (.xodr, .csv, .prepared). Several recordings are compared.",
  choose_files: "Choose files",
  reading: "Reading ...",
  needs_server:
    "Only pldf cockpit on your computer reads such a road. Or make it ready with: pldf route FILE --export ROAD.prepared",
  new_road: "You drive on {name} now, until the page is loaded again.",
  way: "{name}",
  try_again: "Try again",
  missing:
    "no recording: the columns {columns} are missing. pldf export writes any recording with these names.",
  cell: "line {line}, column {column}: {value} is no number",
  empty: "fewer than two moments in it",
  table: "cannot be read as a table: {value}",
  refused: "cannot be read: {reason}",
  play: "Play",
  stop: "Pause",
  rate: "Speed of time",
  time: "Time",
  back: "Back",
  at_place: "{name}: {speed} here, {ahead}",
  ahead: "{seconds} s ahead",
  behind: "{seconds} s behind",
  level: "level",
  follow: "Watch",
  compared: "Compared over distance",
  learned: "learned",
  base: "without lessons",
  distance: "Distance (km)",
  speed_axis: "Speed ({unit})",
  road_differs: "{name} belongs to another road than the one that is shown; places may not fit.",
};

/** @type {Record<keyof typeof en, string>} */
const de = {
  replay: "Ansehen, was gefahren wurde",
  replay_hint:
    "Legen Sie Dateien hier ab oder wählen Sie sie: Aufzeichnungen (.csv), gelernte Profile (.pldf), eine Straße zum Fahren (.xodr, .csv, .prepared). Mehrere Aufzeichnungen werden verglichen.",
  choose_files: "Dateien wählen",
  reading: "Wird gelesen ...",
  needs_server:
    "Eine solche Straße liest nur pldf cockpit auf Ihrem Rechner. Oder bereiten Sie sie vor: pldf route DATEI --export STRASSE.prepared",
  new_road: "Sie fahren jetzt auf {name}, bis die Seite neu geladen wird.",
  way: "{name}",
  try_again: "Noch einmal versuchen",
  missing:
    "keine Aufzeichnung: es fehlen die Spalten {columns}. pldf export schreibt jede Aufzeichnung mit diesen Namen.",
  cell: "Zeile {line}, Spalte {column}: {value} ist keine Zahl",
  empty: "weniger als zwei Momente darin",
  table: "nicht als Tabelle lesbar: {value}",
  refused: "nicht lesbar: {reason}",
  play: "Abspielen",
  stop: "Anhalten",
  rate: "Zeitraffer",
  time: "Zeit",
  back: "Zurück",
  at_place: "{name}: hier {speed}, {ahead}",
  ahead: "{seconds} s voraus",
  behind: "{seconds} s zurück",
  level: "gleichauf",
  follow: "Ansehen",
  compared: "Über die Strecke verglichen",
  learned: "gelernt",
  base: "ohne Lektionen",
  distance: "Strecke (km)",
  speed_axis: "Tempo ({unit})",
  road_differs:
    "{name} gehört zu einer anderen Straße als der gezeigten; Stellen passen vielleicht nicht.",
};

export const say = wording({ en, de });

/**
 * Return why a file was refused, in words.
 * @param {unknown} problem
 * @returns {string}
 */
export function refusalText(problem) {
  if (problem instanceof ReplayError) {
    const { columns = [], line = 0, column = "", value = "" } = problem.details;
    return say(problem.problem, { columns: columns.join(", "), line, column, value });
  }
  return say("refused", { reason: toldBy(problem) });
}
