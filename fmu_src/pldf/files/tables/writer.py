"""The writer of all tables: UTF-8, LF, and numbers that read back to the same bits."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain, repeat
from pathlib import Path
from typing import Final

import numpy as np

from ...errors import ModelError
from ...kernel.arrays import FloatArray
from ..disk import reason, replace_file

Cell = str | float  # bool and int are among them

_TO_QUOTE: Final = re.compile(r'[,"\r\n]|^#')
# Spreadsheets calculate with a text that begins so, a name like =cmd|'/c calc'!A1 among them. What
# OWASP advises against that ("CSV injection"): an apostrophe before it. A text that has one already
# gets another, so that ``plain_text`` knows which is ours.
_FORMULA: Final = re.compile("[ ']*[=+\\-@\t\r\n\uff1d\uff0b\uff0d\uff20]")
_NUMBER: Final = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|-inf", re.ASCII)


def table_csv(
    columns: Mapping[str, Sequence[Cell] | FloatArray], comments: Iterable[str] = ()
) -> bytes:
    """Return the content of a file with these columns of equal length.

    Args:
        columns: name -> cells: text as it is (what a spreadsheet would take for a formula behind an
            apostrophe, which the reader takes away), flags as 0 and 1, numbers as short as they
            read back.
        comments: lines to stand before the header, behind ``#``.
    """
    texts = (_texts(cells) for cells in columns.values())
    lines = chain(
        (f"# {' '.join(comment.splitlines())}" for comment in comments),
        (",".join(map(_text, columns)),),
        (",".join(row) or '""' for row in zip(*texts, strict=True)),
    )
    return ("\n".join(lines) + "\n").encode()


def write_table(
    path: str | os.PathLike[str],
    columns: Mapping[str, Sequence[Cell] | FloatArray],
    comments: Iterable[str] = (),
) -> None:
    """Write ``table_csv`` to ``path``, whole or not at all; ModelError if that fails."""
    data, path = table_csv(columns, comments), Path(path)
    try:
        if path.exists() and not path.is_file():
            path.write_bytes(data)  # a pipe or a device such as /dev/stdout is not replaced
        else:
            replace_file(path, data)
    except OSError as error:
        raise ModelError(f"{path}: cannot be written ({reason(error)})") from error


def _texts(cells: Sequence[Cell] | FloatArray) -> Iterable[str]:
    if len(cells) > 1 and _is_constant(cells):
        return repeat(next(iter(_texts(cells[:1]))), len(cells))
    if isinstance(cells, np.ndarray):
        return map(repr, cells.tolist())
    return map(_text, cells)


def _is_constant(cells: Sequence[Cell] | FloatArray) -> bool:
    if isinstance(cells, np.ndarray):
        # Bits, not values: a zero may have a sign.
        bits = cells.view(np.int64) if cells.dtype == np.float64 else cells
        return bool(np.all(bits == bits[0]))
    return isinstance(cells[0], str) and all(cell == cells[0] for cell in cells)


def _text(cell: Cell) -> str:
    if isinstance(cell, str):
        if _FORMULA.match(cell) and not _NUMBER.fullmatch(cell):
            cell = "'" + cell
        return '"' + cell.replace('"', '""') + '"' if _TO_QUOTE.search(cell) else cell
    if isinstance(cell, bool | np.bool_):
        return "1" if cell else "0"
    return repr(cell.item() if isinstance(cell, np.generic) else cell)


def plain_text(cell: str) -> str:
    """Return the text that was written as ``cell``."""
    return cell[1:] if cell.startswith("'") and _FORMULA.match(cell) else cell
