"""Recordings exported to Parquet and MDF4, read back with the formats' own libraries."""

from __future__ import annotations

import sys
from pathlib import Path

import asammdf
import numpy as np
import pyarrow.parquet as pq
import pytest
from every_column import every_column
from pldf.cli import main
from pldf.errors import ModelError
from pldf.recordings.columns import COLUMNS, KINDS
from pldf.recordings.exports import UNITS, write_mdf4, write_parquet
from pldf.recordings.recording import Recording, write_recording


@pytest.fixture
def recording() -> Recording:
    return Recording(every_column(500), ("rehearsal", "simulator 3"))


def test_every_column_has_a_unit() -> None:
    assert tuple(UNITS) == COLUMNS


def test_parquet_gives_back_values_units_and_comments(recording: Recording, tmp_path: Path) -> None:
    write_parquet(tmp_path / "new" / "drive.parquet", recording)
    table = pq.read_table(tmp_path / "new" / "drive.parquet")
    assert tuple(table.column_names) == COLUMNS
    assert table.schema.metadata[b"comments"].decode() == "rehearsal\nsimulator 3"
    for name in COLUMNS:
        assert table.schema.field(name).metadata[b"unit"].decode() == UNITS[name]
    modes = table["mode"].to_pylist()
    assert modes[:6] == ["OFF", "STANDBY", "ACTIVE", "GAS_OVERRIDE", "FAULT", "OFF"]
    assert table["eligible"].to_pylist()[:3] == [False, True, False]
    for name in (name for name in COLUMNS if KINDS[name].kind in ("number", "whole")):
        assert np.array_equal(table[name].to_numpy(), recording[name])


def test_mdf4_gives_back_values_units_and_mode_names(recording: Recording, tmp_path: Path) -> None:
    path = tmp_path / "drive.mf4"
    write_mdf4(path, recording)
    with asammdf.MDF(path) as file:
        assert file.version == "4.10"
        assert len(file.groups) == 1
        for name in (name for name in COLUMNS[1:] if not KINDS[name].words):
            signal = file.get(name)
            assert signal.unit == UNITS[name]
            assert np.array_equal(signal.samples, recording[name].astype(signal.samples.dtype)), (
                name
            )
            assert np.array_equal(signal.timestamps, recording["time_s"])
        assert file.get("speed_mps").samples.dtype == np.float64
        assert file.get("mode").samples[:3].tolist() == [b"OFF", b"STANDBY", b"ACTIVE"]
        assert file.get("mode", raw=True).samples[3] == 3
        assert file.get("hmi_event").samples[:2].tolist() == [b"NONE", b"LEARNED"]


def test_a_laboratorys_recording_with_few_columns(recording: Recording, tmp_path: Path) -> None:
    few = Recording({name: recording[name] for name in ("time_s", "s_m", "speed_mps", "mode")})
    csv, parquet, mdf = (tmp_path / f"drive.{ending}" for ending in ("csv", "parquet", "mf4"))
    write_recording(csv, few)
    assert main(["export", str(csv), "--parquet", str(parquet), "--mdf4", str(mdf)]) == 0
    assert pq.read_table(parquet).column_names == list(few.columns)
    with asammdf.MDF(mdf) as file:
        assert set(file.channels_db) == {"time", "s_m", "speed_mps", "mode"}


def test_the_same_recording_gives_the_same_parquet_file(
    recording: Recording, tmp_path: Path
) -> None:
    for name in ("one", "two"):
        write_parquet(tmp_path / name, recording)
    assert (tmp_path / "one").read_bytes() == (tmp_path / "two").read_bytes()


@pytest.mark.parametrize(
    ("write", "package", "extra"),
    [(write_parquet, "pyarrow", "parquet"), (write_mdf4, "asammdf", "mdf")],
)
def test_a_missing_package_is_named_with_the_way_out(
    write: object,
    package: str,
    extra: str,
    recording: Recording,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(ModelError, match=rf"{package}.*pip install 'adaptive-pldf\[{extra}\]'"):
        write(tmp_path / "drive", recording)  # type: ignore[operator]


def test_bad_use(recording: Recording, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    csv = tmp_path / "drive.csv"
    write_recording(csv, recording)
    with pytest.raises(SystemExit) as stopped:
        main(["export", str(csv)])
    assert stopped.value.code == 2
    assert main(["export", str(tmp_path / "none.csv"), "--parquet", str(tmp_path / "o")]) == 1
    assert main(["export", str(csv), "--parquet", str(csv / "below" / "o.parquet")]) == 1
    assert "cannot be written" in capsys.readouterr().err
