"""The folder of a study at a desk: what the page may read and write there, and nothing else.

Nothing that a person drove or said is ever lost: a recording that another one replaces is kept in
``earlier/``, and the tables that several windows share are replaced only by who has read them.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from http import HTTPStatus
from pathlib import Path
from typing import Final

from ..errors import ModelError
from ..files.disk import folder_lock, free_name, read_file, replace_file

# A drive of an hour at 100 rows a second and 200 bytes a row is 72 MB.
FILE_MAX: Final = 100_000_000
EARLIER: Final = "earlier"
# What may lie in the folder: text behind a name, such as recordings/P07_A1.csv.
_FOLDERS: Final = {
    "recordings": ".csv",
    "inputs": ".csv",
    "practice": ".csv",
    "profiles": ".pldf",
    "sessions": "",
}
_TABLE: Final = re.compile(r"session\.json|[a-z_]+\.csv")
_NAME: Final = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,99}(?<!\.)")
_DEVICES: Final = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)  # of Windows
_ITERATIONS: Final = re.compile(rb"\nroute [0-9a-f]+\nnodes \d+\nstep_m 1\niterations (\d+)\n")
_DEPTH_MAX: Final = 4
_LOCK_S: Final = 10.0
NOT_THERE: Final = "*"  # what a writer expects who makes a file


class Refused(ModelError):  # noqa: N818 - it says what happened to a request
    """A request that is not done; with the status of HTTP that says so."""

    def __init__(self, status: HTTPStatus, text: str) -> None:
        super().__init__(text)
        self.status = status


@dataclass(frozen=True, slots=True)
class Stored:
    """A file and its mark, which another content does not have."""

    data: bytes
    mark: str


class Folder:
    """The files below ``root``, by relative paths with ``/``.

    Raises:
        Refused: from every method: the path is none of a study at a desk.
        ModelError: somebody else holds the folder.
        OSError: the disk refuses.
    """

    def __init__(self, root: Path, beside: Mapping[str, bytes] | None = None) -> None:
        """Use ``root``, which need not be there yet; it gets the files ``beside`` the data."""
        self.root = root
        self._beside = beside or {}
        self._left: set[str] = set()  # files beside the data that were compared and written

    @property
    def of_another_study(self) -> bool:
        """Whether the folder was begun with another study file, or on another road."""
        return any(self._is_other(name) for name in self._beside)

    def _is_other(self, name: str) -> bool:
        place = self.root / name
        return place.is_file() and place.read_bytes() != self._beside[name]

    def read(self, path: str) -> Stored | None:
        """Return a file; None if there is none."""
        place = self._place(path)
        return _stored(place) if place.is_file() else None

    def write(self, path: str, data: bytes, expected: str | None = None) -> str:
        """Put ``data`` safely on the disk and return its mark.

        Args:
            path: where.
            data: the whole file.
            expected: the mark of what is replaced, or ``NOT_THERE``; needed for shared tables.

        Raises:
            Refused: it is empty, too long, or replaces what its writer has not read.
        """
        place = self._place(path)
        if not data or len(data) > FILE_MAX:
            status = HTTPStatus.REQUEST_ENTITY_TOO_LARGE if data else HTTPStatus.BAD_REQUEST
            raise Refused(status, f"{path}: {len(data)} bytes; from 1 to {FILE_MAX} are stored")
        self.root.mkdir(parents=True, exist_ok=True)
        with folder_lock(self.root, _LOCK_S):
            before = _stored(place) if place.is_file() else None
            _require_expected(path, before, expected, shared=_is_table(path))
            if before is not None and before.data != data:
                self._keep(path, before.data, data)
            place.parent.mkdir(parents=True, exist_ok=True)
            replace_file(place, data)
            self._leave_beside()
        return _mark(data)

    def list(self, prefix: str = "") -> list[str]:
        """Return the paths that begin with ``prefix``, in order."""
        files = (file for file in self.root.rglob("*") if file.is_file())
        paths = (file.relative_to(self.root).as_posix() for file in files)
        return sorted(path for path in paths if path.startswith(prefix) and _is_ours(path))

    def _keep(self, path: str, before: bytes, data: bytes) -> None:
        """Keep what was there, if it holds what the new content does not."""
        if _is_table(path) or path.endswith(".json") or _grown(before, data):
            return  # made anew from all that is there
        self._keep_earlier(path, before)

    def _keep_earlier(self, path: str, before: bytes) -> None:
        kept = self.root / EARLIER / path
        kept.parent.mkdir(parents=True, exist_ok=True)
        replace_file(free_name(kept.with_suffix(""), kept.suffix), before)

    def _leave_beside(self) -> None:
        """Leave study file and road that the data belong to, and those before."""
        for name, data in self._beside.items():
            place = self.root / name
            if name in self._left and place.exists():
                continue  # a road is large, and something is written at every step of a session
            other = self._is_other(name)
            if other:
                self._keep_earlier(name, place.read_bytes())
            if other or not place.exists():
                replace_file(place, data)
            self._left.add(name)

    def _place(self, path: str) -> Path:
        if _is_ours(path):
            place = self.root.joinpath(*path.split("/"))
            if place.resolve().is_relative_to(self.root.resolve()):  # whatever links are there
                return place
        raise Refused(
            HTTPStatus.FORBIDDEN,
            f"{path[:200]!r} is no file of a study: known are session.json, tables such as "
            f"questionnaire.csv, and files in {', '.join(_FOLDERS)}",
        )


def _is_ours(path: str) -> bool:
    if _is_table(path):
        return _DEVICES.fullmatch(path) is None
    folder, *names = path.split("/")
    allowed = names and folder in _FOLDERS and len(names) < _DEPTH_MAX
    if not allowed or (folder != "sessions" and len(names) > 1):
        return False
    good = all(_NAME.fullmatch(name) and not _DEVICES.fullmatch(name) for name in names)
    return good and names[-1].endswith(_FOLDERS[folder] or (".json", ".pldf", ".csv"))


def _is_table(path: str) -> bool:
    return _TABLE.fullmatch(path) is not None


def _stored(place: Path) -> Stored:
    data = read_file(place, FILE_MAX)
    return Stored(data, _mark(data))


def _mark(data: bytes) -> str:
    return f'"{hashlib.sha256(data).hexdigest()[:32]}"'


def _grown(before: bytes, data: bytes) -> bool:
    """Whether the new content holds the old one: more of a table, more iterations of a profile."""
    counts = [_ITERATIONS.search(content) for content in (before, data)]
    if counts[0] and counts[1]:
        return int(counts[1][1]) > int(counts[0][1])
    return data.startswith(before)


def _require_expected(
    path: str, before: Stored | None, expected: str | None, *, shared: bool
) -> None:
    if expected is None:
        if shared:
            raise Refused(
                HTTPStatus.PRECONDITION_REQUIRED,
                f"{path} is shared: say with If-Match what is replaced, or If-None-Match: *",
            )
        return
    if expected != (NOT_THERE if before is None else before.mark):
        raise Refused(
            HTTPStatus.PRECONDITION_FAILED,
            f"{path} was changed by somebody else; read it again and repeat",
        )
