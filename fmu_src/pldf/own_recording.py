"""The driving function's own recording: one row per metre, written when the drive ends.

For simulators that log nothing others can read. What is written was kept by the kernel while
driving (``kernel.log``, ``kernel.recorder``); no step opens a file, and nothing grows. The native
function writes the same bytes (``runtime/recording.c``); what both need stands here once.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

from .errors import ModelError
from .files.disk import folder_lock, make_folder, reason, replace_file
from .files.folders import require_writable
from .kernel.arrays import ProfileArrays, RouteArrays, TraceArrays
from .kernel.codes import MODE, REASON
from .kernel.signals import signals_of
from .kernel.state import PldfState

FOLDER_VARIABLE: Final = "PLDF_RECORDING_FOLDER"
LOCK_TIMEOUT_S: Final = 10.0
# A metre that took longer stands for a car that stood or crept, unless samples are missing. Rows in
# between keep readers from taking it for a hole; an hour's worth of them at most.
ROW_S: Final = 1.0
ROWS_BETWEEN_MAX: Final = 3600

# printf formats and texts, the same in the native FMUs.
HEAD: Final = (
    "recording by metre, by the driving function itself; where a metre took more than a second, "
    "rows between are interpolated"
)
WRITTEN: Final = "recording of this drive, %d m: %s"
NOT_WRITTEN: Final = (
    "recording of this drive not written: %s: %s; make room there, or choose another folder"
)
NOT_WRITABLE: Final = (
    "the recording of this drive cannot be written: %s: %s; choose another recording_folder"
)


class Column(NamedTuple):
    """A column of the file: a per-metre array, or the metre itself if there is no group.

    Attributes:
        name: of the column.
        group: named tuple that has the array.
        field: the array's name there.
        words: what its codes stand for; empty: numbers.
    """

    name: str
    group: Any = None
    field: str = ""
    words: tuple[str, ...] = ()


COLUMNS: Final = (
    Column("time_s", TraceArrays, "time_s"),
    Column("s_m"),
    Column("speed_mps", TraceArrays, "speed_mps"),
    Column("mode", TraceArrays, "mode", MODE.items),
    Column("gas_pedal", TraceArrays, "gas_pedal"),
    Column("brake_pedal", TraceArrays, "brake_pedal"),
    Column("set_speed_mps", TraceArrays, "shown_mps"),
    Column("set_speed_offset_mps", TraceArrays, "offset_mps"),
    Column("profile_mps", TraceArrays, "profile_mps"),
    Column("base_mps", ProfileArrays, "base_mps"),
    Column("limit_mps", RouteArrays, "limit_mps"),
    Column("eligible", TraceArrays, "eligible"),
    Column("hmi_reason", TraceArrays, "reason", REASON.items),
)
# What stands in the head besides the route: fields of the record, by public name.
HEAD_FIELDS: Final = (
    "driver_id", "apply_learned", "rate_pedal", "rate_set_speed", "rate_combined",
    "drive_interventions",
)  # fmt: skip


class Drive(NamedTuple):
    """A drive that is over, as the kernel left it."""

    st: PldfState
    route: RouteArrays
    profile: ProfileArrays
    trace: TraceArrays
    route_key: str


def folder_of(given: str) -> Path | None:
    """Return the folder that a parameter or the environment names; None: nothing is written."""
    name = given or os.environ.get(FOLDER_VARIABLE, "")
    return Path(name).absolute() if name else None


def why_not_writable(folder: Path) -> str:
    """Return, before a drive, why its recording could not be written; empty: it can."""
    try:
        require_writable(folder)
    except (OSError, ModelError) as error:
        return NOT_WRITABLE % (folder, reason(error))
    return ""


def save_drive(folder: Path, drive: Drive) -> Path:
    """Write the recording of ``drive`` into ``folder`` under a name that is free; return its path.

    Raises:
        ModelError: that is not possible, in one of the words above.
    """
    path = folder
    try:
        make_folder(folder)
        with folder_lock(folder, LOCK_TIMEOUT_S):
            path = _free_path(folder, drive.st)
            replace_file(path, content(drive))
    except (OSError, ModelError) as error:
        raise ModelError(NOT_WRITTEN % (path, reason(error))) from error
    return path


def _free_path(folder: Path, st: PldfState) -> Path:
    """Return a name as studies have it: person, system (A base, B learned), number of the drive."""
    stem = f"P{st.driver_id:03d}_{'B' if st.apply_learned else 'A'}"
    number = 1
    while os.path.lexists(folder / f"{stem}{number}.csv"):
        number += 1
    return folder / f"{stem}{number}.csv"


def content(drive: Drive) -> bytes:
    """Return the bytes of the file."""
    lines = [f"# {HEAD}", f"# route {drive.route_key}", *_head(drive.st)]
    lines.append(",".join(column.name for column in COLUMNS))
    lines += _rows(drive)
    return ("\n".join(lines) + "\n").encode()


def _head(st: PldfState) -> Iterator[str]:
    names = {signal.field: signal.name for signal in signals_of(st)}
    for field in HEAD_FIELDS:
        yield f"# {names[field]} {_number(getattr(st, field))}"


def _rows(drive: Drive) -> Iterator[str]:
    trace = drive.trace
    first, behind = drive.st.first_node, drive.st.first_node + drive.st.nodes
    for node in range(first, behind):
        yield _row(drive, node, trace.time_s[node], float(node), trace.speed_mps[node])
        if node + 1 < behind and trace.gap[node + 1] == 0.0:
            yield from _between(drive, node)


def _between(drive: Drive, node: int) -> Iterator[str]:
    """Yield rows between a node and the next if the car stood or crept there, at its mean speed."""
    start_s = drive.trace.time_s[node]
    passed_s = drive.trace.time_s[node + 1] - start_s
    rows = min(int(passed_s / ROW_S), ROWS_BETWEEN_MAX)
    for k in range(1, rows + 1):
        share = k / (rows + 1.0)
        yield _row(drive, node, start_s + passed_s * share, node + share, 1.0 / passed_s)


def _row(drive: Drive, node: int, time_s: float, s_m: float, speed_mps: float) -> str:
    here = {"time_s": time_s, "s_m": s_m, "speed_mps": speed_mps}
    cells = []
    for column in COLUMNS:
        value = here.get(column.name)
        if value is None:
            value = _arrays(drive, column)[node]
        cells.append(column.words[int(value)] if column.words else _number(value))
    return ",".join(cells)


def _arrays(drive: Drive, column: Column) -> Sequence[float]:
    group = {RouteArrays: drive.route, ProfileArrays: drive.profile, TraceArrays: drive.trace}
    array: Sequence[float] = getattr(group[column.group], column.field)
    return array


def _number(value: float) -> str:
    return f"{value:.17g}"
