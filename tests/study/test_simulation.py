"""Simulated participants in process equal the FMUs, and each other, to the bit."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Mapping
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from pldf.cosim.fmu import Fmu
from pldf.cosim.master import connections
from pldf.errors import ModelError
from pldf.recordings.columns import COLUMNS
from pldf.recordings.interventions import rates_of
from pldf.roads import open_road, route_arrays
from pldf.study import loop
from pldf.study.participants import (
    DRIVER_SIGNALS,
    DriveResult,
    Participant,
    StudySettings,
    order_of,
)
from pldf.study.phases import PHASES, seed_of_drive
from pldf.study.simulation import prepared, simulate_participant
from pldf.study.through_fmus import drive_participant

from vehicle_models.driver import ScriptedDriver

BOLD = Participant(
    "P001",
    42,
    {"wish_offset_mps": 3.6, "wish_lateral_accel_max_mps2": 3.4, "driver_threshold_mps": 0.9},
)
CAREFUL = Participant(
    "P002", 999_999_999, {"wish_offset_mps": -2.5, "wish_lateral_accel_max_mps2": 1.9,
                          "driver_uses_lever": 0},
)  # fmt: skip
VARIES = {
    "wish_offset_person_sd_mps": 1.0, "wish_offset_place_sd_mps": 0.8,
    "wish_offset_occasion_sd_mps": 0.6, "wish_lateral_person_sigma": 0.2,
    "wish_lateral_place_sigma": 0.1, "wish_lateral_occasion_sigma": 0.1,
}  # fmt: skip
CHANGING = replace(CAREFUL, values={**CAREFUL.values, **VARIES})


def settings(*phases: str, recorded: tuple[str, ...] = (), step_s: float = 0.01) -> StudySettings:
    return StudySettings(
        road=open_road("study"),
        phases=tuple(PHASES[name] for name in phases or PHASES),
        step_s=step_s,
        recorded=frozenset(recorded),
    )


@cache
def bold_study() -> tuple[DriveResult, ...]:
    return simulate_participant(settings(recorded=("P001",)), BOLD)


def assert_same(one: tuple[DriveResult, ...], other: tuple[DriveResult, ...]) -> None:
    assert [drive.row for drive in one] == [drive.row for drive in other]
    for a, b in zip(one, other, strict=True):
        assert a.recording is not None
        assert b.recording is not None
        for name in COLUMNS:
            assert a.recording[name].tobytes() == b.recording[name].tobytes(), name
        assert (a.iteration is None) == (b.iteration is None)
        if a.iteration is not None and b.iteration is not None:
            for name in ("number", "note", "interventions"):
                assert getattr(a.iteration, name) == getattr(b.iteration, name)
            for name in ("learned_mps", "offset_mps", "drive", "intervention"):
                assert getattr(a.iteration, name).tobytes() == getattr(b.iteration, name).tobytes()


@pytest.mark.parametrize(
    ("participant", "phases", "step_s"),
    [(BOLD, ("A2", "B1"), 0.01), (CHANGING, ("A2", "A3", "B1", "B2"), 0.05)],
)
def test_the_fmus_give_the_same_to_the_bit(
    fmus: dict[str, Fmu], participant: Participant, phases: tuple[str, ...], step_s: float
) -> None:
    chosen = settings(*phases, recorded=(participant.id,), step_s=step_s)
    chosen = replace(
        chosen,
        function={"learning.stretch_factor": 0.6},
        vehicle={"body.mass_kg": 1900.0},
        threshold_growth_per_drive=0.3,
    )
    in_process = simulate_participant(chosen, participant)
    assert_same(in_process, drive_participant(fmus, chosen, participant, lambda _: None))
    assert in_process[0].row.interventions > 0
    assert in_process[-1].row.wish_error_mps < in_process[0].row.wish_error_mps
    varied = [drive.row.drive_wish_error_mps != drive.row.wish_error_mps for drive in in_process]
    assert varied == [participant is CHANGING] * len(phases)


def test_drives_wish_is_what_the_driver_model_plans_from_both_seeds() -> None:
    simulation = prepared(settings())
    person = simulation.person(CHANGING)
    planned = ScriptedDriver()
    for name, value in CHANGING.values.items():
        setattr(planned.record, name, value)
    planned.record.person_seed = CHANGING.seed
    planned.record.driver_uses_lever = 0
    for number, seed in enumerate((999_999_999, 0, 1)):
        planned.record.seed = seed
        planned.initialize()
        of_drive = simulation.wish_of_drive(person, number)
        for ours, theirs in zip(of_drive, planned.arrays, strict=False):
            assert np.asarray(ours).tobytes() == np.asarray(theirs).tobytes()
    # The lasting wish is that of a drive without an occasion, whichever drive it is.
    planned.record.wish_offset_occasion_sd_mps = planned.record.wish_lateral_occasion_sigma = 0.0
    planned.initialize()
    assert np.asarray(person.wish.wish_mps).tobytes() == np.asarray(planned.arrays[0]).tobytes()


def test_the_loop_is_wired_as_the_fmus_are(fmus: Mapping[str, Fmu]) -> None:
    assigned = {
        (ast.unparse(node.targets[0]), ast.unparse(node.value))
        for name in ("_exchange", "_show_vehicle_to_driver", "_show_to_function")
        for node in ast.walk(ast.parse(inspect.getsource(getattr(loop, name))))
        if isinstance(node, ast.Assign)
    }
    wired = {
        tuple(f"{part}.{name.replace('.', '_')}" for part, name in (wire.target, wire.source))
        for wire in connections(fmus)
    }
    # Simulated people never press these; a script's presses are answered by the FMUs alone.
    words = {wire for wire in wired if wire[0].startswith("pldf.teach_")}
    assert len(words) == 3
    assert assigned == wired - words


def test_a_drive_is_the_same_whether_it_is_recorded_or_not() -> None:
    unrecorded = simulate_participant(settings(), BOLD)
    assert [drive.row for drive in unrecorded] == [drive.row for drive in bold_study()]
    assert all(drive.recording is None for drive in unrecorded)


def test_rates_are_those_of_the_recording() -> None:
    for drive in bold_study():
        assert drive.recording is not None
        seen = rates_of(drive.recording)
        told = (drive.row.pedal_rate, drive.row.set_speed_rate, drive.row.combined_rate)
        assert seen == pytest.approx(told, abs=1e-3)
        assert drive.row.duration_s == drive.recording["time_s"][-1]


def test_learning_happens_after_the_drives_that_learn() -> None:
    assert [drive.iteration.number if drive.iteration else 0 for drive in bold_study()] == [
        0, 1, 0, 2, 3, 0,
    ]  # fmt: skip
    base, *_ = bold_study()
    errors = [drive.row.wish_error_mps for drive in bold_study()]
    assert errors[:3] == [base.row.wish_error_mps] * 3
    assert errors[3] > errors[4] > 0.0
    assert errors[3] < 0.8 * errors[0]


def test_a_wish_like_the_function_has_no_error() -> None:
    planner = prepared(settings()).function.record
    same = Participant(
        "P001",
        1,
        {
            "wish_offset_mps": 0.0,
            "wish_lateral_accel_max_mps2": planner.planner_lateral_accel_max_mps2,
            "wish_accel_max_mps2": planner.planner_accel_max_mps2,
            "wish_accel_min_mps2": planner.planner_accel_min_mps2,
            "wish_anticipation_s": 0.0,
        },
    )
    (drive,) = simulate_participant(settings("A1", step_s=0.05), same)
    assert drive.row.wish_error_mps < 1e-12
    assert (drive.row.interventions, drive.row.combined_rate) == (0, 0.0)


def test_an_even_participant_drives_b_first_when_counterbalanced() -> None:
    chosen = replace(settings(), counterbalanced=True)
    names = {
        person.id: [phase.name for phase in order_of(chosen, person)] for person in (BOLD, CAREFUL)
    }
    assert names == {
        "P001": ["A1", "A2", "A3", "B1", "B2", "B3"],
        "P002": ["A2", "B1", "B2", "B3", "A1", "A3"],
    }
    assert [p.name for p in order_of(settings(), CAREFUL)] == list(PHASES)


def test_the_threshold_of_who_gets_used_to_it_grows_by_a_share_per_drive() -> None:
    drives = ("A1", "A2", "A3")
    grown = simulate_participant(replace(settings(*drives), threshold_growth_per_drive=0.5), BOLD)
    for number, threshold in enumerate((0.9, 0.9 * 1.5, 0.9 * 1.5 * 1.5)):
        alike = replace(BOLD, values={**BOLD.values, "driver_threshold_mps": threshold})
        assert grown[number].row == simulate_participant(settings(*drives), alike)[number].row
    assert grown[1].row.interventions < grown[0].row.interventions


def test_who_drives_b_before_a_is_used_to_it_in_a() -> None:
    both = replace(settings("A1", "A2", "B1"), counterbalanced=True, threshold_growth_per_drive=0.5)
    rows = [drive.row for drive in simulate_participant(both, replace(BOLD, id="P002"))]
    assert [row.phase for row in rows] == ["A2", "B1", "A1"]
    grown = {**BOLD.values, "driver_threshold_mps": 0.9 * 1.5 * 1.5}
    alike = simulate_participant(settings("A3", "A3", "A1"), replace(BOLD, id="P002", values=grown))
    assert rows[2] == alike[2].row


def test_seeds_stay_in_the_range_of_the_fmu() -> None:
    assert "seed" not in DRIVER_SIGNALS  # it belongs to the drive, not to the driver
    assert [seed_of_drive(CAREFUL.seed, drive) for drive in range(3)] == [999_999_999, 0, 1]
    assert seed_of_drive(BOLD.seed, 2) == 44


def test_a_parameter_out_of_range_is_named_with_its_participant() -> None:
    wrong = replace(BOLD, values={"driver_reaction_s": 11.0})
    with pytest.raises(ModelError, match=r"participant P001: parameter driver\.reaction_s = 11"):
        simulate_participant(settings(), wrong)


def test_a_drive_that_does_not_arrive_is_an_error() -> None:
    stuck = replace(settings("A1"), vehicle={"body.force_max_n": 1.0, "start_speed_mps": 1.0})
    with pytest.raises(ModelError, match=r"P001, drive A1 was given up: the vehicle stood still"):
        simulate_participant(stuck, BOLD)


def test_the_wish_covers_the_route() -> None:
    person = prepared(settings()).person(BOLD)
    limit = np.asarray(route_arrays(settings().route).limit_mps)
    wish = np.asarray(person.wish.wish_mps)
    assert wish.shape == limit.shape
    assert np.max(wish) == pytest.approx(np.max(limit) + 3.6)
