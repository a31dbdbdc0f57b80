"""Studies that an exported cockpit handed out as zip files, unpacked and put together."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Final
from zipfile import BadZipFile, ZipFile

from ..errors import ModelError
from ..files.disk import make_folder, replace_file

SUFFIX: Final = ".zip"
# Lies in a folder that was unpacked, and says from what: such a folder may be unpacked anew.
MARK: Final = "unpacked.txt"
SESSIONS: Final = "session.json"
# What has rows of several people.
_TABLES: Final = ("answers.csv", "exclusions.csv", "questionnaire.csv")
_TOGETHER: Final = "unpacked"  # the folder of several
_NAME: Final = re.compile(r"[A-Za-z0-9][A-Za-z0-9_./-]*")
_ROW: Final = re.compile(rb'(?:[^"\n]|"[^"]*")+\n?')  # of CSV: a line, with those in quotes
_WHOLE_MAX: Final = 4_000_000_000  # bytes, unpacked


def unpacked_study(paths: Sequence[Path]) -> Path:
    """Unpack the files into one folder beside the first, and return the folder.

    Of one file it has its name without the ending; several are put together in ``unpacked``. The
    folder is made anew if it was unpacked from these files before, or from some of them; what else
    lies in it stays.

    Raises:
        ModelError: a file is none that a cockpit handed out, two of them contradict each other, or
            the folder is somebody else's.
    """
    first = paths[0]
    folder = first.with_suffix("") if len(paths) == 1 else first.with_name(_TOGETHER)
    _require_own(folder, paths)
    whole: dict[str, bytes] = {}
    for path in paths:
        _add(whole, _content(path), path)
    if not whole:
        raise ModelError(f"{first}: is empty; drive first, then save the data once more")
    whole[MARK] = "".join(f"{path.name}\n" for path in paths).encode()
    for name, data in whole.items():
        place = folder / name
        make_folder(place.parent)
        replace_file(place, data)
    return folder


def _require_own(folder: Path, paths: Sequence[Path]) -> None:
    """Raise ModelError if the folder has anything of others: they would be analysed as well."""
    if not folder.exists():
        return
    mark = folder / MARK
    if not mark.exists():
        raise ModelError(
            f"{folder}: is there already and was not unpacked from {paths[0].name}; rename one of "
            "them"
        )
    names = {path.name for path in paths}
    others = [name for name in mark.read_text(encoding="utf-8").splitlines() if name not in names]
    if others:
        raise ModelError(
            f"{folder}: was unpacked from {', '.join(others)} before, whose people would count as "
            "well; name these files, too, or rename the folder"
        )


def _content(path: Path) -> dict[str, bytes]:
    """Return the files in a zip file by name."""
    try:
        with ZipFile(path) as archive:
            members = [member for member in archive.infolist() if not member.is_dir()]
            if sum(member.file_size for member in members) > _WHOLE_MAX:
                raise ModelError(f"{path}: more than {_WHOLE_MAX} bytes unpacked; no study is")
            for member in members:
                _require_usable(path, member.filename)
            return {member.filename: archive.read(member) for member in members}
    except (BadZipFile, NotImplementedError, RuntimeError, EOFError) as problem:
        raise ModelError(
            f"{path}: cannot be unpacked ({problem}); save the data from the page once more"
        ) from None


def _require_usable(path: Path, name: str) -> None:
    parts = name.split("/")
    if not _NAME.fullmatch(name) or any(part.strip(".") == "" for part in parts):
        raise ModelError(f"{path}: {name!r} is no file of a study; it is not unpacked")


def _add(whole: dict[str, bytes], more: Mapping[str, bytes], path: Path) -> None:
    """Add the files of ``path`` to those before it."""
    for name, data in more.items():
        before = whole.get(name, data)
        if before == data:
            whole[name] = data
        elif join := _join_of(name):
            try:
                whole[name] = join(before, data)
            except (ValueError, KeyError, TypeError) as problem:
                raise ModelError(f"{path}: {name}: {problem}") from None
        elif "/" not in name:
            raise ModelError(
                f"{path}: {name} is another one than in the files before, of another study or "
                "of another road; analyse them apart"
            )
        else:
            raise ModelError(
                f"{path}: {name} is another one than in the files before; two people had one "
                "number, or one drove twice: analyse them apart, or rename the files of one"
            )


def _join_of(name: str) -> Callable[[bytes, bytes], bytes] | None:
    if name == SESSIONS:
        return _joined_sessions
    return _joined_tables if name in _TABLES else None


def _joined_tables(first: bytes, second: bytes) -> bytes:
    """Return the rows of two tables that have the same columns, those that are the same once.

    A machine hands out all that it has: what it handed out the day before, too.
    """
    header, *before = _ROW.findall(first)
    other, *rows = _ROW.findall(second)
    if header.strip() != other.strip():
        raise ValueError("has other columns than in the files before; analyse them apart")
    known = {row.strip() for row in before}
    return first.rstrip(b"\n") + b"\n" + b"".join(row for row in rows if row.strip() not in known)


def _joined_sessions(first: bytes, second: bytes) -> bytes:
    whole, more = json.loads(first), json.loads(second)
    whole["sessions"] += [one for one in more["sessions"] if one not in whole["sessions"]]
    return json.dumps(whole).encode()
