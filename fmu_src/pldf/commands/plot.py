"""``pldf plot``: pictures of recordings."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from math import isnan
from pathlib import Path
from typing import Final

from ..errors import ModelError
from ..function import DrivingFunction
from ..profiles.store import read_profile
from ..recordings.derived import completed
from ..recordings.interventions import rates_of
from ..recordings.recording import Recording, read_recording
from ..roads import Road, open_route
from .shared.mapping import add_map, chosen_map
from .shared.road import add_road, chosen_road
from .shared.telling import tell

EXAMPLE: Final = (
    "pldf plot out/recordings/P001_B1.csv --out b1.png\n"
    "  pldf plot out/recordings/P001_A1.csv out/recordings/P001_B2.csv --out compared.png"
)

_NEEDED: Final = ("limit_mps", "base_mps")
BASE: Final = "base"
_COMPARED_MAX: Final = 7  # as many colours can be told apart


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``pldf plot``."""
    parser.add_argument(
        "recordings", metavar="RECORDING.csv", nargs="+", type=Path, help="one, or up to 7 compared"
    )
    parser.add_argument(
        "--profile", type=Path, metavar="P.pldf", help="draw the newest state of this profile too"
    )
    parser.add_argument(
        "--followed", metavar="P.pldf",
        help="what the drives followed, for recordings that do not tell: the newest state of this "
        "profile, or 'base'; without, what is not known is left out",
    )  # fmt: skip
    add_map(parser)
    add_road(parser, "road driven, for recordings without limits")
    parser.add_argument(
        "--out", type=Path, metavar="PNG", help="picture (default: beside the first recording)"
    )
    parser.set_defaults(wrong_usage=parser.error)


def run(options: argparse.Namespace) -> None:
    """Draw the picture and say where it is."""
    from ..report.figures import recorded  # noqa: PLC0415 - slow to import, rarely needed
    from ..report.paper import save  # noqa: PLC0415

    if len(options.recordings) > _COMPARED_MAX:
        options.wrong_usage(f"at most {_COMPARED_MAX} recordings fit into one picture")
    road = chosen_road(options)
    recordings = [_complete(path, road, options) for path in options.recordings]
    named = dict(zip(names_of(options.recordings), recordings, strict=True))
    profile = read_profile(options.profile) if options.profile else None
    shares = [f"{name} {_share(recording)}" for name, recording in named.items()]
    title = f"Share of the time with interventions: {', '.join(shares)}"
    out = options.out or options.recordings[0].with_suffix(".png")
    save(out, recorded(named, title, profile))
    print(f"picture  {out}")


def names_of(paths: Sequence[Path]) -> list[str]:
    """Return the shortest ends of the paths that tell them apart; a file given twice counts up."""
    names = [path.stem for path in paths]
    depth = 1
    while len(set(names)) < len(set(paths)) and depth < max(len(p.parts) for p in paths):
        depth += 1
        names = ["/".join((*path.parts[-depth:-1], path.stem)) for path in paths]
    return [
        name if name not in names[:at] else f"{name} ({names[:at].count(name) + 1})"
        for at, name in enumerate(names)
    ]


def _complete(path: Path, road: Road | None, options: argparse.Namespace) -> Recording:
    """Read a recording; derive what a picture needs and the recording lacks, if it is known."""
    recording = read_recording(path, chosen_map(options))
    missing = [name for name in _NEEDED if name not in recording]
    if road is None and (missing or options.followed):
        why = f"no column {', '.join(missing)}" if missing else "--followed needs the road"
        raise ModelError(f"{path}: {why}; name the route driven with --route")
    function = DrivingFunction()
    function.prepare(road.route if road else open_route("study"))
    if options.followed not in (None, BASE):
        function.follow(read_profile(options.followed))
    whole = completed(recording, function, str(path), profile_known=options.followed is not None)
    tell(whole.notes)
    return whole


def _share(recording: Recording) -> str:
    """Return the share of the time with interventions, as far as it is known."""
    rates = rates_of(recording)
    if isnan(rates.combined):
        return f"{100 * rates.pedal:.0f} % by pedals (set speed not known)"
    return f"{100 * rates.combined:.0f} %"
