"""The text of an XML file, block by block: its encoding, and what stands before the XML.

The parser itself knows four encodings, and refuses those with several bytes per letter. Python
knows a hundred: it decodes, and the parser gets text.
"""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import AnyStr, Final, NamedTuple

from ...errors import ModelError
from ...files.encodings import encoding_of
from ...findings import Finding

_WIDE: Final = re.compile(r"(?i)utf[-_]?(16|32)")
_UTF_8: Final = re.compile(r"(?i)utf[-_]?8")
# Programs declare the older set and write letters of the one that contains it.
_LARGER: Final = {"gb2312": "gb18030", "gbk": "gb18030", "shift_jis": "cp932"}
_DECLARED: Final = re.compile(rb"""<\?xml [^>]*?encoding\s*=\s*["']([\w.:-]+)""", re.ASCII)


class XmlText(NamedTuple):
    """What the parser gets."""

    blocks: Iterator[str]  # from the XML declaration or the root on
    skipped_lines: int  # before that


class _Written(NamedTuple):
    """How the bytes are to be read."""

    encoding: str
    named: str  # what the file says of it
    line: int  # from which on


def xml_text(blocks: Iterator[bytes], root: str, path: Path, notes: list[Finding]) -> XmlText:
    """Return the text from the XML declaration on, and how many lines were before it.

    It is in the encoding that the bytes show, else in the one that they declare.

    Args:
        blocks: the content of the file; the first of them holds all that is before the XML.
        root: name of the element that holds all others.
        path: of the file.
        notes: a declaration that is not true is added to them.

    Raises:
        ModelError: with file and line; while the blocks are read, too.
    """
    head = next(blocks, b"")
    encoding, mark = encoding_of(head)
    head = head.removeprefix(mark)
    written, skipped = _Written(encoding, encoding, 1), 0
    if encoding == "utf-8":
        start = _start(head, b"<?xml ", f"<{root}".encode())
        skipped, head = head.count(b"\n", 0, start), head[start:]
        written = _declared(head, skipped + 1, bool(mark))
        if written.encoding != written.named:
            # Nobody could have read the declaration if it were true.
            told = f"declares {written.named} and is in UTF-8, as which it was read"
            notes.append(Finding("note", str(path), written.line, "", told))
    texts = _decoded(chain([head], blocks), written, path, notes)
    first = next(texts, "")
    start = _start(first, "<?xml ", f"<{root}")
    return XmlText(chain([first[start:]], texts), skipped + first.count("\n", 0, start))


def _declared(head: bytes, line: int, marked: bool) -> _Written:
    declared = _DECLARED.match(head)
    named = declared[1].decode() if declared else "utf-8"
    untrue = _WIDE.match(named) or (marked and not _UTF_8.match(named))
    return _Written("utf-8" if untrue else named, named, line)


def _start(data: AnyStr, declaration: AnyStr, root: AnyStr) -> int:
    start = data.find(declaration)
    return start if start >= 0 else max(data.find(root), 0)


def _decoded(
    blocks: Iterator[bytes], written: _Written, path: Path, notes: list[Finding]
) -> Iterator[str]:
    """Yield the text; in the larger set of letters from those on that the declared one lacks."""
    decoder = _decoder(written, path)
    line = written.line
    for block in chain(blocks, [b""]):
        waiting, _ = decoder.getstate()
        try:
            text = decoder.decode(block, not block)
        except UnicodeDecodeError as error:
            larger = _LARGER.get(written.encoding.lower())
            if larger is None:
                at = line + error.object.count(b"\n", 0, error.start)
                raise _not_in(written, path, at) from None
            told = (
                f"declares {written.encoding} and has letters that only {larger.upper()} has,"
                " as which it was read"
            )
            notes.append(Finding("note", str(path), written.line, "", told))
            rest = chain([waiting + block], blocks)
            yield from _decoded(rest, written._replace(encoding=larger, line=line), path, notes)
            return
        yield text
        line += text.count("\n")


def _decoder(written: _Written, path: Path) -> codecs.IncrementalDecoder:
    try:
        "<".encode(written.encoding)  # refuses codecs that are no text
        return codecs.getincrementaldecoder(written.encoding)()
    except LookupError:
        told = f"unknown encoding {written.encoding!r}; save the file as UTF-8, and declare that"
        raise ModelError(f"{path}, line {written.line}: {told}") from None
    except UnicodeError:
        raise _not_in(written, path, written.line) from None


def _not_in(written: _Written, path: Path, line: int) -> ModelError:
    told = f"not {written.named.upper()}, which the file seems to be; save it as UTF-8"
    return ModelError(f"{path}, line {line}: {told}")
