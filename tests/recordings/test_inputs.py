"""Recordings that are no CSV: what was exported reads back, and what others write is read."""

from __future__ import annotations

import sys
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from asammdf import MDF, Signal
from numpy.typing import NDArray
from pldf.errors import ModelError
from pldf.kernel.codes import MODE
from pldf.recordings.exports import write_mdf4, write_parquet
from pldf.recordings.recording import Recording, read_recording
from sample_recording import sample_recording

CODES = '[mode]\n0 = "OFF"\n1 = "STANDBY"\n2 = "ACTIVE"\n3 = "GAS_OVERRIDE"\n'


def read_with(path: Path, mapping: str) -> Recording:
    path.with_suffix(".toml").write_text(mapping)
    return read_recording(path, path.with_suffix(".toml"))


def test_exported_parquet_reads_back_to_the_same_bits(tmp_path: Path) -> None:
    made = sample_recording(1.0 / 3.0)
    made.columns["eligible"][3:9] = 0.0
    write_parquet(tmp_path / "a.parquet", made)
    read = read_recording(tmp_path / "a.parquet")
    assert read.notes == () and list(read.columns) == list(made.columns)
    for name, values in made.columns.items():
        assert read[name].tobytes() == values.tobytes(), name


def test_exported_mdf4_reads_back_to_the_same_bits(tmp_path: Path) -> None:
    made = sample_recording(1.0 / 3.0)
    made.columns["mode"][:5] = range(5)
    write_mdf4(tmp_path / "a.mf4", made)
    read = read_recording(tmp_path / "a.mf4")
    assert set(read.columns) == set(made.columns)
    for name, values in made.columns.items():
        assert read[name].tobytes() == values.tobytes(), name


def test_the_unit_that_a_file_states_counts_and_is_told(tmp_path: Path) -> None:
    fields = [
        pa.field("when", pa.timestamp("us")),
        pa.field("s_m", pa.float32(), metadata={"unit": "km"}),
        pa.field("v", pa.float64(), metadata={"unit": "km/h"}),
        pa.field("acc", pa.int8()),
    ]
    stamps = [datetime(2026, 5, 1, 12, 0, 0, 50_000 * k, UTC) for k in range(3)]
    cells = [[s.replace(tzinfo=None) for s in stamps], [1.0, 1.5, 2.0], [72, 72, 36], [2, 2, 1]]
    table = pa.table(cells, schema=pa.schema(fields))
    pq.write_table(table, tmp_path / "a.parquet")
    names = '[recording]\ntime_s = "when"\nspeed_mps = "v"\nmode = "acc"\n'
    read = read_with(tmp_path / "a.parquet", names + CODES)
    np.testing.assert_allclose(read["time_s"], [0.0, 0.05, 0.1], atol=1e-6)
    assert read["s_m"].tolist() == [1000.0, 1500.0, 2000.0]
    assert read["speed_mps"].tolist() == [20.0, 20.0, 10.0]
    assert read["mode"].tolist() == [2.0, 2.0, 1.0]
    assert "s_m from 's_m' in km" in read.notes[0].text


def test_what_is_wrong_in_a_file_without_lines_is_told_by_its_sample(tmp_path: Path) -> None:
    columns = {"time_s": [0.0, 1.0, 2.0], "s_m": [0.0, None, 2.0], "speed_mps": [1.0, 1.0, 1.0]}
    pq.write_table(pa.table({**columns, "mode": ["OFF", "OFF", "on"]}), tmp_path / "a.parquet")
    with pytest.raises(ModelError) as caught:
        read_recording(tmp_path / "a.parquet")
    told = str(caught.value)
    assert "sample 2, s_m: " in told and "sample 3, mode" in told and "line" not in told
    columns["time_s"][2] = 0.5
    columns["s_m"][1] = 1.0
    pq.write_table(pa.table({**columns, "mode": ["OFF"] * 3}), tmp_path / "a.parquet")
    with pytest.raises(
        ModelError, match=r"sample 3, time_s: time runs backwards, from 1 s to 0\.5"
    ):
        read_recording(tmp_path / "a.parquet")


def signal(name: str, time: NDArray[np.float64], samples: object, unit: str = "") -> Signal:
    return Signal(samples=np.array(samples), timestamps=time, name=name, unit=unit)


def test_mdf_channels_of_several_rates_come_to_one_time(tmp_path: Path) -> None:
    fast, slow = np.arange(0.0, 2.001, 0.01), np.arange(0.5, 2.51, 0.5)
    with MDF(version="4.10") as file:
        steady = signal("V", fast, 0.0 * fast + 72.0, "km/h")
        file.append([signal("Weg", fast, 20.0 * fast, "m"), steady])
        file.append([signal("Limit", slow, [100.0, 100.0, 80.0, 80.0, 80.0], "km/h")])
        file.append([signal("State", slow, np.array([2, 2, 3, 2, 2], dtype=np.uint8))])
        file.save(tmp_path / "a.mf4", overwrite=True)
    names = '[recording]\ns_m = "Weg"\nspeed_mps = "V"\nlimit_mps = "Limit"\n'
    read = read_with(tmp_path / "a.mf4", names + 'mode = "State"\n' + CODES)
    time = read["time_s"]
    np.testing.assert_allclose(time, fast[50:])  # from where the last channel has begun
    np.testing.assert_allclose(read["s_m"], 20.0 * time)
    np.testing.assert_allclose(read["speed_mps"], 20.0)
    expected = np.interp(time, slow, [100.0, 100.0, 80.0, 80.0, 80.0]) / 3.6
    np.testing.assert_allclose(read["limit_mps"], expected)
    gas = (time >= slow[2]) & (time < slow[3])
    np.testing.assert_array_equal(read["mode"], np.where(gas, 3.0, 2.0))
    told = " ".join(note.text for note in read.notes)
    assert "other times of sampling than most have State, Limit" in told


def test_a_channel_of_two_groups_is_refused(tmp_path: Path) -> None:
    time = np.arange(3.0)
    with MDF(version="4.10") as file:
        for start in (0.0, 5.0):
            file.append([signal("s_m", time, start + time)])
        file.append([signal("speed_mps", time, time), signal("mode", time, time)])
        file.save(tmp_path / "a.mf4", overwrite=True)
    with pytest.raises(ModelError, match=r"repeated column s_m"):
        read_recording(tmp_path / "a.mf4")


@pytest.mark.parametrize("ending", [".npy", ".npz"])
def test_a_structured_array_is_read(tmp_path: Path, ending: str) -> None:
    made = sample_recording()
    kinds = [("time_s", "f8"), ("s_m", "f8"), ("speed_mps", "f8"), ("mode", "U12"), ("x", "?")]
    rows = np.zeros(len(made), dtype=kinds)
    for name in ("time_s", "s_m", "speed_mps"):
        rows[name] = made[name]
    rows["mode"] = [MODE.items[int(code)] for code in made["mode"]]
    path = tmp_path / f"a{ending}"
    if ending == ".npy":
        np.save(path, rows)
    else:
        np.savez(path, **{name: rows[name] for name, _ in kinds})
    read = read_recording(path)
    for name in read.columns:
        np.testing.assert_array_equal(read[name], made[name])


@pytest.mark.parametrize("name", ["a.parquet", "a.mf4", "a.npy", "a.npz"])
@pytest.mark.parametrize("content", [b"", b"time_s,s_m\n0,0\n", b"PAR1" * 20, b"MDF     4.10" * 9])
def test_what_is_no_such_file(
    tmp_path: Path, name: str, content: bytes, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ModelError, match="not a file of its kind that can be read"):
        read_recording(tmp_path / name)
    with pytest.raises(ModelError, match="cannot be read"):
        read_recording(tmp_path / "nowhere" / name)
    assert "Traceback" not in capsys.readouterr().err


@pytest.mark.parametrize("ending", [".parquet", ".mf4", ".npz"])
def test_damage_is_told_or_does_no_harm(tmp_path: Path, ending: str) -> None:
    """Never a traceback: each file with one run of bytes overwritten, at forty places."""
    path, made = tmp_path / f"a{ending}", sample_recording()
    if ending == ".npz":
        texts = [MODE.items[int(code)] for code in made["mode"]]
        np.savez_compressed(path, **{**made.columns, "mode": np.array(texts)})
    else:
        {".parquet": write_parquet, ".mf4": write_mdf4}[ending](path, made)
    whole, told = path.read_bytes(), 0
    for seed in range(40):
        random = np.random.default_rng(seed)
        at = int(random.integers(len(whole) - 8))
        path.write_bytes(whole[:at] + random.bytes(8) + whole[at + 8 :])
        try:
            read_recording(path)
        except ModelError:
            told += 1
    assert told > 2


def test_an_array_without_names_is_refused(tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", np.zeros((5, 4)))
    with pytest.raises(ModelError, match="an array without names of columns"):
        read_recording(tmp_path / "a.npy")


@pytest.mark.parametrize(
    ("name", "package", "extra"), [("a.mf4", "asammdf", "mdf"), ("a.parquet", "pyarrow", "parquet")]
)
def test_a_package_that_is_missing_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, package: str, extra: str
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    (tmp_path / name).write_bytes(b"x")
    with pytest.raises(ModelError, match=rf"{package}: pip install 'adaptive-pldf\[{extra}\]'"):
        read_recording(tmp_path / name)
