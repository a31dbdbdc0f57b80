"""Spoilt study files and roads: what is read is what an independent parser reads."""

from __future__ import annotations

import codecs
import random
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from .byte_changes import DAMAGES
from .experiment import Counts, Experiment, Progress
from .judged_kinds import Answer
from .judged_text_kinds import KINDS, Kind
from .sheets import NUMBER, Unclear
from .verdicts import Verdict, Word, asked, counted, same

_NUMBER: Final = re.compile(rf"(?<![\w.]){NUMBER.pattern}(?![\w.])", re.ASCII)
_ENCODINGS: Final = {
    "utf_8": ("utf-8", b""),
    "utf_8_mark": ("utf-8", codecs.BOM_UTF8),
    "utf_16_le": ("utf-16-le", codecs.BOM_UTF16_LE),
    "utf_16_be": ("utf-16-be", codecs.BOM_UTF16_BE),
    "utf_32": ("utf-32-le", codecs.BOM_UTF32_LE),
    "latin_1": ("latin-1", b""),
    "gb2312": ("gb2312", b""),
    "shift_jis": ("shift_jis", b""),
    "utf_7": ("utf-7", b""),
}
_BY_BYTES: Final = ("utf-8", "latin-1", "gb2312", "shift_jis")


def _other_number(text: str, chance: random.Random) -> str:
    """Write one number otherwise."""
    found = chance.choice(list(_NUMBER.finditer(text)))
    old = found.group()
    new = chance.choice(
        (f"-{old}", f"{old}.0", f"{old}e0", old.replace(".", ","), f'"{old}"', f"{old} km/h",
         f"\u2212{old}", "".join(chr(0x660 + int(c)) if c.isdigit() else c for c in old), "nan",
         "inf", "1e300", "", "true", f"1_{old}", f"{old}_0", f"0{old}", f"+{old}", "9" * 40,
         str(float(old) * 3.6), old[::-1], f"\u00a0{old}", "NA", "-99")
    )  # fmt: skip
    return text[: found.start()] + new + text[found.end() :]


def _other_line(text: str, chance: random.Random) -> str:
    """Drop, repeat or move a line, or rename what it begins with."""
    lines = text.splitlines()
    at = chance.randrange(len(lines))
    line = lines.pop(at)
    kind = chance.randrange(4)
    if kind == 0:
        lines.insert(chance.randrange(len(lines)), line)
    elif kind == 1:
        lines[at:at] = [line, line]
    elif kind == 2 and line:
        cut = chance.randrange(len(line))
        lines.insert(at, line[:cut] + line[cut + 1 :])
    return "\n".join(lines) + "\n"


def spoilt(kind: Kind, chance: random.Random) -> tuple[str, bytes, str, bytes]:
    """Return what was done, the file, its encoding and its byte order mark."""
    text, done = kind.text, []
    if kind.values and chance.random() < 0.7:
        change = chance.choice((_other_number, _other_line))
        text, done = change(text, chance), [change.__name__.strip("_")]
    if chance.random() < 0.3:
        end = chance.choice(("\r\n", "\r", "\n\n"))
        text, done = text.replace("\n", end), [*done, f"ends {end!r}"]
    # TOML is UTF-8 by its standard, so ASCII means what it says, UTF-7 or not.
    names = [name for name in _ENCODINGS if name != "utf_7" or not kind.values]
    name = chance.choice(names) if chance.random() < 0.4 else "utf_8"
    encoding, mark = _ENCODINGS[name]
    if chance.random() < 0.5:  # what the file says of itself follows
        text = text.replace('encoding="UTF-8"', f'encoding="{encoding.removesuffix("-le")}"')
    data = mark + text.encode(encoding, errors="replace")
    done.append(name)
    if chance.random() < 0.4 or done == ["utf_8"]:
        done.append(chance.choice(list(DAMAGES)))
        data = DAMAGES[done[-1]](data, chance)
    return " ".join(done), data, encoding, mark


def verdict(kind: Kind, path: Path, encoding: str, mark: bytes) -> tuple[Word, str]:
    """Return right, told, refused or violation, and what speaks for it."""
    meant, why = None, "encoding"
    try:
        data = path.read_bytes()
        data = b"" if mark.startswith(data) else data.removeprefix(mark)
        # Whatever stands before a road's XML is passed over.
        if not kind.values and encoding in _BY_BYTES:  # what counts of it is ASCII all the same
            encoding = "latin-1"
        text = data[max(data.find(b"<OpenDRIVE"), 0) :].decode(encoding)
        if "\0" in text:
            raise Unclear("characters")
        meant = kind.judge(text.replace("\r\n", "\n").replace("\r", "\n"))
    except (UnicodeError, Unclear) as unclear:
        why = str(unclear)
    answer = asked(kind.read, path)
    if not isinstance(answer, Answer):
        return answer
    if answer.told:
        return "told", answer.told
    if meant is None:
        return "violation", f"taken without a word, though unclear: {why}"
    for name, wanted in meant.items():
        if not same(answer.values.get(name), wanted):
            return "violation", f"{name} is {answer.values.get(name)}, not {wanted}"
    return "right", ""


def trials(kind: Kind, count: int, seed: int) -> Iterator[Verdict]:
    """Spoil a file of this kind so often; yield what came of it."""
    chance = random.Random(f"{kind.name} {seed}")
    with tempfile.TemporaryDirectory(prefix="faults_") as folder:
        path = Path(folder, kind.name)
        for _ in range(count):
            done, data, encoding, mark = spoilt(kind, chance)
            path.write_bytes(data)
            yield Verdict(done, *verdict(kind, path, encoding, mark))


def texts(count: int, seed: int, progress: Progress) -> Counts:
    """Spoil so many study files and roads; count the verdicts."""
    return counted(KINDS, trials, count, seed, progress)


EXPERIMENTS: Final = (
    Experiment(
        "judged_texts",
        "A study file or a road that was spoilt means what an independent parser reads, or it is "
        "told, or refused.",
        texts,
        count=6000,
        short=200 * len(KINDS),
    ),
)
