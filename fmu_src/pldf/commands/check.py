"""``pldf check``: every problem of files and studies at once, before anybody counts on them."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from math import isnan
from pathlib import Path
from typing import Any, Final

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from ..analysis.checks import CheckedFile, Checks, check_file, check_folder, is_study
from ..analysis.checks.asam import HOW_TO_GET, checker
from ..analysis.checks.files import Known
from ..analysis.checks.folder import with_copies, with_own_road
from ..analysis.checks.kinds import KNOWN_SUFFIXES, is_opendrive
from ..analysis.study_folder import StudyFolder
from ..errors import ModelError
from ..findings import SEVERITIES, Finding
from ..recordings.mapping import RecordingMap
from ..recordings.quality import Quality
from ..recordings.suggest import suggest_map
from ..roads import Road, route_arrays
from .shared.mapping import add_map, chosen_map
from .shared.progress import recordings_bar
from .shared.road import add_road, chosen_road, road_options

EXAMPLE: Final = (
    "pldf check road.xodr\n"
    "  pldf check laboratory --route road.xodr\n"
    "  pldf check drive1.csv drive2.csv --route study --json > problems.json\n"
    "  pldf check simulator.csv --suggest-map > map.toml"
)

_LISTED_MAX: Final = 8  # recordings with a line each
_STYLES: Final = {"error": "bold red", "warning": "yellow", "note": ""}


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``pldf check``."""
    parser.add_argument(
        "paths", metavar="PATH", type=Path, nargs="+",
        help="a road, a recording, a questionnaire, a table of drives or participants, a driver "
        "script, a profile, a study file, a mapping file, or a folder with a study or recordings",
    )  # fmt: skip
    add_road(parser, "road driven, against which recordings are held")
    add_map(parser)
    parser.add_argument(
        "--without", action="append", default=[], metavar="PARTICIPANT",
        help="leave this participant of a study out (repeatable)",
    )  # fmt: skip
    parser.add_argument(
        "--suggest-map", action="store_true",
        help="print a first mapping file for the recording PATH, to complete and give to --map",
    )  # fmt: skip
    parser.add_argument(
        "--no-asam", dest="asam", action="store_false",
        help="do not ask ASAM's own checker about OpenDRIVE files, where it is installed",
    )  # fmt: skip
    parser.set_defaults(wrong_usage=parser.error)
    parser.add_argument(
        "--json", action="store_true", help="print all that was found, for programs"
    )


def run(options: argparse.Namespace) -> int:
    """Print all findings; return 1 if there are errors."""
    if options.suggest_map:
        if len(options.paths) > 1:
            options.wrong_usage("--suggest-map takes one recording; others like it use its map")
        print(suggest_map(options.paths[0]), end="")
        return 0
    road, mapping = chosen_road(options), chosen_map(options)
    known = Known(
        route_arrays(road.route) if road else None,
        mapping,
        road_options(options),
        asam=options.asam,
    )
    checks, files = Checks(), list[CheckedFile]()
    for path in options.paths:
        if path.is_dir() and is_study(path):
            checks += _study(path, road, mapping, options.without)
        else:
            paths = _files_in(path) if path.is_dir() else [path]
            files += (check_file(file, known) for file in paths)
    checks += Checks(tuple(with_copies(files)), tuple(_not_asked(files, known)))
    if options.json:
        print(json.dumps(_report(checks), indent=2))
    else:
        _print(checks)
    return 1 if checks.of("error") else 0


def _study(
    folder: Path, road: Road | None, mapping: RecordingMap | None, without: Sequence[str]
) -> Checks:
    study = StudyFolder(folder, road.route if road else None, frozenset(without), mapping)
    with recordings_bar("check") as reading:
        return check_folder(with_own_road(study), reading)


def _not_asked(files: Sequence[CheckedFile], known: Known) -> Iterator[Finding]:
    """Yield once that ASAM's checker could be asked, too."""
    roads = [one.path for one in files if one.kind == "road" and is_opendrive(one.path)]
    if roads and known.asam and checker() is None:
        text = "ASAM's own checker of OpenDRIVE is not installed"
        yield Finding("note", str(roads[0]), 0, "", text, "", HOW_TO_GET)


def _files_in(folder: Path) -> list[Path]:
    files = sorted(path for path in folder.iterdir() if path.suffix.lower() in KNOWN_SUFFIXES)
    if not files:
        raise ModelError(
            f"{folder}: neither a study (recordings/, drives.csv) nor a file ending in "
            f"{', '.join(KNOWN_SUFFIXES)}; name the files themselves, or another folder"
        )
    return files


def _report(checks: Checks) -> dict[str, Any]:
    return {
        "counts": {severity: len(checks.of(severity)) for severity in SEVERITIES},
        "files": [_file(file) for file in checks.files],
        "findings": [finding._asdict() for finding in checks.findings],
    }


def _file(file: CheckedFile) -> dict[str, Any]:
    told: dict[str, Any] = {"file": str(file.path), "kind": file.kind, "worst": file.worst}
    if file.participant:
        told |= {"participant": file.participant, "phase": file.phase}
    return told | ({"quality": _quality(file.quality)} if file.quality else {})


def _quality(quality: Quality) -> dict[str, Any]:
    whole = quality._asdict()
    whole["holes"] = [hole._asdict() for hole in quality.holes]
    whole["lost_m"] = quality.lost_m
    # JSON has no NaN: what is not known is null.
    return {
        name: None if isinstance(value, float) and isnan(value) else value
        for name, value in whole.items()
    }


def _print(checks: Checks) -> None:
    """Print a table for people, plain lines for files and pipes."""
    findings = checks.findings
    if sys.stdout.isatty() and findings:
        Console().print(_table(findings))
    else:
        for finding in findings:
            print(f"{finding.severity}: {finding}")
    for line in _qualities(checks.files):
        print(line)
    told = [_count(len(checks.of(severity)), severity) for severity in SEVERITIES]
    print(f"{', '.join(told)} in {_count(len(checks.files), 'file')}.")


def _qualities(files: Sequence[CheckedFile]) -> list[str]:
    """Return a line per recording, of many one for all."""
    recorded = [(file.path, file.quality) for file in files if file.quality is not None]
    if len(recorded) <= _LISTED_MAX:
        return [f"{path}: {_about(quality)}" for path, quality in recorded]
    every = [quality for _, quality in recorded]
    ranges = (
        (f"{min(values):.3g}" + (f" to {max(values):.3g}" if max(values) > min(values) else ""))
        for values in ([one.duration_s for one in every], [round(one.rate_hz, 3) for one in every])
    )
    duration, rate = ranges
    holes = _count(sum(len(one.holes) for one in every), "drop-out")
    lost = sum(one.lost_m for one in every)
    return [f"{len(every)} recordings: {duration} s at {rate} Hz, {holes} of {lost:.0f} m in all"]


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"


def _about(quality: Quality) -> str:
    covered = "" if isnan(quality.coverage) else f" ({100 * quality.coverage:.0f} % of the road)"
    holes = _count(len(quality.holes), "drop-out") + (
        f" of {quality.lost_m:.0f} m" if quality.holes else ""
    )
    return (
        f"{quality.duration_s:.0f} s at {quality.rate_hz:.3g} Hz, {quality.from_m:.0f} to "
        f"{quality.to_m:.0f} m{covered}, {holes}"
    )


def _table(findings: Sequence[Finding]) -> Table:
    table = Table(box=SIMPLE_HEAD, padding=(0, 1, 0, 0), show_lines=True)
    for heading in ("", "where", "what", "so", "way out"):
        table.add_column(heading, overflow="fold")
    for finding in findings:
        told = (finding.where, finding.text, finding.consequence, finding.way_out)
        severity = Text(finding.severity, _STYLES[finding.severity])
        table.add_row(severity, *map(Text, told))
    return table
