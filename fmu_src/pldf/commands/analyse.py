"""``pldf analyse``: rates, scores, tests and effect sizes of a study, real or simulated."""

from __future__ import annotations

import argparse
from math import isnan
from pathlib import Path
from typing import Final, Literal

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from ..analysis.analysis import RATES, Analysis
from ..analysis.analysis_tables import write_tables
from ..analysis.checks import Checks, analysed
from ..analysis.checks.folder import with_road_beside
from ..analysis.published import DRIVERS, TESTS, published_means
from ..analysis.questionnaires import SCALES, Questionnaire
from ..analysis.study_folder import StudyFolder
from ..analysis.unpacked import SUFFIX, unpacked_study
from .shared.mapping import add_map, chosen_map, remember_map
from .shared.progress import recordings_bar
from .shared.road import add_road, chosen_road
from .shared.telling import tell

EXAMPLE: Final = (
    "pldf analyse out --report report.html\n"
    "  pldf analyse desk1.zip desk2.zip\n"
    "  pldf analyse laboratory --route road.xodr --without P07 --figures paper --format pdf"
)

FORMATS: Final = ("svg", "pdf", "png")
_NAMES: Final = {
    "pedal": "Pedal, %",
    "set_speed": "Set speed, %",
    "combined": "Either, %",
    "usefulness": "Usefulness",
    "satisfying": "Satisfying",
    "speed_profile": "Speed profile",
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``pldf analyse``."""
    parser.add_argument(
        "folder", metavar="FOLDER", type=Path, nargs="+",
        help="with drives.csv or recordings/PARTICIPANT_PHASE.csv, and questionnaire.csv if any; "
        "or the .zip files that an exported cockpit handed out: unpacked into a folder beside them",
    )  # fmt: skip
    parser.add_argument(
        "--without", action="append", default=[], metavar="NAME",
        help="leave out a participant (P07), a drive (P07_B2) or a recording by the name of its "
        "file (repeatable); with a reason that the report quotes: FOLDER/exclusions.csv",
    )  # fmt: skip
    add_road(parser, "road driven, needed if recordings lack columns")
    parser.add_argument(
        "--profiles", type=Path, metavar="FOLDER",
        help="learned profiles of the participants, for recordings of system B without "
        "set_speed_offset_mps (default: FOLDER/profiles)",
    )  # fmt: skip
    add_map(parser)
    parser.add_argument(
        "--out", type=Path, metavar="FOLDER", help="tables as CSV (default: FOLDER/analysis)"
    )

    parser.add_argument(
        "--report", type=Path, metavar="HTML", help="write a report, one file that needs no network"
    )
    parser.add_argument(
        "--figures", type=Path, metavar="FOLDER", help="write the figures for papers into a folder"
    )
    parser.add_argument(
        "--format", choices=FORMATS, default="svg", help="of these figures (default: svg)"
    )
    parser.add_argument(
        "--driver", metavar="PARTICIPANT",
        help="whom report and figures show in detail (default: nearest to the median effect)",
    )  # fmt: skip
    parser.set_defaults(wrong_usage=parser.error)


def run(options: argparse.Namespace) -> None:
    """Analyse, write the tables, print what was found and where it is."""
    options.folder = _folder(options)
    road = chosen_road(options)
    route = road.route if road else None
    study = StudyFolder(
        options.folder, route, frozenset(options.without), chosen_map(options), options.profiles
    )
    study = with_road_beside(study)
    with recordings_bar("read") as reading:
        analysis, checks = analysed(study, reading)
    answers = analysis.questionnaire.notes if analysis.questionnaire else ()
    tell(n for n in analysis.notes if n.severity == "warning" or n not in answers)
    remember_map(options, options.folder)  # one that could not be used is not worth keeping
    written = write_tables(analysis, options.out or options.folder / "analysis")
    console = Console()
    console.print(_means(analysis))
    console.print(_tests(analysis))
    for line in _remarks(analysis):
        console.print(line, highlight=False)
    if options.report or options.figures:
        _show(analysis, study, checks, options)
    print(f"Tables: {', '.join(path.name for path in written)} in {written[0].parent}.")


def _folder(options: argparse.Namespace) -> Path:
    """Return the folder of the study; zip files are unpacked into one."""
    folders: list[Path] = options.folder
    zipped = [path for path in folders if path.suffix.lower() == SUFFIX and path.is_file()]
    if zipped and len(zipped) == len(folders):
        return unpacked_study(zipped)
    if len(folders) > 1:
        options.wrong_usage("one FOLDER, or .zip files only")
    return folders[0]


def _show(
    analysis: Analysis, study: StudyFolder, checks: Checks, options: argparse.Namespace
) -> None:
    """Write report and figures, as far as they are wanted."""
    from ..report.contents import collect  # noqa: PLC0415 - slow to import

    contents = collect(analysis, study, options.driver, checks)
    tell(note for note in contents.analysis.notes if note not in analysis.notes)
    if options.report:
        from ..report.page import write_report  # noqa: PLC0415

        write_report(options.report, contents)
        print(f"Report: {options.report}")
    if options.figures:
        from ..report.figures.study import study_figures  # noqa: PLC0415
        from ..report.paper import save  # noqa: PLC0415

        figures = study_figures(contents)
        paths = [options.figures / f"{name}.{options.format}" for name in figures]
        for path, figure in zip(paths, figures.values(), strict=True):
            save(path, figure)
        print(f"Figures: {', '.join(path.name for path in paths)} in {options.figures}.")


def _means(analysis: Analysis) -> Table:
    title = f"System A against B, means of {len(analysis.participants)} participants"
    if any(found.people < len(analysis.participants) for found in analysis.comparisons.values()):
        title += " (n: with both values)"
    table = Table(title=title, box=SIMPLE_HEAD, padding=(0, 1, 0, 0))
    for heading in ("", "n", "A", "B", "A - B", "95 % interval", "paper A", "paper B"):
        table.add_column(heading, justify="right" if heading else "left", no_wrap=True)
    for measure, comparison in analysis.comparisons.items():
        unit = 100.0 if measure in RATES else 1.0
        paper = published_means(measure) if measure in RATES else ()
        change = comparison.difference
        values = (comparison.mean_first, comparison.mean_second, change.value)
        table.add_row(
            _NAMES[measure],
            str(comparison.people),
            *(f"{unit * value:.2f}" for value in values),
            f"{unit * change.low:.2f} to {unit * change.high:.2f}",
            *(f"{unit * value:.2f}" for value in paper),
        )
    return table


def _tests(analysis: Analysis) -> Table:
    title = "Two-sided tests and effect sizes (positive: B is lower)"
    table = Table(title=title, box=SIMPLE_HEAD, padding=(0, 1, 0, 0))
    for heading in ("", "n", "t", "p", "W", "pairs", "p", "by", "d_z", "r"):
        justify: Literal["left", "right"] = "right" if heading else "left"
        table.add_column(heading, justify=justify, no_wrap=True)
    for measure, comparison in analysis.comparisons.items():
        t, ranks = comparison.t, comparison.signed_rank
        used = TESTS[measure].kind if measure in TESTS else ""
        table.add_row(
            _NAMES[measure].partition(",")[0],
            str(comparison.people),
            f"{'*' if used == 't' else ''}{t.t:.2f}",
            f"{t.p:.2g}" if t.has_spread else "no spread",
            f"{'*' if used == 'wilcoxon' else ''}{ranks.w:g}",
            str(ranks.pairs),
            f"{ranks.p:.2g}",
            ranks.method,
            f"{comparison.d_z:.2f}",
            f"{comparison.rank_biserial:.2f}",
        )
    return table


def _remarks(analysis: Analysis) -> list[str]:
    told = [f"Rates from {analysis.source}. Paper: {DRIVERS} drivers; * the test that it used."]
    told.append("d_z: Cohen's d of the differences; r: rank-biserial correlation.")
    if same := [name for name, found in analysis.comparisons.items() if not found.t.has_spread]:
        told.append(
            f"No spread: {', '.join(same)}; A - B is the same for everybody, so t and d_z are "
            "infinite and say nothing."
        )
    answers = analysis.questionnaire
    if answers:
        told.append(f"Cronbach's alpha: {', '.join(_alpha(answers, s) for s in answers.scores)}.")
        notes = [note for note in answers.notes if note.severity == "note"]
        told += [f"{note.text[:1].upper()}{note.text[1:]}." for note in notes if not note.line]
        if partly := sum(1 for note in notes if note.line):
            told.append(f"Scores without single items, means of the others: {partly}.")
        absent = [scale for scale in SCALES if scale not in answers.scores]
        if absent:
            told.append(f"Not in the questionnaire: {', '.join(absent)}.")
    else:
        told.append("No questionnaire.csv, so no scores.")
    return told


def _alpha(answers: Questionnaire, scale: str) -> str:
    """Return the reliability of a scale with the number of questionnaires that it is from."""
    alpha, count = answers.reliability(scale), answers.complete[scale].shape[1]
    return f"{scale} {'not defined' if isnan(alpha) else f'{alpha:.2f}'} (n = {count})"
