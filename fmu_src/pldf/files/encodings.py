"""Which encoding a text file says that it has, by its first bytes."""

from __future__ import annotations

import codecs
from typing import Final

_MARKS: Final = {  # UTF-32 before UTF-16, whose mark is the beginning of the other's
    codecs.BOM_UTF8: "utf-8",
    codecs.BOM_UTF32_LE: "utf-32-le",
    codecs.BOM_UTF32_BE: "utf-32-be",
    codecs.BOM_UTF16_LE: "utf-16-le",
    codecs.BOM_UTF16_BE: "utf-16-be",
}
_LOOKED_AT: Final = 400  # bytes, for zeros


def encoding_of(data: bytes) -> tuple[str, bytes]:
    """Return the encoding of a file by its byte order mark or its zeros, else UTF-8; and the mark.

    Of UTF-16 and UTF-32 without a mark the zeros tell, which Latin letters and digits have.
    """
    mark = next((mark for mark in _MARKS if data.startswith(mark)), b"")
    return (_MARKS[mark] if mark else _by_zeros(data)), mark


def _by_zeros(data: bytes) -> str:
    """Return what a file without a mark is: Latin letters and digits have zeros beside them."""
    head = data[: min(_LOOKED_AT, len(data) // 4 * 4)]
    zero = [head[at::4].count(0) > 0.9 * len(head) / 4 for at in range(4)] if head else []
    shapes = {
        "utf-32-le": [False, True, True, True],
        "utf-32-be": [True, True, True, False],
        "utf-16-le": [False, True, False, True],
        "utf-16-be": [True, False, True, False],
    }
    return next((name for name, shape in shapes.items() if zero == shape), "utf-8")
