// The words of the session's pages; those of the drive itself are in drive_words.js.

import { wording } from "../language.js";

const en = {
  title: "Drive it yourself",
  about:
    "A car that keeps the speed for you, and learns from how you drive. This page runs the very software that a simulator runs.",
  drive_at_once: "Drive now",
  drive_at_once_hint:
    "One drive of about {minutes} min with the keyboard or a device. Then see what the car learned, and drive again.",
  demonstration: "Watch a drive",
  demonstration_hint: "A simulated driver drives; what it does in the car is shown.",
  simulation: "A whole study in seconds",
  simulation_hint:
    "A simulated driver drives all drives of the plan as fast as this computer can. Then watch and compare them. They are not kept unless you save them.",
  simulation_start: "Simulate",
  simulation_save: "Save as zip",
  forget_all: "Forget everything",
  forget_all_sure:
    "Everything that was learned on this road in free drives is gone for good. Forget it?",
  take_part: "Take part in the study",
  pseudonym: "Your code, such as P07 (no names)",
  pseudonym_wrong:
    "A code is up to 12 letters and one number, such as P07. Please do not use a name.",
  pseudonym_taken: "{other} has the same number. Every person needs a number of their own.",
  order: "Order",
  order_plan: "as planned",
  begin: "Begin",
  replay: "Watch a recording",
  replay_hint:
    "Drop a recording (.csv), a learned profile (.pldf) or a road (.xodr or prepared) here, or choose files.",
  choose_files: "Choose files",
  experimenter: "Experimenter's page",
  second_screen: "Instrument cluster for a second screen",
  windows: "Other windows",
  settings: "Settings",
  set_up_device: "Set up a wheel or gamepad",
  language: "Language",
  data: "Data",
  data_here:
    "The drives are kept in this browser only. Nobody else sees them until you hand them out.",
  data_memory:
    "This browser keeps no data for this page. Hand them out as a zip before you close it.",
  hand_out: "Hand out all data as a zip",
  hand_out_hint: "pldf analyse reads the zip as it is.",
  nothing_kept: "There are no data yet.",
  next: "Continue",
  back: "Back",
  home: "To the start",
  agree: "I agree",
  decline: "I do not agree",
  declined:
    "You did not agree. Kept are your code, when it was, this browser, and that you did not agree; nothing else. Thank you for your time.",
  practice_title: "Practice drive {number}",
  practice_text: "Get to know pedals, lever and display. Nothing is learned or judged here.",
  drive_title: "Drive {number} of {of}",
  drive_text:
    "Drive as you would drive your own car. Use pedals and lever whenever you would like another speed.",
  watch_text:
    "Please let the car drive in this drive, and watch. If you must, the brake always works.",
  explained_text: "The display says why the car drives at its speed.",
  start_drive: "Start the drive",
  stored: "The drive is stored.",
  storing: "Storing the drive ...",
  not_stored: "The data could not be stored: {problem}",
  not_stored_way_out:
    "Nothing is lost while this page stays open. Please tell the experimenter. Start the server again if it has stopped, then try again; or hand out the data as a zip.",
  try_again: "Try again",
  ended_early: "The drive ended early",
  ended_early_why: "Reason: {reason}",
  practise_again: "Practise once more",
  drive_again: "Drive it again",
  drive_again_learned: "Drive again with what was learned",
  after_title: "After the drive",
  end_session: "End the session",
  break_title: "A short break",
  break_text: "Please rest, get up, look into the distance.",
  break_left: "{minutes}:{seconds} left",
  break_early: "End the break now",
  break_over: "The break is over. Continue when you are ready.",
  thanks_title: "Thank you",
  finished: "You have finished. All data are stored.",
  finished_here:
    "You have finished. All data are kept in this browser only: please hand them out now.",
  see_learned: "See what the car learned from you",
  stopped_title: "The session was stopped",
  stopped_text: "All that you drove and answered so far is stored.",
  stopped_go_on: "Go on where it was stopped",
  welcome_back: "Welcome back. The session goes on where it was.",
  cut_off: "The last drive was interrupted before its end; it begins again.",
  unwell_title: "How do you feel?",
  unwell:
    "Moving pictures make some people feel unwell: dizzy, hot, queasy. Then stop at once, look out of the window, and rest. That is always all right.",
  why_stop: "Why do you stop?",
  reason_unwell: "I feel unwell",
  reason_time: "I have no more time",
  reason_broken: "Something does not work",
  reason_other: "Another reason, or none",
  study_changed:
    "This session was begun with the study {study}, at the step {step}, which the study that is open now does not have. Open that study, or give this person a new code.",
  other_tab: "This session is open in another window. Please close one of them.",
  problem_title: "Something went wrong",
  problem_way_out:
    "Reload the page: it goes on where it was. If that does not help, tell the people who gave you this page what stands here.",
  no_webgl:
    "This browser cannot draw in three dimensions (WebGL 2). Try a current Firefox, Chrome, Edge or Safari, and allow hardware acceleration in its settings.",
  required: "Please answer this.",
  out_of_range: "Please give a number from {low} to {high}.",
  to_answer: "Still to answer or to correct: {count}. They are marked.",
  optional: "(if you like)",
  progress: "Step {position} of {of}",
  loading: "Loading ...",
  place_waiting: "between drives",
};

/** @type {Record<keyof typeof en, string>} */
const de = {
  title: "Selbst fahren",
  about:
    "Ein Auto, das das Tempo für Sie hält und daraus lernt, wie Sie fahren. Auf dieser Seite läuft dieselbe Software wie in einem Simulator.",
  drive_at_once: "Jetzt fahren",
  drive_at_once_hint:
    "Eine Fahrt von etwa {minutes} min mit Tastatur oder Gerät. Danach sehen Sie, was das Auto gelernt hat, und fahren noch einmal.",
  demonstration: "Eine Fahrt ansehen",
  demonstration_hint: "Ein simulierter Fahrer fährt; es wird gezeigt, was er im Auto tut.",
  simulation: "Eine ganze Studie in Sekunden",
  simulation_hint:
    "Ein simulierter Fahrer fährt alle Fahrten des Plans, so schnell dieser Rechner kann. Danach sehen und vergleichen Sie sie. Behalten werden sie nur, wenn Sie sie sichern.",
  simulation_start: "Simulieren",
  simulation_save: "Als Zip sichern",
  forget_all: "Alles vergessen",
  forget_all_sure:
    "Alles, was auf dieser Straße in freien Fahrten gelernt wurde, ist dann für immer weg. Vergessen?",
  take_part: "An der Studie teilnehmen",
  pseudonym: "Ihr Kürzel, etwa P07 (keine Namen)",
  pseudonym_wrong:
    "Ein Kürzel hat bis zu 12 Buchstaben und eine Nummer, etwa P07. Bitte verwenden Sie keinen Namen.",
  pseudonym_taken: "{other} hat dieselbe Nummer. Jede Person braucht eine eigene Nummer.",
  order: "Reihenfolge",
  order_plan: "wie geplant",
  begin: "Beginnen",
  replay: "Eine Aufzeichnung ansehen",
  replay_hint:
    "Legen Sie eine Aufzeichnung (.csv), ein gelerntes Profil (.pldf) oder eine Straße (.xodr oder vorbereitet) hier ab, oder wählen Sie Dateien.",
  choose_files: "Dateien wählen",
  experimenter: "Seite der Versuchsleitung",
  second_screen: "Kombiinstrument für einen zweiten Bildschirm",
  windows: "Weitere Fenster",
  settings: "Einstellungen",
  set_up_device: "Lenkrad oder Gamepad einrichten",
  language: "Sprache",
  data: "Daten",
  data_here:
    "Die Fahrten liegen nur in diesem Browser. Niemand sonst sieht sie, bis Sie sie herausgeben.",
  data_memory:
    "Dieser Browser behält für diese Seite keine Daten. Geben Sie sie als Zip heraus, bevor Sie sie schließen.",
  hand_out: "Alle Daten als Zip herausgeben",
  hand_out_hint: "pldf analyse liest das Zip, wie es ist.",
  nothing_kept: "Es gibt noch keine Daten.",
  next: "Weiter",
  back: "Zurück",
  home: "Zum Anfang",
  agree: "Ich stimme zu",
  decline: "Ich stimme nicht zu",
  declined:
    "Sie haben nicht zugestimmt. Aufbewahrt werden Ihr Kürzel, wann es war, dieser Browser und dass Sie nicht zugestimmt haben; sonst nichts. Danke für Ihre Zeit.",
  practice_title: "Übungsfahrt {number}",
  practice_text:
    "Lernen Sie Pedale, Hebel und Anzeige kennen. Hier wird nichts gelernt und nichts bewertet.",
  drive_title: "Fahrt {number} von {of}",
  drive_text:
    "Fahren Sie, wie Sie Ihr eigenes Auto fahren würden. Nehmen Sie Pedale und Hebel, wann immer Sie ein anderes Tempo möchten.",
  watch_text:
    "Bitte lassen Sie in dieser Fahrt das Auto fahren, und sehen Sie zu. Wenn es sein muss: die Bremse wirkt immer.",
  explained_text: "Die Anzeige sagt, warum das Auto so schnell fährt.",
  start_drive: "Fahrt beginnen",
  stored: "Die Fahrt ist gespeichert.",
  storing: "Die Fahrt wird gespeichert ...",
  not_stored: "Die Daten konnten nicht gespeichert werden: {problem}",
  not_stored_way_out:
    "Solange diese Seite offen bleibt, ist nichts verloren. Bitte sagen Sie der Versuchsleitung Bescheid. Läuft der Server nicht mehr, starten Sie ihn neu und versuchen es noch einmal; oder geben Sie die Daten als Zip heraus.",
  try_again: "Noch einmal versuchen",
  ended_early: "Die Fahrt endete vorzeitig",
  ended_early_why: "Grund: {reason}",
  practise_again: "Noch einmal üben",
  drive_again: "Noch einmal fahren",
  drive_again_learned: "Noch einmal fahren, mit dem Gelernten",
  after_title: "Nach der Fahrt",
  end_session: "Sitzung beenden",
  break_title: "Eine kurze Pause",
  break_text: "Bitte ruhen Sie sich aus, stehen Sie auf, sehen Sie in die Ferne.",
  break_left: "noch {minutes}:{seconds}",
  break_early: "Pause jetzt beenden",
  break_over: "Die Pause ist vorbei. Fahren Sie fort, wenn Sie bereit sind.",
  thanks_title: "Danke",
  finished: "Sie sind fertig. Alle Daten sind gespeichert.",
  finished_here:
    "Sie sind fertig. Alle Daten liegen nur in diesem Browser: bitte geben Sie sie jetzt heraus.",
  see_learned: "Ansehen, was das Auto von Ihnen gelernt hat",
  stopped_title: "Die Sitzung wurde beendet",
  stopped_text: "Alles, was Sie bisher gefahren sind und geantwortet haben, ist gespeichert.",
  stopped_go_on: "Dort weitermachen, wo sie beendet wurde",
  welcome_back: "Willkommen zurück. Die Sitzung geht weiter, wo sie war.",
  cut_off: "Die letzte Fahrt wurde vor ihrem Ende unterbrochen; sie beginnt von vorn.",
  unwell_title: "Wie geht es Ihnen?",
  unwell:
    "Von bewegten Bildern wird manchen Menschen unwohl: schwindlig, heiß, übel. Hören Sie dann sofort auf, sehen Sie aus dem Fenster und ruhen Sie sich aus. Das ist immer in Ordnung.",
  why_stop: "Warum hören Sie auf?",
  reason_unwell: "Mir ist unwohl",
  reason_time: "Ich habe keine Zeit mehr",
  reason_broken: "Etwas funktioniert nicht",
  reason_other: "Ein anderer Grund, oder keiner",
  study_changed:
    "Diese Sitzung wurde mit der Studie {study} begonnen und steht beim Schritt {step}, den die jetzt geöffnete Studie nicht hat. Öffnen Sie jene Studie, oder geben Sie dieser Person ein neues Kürzel.",
  other_tab: "Diese Sitzung ist in einem anderen Fenster offen. Bitte schließen Sie eines davon.",
  problem_title: "Etwas ist schiefgegangen",
  problem_way_out:
    "Laden Sie die Seite neu: sie macht weiter, wo sie war. Hilft das nicht, sagen Sie denen, von denen Sie diese Seite haben, was hier steht.",
  no_webgl:
    "Dieser Browser kann nicht räumlich zeichnen (WebGL 2). Versuchen Sie es mit einem aktuellen Firefox, Chrome, Edge oder Safari, und erlauben Sie in dessen Einstellungen die Hardwarebeschleunigung.",
  required: "Bitte beantworten Sie das.",
  out_of_range: "Bitte geben Sie eine Zahl von {low} bis {high} an.",
  to_answer: "Noch zu beantworten oder zu berichtigen: {count}. Es ist markiert.",
  optional: "(wenn Sie möchten)",
  progress: "Schritt {position} von {of}",
  loading: "Wird geladen ...",
  place_waiting: "zwischen Fahrten",
};

export const say = wording({ en, de });
