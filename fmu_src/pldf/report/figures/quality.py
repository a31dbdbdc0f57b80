"""How good the recordings of a study are, at one look: participants by drives."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import isnan
from typing import Final

from ...analysis.checks import CheckedFile, Checks
from .. import palette
from ..scene import Axis, Box, Boxes, Fill, Panel, Scene, Tick

# By the gravest finding of a drive; what only colour would tell apart is hatched.
_KINDS: Final = {
    "error": ("Cannot be used", Fill(palette.VERMILLION, 0.9, hatched=True)),
    "warning": ("With a warning", Fill(palette.ORANGE, 0.8)),
    "": ("Nothing found", Fill(palette.GREEN, 0.35)),
}
_CELL: Final = 0.46  # half of a cell's width and height
_ROW_IN: Final = 0.24


def quality(checks: Checks) -> Scene:
    """Return a cell per recording, coloured by the gravest that was found in it."""
    drives = checks.drives
    people = list(dict.fromkeys(file.participant for file in drives))
    phases = sorted({file.phase for file in drives}, key=lambda name: (name[0], int(name[1:])))
    row = {name: len(people) - 1 - at for at, name in enumerate(people)}
    column = {name: at for at, name in enumerate(phases)}
    cells = tuple(_cells(drives, row, column))
    x = Axis("", low=-0.6, high=len(phases) - 0.4, grid=False, ticks=_ticks(column))
    y = Axis("", low=-0.6, high=len(people) - 0.4, grid=False, ticks=_ticks(row))
    height_in = 1.0 + _ROW_IN * len(people)
    return Scene((Panel(cells, x, y, height_in),), "Quality of the recordings", width_in=7.0)


def _ticks(places: Mapping[str, int]) -> tuple[Tick, ...]:
    return tuple(Tick(float(at), name) for name, at in places.items())


def _cells(
    drives: Sequence[CheckedFile], row: Mapping[str, int], column: Mapping[str, int]
) -> Iterator[Boxes]:
    for kind, (label, fill) in _KINDS.items():
        boxes = tuple(
            _box(file, column[file.phase], row[file.participant])
            for file in drives
            if (file.worst if file.worst != "note" else None) == (kind or None)
        )
        if boxes:
            yield Boxes(boxes, fill, label)


def _box(file: CheckedFile, x: float, y: float) -> Box:
    return Box(x - _CELL, x + _CELL, y - _CELL, y + _CELL, "\n".join(_hover(file)))


def _hover(file: CheckedFile) -> Iterator[str]:
    yield f"{file.participant} {file.phase}"
    if (found := file.quality) is not None:
        covered = "" if isnan(found.coverage) else f", {100 * found.coverage:.0f} % of the road"
        yield f"{found.duration_s:.0f} s, {found.rate_hz:.3g} Hz{covered}"
        yield f"{len(found.holes)} drop-outs, {found.lost_m:.0f} m lost"
    for finding in file.findings:
        if finding.severity != "note":
            yield f"{finding.severity}: {finding.text}"
