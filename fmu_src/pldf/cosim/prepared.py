"""Routes and driver scripts as float64 columns, so that a native FMU parses neither XML nor CSV.

The layout is described to the byte in ``docs/native.md``; ``build/runtime/prepared.c`` reads it.
"""

from __future__ import annotations

import zlib
from pathlib import Path
from typing import Any, Final

import numpy as np

from ..errors import ModelError
from ..files.disk import replace_file
from ..roads import Route, fingerprint, packed_route, route_arrays
from ..roads.load import PACKED
from ..roads.marks import mark_lines

SUFFIX: Final = ".prepared"
_ALIGNMENT: Final = 64


def prepared_route(route: Route) -> bytes:
    """Return the file of ``route`` with the arrays that the kernel needs."""
    there = [mark for mark in route.marks if mark.s_m <= route.length_m]
    lines = mark_lines(there, exact=False)
    return _prepared("route", fingerprint(route), route_arrays(route), route.has_line, lines)


def packed_files() -> dict[str, bytes]:
    """Return the files of all packed routes by their path in ``resources/``."""
    return {f"route/{i}{SUFFIX}": prepared_route(packed_route(i)) for i in range(len(PACKED))}


def prepared_script(columns: tuple[Any, ...]) -> bytes:
    """Return the file of a driver's script, given as the kernel's arrays."""
    return _prepared("script", "0" * 16, columns, False, [])


def write_prepared_route(route: Route, path: Path) -> None:
    """Write the file of ``route``; ModelError if that is not possible."""
    _write(path, prepared_route(route))


def write_prepared_script(columns: tuple[Any, ...], path: Path) -> None:
    """Write the file of a driver's script; ModelError if that is not possible."""
    _write(path, prepared_script(columns))


def _write(path: Path, data: bytes) -> None:
    try:
        replace_file(path, data)
    except OSError as error:
        raise ModelError(f"{path}: cannot be written ({error.strerror})") from None


def _prepared(
    kind: str, key: str, columns: tuple[Any, ...], has_line: bool, marks: list[str]
) -> bytes:
    """Return the bytes; without marks they are of format 1, which older releases read."""
    lines = [
        f"PLDF-PREPARED {2 if marks else 1}",
        f"kind {kind}",
        f"key {key}",
        f"columns {len(columns)}",
        f"rows {len(columns[0])}",
        f"line {int(has_line)}",
        *([f"marks {len(marks)}", *marks] if marks else []),
        "end",
    ]
    head = "\n".join(lines).encode()
    head += b" " * (-(len(head) + 1) % _ALIGNMENT) + b"\n"
    body = head + b"".join(np.asarray(c, "<f8").tobytes() for c in columns)
    return body + b"crc32 %08x\n" % zlib.crc32(body)
