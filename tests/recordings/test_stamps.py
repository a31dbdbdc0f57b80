"""Stamps: dates, and clocks that are coarser than the samples."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pldf.errors import ModelError
from pldf.recordings.recording import Recording, read_recording
from pldf.recordings.stamps import CoarseStamps, seconds_of_dates


def written(path: Path, time: list[str], s_m: list[float]) -> Path:
    rows = (f"{t},{s!r},20,ACTIVE" for t, s in zip(time, s_m, strict=True))
    path.write_text("\n".join(["time_s,s_m,speed_mps,mode", *rows]) + "\n")
    return path


def read(path: Path, time: list[str], s_m: list[float]) -> Recording:
    return read_recording(written(path / "a.csv", time, s_m))


@given(st.integers(11, 200), st.floats(0.0, 1.0))
def test_coarse_stamps_of_an_even_clock_become_even(hertz: int, start: float) -> None:
    """Whatever the rate and whether the logger rounds or cuts: within the resolution of a stamp."""
    true = start + np.arange(600.0) / hertz
    for stamps in (np.round(true, 1), np.floor(true * 10.0) / 10.0):
        found = CoarseStamps(stamps).times_s()
        assert np.all(np.diff(found) > 0.0)
        assert np.max(np.abs(found - stamps)) <= 0.1 + 1e-9
        np.testing.assert_allclose(np.diff(found), 1.0 / hertz, rtol=0.02)


def test_twenty_hertz_with_stamps_of_a_tenth(tmp_path: Path) -> None:
    time = [f"{round(0.05 * k, 1)}" for k in range(400)]
    found = read(tmp_path, time, [1.0 * k for k in range(400)])
    np.testing.assert_allclose(np.diff(found["time_s"]), 0.05, rtol=1e-3)
    (note,) = found.notes
    assert note.severity == "note" and note.line == 4 and note.place == "time_s"
    assert "of 400 samples have the stamp of the one before" in note.text
    assert "0.1 s" in note.text and "uncertain" in note.consequence and "decimals" in note.way_out


def test_a_hole_between_coarse_stamps_stays_a_hole(tmp_path: Path) -> None:
    true = np.concatenate([np.arange(100) * 0.05, 20.0 + np.arange(100) * 0.05])
    found = read(tmp_path, [f"{t:.1f}" for t in true], (20.0 * true).tolist())
    np.testing.assert_allclose(found["time_s"], true, atol=0.1)
    assert np.max(np.diff(found["time_s"])) == pytest.approx(15.05, abs=0.1)


def test_one_shared_stamp_moves_no_other(tmp_path: Path) -> None:
    time = [f"{0.1 * k:.1f}" for k in range(50)]
    time[30] = time[29]
    found = read(tmp_path, time, [2.0 * k for k in range(50)])
    expected = [0.1 * k for k in range(50)]
    expected[30] = expected[29] + 0.05
    np.testing.assert_allclose(found["time_s"], expected, atol=1e-9)


def test_repeated_rows_are_left_out_and_told(tmp_path: Path) -> None:
    rows = [k for k in range(50) for _ in range(1 + (k in (10, 20)))]
    found = read(tmp_path, [f"{0.1 * k:.1f}" for k in rows], [2.0 * k for k in rows])
    assert found["s_m"].tolist() == [2.0 * k for k in range(50)]
    (note,) = found.notes
    assert note.text == "2 rows repeat the one before them" and note.line == 13


def test_a_car_that_stands_under_a_coarse_clock_repeats_nothing(tmp_path: Path) -> None:
    """Rows are equal because nothing moves: they are samples all the same."""
    time = [f"{round(0.05 * k, 1)}" for k in range(400)]
    found = read(tmp_path, time, [1.0 * min(k, 280) for k in range(400)])
    assert len(found) == 400
    np.testing.assert_allclose(np.diff(found["time_s"]), 0.05, rtol=1e-3)


def test_a_recording_of_one_row_again_and_again_is_none(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="all rows are the same"):
        read(tmp_path, ["0.0"] * 5, [3.0] * 5)


def test_a_clock_that_stands_still_is_refused_with_its_place(tmp_path: Path) -> None:
    time = [f"{0.1 * k:.1f}" for k in range(20)] + ["2.0"] * 50 + ["7.0", "7.1"]
    with pytest.raises(ModelError, match=r"line 22, time_s: the clock stands still at 2 s"):
        read(tmp_path, time, [2.0 * k for k in range(len(time))])


def test_time_that_runs_backwards_is_refused_wherever_it_does(tmp_path: Path) -> None:
    time = ["0", "1", "0.5", "2", "3", "1", "4"]
    with pytest.raises(ModelError) as caught:
        read(tmp_path, time, [1.0] * 7)
    told = str(caught.value)
    assert "line 4, time_s: time runs backwards, from 1 s to 0.5 s" in told
    assert "sort the recording by time, or cut it" in told and "also line 7" in told


def test_a_slow_log_with_jitter_is_as_it_is(tmp_path: Path) -> None:
    time = (np.arange(60.0) + np.random.default_rng(1).uniform(-0.2, 0.2, 60)).tolist()
    found = read(tmp_path, [repr(t) for t in time], [20.0 * t for t in time])
    assert found["time_s"].tolist() == time and found.notes == ()


@pytest.mark.parametrize(
    ("texts", "expected"),
    [
        (["2026-05-01T12:00:00", "2026-05-01T12:00:00.250", "2026-05-01T12:00:01"], [0, 0.25, 1]),
        (["2026-05-01 12:00:00,5", "2026-05-01 12:00:01,5"], [0, 1]),
        (["2026-05-01T12:00:00Z", "2026-05-01T14:00:01+02:00"], [0, 1]),
        (["23:59:59.5", "00:00:00.5"], [0, 1]),
        (["2026-02-28T23:59:59", "2026-03-01T00:00:00"], [0, 1]),
    ],
)
def test_dates(texts: list[str], expected: list[float]) -> None:
    np.testing.assert_allclose(seconds_of_dates(texts), expected, atol=1e-6)


def test_what_is_no_date() -> None:
    assert np.isnan(seconds_of_dates(["2026-05-01T12:00:00", "", "noon", "3.5"])).tolist() == [
        False, True, True, True,
    ]  # fmt: skip
