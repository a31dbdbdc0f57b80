"""Rates and learning in traffic (section 8), counted a second time from what was seen per step."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import KMH, PointMass, assert_sound, driving, road
from pldf.kernel.codes import GAS_OVERRIDE

STEP_S = 0.05
ROAD = road(3000.0, [(0.0, 80.0 * KMH), (1500.0, 60.0 * KMH)])


class Traffic:
    """A car ahead that comes, brakes, goes on and leaves."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng, self.gap_m, self.speed_mps, self.there = rng, 0.0, 0.0, False

    def inputs(self, ego_mps: float) -> dict[str, float]:
        """Return what the function sees of it in the next step."""
        if self.rng.random() < 0.15 * STEP_S:
            self.there = not self.there
            self.gap_m = self.rng.uniform(15.0, 60.0)
            self.speed_mps = max(ego_mps + self.rng.uniform(-6.0, 3.0), 0.0)
        wish = 8.0 + 6.0 * np.sin(0.05 * self.gap_m)
        self.speed_mps += STEP_S * float(np.clip(wish - self.speed_mps, -2.0, 1.0))
        self.gap_m += STEP_S * (self.speed_mps - ego_mps)
        self.there &= self.gap_m > 1.0
        if not self.there:
            return {"lead_present": 0}
        return {"lead_present": 1, "lead_gap_m": self.gap_m, "lead_speed_mps": self.speed_mps}


def drive(rng: np.random.Generator, car: PointMass) -> np.ndarray:
    """Drive with gas now and then; return per step time in s, limited by a car, gas override."""
    traffic, rows, gas_s = Traffic(rng), [], 0.0
    st = car.made.record
    while car.s_m < 2900.0:
        gas_s -= STEP_S
        if gas_s < -1.0 and rng.random() < 0.1 * STEP_S:  # sooner it would be pedal bounce
            gas_s = rng.uniform(1.0, 6.0)
        car.step(STEP_S, driver_gas_pedal=0.3 * (gas_s > 0.0), **traffic.inputs(car.speed_mps))
        # Time is charged from sample to sample, to what was in force at the first of them.
        rows.append((1e-9 * st.previous_ns, st.following_limits, st.mode == GAS_OVERRIDE))
    return np.array(rows, dtype=float)


@pytest.mark.parametrize("seed", range(3))
def test_time_behind_a_car_counts_neither_above_nor_below(seed: int) -> None:
    car = driving(ROAD, learn=1)
    seen = drive(np.random.default_rng(seed), car)
    passed = np.diff(seen[:, 0])
    limited, gas = seen[:-1, 1] > 0.0, seen[:-1, 2] > 0.0
    assert limited.any() and (gas & ~limited).any() and (gas & limited).any()
    # The tip that activates the function comes before what was seen.
    before_s = seen[0, 0]
    expected = passed[gas & ~limited].sum() / (before_s + passed[~limited].sum())
    assert car.made.record.rate_pedal == pytest.approx(expected, abs=0.002)


@pytest.mark.parametrize("seed", range(3))
def test_nothing_is_learned_where_a_car_limits(seed: int) -> None:
    car = driving(ROAD, learn=1)
    made, rng = car.made, np.random.default_rng(100 + seed)
    followed = np.array(made.profile.learned_mps)
    limited = np.zeros(len(followed), dtype=bool)
    traffic, gas_s = Traffic(rng), 0.0
    while car.s_m < 2900.0:
        gas_s -= STEP_S
        if gas_s < -1.0 and rng.random() < 0.2 * STEP_S:
            gas_s = rng.uniform(1.0, 6.0)
        before = car.s_m
        car.step(STEP_S, driver_gas_pedal=0.3 * (gas_s > 0.0), **traffic.inputs(car.speed_mps))
        if made.record.following_limits:
            limited[int(before) + 1 : int(car.s_m) + 1] = True
    pieces = [
        (int(made.trace.start_m[k]), int(made.trace.end_m[k]))
        for k in range(made.record.drive_interventions)
    ]
    learned = made.learn().learned_mps
    taught = learned != followed
    assert limited.any()
    for begin, end in pieces:
        near = any(0 < abs(a - begin) < 300 + end - begin for a, _ in pieces)
        # With it the whole intervention is no wish; a neighbour's lesson may fade into it.
        if limited[begin : end + 1].any() and not near:
            assert not taught[begin + 1 : end].any(), (begin, end)
    assert taught.any() == any(not limited[a : b + 1].any() for a, b in pieces)


def test_a_temporary_limit_is_driven_and_never_learned_from() -> None:
    car = driving(ROAD, learn=1)
    made = car.made
    followed = np.array(made.profile.learned_mps)
    fastest = 0.0
    while car.s_m < 1400.0:
        inside = 400.0 <= car.s_m < 1000.0
        gas = 0.4 if 700.0 <= car.s_m < 800.0 or 1200.0 <= car.s_m < 1300.0 else 0.0
        car.step(STEP_S, driver_gas_pedal=gas, limit_override_mps=50.0 * KMH if inside else 0.0)
        if 600.0 <= car.s_m < 695.0:
            fastest = max(fastest, car.speed_mps)
    assert fastest <= 50.5 * KMH
    learned = made.learn().learned_mps
    np.testing.assert_array_equal(learned[450:950], followed[450:950])
    assert np.all(learned[1220:1280] > followed[1220:1280])


@pytest.mark.parametrize("speed_mps", [0.0, 1e-300, 5.0])
@pytest.mark.parametrize("lead_mps", [0.0, 12.0])
def test_a_car_that_touches_the_one_ahead_goes_on_telling_numbers(
    speed_mps: float, lead_mps: float
) -> None:
    car = driving(ROAD)
    car.speed_mps = speed_mps
    car.step(STEP_S, lead_present=1, lead_gap_m=-0.5, lead_speed_mps=lead_mps)
    assert_sound(car.made)
    assert car.made.record.hmi_take_over
