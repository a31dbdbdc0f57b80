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

from ..files.tables import Column, Fault, Format, parse_table, write_table
from .route import COLUMNS, Route, fingerprint, first_fault

# What a knot may hold beyond being numbers is the route's affair: ``first_fault``.
ROUTE: Final = Format(
    "route file",
    "knot",
    (
        Column("s_m", unit="m"),
        Column("curvature_per_m", unit="1/m"),
        Column("speed_limit_mps", unit="m/s"),
        # A slope in percent, taken for a share, would be a wall.
        Column("grade", low=-1.0, high=1.0, wanted="rise over run, such as 0.05", needed=False),
        Column("x_m", unit="m", needed=False),
        Column("y_m", unit="m", needed=False),
    ),
    closed=True,
)


def parse_route_csv(data: bytes, path: Path) -> Route:
    """Return the route in ``data``, the content of ``path``.

    Raises:
        ModelError: with file, line, column, value and way out.
    """
    table = parse_table(data, path, ROUTE)
    if ("x_m" in table) != ("y_m" in table):
        absent = "y_m" if "x_m" in table else "x_m"
        text = f"missing column {absent}; a line needs both x_m and y_m"
        table.refuse([Fault(table.header_line, "", text)])
    knots = {name: np.zeros(len(table)) for name in COLUMNS} | table.numbers
    fault = first_fault(knots)
    if fault is not None:
        row, text = fault
        table.refuse([table.fault(row, "", text)])
    s_m, curvature, limit, grade, x_m, y_m = (knots[name] for name in COLUMNS)
    return Route(
        path.stem, s_m, curvature, limit, grade, x_m, y_m,
        has_line="x_m" in table, notes=tuple(table.notes),
    )  # fmt: skip


def write_route_csv(route: Route, path: Path | str) -> None:
    """Write every knot so that reading the file gives the same route to the bit.

    Raises:
        ModelError: it cannot be written.
    """
    columns = COLUMNS if route.has_line else COLUMNS[:4]
    head = f"route {route.name}, fingerprint {fingerprint(route)}"
    write_table(path, {name: route.knots[name] for name in columns}, [head])
