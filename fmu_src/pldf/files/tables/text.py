"""From bytes to text, whatever program wrote them.

A byte order mark says what a file is, and so do the zeros of a UTF-16 file without one. What is
neither that nor UTF-8 is a guess, and is told: Windows-1252 (Western Europe), or GB2312 or
Shift_JIS where all letters beyond ASCII come in pairs that these know.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

from ...findings import Finding
from ..encodings import encoding_of
from .declared import Fault, TableError

_WESTERN: Final = "Windows-1252"
_GUESSES: Final = {"GB2312": "gb2312", "Shift_JIS": "shift_jis", _WESTERN: "cp1252"}
_BEYOND: Final = re.compile(rb"[\x80-\xff]+")
_SHIFT_JIS_LEAD: Final = re.compile(rb"[\x81-\x9f\xe0-\xef][\x40-\x7e\x80-\xfc]")
_UTF_7: Final = re.compile(rb"\+(?!\d)[A-Za-z0-9+/]{3,}-?")
_WORD: Final = re.compile(r"\S*[^\x00-\x7f]\S*")
_SHOWN_MAX: Final = 40
_SAVE: Final = "save the file as UTF-8 (in Excel: CSV UTF-8)"


def decoded(data: bytes, path: Path) -> tuple[str, list[Finding]]:
    """Return the text in ``data``, the content of ``path``, and what was guessed.

    Raises:
        TableError: it is no text, with the line.
    """
    encoding, mark = encoding_of(data)
    body = data.removeprefix(mark)
    try:
        text = body.decode(encoding)
    except UnicodeDecodeError as error:
        if encoding != "utf-8":
            line = body[: error.start].decode(encoding, "replace").count("\n") + 1
            told = f"not {encoding.upper()}, as it began ({error.reason}); is the file whole?"
            raise TableError(path, [Fault(line, "", f"{told} {_SAVE}")]) from None
        return _guessed(body, error.start, path)
    _refuse_zeros(text, path)
    return text, [_maybe_utf_7(body, found, path)] if (found := _UTF_7.search(body)) else []


def _refuse_zeros(text: str, path: Path) -> None:
    if (at := text.find("\0")) >= 0:
        line = text.count("\n", 0, at) + 1
        told = "a zero byte, which is no text: the file is damaged, or no table; export it again"
        raise TableError(path, [Fault(line, "", told)])


def _guessed(data: bytes, start: int, path: Path) -> tuple[str, list[Finding]]:
    """Return text that is not UTF-8 from byte ``start`` on, and the note that says so."""
    pairs = all(len(found.group()) % 2 == 0 for found in _BEYOND.finditer(data))
    likely = ["GB2312"] if pairs else []
    likely += ["Shift_JIS"] if _SHIFT_JIS_LEAD.search(data) else []
    for name in (*likely, _WESTERN):
        try:
            text = data.decode(_GUESSES[name])
        except UnicodeDecodeError:
            continue
        _refuse_zeros(text, path)
        line = data.count(b"\n", 0, start) + 1
        word = _WORD.search(text)
        shown = f": {word.group()[:_SHOWN_MAX]!r} stands there" if word else ""
        note = Finding(
            "warning", str(path), line, "", f"not UTF-8; read as {name}{shown}",
            "names with such letters may be others, numbers are not", _SAVE,
        )  # fmt: skip
        return text, [note]
    line = data.count(b"\n", 0, start) + 1
    raise TableError(path, [Fault(line, "", f"not UTF-8 text, nor any that is known; {_SAVE}")])


def _maybe_utf_7(data: bytes, found: re.Match[bytes], path: Path) -> Finding:
    return Finding(
        "note", str(path), data.count(b"\n", 0, found.start()) + 1, "",
        f"{found.group()[:_SHOWN_MAX].decode()!r} may be a letter in UTF-7; read as it stands",
        "names with such letters may be others, numbers are not", _SAVE,
    )  # fmt: skip
