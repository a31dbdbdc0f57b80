"""The route file: ``s_m,curvature_per_m,speed_limit_mps[,grade][,x_m,y_m]``.

UTF-8, ``#`` comment lines first, then the header, then one knot per line. The knots may be as far
apart as the road allows: curvature, grade and line are linear in between, a limit holds until the
next knot, two lines with the same ``s_m`` are a jump. ``s_m`` starts at 0; a file that does not is
refused rather than shifted, because recordings made with it count from its own zero.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import numpy as np

from ..instance import ModelError
from ..kernel.arrays import FloatArray
from .route import COLUMNS, Route, fingerprint, first_fault

REQUIRED: Final = COLUMNS[:3]
_FORMAT: Final = "s_m,curvature_per_m,speed_limit_mps[,grade][,x_m,y_m]"


def parse_route_csv(text: str, path: Path) -> Route:
    """Return the route in ``text``; ``path`` names it in errors.

    Raises:
        ModelError: with file, line and way out.
    """
    header_line, columns, start = _header(text, path)
    table = _table(text[start:], columns, path, header_line)
    knots = {name: np.zeros(len(table)) for name in COLUMNS}
    knots |= {name: np.ascontiguousarray(table[:, i]) for i, name in enumerate(columns)}
    fault = first_fault(knots)
    if fault is not None:
        line = _line_of_row(text[start:], header_line, fault[0])
        raise ModelError(f"{path}, line {line}: {fault[1]}")
    return Route(name=path.stem, has_line="x_m" in columns, **knots)


def write_route_csv(route: Route, path: Path | str) -> None:
    """Write every knot so that reading the file gives the same route to the bit."""
    columns = COLUMNS if route.has_line else COLUMNS[:4]
    head = f"# route {route.name}, fingerprint {fingerprint(route)}\n{','.join(columns)}\n"
    values = (map(repr, route.knots[name].tolist()) for name in columns)
    with Path(path).open("w", encoding="utf-8", newline="\n") as file:
        file.write(head.replace("\r", " "))
        file.writelines(f"{','.join(row)}\n" for row in zip(*values, strict=True))


def _header(text: str, path: Path) -> tuple[int, list[str], int]:
    """Return the header's line number, its columns and the offset behind it."""
    offset = 0
    for number, line in enumerate(io.StringIO(text), start=1):
        offset += len(line)
        if line.strip() and not line.startswith("#"):
            columns = [name.strip() for name in line.split(",")]
            _check_columns(columns, f"{path}, line {number}")
            return number, columns, offset
    raise ModelError(f"{path}: no header; a route file has the columns {_FORMAT}")


def _check_columns(columns: list[str], where: str) -> None:
    missing = [name for name in REQUIRED if name not in columns]
    if ("x_m" in columns) != ("y_m" in columns):
        missing.append("y_m" if "x_m" in columns else "x_m")
    unknown = [name for name in columns if name not in COLUMNS]
    twice = [name for name in COLUMNS if columns.count(name) > 1]
    for names, what in ((missing, "missing"), (twice, "repeated"), (unknown, "unknown")):
        if names:
            found = ",".join(columns)[:120]
            listed = ", ".join(names)[:120]
            raise ModelError(
                f"{where}: {what} column {listed} (found: {found})\n  a route file has {_FORMAT}"
            )


def _table(body: str, columns: list[str], path: Path, header_line: int) -> FloatArray:
    if next(_rows(body, header_line), None) is None:
        raise ModelError(f"{path}: no knots below the header (line {header_line})")
    try:
        table = np.loadtxt(io.StringIO(body), delimiter=",", ndmin=2, dtype=np.float64)
    except ValueError as error:
        raise ModelError(f"{path}, {_why(body, columns, header_line, error)}") from None
    if table.shape[1] != len(columns):
        raise ModelError(f"{path}, {_why(body, columns, header_line, 'wrong number of columns')}")
    return table


def _why(body: str, columns: list[str], header_line: int, otherwise: object) -> str:
    """Find the first line that does not hold one number per column."""
    for number, line in _rows(body, header_line):
        fields = line.split("#", 1)[0].split(",")
        if len(fields) != len(columns):
            return f"line {number}: {len(fields)} values for {len(columns)} columns"
        for name, field in zip(columns, fields, strict=True):
            try:
                float(field)
            except ValueError:
                return f"line {number}: {name} = {field.strip()[:40]!r} is not a number"
    return f"line {header_line} and below: {otherwise}"


def _rows(body: str, header_line: int) -> Iterator[tuple[int, str]]:
    for number, line in enumerate(io.StringIO(body), start=header_line + 1):
        if line.split("#", 1)[0].strip():
            yield number, line


def _line_of_row(body: str, header_line: int, row: int) -> int:
    for index, (number, _) in enumerate(_rows(body, header_line)):
        if index == row:
            return number
    return header_line
