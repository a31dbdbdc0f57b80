"""``pldf learn``: SPAA on a recording."""

from __future__ import annotations

import argparse
import json
import sys
from typing import Any, Final

from ..function import DrivingFunction
from ..outcome_words import lines_of
from ..profiles.store import (
    StoredProfile,
    continue_profile,
    present_profile,
    read_profile,
    require_continued,
    write_profile,
)
from ..recordings.contradictions import require_sound
from ..recordings.offline import Learned, explain, learn_from
from ..recordings.recording import read_recording
from ..roads import route_arrays
from .shared.mapping import add_map, chosen_map
from .shared.road import add_road, required_road
from .shared.settings import add_settings, apply_settings
from .shared.telling import tell

EXAMPLE: Final = (
    "pldf learn --route study --recording out/recordings/P001_A2.csv --out a2.pldf\n"
    "  pldf learn --route study --recording b1.csv --profile-in a2.pldf --out b1.pldf --json\n"
    "  pldf learn --route study --recording b1.csv --out b1.pldf --set learn=CONSISTENT"
)


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``pldf learn``."""
    add_road(parser, required=True)
    parser.add_argument(
        "--recording",
        required=True,
        help="CSV, Parquet or MDF4 with at least time_s, s_m, speed_mps and mode (OFF, STANDBY, "
        "ACTIVE, ...); other names and units: --map",
    )
    add_map(parser)
    parser.add_argument(
        "--profile-in", help="profile that the drive followed (default: the route's base profile)"
    )
    parser.add_argument(
        "--out",
        required=True,
        help="profile file to write (.pldf): a new one, or one that this lesson continues, such as "
        "--profile-in",
    )
    parser.add_argument(
        "--force",
        action="store_true",
        help="replace what --out holds, whatever it is; it is kept as OUT.replaced-N",
    )
    parser.add_argument(
        "--json",
        action="store_true",
        help="print for every intervention what became of it: learned where and how much, held by "
        "which bound, or why not",
    )
    add_settings(parser)


def run(options: argparse.Namespace) -> None:
    """Learn, write the profile, say what was learned."""
    route = required_road(options).route
    stored = read_profile(options.profile_in) if options.profile_in else None
    function = DrivingFunction()
    apply_settings(function.record, options.settings)
    mapping = chosen_map(options)
    present = None if options.force else present_profile(options.out)
    recording = read_recording(options.recording, mapping)
    tell(require_sound(recording, options.recording, route_arrays(route)))
    learned = learn_from(recording, route, stored, function, options.recording)
    tell(learned.notes)
    _write(options, learned.profile, present)
    report = explain(learned)
    if options.json:
        print(json.dumps(report, indent=2))
    else:
        _print_summary(learned, report, options.out)


def _write(
    options: argparse.Namespace, profile: StoredProfile, present: StoredProfile | None
) -> None:
    if options.force:
        kept = write_profile(options.out, profile, force=True)
        if kept is not None:
            print(f"pldf: {options.out}: what was there is kept as {kept}", file=sys.stderr)
        return
    require_continued(options.out, profile, present)
    saved = continue_profile(options.out, profile)
    if saved.warning:
        print(f"pldf: {saved.warning}", file=sys.stderr)


def _print_summary(learned: Learned, report: dict[str, Any], out: str) -> None:
    rates = report["rates"]
    print(
        f"Rates: pedal {rates['pedal']:.1%}, set speed {rates['set_speed']:.1%}, "
        f"combined {rates['combined']:.1%}"
    )
    lines = list(lines_of(learned.function.outcomes(), learned.function.marks))
    for line in lines or ["no intervention, so nothing was learned"]:
        print(line[0].upper() + line[1:])
    print(f"Iteration {learned.iteration.number} written to {out}")
