"""A1 to B2 with traffic: behind a car ahead nothing is learned, before and after it is."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from laboratory import Array, PointMass, after, function, outcomes
from pldf.function import DrivingFunction
from pldf.kernel.codes import LEARN_FAITHFUL, LEARN_OFF, OUTCOME_FOLLOWING, OUTCOME_LEARNED
from pldf.profiles.stored_profile import StoredProfile
from pldf.roads import packed_route

from vehicle_models.lead import LeadVehicle

STEP_S = 0.05
ROUTE = packed_route(0)
# apply_learned, learn
PHASES = {"A1": (0, LEARN_OFF), "A2": (0, LEARN_FAITHFUL), "B1": (1, LEARN_FAITHFUL),
          "B2": (1, LEARN_FAITHFUL)}  # fmt: skip
GAS = [(s, s + 60.0) for s in np.arange(250.0, 4300.0, 270.0)]


class Driven(NamedTuple):
    """One drive: the function at its end, and per node whether a lead limited there."""

    made: DrivingFunction
    limited: Array
    behind_lead: set[int]  # numbers of the interventions during which one did
    shares: tuple[float, float]  # pedal and combined rate, recounted


def drive(phase: str, seed: int, stored: StoredProfile | None) -> Driven:
    """Drive the study road behind whoever comes, with gas at the same places every time."""
    applied, learn = PHASES[phase]
    made = function(ROUTE, stored, apply_learned=applied, learn=learn)
    traffic = LeadVehicle()
    traffic.record.seed, traffic.record.traffic_stop_share = seed, 0.2
    traffic.initialize()
    car = PointMass(made, made.profile.learned_mps[0], 0.2)
    st = made.record
    limited = np.zeros(len(made.profile.base_mps))
    behind_lead: set[int] = set()
    counted = pedal = 0
    car.step(STEP_S, lever_resume=1)
    steps = 0
    while car.s_m < len(limited) - 20.0:
        steps += 1
        assert steps < 20_000, f"stands at {car.s_m:.0f} m"
        resume = int(st.standing and steps % 40 < 5)  # the driver goes on behind a longer stop
        gas = any(a <= car.s_m < b for a, b in GAS)
        was_limited, intervening = st.following_limits, st.intervening
        counted += 1 - was_limited
        pedal += (1 - was_limited) * intervening
        first = int(car.s_m)
        seen = {name: getattr(traffic.record, name) for name in
                ("lead_present", "lead_gap_m", "lead_speed_mps")}  # fmt: skip
        car.step(STEP_S, lever_resume=resume, driver_gas_pedal=0.25 * gas, **seen)
        traffic.record.vehicle_s_m, traffic.record.vehicle_speed_mps = car.s_m, car.speed_mps
        traffic.step(STEP_S)
        if was_limited:
            limited[first + 1 : int(car.s_m) + 1] = 1.0
            if st.intervening:
                behind_lead.add(st.drive_interventions)
    return Driven(made, limited, behind_lead, (pedal / counted, st.rate_pedal))


@pytest.mark.parametrize("seed", [1, 5])
def test_nothing_is_learned_behind_a_lead_from_a1_to_b2(seed: int) -> None:
    stored: StoredProfile | None = None
    learned_free = barred = 0
    for number, phase in enumerate(PHASES):
        driven = drive(phase, 10 * seed + number, stored)
        made = driven.made
        assert driven.shares[0] == pytest.approx(driven.shares[1], abs=0.002)
        if phase == "A1":
            continue
        iteration = made.learn()
        became = outcomes(made)
        for k in range(made.record.drive_interventions):
            if k + 1 in driven.behind_lead:
                assert became[k] == OUTCOME_FOLLOWING
                barred += 1
        taught = iteration.drive == made.record.profile_iteration + 1
        assert not np.any(taught & np.isin(iteration.intervention, [*driven.behind_lead]))
        change = np.abs(iteration.learned_mps - np.array(made.profile.learned_mps))
        # Only the transition that a lesson beside it needs (section 3.8) may reach behind a lead.
        transition = iteration.bound > 0.0
        # A node gets what holds at the sample behind it; so the first and last ones are left out.
        inside = np.minimum(np.roll(driven.limited, 2), np.roll(driven.limited, -2)) > 0.0
        assert not np.any(change[inside & ~transition] > 0.0)
        learned_free += int(np.sum(became == OUTCOME_LEARNED))
        stored = after(made, iteration)
    assert learned_free > 5
    assert barred > 3
