"""A recording that goes on behind the road's end, or has two laps: one drive of it counts."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import function, play, road, within
from pldf.kernel.codes import ACTIVE, GAS_OVERRIDE, STANDBY
from pldf.recordings.derived import completed
from pldf.recordings.interventions import rates_of
from pldf.recordings.offline import learn_from
from pldf.recordings.recording import Recording

LENGTH_M, SPEED_MPS, STEP_S = 1000.0, 20.0, 0.05
ROAD = road(LENGTH_M)

Piece = tuple[float, float]  # from m, seconds


def recorded(*pieces: Piece, mode: float = ACTIVE) -> Recording:
    """Pieces at 20 m/s; gas from the 10th to the 15th second, and in the last third."""
    counts = [round(seconds / STEP_S) for _, seconds in pieces]
    s_m = np.concatenate(
        [p[0] + SPEED_MPS * STEP_S * np.arange(n) for p, n in zip(pieces, counts, strict=True)]
    )
    time = STEP_S * np.arange(len(s_m))
    gas = within(time, [(10.0, 15.0), (0.7 * time[-1], 0.8 * time[-1])]) & (mode == ACTIVE)
    columns = {"time_s": time, "s_m": s_m, "speed_mps": np.full(len(s_m), SPEED_MPS)}
    columns["mode"] = np.where(gas, GAS_OVERRIDE, mode)
    return Recording(columns)


def rows(recording: Recording, first: int, behind: int) -> Recording:
    return Recording({name: values[first:behind] for name, values in recording.columns.items()})


def joined(first: Recording, second: Recording) -> Recording:
    shift = first["time_s"][-1] + STEP_S
    columns = {name: np.append(first[name], second[name]) for name in first.columns}
    columns["time_s"] = np.append(first["time_s"], second["time_s"] + shift)
    return Recording(columns)


def kept(recording: Recording) -> Recording:
    return completed(recording, function(ROAD), "drive.csv")


def told(recording: Recording) -> list[tuple[str, str]]:
    return [(f.severity, f.text) for f in kept(recording).notes if f.place == "s_m"]


def test_one_drive_is_kept_as_it_is() -> None:
    drive = recorded((0.0, 49.0))
    assert len(kept(drive)) == len(drive)
    assert told(drive) == []


def test_what_lies_behind_the_road_counts_for_nothing() -> None:
    whole = recorded((0.0, 80.0))
    assert kept(whole)["s_m"][-1] == LENGTH_M
    ((severity, text),) = told(whole)
    assert (severity, text) == ("note", "30.0 s behind the road's end")
    # 50 s on the road; of the two presses of 5 and 8 s, the second lies behind it.
    assert rates_of(kept(whole)).pedal == pytest.approx(0.1)


@pytest.mark.parametrize("seconds", [30.0, 49.0, 70.0])
def test_the_second_lap_is_left_out_and_told(seconds: float) -> None:
    first = recorded((0.0, seconds))
    both = joined(first, recorded((0.0, 40.0)))
    one, two = kept(first), kept(both)
    assert np.array_equal(one["s_m"], two["s_m"])
    assert rates_of(one) == rates_of(two)
    assert ("warning", f"set back from {first['s_m'][-1]:.0f} to 0 m at {seconds:g} s") in told(
        both
    )
    learned = [learn_from(recording, ROAD).iteration.learned_mps for recording in (first, both)]
    assert np.array_equal(*learned)


def test_a_glitch_is_no_second_lap() -> None:
    drive = recorded((0.0, 49.0))
    drive["s_m"][400:410] = 0.0  # half a second
    assert len(kept(drive)) == len(drive)


def test_a_car_brought_to_the_start_has_not_driven_before() -> None:
    parked = recorded((600.0, 5.0), mode=STANDBY)
    drive = recorded((0.0, 49.0))
    assert np.array_equal(kept(joined(parked, drive))["s_m"], drive["s_m"])
    ((severity, _),) = told(joined(parked, drive))
    assert severity == "note"


@pytest.mark.parametrize("seconds", [30.0, 49.0, 70.0])
def test_rates_of_rows_are_those_of_the_kernel(seconds: float) -> None:
    """Which follows the whole recording, sample by sample, with its own rule."""
    both = joined(recorded((0.0, seconds)), recorded((0.0, 40.0)))
    made = function(ROAD)
    columns = both.columns
    play(made, columns["s_m"], columns["speed_mps"], time_s=columns["time_s"], mode=columns["mode"])
    made.refresh()
    assert rates_of(kept(both)).pedal == pytest.approx(made.record.rate_pedal, abs=1e-3)
