"""The files that a recording may be in: CSV, Parquet, ASAM MDF4, NumPy; each as named columns.

All of them end in the reader of tables, so a cell that cannot be used is told in the same way. What
needs an optional package is imported when it is needed.
"""

from __future__ import annotations

import gc
import logging
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from ..errors import ModelError
from ..files.disk import reason
from ..files.tables import (
    Cell,
    Fault,
    Format,
    Table,
    TableError,
    parse_table,
    read_header,
    read_table,
    table_csv,
)
from ..findings import Finding
from ..kernel.arrays import FloatArray
from .units import header_of

MDF_TIME: Final = "time_s"  # the time of a channel, whatever its master is called

Cells = Sequence[Cell] | FloatArray


class Loaded(NamedTuple):
    """Columns that were wanted, and what has to be known about how they were read."""

    cells: Mapping[str, Cells]
    notes: tuple[Finding, ...] = ()


@dataclass(frozen=True)
class Input:
    """A recording's file, of which nothing but the names of its columns has been read.

    Attributes:
        path: the file.
        names: of its columns, as they stand there; a name may occur twice.
        units: column -> unit as the file states it, beside the name or within; not of all.
        load: returns columns of one length; None: the file is a CSV.
    """

    path: Path
    names: tuple[str, ...]
    units: Mapping[str, str] = field(default_factory=dict)
    load: Callable[[Sequence[str]], Loaded] | None = None

    def table(self, form: Format) -> tuple[Table, tuple[Finding, ...]]:
        """Return the columns of ``form``, and what has to be known about how they were read.

        Raises:
            TableError: with all cells that are not what ``form`` says.
        """
        if self.load is None:
            return read_table(self.path, form), ()
        with _told_as_unreadable(self.path):
            loaded = self.load([name for name in form.names if name in self.names])
        return parse_table(table_csv(loaded.cells), self.path, form), loaded.notes

    @contextmanager
    def placed(self) -> Iterator[None]:
        """Have faults name samples where the file has no lines: those are of a text nobody sees."""
        try:
            yield
        except TableError as error:
            if self.load is None:
                raise
            raise TableError(self.path, [_of_sample(fault) for fault in error.faults]) from None

    def place(self, finding: Finding) -> Finding:
        """Return ``finding`` with a sample in place of a line if the file has no lines."""
        if self.load is None or not finding.line:
            return finding
        fault = _of_sample(Fault(finding.line, finding.place, finding.text))
        return finding._replace(line=0, place=fault.place)


def _of_sample(fault: Fault) -> Fault:
    sample = f"sample {fault.line - 1}" if fault.line > 1 else ""
    return Fault(0, ", ".join(filter(None, (sample, fault.place))), fault.text)


@contextmanager
def _told_as_unreadable(path: Path) -> Iterator[None]:
    """Tell whatever a library raises at a damaged file; its own clean-up may fail, too."""
    hook = sys.unraisablehook
    sys.unraisablehook = lambda _unraisable: None
    problem = None
    try:
        yield
    except (ModelError, FileNotFoundError, PermissionError, IsADirectoryError):
        raise
    except Exception as error:
        problem = " ".join(f"{error}".split()) or type(error).__name__
        # What was half opened lives in its frames; asammdf fails to close that.
        error.__traceback__ = error.__context__ = error.__cause__ = None
        gc.collect()
    finally:
        sys.unraisablehook = hook
    if problem is not None:
        raise ModelError(f"{path}: not a file of its kind that can be read ({problem[:200]})")


def open_input(path: Path) -> Input:
    """Return what the file ``path`` holds; its ending says what it is, and none a CSV.

    Raises:
        ModelError: the file cannot be read, or the package that reads it is not installed.
    """
    opened = _OPENERS.get(path.suffix.lower(), _open_csv)
    if opened is _open_csv:
        return opened(path)
    try:
        with path.open("rb"), _told_as_unreadable(path):
            return opened(path)
    except OSError as error:
        raise ModelError(f"{path}: cannot be read ({reason(error)}); check the path") from error


def _open_csv(path: Path) -> Input:
    names = read_header(path)
    return Input(path, names, _units_in(names))


def _units_in(names: Iterable[str]) -> dict[str, str]:
    return {name: unit for name in names if (unit := header_of(name).unit)}


def _open_parquet(path: Path) -> Input:
    try:
        import pyarrow as pa  # type: ignore[import-untyped]  # noqa: PLC0415 - optional
        import pyarrow.parquet as pq  # type: ignore[import-untyped]  # noqa: PLC0415
    except ImportError as error:
        raise not_installed("Parquet", "pyarrow", "parquet") from error
    schema = pq.read_schema(path)
    stated = {
        part.name: "date" if pa.types.is_timestamp(part.type) else _text_of(part.metadata, b"unit")
        for part in schema
    }

    def load(wanted: Sequence[str]) -> Loaded:
        table = pq.read_table(path, columns=list(wanted))
        return Loaded({name: _parquet_cells(table[name]) for name in wanted})

    units = {**_units_in(schema.names), **{name: unit for name, unit in stated.items() if unit}}
    return Input(path, tuple(schema.names), units, load)


def _text_of(metadata: Mapping[bytes, bytes] | None, key: bytes) -> str:
    return (metadata or {}).get(key, b"").decode("utf-8", "replace")


def _parquet_cells(column: Any) -> Cells:
    if column.null_count == 0 and str(column.type) in ("double", "float", "int64", "int32"):
        values: FloatArray = column.to_numpy().astype(np.float64)
        return values
    return ["" if cell is None else _cell(cell) for cell in column.to_pylist()]


def _cell(value: Any) -> Cell:
    """Return a value of any library as a cell of a table."""
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace").strip("\0")
    return value if isinstance(value, str | bool | int | float) else str(value)


def _open_mdf(path: Path) -> Input:
    try:
        from asammdf import MDF  # noqa: PLC0415 - optional
    except ImportError as error:
        raise not_installed("MDF4", "asammdf", "mdf") from error
    logging.getLogger("asammdf").setLevel(logging.CRITICAL)  # what it says is told by an error
    with MDF(path) as file:
        groups: list[Any] = list(file.groups)
        channels = [
            channel
            for at, group in enumerate(groups)
            for number, channel in enumerate(group.channels)
            if file.masters_db.get(at) != number
        ]
    names = tuple(channel.name for channel in channels)
    stated = {channel.name: getattr(channel, "unit", "") for channel in channels}
    units = {**_units_in(names), **{name: unit for name, unit in stated.items() if unit}}

    def load(wanted: Sequence[str]) -> Loaded:
        with MDF(path) as file:
            signals = {name: file.get(name) for name in wanted if name != MDF_TIME}
        return _channels(path, signals)

    return Input(path, (MDF_TIME, *(name for name in names if name != MDF_TIME)), units, load)


def _channels(path: Path, signals: Mapping[str, Any]) -> Loaded:
    """Return MDF channels over the time of the one with the most samples.

    Numbers of others are linear in between; texts, flags and codes hold until the next sample. The
    ends are where all channels have begun and none has ended.
    """
    if without := [name for name, signal in signals.items() if not len(signal.timestamps)]:
        raise ModelError(f"{path}: no samples of {', '.join(without)}")
    time = max((signal.timestamps for signal in signals.values()), key=len)
    first = max(float(signal.timestamps[0]) for signal in signals.values())
    last = min(float(signal.timestamps[-1]) for signal in signals.values())
    kept = time[(time >= first) & (time <= last)].astype(np.float64)
    cells: dict[str, Cells] = {MDF_TIME: kept}
    cells |= {name: _at_times(signal, kept) for name, signal in signals.items()}
    other = [name for name, s in signals.items() if not np.array_equal(s.timestamps, time)]
    if not other:
        return Loaded(cells)
    text = f"other times of sampling than most have {', '.join(other)}"
    effect = "their numbers are linear in between, codes and texts hold until the next sample"
    return Loaded(cells, (Finding("note", str(path), 0, "", text, effect),))


def _at_times(signal: Any, time: FloatArray) -> Cells:
    samples, sampled = signal.samples, signal.timestamps
    if np.issubdtype(samples.dtype, np.floating):
        same = len(time) == len(sampled) and np.array_equal(time, sampled)
        values: FloatArray = samples.astype(np.float64)
        return values if same else np.interp(time, sampled, values)
    held = samples[np.searchsorted(sampled, time, side="right") - 1]
    return [_cell(value) for value in held.tolist()]


def _open_numpy(path: Path) -> Input:
    """Open a structured array in .npy, or columns of one length in .npz."""
    stored = np.load(path, allow_pickle=False)
    arrays = stored if isinstance(stored, np.ndarray) else dict(stored)
    if isinstance(arrays, dict) and len(arrays) == 1:
        (arrays,) = arrays.values()
    if isinstance(arrays, np.ndarray):
        if not arrays.dtype.names:
            raise ModelError(f"{path}: an array without names of columns; save a structured array")
        arrays = {name: arrays[name] for name in arrays.dtype.names}
    wrong = [name for name, values in arrays.items() if values.ndim != 1]
    arrays = {name: values for name, values in arrays.items() if name not in wrong}
    if len({len(values) for values in arrays.values()}) > 1:
        lengths = ", ".join(f"{name} {len(values)}" for name, values in arrays.items())
        raise ModelError(f"{path}: columns of different length: {lengths}")

    def load(wanted: Sequence[str]) -> Loaded:
        return Loaded({name: [_cell(v) for v in arrays[name].tolist()] for name in wanted})

    return Input(path, tuple(arrays), _units_in(arrays), load)


def not_installed(format_name: str, package: str, extra: str) -> ModelError:
    """Return the error that says which optional package is needed."""
    return ModelError(
        f"{format_name} needs the package {package}: pip install 'adaptive-pldf[{extra}]'"
    )


_OPENERS: Final = {
    ".csv": _open_csv,
    ".parquet": _open_parquet,
    ".mf4": _open_mdf,
    ".mdf": _open_mdf,
    ".npy": _open_numpy,
    ".npz": _open_numpy,
}
SUFFIXES: Final = tuple(_OPENERS)
