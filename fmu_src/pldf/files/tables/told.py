"""What is told about how a table is written: its encoding, and what separates its columns."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from ...findings import Finding
from .content import SEPARATORS, Content

_CELL_MAX: Final = 40  # characters of a text that is shown
_SAMPLES_MAX: Final = 5  # texts shown that depend on the encoding
# Letters that two bytes of UTF-8 become when they are taken for two letters: a u with dots.
_GARBLED: Final = re.compile("[\xc2-\xc3][\x80-\xbf]|\ufffd")


def how_written(
    content: Content, columns: Sequence[str], texts: Mapping[str, Sequence[str]]
) -> Iterator[Finding]:
    """Yield how a file is written, where that is not UTF-8 with commas.

    Args:
        content: of the file.
        columns: names of those that are read.
        texts: what was read of the columns of texts.
    """
    if content.separator != ",":
        told = f"{SEPARATORS[content.separator]} separate the columns"
        yield _note(content, told)
    text = content.text
    strange = [cell for cells in texts.values() for cell in cells if not cell.isascii()]
    if text.encoding:
        yield _encoding_told(content, columns, strange)
    if garbled := [cell for cell in strange if _GARBLED.search(cell)]:
        yield Finding(
            "warning", str(content.path), 0, "", f"letters were lost before: {_listed(garbled)}",
            "names are read as they stand there", "export the file again, as UTF-8",
        )  # fmt: skip


def rows_in_comments(content: Content) -> Iterator[Finding]:
    """Yield lines with # that have as many cells as a row: somebody may be called #7."""
    marks = len(content.header) - 1
    rows = [line for line, text in content.passed_over if text.count(content.separator) == marks]
    if rows and marks:
        more = f" ({len(rows)} lines like it)" if len(rows) > 1 else ""
        yield Finding(
            "note", str(content.path), rows[0], "",
            f"begins with # and is passed over, though it has {marks + 1} cells{more}",
            "it counts nowhere; quote its first cell if it should",
        )  # fmt: skip


def _encoding_told(content: Content, columns: Sequence[str], cells: Sequence[str]) -> Finding:
    """Return which encoding was taken; a warning where names depend on a guess."""
    text = content.text
    told = f"read as {text.encoding}"
    if not text.sample:
        return _note(content, told)
    if text.encoding == "ASCII":
        ((name, word),) = text.others
        told = f"{text.sample!r} is {word!r} in {name}; read as it stands"
        return Finding("note", str(content.path), text.line, "", told)
    others = "".join(f"; in {name} it is {word!r}" for name, word in text.others)
    shown = _listed(cells or [text.sample])
    named = not all(map(str.isascii, columns))
    return Finding(
        "warning" if cells or named or text.others else "note", str(content.path), text.line, "",
        f"not UTF-8: {told}, which gives {shown}{others}",
        "names depend on that" if cells or named else "", "save the file as UTF-8",
    )  # fmt: skip


def _listed(cells: Sequence[str]) -> str:
    different = list(dict.fromkeys(cells))
    more = f" and {len(different) - _SAMPLES_MAX} more" if len(different) > _SAMPLES_MAX else ""
    return ", ".join(repr(cell[:_CELL_MAX]) for cell in different[:_SAMPLES_MAX]) + more


def _note(content: Content, text: str) -> Finding:
    return Finding("note", str(content.path), 0, "", text)
