"""The route file: ``s_m,curvature_per_m,speed_limit_mps[,grade][,x_m,y_m]``.

A table with one knot per line. The knots may be as far apart as the road allows: curvature, grade
and line are linear in between, a limit holds until the next knot, two lines with the same ``s_m``
are a jump. ``s_m`` starts at 0; a file that does not is refused rather than shifted, because
recordings made with it count from its own zero.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np

from ..files.tables import Column, Fault, Format, Table, parse_table, write_table
from ..findings import Finding
from ..kernel.arrays import FloatArray
from .curves.joints import NO_JOINTS
from .curves.judge import judged
from .curves.kinks import CAR_LENGTH_M
from .line_check import line_doubts
from .marks import mark_lines, marks_in
from .route import COLUMNS, GRADE_MAX, Route, fingerprint, first_fault

# What a knot may hold beyond being numbers is the route's affair: ``first_fault``.
ROUTE: Final = Format(
    "route file",
    "knot",
    (
        Column("s_m", unit="m"),
        Column("curvature_per_m", unit="1/m"),
        Column("speed_limit_mps", unit="m/s"),
        # A slope in percent, taken for a share, would be a wall.
        Column(
            "grade",
            low=-GRADE_MAX,
            high=GRADE_MAX,
            wanted="rise over run, such as 0.05",
            needed=False,
        ),
        Column("x_m", unit="m", needed=False),
        Column("y_m", unit="m", needed=False),
    ),
    closed=True,
)


def parse_route_csv(data: bytes, path: Path, smoothing_m: float | None) -> Route:
    """Return the route in ``data``, the content of ``path``.

    ``smoothing_m`` is that of ``RoadOptions``; nothing else of them concerns a table.

    Raises:
        ModelError: with file, line, column, value and way out.
    """
    table = parse_table(data, path, ROUTE)
    if ("x_m" in table) != ("y_m" in table):
        absent = "y_m" if "x_m" in table else "x_m"
        text = f"missing column {absent}; a line needs both x_m and y_m"
        table.refuse([Fault(table.header_line, "", text)])
    columns = {name: np.zeros(len(table)) for name in COLUMNS} | table.numbers
    _refuse(table, first_fault(columns, sharp=False))
    knots = np.stack([columns[name] for name in COLUMNS])
    told: list[Finding] = []
    ours = _written_by_us(table, columns)
    if smoothing_m is not None or not ours:
        knots, told = _judged(table, knots, smoothing_m)
    s_m, curvature, limit, grade, x_m, y_m = knots
    return Route(
        path.stem, s_m, curvature, limit, grade, x_m, y_m,
        has_line="x_m" in table, notes=(*table.notes, *told),
        marks=marks_in(table.comments, float(s_m[-1])) if ours else (),
    )  # fmt: skip


def _judged(
    table: Table, knots: FloatArray, smoothing_m: float | None
) -> tuple[FloatArray, list[Finding]]:
    """Return the knots with the curves that a car drives, and what is told of them."""

    def locate(at_m: float) -> tuple[int, str]:
        row = max(int(np.searchsorted(table.numbers["s_m"], at_m, side="right")) - 1, 0)
        return table.lines[row], f"{at_m:.6g} m"

    doubts = line_doubts(knots) if "x_m" in table else ()
    told = [Finding("warning", str(table.path), *locate(at_m), text) for at_m, text in doubts]
    knots, repairs = judged(knots, NO_JOINTS, smoothing_m, str(table.path), locate)
    fault = first_fault(dict(zip(COLUMNS, knots, strict=True)))
    if fault is not None:
        line, _ = locate(float(knots[0, fault[0]]))
        table.refuse([Fault(line, "", fault[1])])
    return knots, told + repairs


def write_route_csv(route: Route, path: Path | str) -> None:
    """Write every knot so that reading the file gives the same route to the bit, with its marks.

    Raises:
        ModelError: it cannot be written.
    """
    columns = COLUMNS if route.has_line else COLUMNS[:4]
    head = f"route {route.name}, {_judged_mark(route)}"
    marks = mark_lines(route.marks, exact=True)
    write_table(path, {name: route.knots[name] for name in columns}, [head, *marks])


def _judged_mark(route: Route) -> str:
    """Return what a file says whose curves are already those that a car drives."""
    return f"fingerprint {fingerprint(route)}, curves judged over {CAR_LENGTH_M:g} m"


def _refuse(table: Table, fault: tuple[int, str] | None) -> None:
    if fault is not None:
        table.refuse([table.fault(fault[0], "", fault[1])])


def _written_by_us(table: Table, knots: dict[str, FloatArray]) -> bool:
    """Tell whether this is a route that was exported, and nobody has changed it since."""
    said = [comment for comment in table.comments if "curves judged" in comment]
    if not said or first_fault(knots) is not None:
        return False
    s_m, curvature, limit, grade, x_m, y_m = (knots[name] for name in COLUMNS)
    return said[0].endswith(_judged_mark(Route("", s_m, curvature, limit, grade, x_m, y_m)))
