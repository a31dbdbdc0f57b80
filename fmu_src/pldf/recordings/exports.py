"""Recordings as Parquet and ASAM MDF4, with units; for tools that do not read CSV.

Each needs an optional package, so nothing here is imported before it is used.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final

import numpy as np

from ..errors import ModelError
from .columns import COLUMNS, KINDS
from .inputs import not_installed
from .recording import Recording

UNITS: Final = {name: column.unit for name, column in KINDS.items()}

_INTEGER: Final = {
    name: np.uint32 if column.kind == "whole" else np.uint8
    for name, column in KINDS.items()
    if not column.unit
}


def write_parquet(path: Path, recording: Recording) -> None:
    """Write ``recording`` as Parquet: float64, modes and the like by name, flags as Boolean.

    The unit of a column is in its field's metadata, key ``unit``; comments are in the schema's.

    Raises:
        ModelError: pyarrow is not installed, or the file cannot be written.
    """
    try:
        import pyarrow as pa  # type: ignore[import-untyped]  # noqa: PLC0415 - optional
        import pyarrow.parquet as pq  # type: ignore[import-untyped]  # noqa: PLC0415
    except ImportError as error:
        raise not_installed("Parquet", "pyarrow", "parquet") from error
    arrays, fields = [], []
    for name in _names(recording):
        array = pa.array(_typed(name, recording))
        arrays.append(array.dictionary_encode() if KINDS[name].words else array)
        fields.append(pa.field(name, arrays[-1].type, metadata={"unit": UNITS[name]}))
    comments = {"comments": "\n".join(recording.comments)}
    table = pa.Table.from_arrays(arrays, schema=pa.schema(fields, metadata=comments))
    with _writable(path) as target:
        pq.write_table(table, target)


def write_mdf4(path: Path, recording: Recording) -> None:
    """Write ``recording`` as ASAM MDF 4.10: one channel group over time, ``mode`` with its texts.

    Raises:
        ModelError: asammdf is not installed, or the file cannot be written.
    """
    try:
        from asammdf import MDF, Signal  # noqa: PLC0415 - optional
    except ImportError as error:
        raise not_installed("MDF4", "asammdf", "mdf") from error
    signals = [
        Signal(
            samples=recording[name] if UNITS[name] else recording[name].astype(_INTEGER[name]),
            timestamps=recording["time_s"],
            name=name,
            unit=UNITS[name],
            conversion=_texts_of_codes(KINDS[name].words) if KINDS[name].words else None,
        )
        for name in _names(recording)
        if name != "time_s"
    ]
    with MDF(version="4.10") as file:
        # A recording knows no date; the time of the export is not that of the drive.
        file.start_time = datetime.fromtimestamp(0, UTC)
        comment = "\n".join(recording.comments) or "pldf recording"
        file.append(signals, acq_name="drive", comment=comment, common_timebase=True)
        with _writable(path) as target:
            file.save(target, overwrite=True, compression=1)


def _names(recording: Recording) -> list[str]:
    return [name for name in COLUMNS if name in recording]


def _typed(name: str, recording: Recording) -> Any:
    values = recording[name]
    kind = KINDS[name]
    if kind.words:
        return [kind.words[int(code)] for code in values]
    return values != 0.0 if kind.kind == "flag" else values


def _texts_of_codes(words: tuple[str, ...]) -> dict[str, Any]:
    """Return the conversion of a code to its name."""
    codes = {f"val_{code}": float(code) for code in range(len(words))}
    return {**codes, **{f"text_{code}": word for code, word in enumerate(words)}}


@contextmanager
def _writable(path: Path) -> Iterator[Path]:
    """Make the folder of ``path`` if need be; ModelError if nothing can be written there."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield path
    except OSError as error:
        raise ModelError(f"{path}: cannot be written ({error})") from error
