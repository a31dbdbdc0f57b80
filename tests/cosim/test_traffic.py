"""The coupled FMUs with a car ahead: how they drive behind it; nothing is learned there."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pldf.cosim.fmu import Fmu
from pldf.cosim.master import Drive, connections, drive
from pldf.profiles.store import ProfileStore
from pldf.roads import fingerprint, packed_route
from pldf.study.phases import PHASES, TRAFFIC, TRAFFIC_SCRIPT, DriveSetting, values_of

from vehicle_models.lead_script import packed_traffic

ROUTE = packed_route(0)
STEP_S = 0.02


def driven(
    fmus: Mapping[str, Fmu],
    phase: str,
    traffic: Mapping[str, Any] | None,
    length_m: float = 4000.0,
    **more: Any,
) -> Drive:
    setting = DriveSetting(ROUTE, {"route_id": 0}, traffic=traffic, **more)
    return drive(fmus, values_of(PHASES[phase], setting), length_m, STEP_S)


def test_the_car_ahead_is_seen_by_driver_and_function(traffic_fmus: dict[str, Fmu]) -> None:
    wires = {wire.target: wire.source for wire in connections(traffic_fmus)}
    for part in ("driver", "pldf"):
        for name in ("lead.present", "lead.gap_m", "lead.speed_mps"):
            assert wires[part, name] == ("lead", name)
    assert wires["lead", "vehicle.s_m"] == ("vehicle", "s_m")
    assert wires["lead", "vehicle.speed_mps"] == ("vehicle", "speed_mps")


def test_a_car_that_never_comes_changes_nothing(
    traffic_fmus: dict[str, Fmu], fmus: dict[str, Fmu]
) -> None:
    alone = driven(fmus, "A1", None, 600.0).recording
    late = {"kind": 0, "scene.appear_s": 1e5}
    beside = driven(traffic_fmus, "A1", late, 600.0).recording
    for name in alone.columns:
        np.testing.assert_array_equal(alone[name], beside[name], err_msg=name)


def test_python_and_native_drive_the_same_traffic(
    traffic_fmus: dict[str, Fmu], native_traffic_fmus: dict[str, Fmu]
) -> None:
    busy = {"kind": TRAFFIC, "traffic.free_s": 4.0, "traffic.stop_share": 1.0}
    python, native = (
        driven(found, "A1", busy, 700.0).recording for found in (traffic_fmus, native_traffic_fmus)
    )
    assert python["lead_present"].max() == 1.0
    for name in python.columns:
        np.testing.assert_array_equal(python[name], native[name], err_msg=name)


@pytest.mark.parametrize("number", [0, 1])
def test_shipped_scripts_are_driven_without_contact_and_beyond_their_stops(
    native_traffic_fmus: dict[str, Fmu], number: int
) -> None:
    """By number and by file, which a native FMU gets prepared: the same drive."""
    by_number, by_file = (
        driven(native_traffic_fmus, "A3", {"kind": TRAFFIC_SCRIPT, **script})
        for script in ({"script_id": number}, {"script_file": str(packed_traffic(number))})
    )
    recording = by_number.recording
    assert by_number.arrived
    there = recording["lead_present"] == 1.0
    assert recording["lead_gap_m"][there].min() > 2.0
    assert recording["speed_mps"].min() < 0.1  # it stood behind the car
    for name in recording.columns:
        np.testing.assert_array_equal(recording[name], by_file.recording[name], err_msg=name)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_traffic_that_stops_is_never_touched_and_the_road_is_finished(
    native_traffic_fmus: dict[str, Fmu], seed: int
) -> None:
    busy = {"kind": TRAFFIC, "traffic.free_s": 8.0, "traffic.stop_share": 1.0}
    done = driven(native_traffic_fmus, "A3", busy, seed=seed)
    there = done.recording["lead_present"] == 1.0
    assert done.arrived
    assert np.mean(there) > 0.3
    assert done.recording["lead_gap_m"][there].min() > 1.0
    assert not [message for message in done.messages if "run into" in message.text]


def test_nothing_is_learned_behind_a_car(
    native_traffic_fmus: dict[str, Fmu], tmp_path: Path
) -> None:
    """A1 to B2: a metre at which the car ahead limited ours is learned as it was before."""
    busy = {"kind": TRAFFIC, "traffic.free_s": 12.0}
    limited_and_changed = learned = 0
    for number, phase in enumerate(("A1", "A2", "B1", "B2")):
        store = ProfileStore(str(tmp_path))
        before = store.load(1, fingerprint(ROUTE), ROUTE.nodes)
        done = driven(native_traffic_fmus, phase, busy, seed=3 + number, store=tmp_path)
        assert done.arrived
        after = store.load(1, fingerprint(ROUTE), ROUTE.nodes)
        if after is None or (before is not None and after.iterations == before.iterations):
            assert phase == "A1"
            continue
        base = after.iteration(len(after.iterations) - 1).learned_mps
        changed = np.abs(after.iteration().learned_mps - base) > 1e-9
        recording = done.recording
        limits = recording["following_limits"] == 1.0
        assert limits.any(), phase
        metres = np.unique(np.ceil(recording["s_m"][limits]).astype(int))
        # Only the transition that a lesson beside it needs (section 3.8) may reach behind a car.
        taught = changed & (after.iteration().bound == 0.0)
        limited_and_changed += int(taught[metres[metres < ROUTE.nodes]].sum())
        learned += int(changed.sum())
    assert learned > 100
    assert limited_and_changed == 0
