"""Which files in a folder are a study's own: only these are ever taken away."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Final

from .participants_file import participants_csv

DRIVES: Final = "drives.csv"
PARTICIPANTS: Final = "participants.csv"
STUDY: Final = "study.toml"
VERSIONS: Final = "versions.json"
# Of a study with variants, beside their folders: how they compare.
LONG_RUN_CSV: Final = "long_run.csv"
COMPARED: Final = (LONG_RUN_CSV, "long_run.png")
PARTS: Final = "parts"
DAMAGED: Final = "damaged"
TABLES: Final = (DRIVES, PARTICIPANTS, STUDY, VERSIONS)
RECORDINGS: Final = "recordings"
PROFILES: Final = "profiles"
FOLDERS: Final = (PARTS, DAMAGED, RECORDINGS, PROFILES)

# The one driver's study of release 0.1.0, which had a folder of another kind.
_OLD_STUDY: Final = "study.json"
_OLD_KEYS: Final = ("phases", "route_fingerprint", "fmus")

_PROFILE: Final = r"driver-\d{6,}_route-[0-9a-zA-Z]+\.pldf"
_INSIDE: Final = {
    PARTS: r"P\d+\.json",
    DAMAGED: r"P\d+-\d+\.json",
    RECORDINGS: r"P\d+_[AB]\d+\.csv",
    PROFILES: _PROFILE,
}
_OLD_INSIDE: Final = {
    RECORDINGS: r"[AB]\d\.csv",
    PROFILES: _PROFILE,
    "profile_after": r"[AB]\d\.csv",
}
_UNFINISHED: Final = r"(\.tmp)?"  # of ``replace_file``, when the process was killed


def is_study(out: Path) -> bool:
    """Whether what is in ``out`` says that a study of participants was begun there."""
    return _has_keys(out / VERSIONS, ("adaptive-pldf",))


def is_old_study(out: Path) -> bool:
    """Whether ``out`` is that of the one driver of release 0.1.0."""
    return _has_keys(out / _OLD_STUDY, _OLD_KEYS)


def is_hardly_begun(out: Path) -> bool:
    """Whether release 0.2.0 was stopped in ``out`` before it said whose the folder is."""
    there = {name for name in (*TABLES, *FOLDERS) if (out / name).exists()}
    if not {PARTS} <= there <= {PARTS, PARTICIPANTS}:
        return False
    parts = set(out.glob(f"{PARTS}/*")) == set(_inside(out, _INSIDE))
    header, path = participants_csv(()), out / PARTICIPANTS
    return parts and (not path.exists() or path.read_bytes().startswith(header))


def clear(out: Path) -> bool:
    """Take away the study in ``out``, if there is one, and nothing that somebody else put there.

    What says whose the folder is comes last: a second call finishes what a first one began.
    """
    old, new = is_old_study(out), is_study(out)
    if old:
        _remove(out, [*_inside(out, _OLD_INSIDE), out / "rates.csv", out / _OLD_STUDY])
    if new:
        _remove(out, [*_inside(out, _INSIDE), *(out / name for name in TABLES)])
    return old or new


def clear_parts(out: Path) -> None:
    """Take away the parts of a study whose drives are in one table."""
    _remove(out, list(_inside(out, {PARTS: _INSIDE[PARTS]})))
    with suppress(OSError):
        (out / PARTS).rmdir()


def _inside(out: Path, patterns: dict[str, str]) -> Iterator[Path]:
    for folder, pattern in patterns.items():
        for path in out.glob(f"{folder}/*"):
            if re.fullmatch(pattern + _UNFINISHED, path.name):
                yield path


def _remove(out: Path, files: list[Path]) -> None:
    for path in files:
        path.unlink(missing_ok=True)
        if path.parent != out:
            with suppress(OSError):  # something else is in it
                path.parent.rmdir()


def _has_keys(path: Path, keys: tuple[str, ...]) -> bool:
    try:
        content = json.loads(path.read_bytes())
    except (FileNotFoundError, NotADirectoryError, IsADirectoryError, ValueError, RecursionError):
        return False
    return isinstance(content, dict) and all(key in content for key in keys)
