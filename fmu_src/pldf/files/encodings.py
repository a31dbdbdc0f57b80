"""From bytes to text: which encoding a file that people brought is in, and how sure that is.

UTF-8 and what says of itself what it is (a byte order mark, zeros at every second place) are
certain. The rest is told by what the bytes would mean: letters between letters are Windows-1252
(Latin-1), runs of common characters are GB 18030 or Shift JIS. No guess is silent: what was taken
is in ``Text.encoding``, what else it could be in ``Text.others``. Where no reading makes sense
there is none.
"""

from __future__ import annotations

import codecs
import re
from collections.abc import Callable, Iterator
from typing import Final, NamedTuple

# The longer ones first: that of UTF-16 begins that of UTF-32.
_MARKS: Final = (
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
    (b"\x84\x31\x95\x33", "gb18030"),
)
# Which of four bytes are zero where letters are Latin.
_ZEROS: Final = {
    "utf-32-le": [False, True, True, True],
    "utf-32-be": [True, True, True, False],
    "utf-16-le": [False, True, False, True],
    "utf-16-be": [True, False, True, False],
}
_LOOKED_AT: Final = 400  # bytes, for zeros
_NAMES: Final = {
    "utf-8": "UTF-8",
    "utf-7": "UTF-7",
    "utf-16-le": "UTF-16",
    "utf-16-be": "UTF-16",
    "utf-32-le": "UTF-32",
    "utf-32-be": "UTF-32",
    "cp1252": "Windows-1252 (Latin-1)",
    "gb18030": "GB 18030 (GB 2312)",
    "cp932": "Shift JIS",
}
# A shifted sequence; one of digits alone is an exponent.
_UTF7_MARK: Final = re.compile(rb"\+/v[89+/]")
_UTF7: Final = re.compile(rb"\+(?![0-9]+\b)[A-Za-z0-9/]{3,}")
_EUROPEAN_MAX: Final = "\u024f"
_LETTERS: Final = frozenset("äöüßéèêëàâáåãæøœçñíìîïóòôõúùûÿšžÄÖÜÉÈÊËÀÂÁÅÃÆØŒÇÑÍÌÎÏÓÒÔÕÚÙÛŠŽ")
# Degree, powers, micro, currencies, dashes, quotation marks and the like.
_SIGNS: Final = frozenset("°²³µ·§€£¿¡ºª©®±½¼¾«»…\xa0\xd7\u2013\u2014\u2018\u2019\u201c\u201d\u201e")
_RUN: Final = re.compile(r"[^\x00-\x7f]+")
_WORD: Final = re.compile(r"[^\s,;\"]*[^\x00-\x7f][^\s,;\"]*")
_WORD_MAX: Final = 2  # letters with accents in a row, as in "Größe"
_SENSE_MIN: Final = 0.75  # share of the characters that must make sense
_SHOWN_MAX: Final = 40  # characters of a word that is shown


class Text(NamedTuple):
    """The content of a file.

    Attributes:
        text: without byte order mark.
        encoding: as people call it; empty for UTF-8.
        sample: a word that depends on the encoding, as it was read; empty if that is certain.
        others: other encodings that the bytes could be in, and what ``sample`` would be in them.
        line: of ``sample``, from 1.
    """

    text: str
    encoding: str = ""
    sample: str = ""
    others: tuple[tuple[str, str], ...] = ()
    line: int = 0


class NotTextError(ValueError):
    """The bytes are no text in a known encoding.

    Attributes:
        line: the first that is none, from 1; 0 for the file as a whole.
    """

    def __init__(self, text: str, line: int = 0) -> None:
        super().__init__(text)
        self.line = line


def text_of(data: bytes) -> Text:
    """Return the text that ``data``, the content of a file, is.

    Raises:
        NotTextError: in no encoding it is; what is the matter, and the way out.
    """
    encoding, mark = encoding_of(data)
    if encoding != "utf-8":
        return _certain(data.removeprefix(mark), encoding)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        return _guessed(data, line)
    _refuse_zeros(text)
    if _UTF7.search(data) and text.isascii():
        return _perhaps_utf7(data, text)
    return Text(text)


def encoding_of(data: bytes) -> tuple[str, bytes]:
    """Return the encoding of a file by its byte order mark or its zeros, else UTF-8; and the mark.

    Of UTF-16 and UTF-32 without a mark the zeros tell, which Latin letters and digits have.
    """
    for mark, encoding in _MARKS:
        if data.startswith(mark):
            return encoding, mark
    if _UTF7_MARK.match(data):
        return "utf-7", b""
    head = data[: min(_LOOKED_AT, len(data) // 4 * 4)]
    zero = [head[at::4].count(0) > 0.9 * len(head) / 4 for at in range(4)] if head else []
    return next((name for name, shape in _ZEROS.items() if zero == shape), "utf-8"), b""


def _certain(data: bytes, encoding: str) -> Text:
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError as error:
        line = data[: error.start].decode(encoding, "ignore").count("\n") + 1
        told = f"not {_NAMES[encoding]} text, as it began; is the file whole? Save it as UTF-8"
        raise NotTextError(told, line) from None
    _refuse_zeros(text)
    return Text(text.removeprefix("\ufeff"), _NAMES[encoding])


def _refuse_zeros(text: str) -> None:
    if (at := text.find("\0")) >= 0:
        told = "a zero byte, which is no text: the file is damaged, or no table; export it again"
        raise NotTextError(told, text.count("\n", 0, at) + 1)


def _perhaps_utf7(data: bytes, text: str) -> Text:
    """Return ASCII that may be UTF-7: ``M+APw-ller`` is, ``speed+acc`` could be.

    It is taken for UTF-7 if that gives European letters.
    """
    try:
        decoded = data.decode("utf-7")
    except UnicodeDecodeError:
        return Text(text)
    words = zip(text.split(), decoded.split(), strict=False)
    pair = next((pair for pair in words if pair[0] != pair[1]), ("", ""))
    if decoded.isascii() or not all(pair):
        return Text(text)
    line = text.count("\n", 0, text.find(pair[0])) + 1
    written, word = (one[:_SHOWN_MAX] for one in pair)
    if max(decoded) <= _EUROPEAN_MAX:
        return Text(decoded, "UTF-7", word, (("ASCII", written),), line)
    return Text(text, "ASCII", written, (("UTF-7", word),), line)


def _guessed(data: bytes, line: int) -> Text:
    """Return text in the encoding in which it makes most sense."""
    _refuse_zeros(data.decode("latin-1"))
    made = dict(_readings(data))
    senses = {name: _SENSES[name](text) for name, text in made.items()}
    best = max(senses, key=lambda name: senses[name], default="")
    if not best or senses[best] < _SENSE_MIN:
        raise NotTextError("not UTF-8 text; save the file as UTF-8", line)
    others = [
        (_NAMES[name], _first_word(text))
        for name, text in made.items()
        if name != best and senses[name] >= _SENSE_MIN
    ]
    return Text(made[best], _NAMES[best], _first_word(made[best]), tuple(others), line)


def _readings(data: bytes) -> Iterator[tuple[str, str]]:
    for encoding in _SENSES:
        try:
            yield encoding, data.decode(encoding)
        except UnicodeDecodeError:
            continue


def _first_word(text: str) -> str:
    found = _WORD.search(text)
    return found.group()[:_SHOWN_MAX] if found else ""


def _latin_sense(text: str) -> float:
    """Return the share of letters of western Europe that stand as in words, and of signs."""
    good = total = 0
    for found in _RUN.finditer(text):
        run = found.group()
        total += len(run)
        before, after = _neighbours(text, found)
        alone = not (before.isalpha() or after.isalpha())
        in_word = len(run) == 1 or (len(run) <= _WORD_MAX and not alone)
        if _SIGNS.issuperset(run) or (in_word and _LETTERS.issuperset(run)):
            good += len(run)
    return good / max(1, total)


def _chinese_sense(text: str) -> float:
    """Return the share of common characters: level 1 of GB 2312 and full-width signs."""
    return _asian_sense(text, "gb2312", 0xB0, 0xD7, _wide)


def _japanese_sense(text: str) -> float:
    """Return the share of common characters: level 1 of JIS X 0208, kana, full-width signs."""
    return _asian_sense(text, "cp932", 0x88, 0x98, lambda c: _wide(c) or "\u3040" <= c <= "\u30ff")


def _wide(character: str) -> bool:
    return "\u3000" <= character <= "\u303f" or "\uff01" <= character <= "\uff5e"


def _asian_sense(
    text: str, encoding: str, low: int, high: int, is_sign: Callable[[str], bool]
) -> float:
    """Return the share of signs, and of characters whose first byte is from ``low`` to ``high``.

    Those between letters of the Latin alphabet do not count: there stands an accented letter.
    """
    good = total = 0
    for found in _RUN.finditer(text):
        run = found.group()
        total += len(run)
        before, after = _neighbours(text, found)
        if before.islower() or after.islower() or (before.isalpha() and after.isalpha()):
            continue
        good += sum(is_sign(c) or low <= c.encode(encoding, "replace")[0] <= high for c in run)
    return good / max(1, total)


def _neighbours(text: str, found: re.Match[str]) -> tuple[str, str]:
    return text[max(0, found.start() - 1) : found.start()], text[found.end() : found.end() + 1]


_SENSES: Final = {"cp1252": _latin_sense, "gb18030": _chinese_sense, "cp932": _japanese_sense}
