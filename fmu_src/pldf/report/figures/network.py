"""A map of all roads of a file with their ids, for who looks for a way."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

import numpy as np

from ...kernel.arrays import FloatArray
from ...kernel.units import KMH_PER_MPS
from ...roads import RoadRow
from .. import palette
from ..scene import Line, Note, Scene, Stroke
from .frame import Frame, frame_around
from .labels import Labels
from .plan import limit_classes

_TEXTS_MAX: Final = 400  # for which room is looked for
_INNER: Final = Stroke(palette.GREY, 0.8)
_NO_LIMIT: Final = Stroke(palette.BLACK, 1.4, "dash")
_ARROW_ROOM_IN: Final = 0.4  # a shorter road has no arrow head


def network(rows: Iterable[RoadRow], name: str) -> Scene | None:
    """Return the map of these roads, None if none has a line.

    Args:
        rows: the roads.
        name: what they are of, for the title.
    """
    drawn = [row for row in rows if row.line_m is not None]
    if not drawn:
        return None
    x_m, y_m = (np.concatenate([_line(row)[k] for row in drawn]) for k in (0, 1))
    frame = frame_around(x_m, y_m)
    plain = [row for row in drawn if not row.junction]
    lines = (*_inner(drawn, frame), *_roads(plain, frame), _arrows(plain, frame))
    labels = Labels(frame.factor * x_m, frame.factor * y_m, frame.per_in, frame.inside)
    return frame.scene((*lines, *_ids(plain or drawn, frame, labels)), f"{name}: all roads")


def _line(row: RoadRow) -> tuple[FloatArray, FloatArray]:
    assert row.line_m is not None
    return row.line_m


def _inner(rows: Sequence[RoadRow], frame: Frame) -> Iterator[Line]:
    inner = [row for row in rows if row.junction]
    if inner:
        yield _joined(inner, frame, _INNER, "Connecting road of a junction")


def _roads(rows: Sequence[RoadRow], frame: Frame) -> Iterator[Line]:
    """Yield the roads by their highest limit, the slowest first."""
    limited = [(row, row.limits_mps[1]) for row in rows if row.limits_mps is not None]
    if limited:
        limits_kmh = np.round(np.array([limit for _, limit in limited]) * KMH_PER_MPS, 1)
        of_row, labels = limit_classes(limits_kmh)
        for number, label in enumerate(labels):
            chosen = [row for (row, _), k in zip(limited, of_row, strict=True) if k == number]
            yield _joined(chosen, frame, palette.limit(number, len(labels)), label)
    if without := [row for row in rows if row.limits_mps is None]:
        yield _joined(without, frame, _NO_LIMIT, "No limit stated")


def _joined(rows: Sequence[RoadRow], frame: Frame, stroke: Stroke, label: str) -> Line:
    """Return all these roads as one line with gaps."""
    x, y = (
        np.concatenate([np.append(frame.factor * _line(row)[k], np.nan) for row in rows])
        for k in (0, 1)
    )
    texts = [text for row in rows for text in [_about(row)] * (len(_line(row)[0]) + 1)]
    return Line(x, y, stroke, label, hover=tuple(texts))


def _about(row: RoadRow) -> str:
    name = f" {row.name}" if row.name not in ("", row.id) else ""
    return f"road {row.id}{name}, {row.length_m:.0f} m"


def _arrows(rows: Sequence[RoadRow], frame: Frame) -> Line:
    """Return arrow heads in the direction in which the roads are drawn."""
    least_m = _ARROW_ROOM_IN * frame.per_in / frame.factor
    return frame.arrow_heads(_middle(row, frame) for row in rows if row.length_m > least_m)


def _middle(row: RoadRow, frame: Frame) -> tuple[float, float, float, float]:
    """Return where the middle of a road is and its direction there."""
    x, y = (frame.factor * values for values in _line(row))
    at = (len(x) - 1) // 2
    east, north = float(x[at + 1] - x[at]), float(y[at + 1] - y[at])
    length = float(np.hypot(east, north)) or 1.0
    return float(x[at]), float(y[at]), east / length, north / length


def _ids(rows: Sequence[RoadRow], frame: Frame, labels: Labels) -> list[Note]:
    """Return the ids for which there is room, those of the longest roads first."""
    for row in sorted(rows, key=lambda row: -row.length_m)[:_TEXTS_MAX]:
        labels.add(*_middle(row, frame)[:2], row.id or row.name)
    return labels.notes
