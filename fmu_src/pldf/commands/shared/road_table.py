"""The roads of a file as a table."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from ...kernel.units import KMH_PER_MPS
from ...roads import RoadRow

_HEADER: Final = (
    "road", "name", "length", "limits", "lanes", "leads on to", "driven against, to"
)  # fmt: skip
_NAME_MAX: Final = 24
_WAYS_MAX: Final = 8


def road_table(rows: Iterable[RoadRow]) -> Iterator[str]:
    """Yield the lines of a table of roads; connecting roads of junctions have one of their own."""
    rows = list(rows)
    plain = [row for row in rows if not row.junction]
    inner = [row for row in rows if row.junction]
    yield from _aligned([_HEADER, *map(_cells, plain)])
    if inner:
        yield ""
        header = ("junction", *_HEADER)
        yield from _aligned([header, *((row.junction, *_cells(row)) for row in inner)])
    yield ""
    yield f"{_counted(len(plain), 'road')}, {_counted(len(inner), 'connecting road')} in junctions"
    yield "lanes: for cars, along the direction in which the road is drawn + against it"
    if any(row.limits_mps is None for row in rows):
        yield "limits -: the road states none; on a way it has that of its neighbours"


def _cells(row: RoadRow) -> tuple[str, ...]:
    name = row.name if len(row.name) <= _NAME_MAX else row.name[: _NAME_MAX - 3] + "..."
    along, against = row.ways_on
    return (
        row.id or "-",
        name if name != row.id else "",
        f"{row.length_m:.1f} m",
        _limits(row.limits_mps),
        "?" if row.lanes is None else f"{row.lanes[0]} + {row.lanes[1]}",
        _ways(along),
        _ways(against),
    )


def _limits(limits_mps: tuple[float, float] | None) -> str:
    if limits_mps is None:
        return "-"
    low, high = (f"{round(limit * KMH_PER_MPS, 1):g}" for limit in limits_mps)
    return f"{low} km/h" if low == high else f"{low}-{high} km/h"


def _ways(roads: Sequence[str]) -> str:
    more = f", and {len(roads) - _WAYS_MAX} more" if len(roads) > _WAYS_MAX else ""
    return ", ".join(roads[:_WAYS_MAX]) + more or "-"


def _counted(count: int, what: str) -> str:
    return f"{count} {what}{'' if count == 1 else 's'}"


def _aligned(lines: list[tuple[str, ...]]) -> Iterator[str]:
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    for line in lines:
        cells = (f"{cell:{width}}" for cell, width in zip(line, widths, strict=True))
        yield "  ".join(cells).rstrip()
