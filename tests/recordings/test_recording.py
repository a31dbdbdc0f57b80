"""Recordings as CSV: read back to the bit, refused by place, completed from road and profile."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from every_column import every_column
from pldf.errors import ModelError
from pldf.function import DrivingFunction
from pldf.kernel.codes import ACTIVE, GAS_OVERRIDE, MODE, STANDBY
from pldf.recordings.columns import COLUMNS, LABORATORY
from pldf.recordings.derived import completed
from pldf.recordings.recording import (
    Recording,
    read_recording,
    recording_csv,
    write_recording,
)

NEEDED = "time_s,s_m,speed_mps,mode"
ROWS = "0,0,20,ACTIVE\n0.1,2,20,ACTIVE\n0.2,4,20.5,GAS_OVERRIDE\n"


def test_a_recording_reads_back_to_the_same_bits(tmp_path: Path) -> None:
    made = Recording(every_column(200), ("participant 7", "drive A2"))
    write_recording(tmp_path / "a.csv", made)
    read = read_recording(tmp_path / "a.csv")
    assert read.comments == made.comments
    assert list(read.columns) == list(COLUMNS)
    for name in COLUMNS:
        assert read[name].tobytes() == made[name].tobytes()
    assert (tmp_path / "a.csv").read_bytes() == recording_csv(read)


def test_columns_may_lack_be_more_and_come_in_any_order(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("mode,who,time_s,speed_mps,s_m\nOFF,me,0,1,2\nFAULT,you,1,3,4\n")
    read = read_recording(path)
    assert list(read.columns) == NEEDED.split(",")
    assert read["mode"].tolist() == [MODE.code("OFF"), MODE.code("FAULT")]
    assert read["s_m"].tolist() == [2.0, 4.0]
    assert "eligible" not in read


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "a.csv: no header"),
        ("time_s,s_m\n0,0\n", "a.csv, line 1: missing column speed_mps, mode; a recording has"),
        (f"{NEEDED}\n", "a.csv: no samples below the header (line 1); at least 2 are needed"),
        (f"{NEEDED}\n0,0,20,ACTIVE\n", "a.csv: 1 sample below the header"),
        (f"{NEEDED}\n{ROWS}0.3,6,20\n", "a.csv, line 5: 3 values for 4 columns"),
        (f"# c\n{NEEDED}\n{ROWS}0.3,6,fast,OFF\n", "line 6, speed_mps: 'fast' is not a number"),
        (
            f"{NEEDED}\n{ROWS}0.3,6,,OFF\n",
            "a.csv, line 5, speed_mps: '' is not a number from -90 to 1000 in m/s",
        ),
        (f"{NEEDED}\n{ROWS}0.3,inf,2,OFF\n", "a.csv, line 5, s_m: 'inf' is not a number in m"),
        (f"{NEEDED}\n{ROWS}0.3,6,2,ON\n", "line 5, mode: 'ON' is not one of OFF, STANDBY, ACTIVE"),
        (f"{NEEDED},eligible\n0,0,2,OFF,2\n", "line 2, eligible: '2' is not 0 or 1"),
        (
            f"{NEEDED}\n{ROWS}\n0.15,6,2,OFF\n",
            "line 6, time_s: time runs backwards, from 0.2 s to 0.15",
        ),
        (f"{NEEDED}\n{ROWS}0.1,x,2,OFF\n0,6,2,ON\n", "line 5, s_m: 'x' is not a number in m\n"),
    ],
)
def test_what_cannot_be_used_is_named(tmp_path: Path, text: str, told: str) -> None:
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(ModelError) as caught:
        read_recording(tmp_path / "a.csv")
    assert told in str(caught.value)


def test_what_lacks_is_derived_from_the_road_and_the_profile() -> None:
    function = DrivingFunction()
    function.initialize()
    time = np.arange(0.0, 30.0, 0.1)
    mode = np.full(len(time), float(ACTIVE))
    mode[100:120] = GAS_OVERRIDE
    mode[200:] = STANDBY
    few = Recording({"time_s": time, "s_m": 10.0 * time, "speed_mps": 10.0 + time, "mode": mode})
    whole = completed(few, function)
    assert list(whole.columns) == list(LABORATORY.names)
    cell = few["s_m"].astype(int)
    limit = np.asarray(function.route.limit_mps)[cell]
    np.testing.assert_array_equal(whole["limit_mps"], limit)
    np.testing.assert_array_equal(whole["set_speed_mps"], limit)
    np.testing.assert_array_equal(whole["gas_pedal"], mode == GAS_OVERRIDE)
    np.testing.assert_array_equal(whole["brake_pedal"], mode == STANDBY)
    np.testing.assert_allclose(whole["acceleration_mps2"], 1.0)
    assert whole["base_mps"][0] == np.asarray(function.profile.base_mps)[0]
    assert not np.any(whole["set_speed_offset_mps"])


def test_titles_that_are_almost_our_names_are_read_or_told(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(
        "Time_S,s m,speed-mps,MODE,Gas_Pedal,brake_pedl\n0,0,20,2,0.5,1\n0.1,2,20,ACTIVE,0,0\n"
    )
    recording = read_recording(path)
    assert recording["time_s"].tolist() == [0.0, 0.1]
    assert recording["gas_pedal"].tolist() == [0.5, 0.0]
    assert recording["mode"].tolist() == [ACTIVE, ACTIVE]
    told = list(map(str, recording.notes))
    assert f"{path}, gas_pedal: the column 'Gas_Pedal' is read as gas_pedal" in told
    assert any("'brake_pedl' is not known and passed over; is brake_pedal meant" in t for t in told)


@pytest.mark.parametrize("code", ["-99", "-999", "1e9", "inf"])
@pytest.mark.parametrize("name", ["speed_mps", "set_speed_offset_mps", "brake_pedal"])
def test_codes_for_missing_numbers_are_no_measurements(
    tmp_path: Path, name: str, code: str
) -> None:
    path = tmp_path / "a.csv"
    row = {"time_s": "0", "s_m": "0", "speed_mps": "20", "mode": "ACTIVE", name: code}
    path.write_text(",".join(row) + "\n" + ",".join(row.values()) + "\n")
    with pytest.raises(ModelError, match=f"line 2, {name}: '{code}' is not a number from -90"):
        read_recording(path)
