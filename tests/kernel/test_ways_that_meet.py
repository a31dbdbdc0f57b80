"""Where the car is on ways that pass a place more than once, judged by a search with numpy."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan, pi

import numpy as np
import pytest
from laboratory import Array, function
from pldf.function import DrivingFunction
from pldf.kernel.codes import INPUT_INVALID, INPUT_OK, OFF_ROUTE, POSITION_JUMP, XY
from pldf.roads import Route
from ways import FIGURE_OF_EIGHT, OUT_AND_BACK, ROUND_AND_ROUND, WAYS, Way

CROSSING_M = (100.0, 150.0 + 75.0 * pi + 50.0)  # of the figure of eight: both passes


@dataclass
class Car:
    """A car with coordinates, on a route that knows where it is."""

    made: DrivingFunction

    @classmethod
    def on(cls, route: Route) -> Car:
        """Before its first step."""
        return cls(function(route, localization=XY))

    def at(self, x_m: float, y_m: float, speed_mps: float = 0.0, step_s: float = 0.1) -> float:
        """Take one step there; return where the function takes the car to be."""
        st = self.made.record
        st.vehicle_x_m, st.vehicle_y_m, st.vehicle_speed_mps = x_m, y_m, speed_mps
        self.made.step(step_s)
        return st.s_m

    @property
    def state(self) -> int:
        """What the function says of the inputs."""
        return self.made.record.input_state


def driven(
    way: Way, speed_mps: float, step_s: float, left_m: float, noise_m: float
) -> tuple[Array, Array, Array]:
    """Drive the whole way; return true and found place, and the distance of a search by hand."""
    true_m = np.arange(0.0, way.length_m - 1.0, speed_mps * step_s)
    random = np.random.default_rng(7)
    x, y = (c + noise_m * random.standard_normal(len(c)) for c in way.beside(true_m, left_m))
    car = Car.on(way.route())
    found = np.zeros(len(true_m))
    for i in range(len(true_m)):
        found[i] = car.at(x[i], y[i], speed_mps, step_s)
        assert car.state == INPUT_OK, f"at {true_m[i]} m"
    some = slice(None, None, max(round(1.0 / (speed_mps * step_s)), 1))  # a metre apart
    points = zip(true_m[some], x[some], y[some], strict=True)
    return true_m[some], found[some], np.array([nearest(way, *point) for point in points])


def nearest(way: Way, true_m: float, x_m: float, y_m: float) -> float:
    """Return the nearest place within 4 m of the true one on the exact line, to 5 mm."""
    s_m = np.clip(true_m + np.arange(-4.0, 4.0, 0.005), 0.0, way.length_m)
    x, y, _ = way.pose(s_m)
    return float(s_m[np.argmin(np.hypot(x - x_m, y - y_m))])


@pytest.mark.parametrize(("speed_mps", "step_s"), [(8.0, 0.05), (14.0, 0.1), (50.0, 0.1)])
@pytest.mark.parametrize("left_m", [0.0, -1.75, 1.5])
@pytest.mark.parametrize("name", WAYS)
def test_the_car_is_found_on_every_pass(
    name: str, left_m: float, speed_mps: float, step_s: float
) -> None:
    way = WAYS[name]
    if name == "mini roundabout" and left_m > 0.0:
        left_m = 0.5  # else it would turn round the middle of a circle of 3 m
    true_m, found, by_hand = driven(way, speed_mps, step_s, left_m, 0.0)
    assert np.abs(found - by_hand).max() < 0.3  # the line is one of chords of a metre
    assert np.abs(by_hand - true_m).max() < 0.01
    _, found, by_hand = driven(way, speed_mps, step_s, left_m, 0.3)
    assert np.abs(found - by_hand).max() < 1.0


@pytest.mark.parametrize("before_m", [5.0, 1.0, 0.0, -1.0, -5.0])
@pytest.mark.parametrize("left_m", [0.0, -1.75, 1.75])
def test_a_drive_begins_at_the_start_even_where_the_way_ends(
    before_m: float, left_m: float
) -> None:
    """On a circle that is driven three times; also with the car a little before the start."""
    way = ROUND_AND_ROUND
    x, y = way.beside(np.array([2.0 * pi * 60.0 - before_m]), left_m)
    car = Car.on(way.route())
    assert car.at(x[0], y[0]) == pytest.approx(max(-before_m, 0.0), abs=0.3)
    assert car.state == INPUT_OK


def test_elsewhere_it_begins_in_the_earliest_pass_that_it_cannot_be_told_from() -> None:
    for s_m, expected in ((CROSSING_M[1], CROSSING_M[0]), (CROSSING_M[1] + 20.0, None)):
        x, y = FIGURE_OF_EIGHT.beside(np.array([s_m]), -1.0)
        car = Car.on(FIGURE_OF_EIGHT.route())
        assert car.at(x[0], y[0]) == pytest.approx(expected or s_m, abs=1.5)


def test_a_parallel_carriageway_is_another_place() -> None:
    for s_m in (150.0, 450.0):
        x, y = OUT_AND_BACK.beside(np.array([s_m]), -1.0)
        assert Car.on(OUT_AND_BACK.route()).at(x[0], y[0]) == pytest.approx(s_m, abs=0.5)


def test_a_wrong_guess_is_told_and_mended() -> None:
    """A car that starts where two passes cross, and drives the later one."""
    car = Car.on(FIGURE_OF_EIGHT.route())
    states = []
    for s_m in np.arange(CROSSING_M[1], CROSSING_M[1] + 90.0, 1.0):
        x, y = FIGURE_OF_EIGHT.beside(np.array([s_m]), 0.0)
        found = car.at(x[0], y[0], 10.0)
        states.append(car.state)
    assert states.index(OFF_ROUTE) < states.index(POSITION_JUMP)
    assert found == pytest.approx(s_m, abs=0.1)
    assert car.state == INPUT_OK


@pytest.mark.parametrize("crossing_m", CROSSING_M)
@pytest.mark.parametrize("gap_s", [0.0, 2.0, 30.0])
def test_who_stands_at_the_crossing_stays_in_the_pass(crossing_m: float, gap_s: float) -> None:
    """With noise of the position, also after a hole in which no position was known."""
    car = Car.on(FIGURE_OF_EIGHT.route())
    for s_m in np.arange(0.0, crossing_m, 1.5):
        x, y = FIGURE_OF_EIGHT.beside(np.array([s_m]), 0.0)
        car.at(x[0], y[0], 15.0)
    x, y = FIGURE_OF_EIGHT.beside(np.array([crossing_m]), 0.0)
    random = np.random.default_rng(3)
    for _ in range(round(gap_s / 0.1)):
        car.at(nan, y[0])
        assert car.state == INPUT_INVALID
    for _ in range(100):
        dx, dy = 0.5 * random.standard_normal(2)
        assert car.at(x[0] + dx, y[0] + dy) == pytest.approx(crossing_m, abs=2.5)
        assert car.state == INPUT_OK


@pytest.mark.parametrize("crossing_m", CROSSING_M)
def test_who_drives_over_the_crossing_without_a_position_is_found_behind_it(
    crossing_m: float,
) -> None:
    car = Car.on(FIGURE_OF_EIGHT.route())
    for s_m in np.arange(0.0, crossing_m + 60.0, 1.5):
        hole = crossing_m - 20.0 < s_m < crossing_m + 5.0
        x, y = FIGURE_OF_EIGHT.beside(np.array([s_m]), 0.0)
        found = car.at(nan if hole else x[0], y[0], 15.0)
        assert hole or (car.state == INPUT_OK and found == pytest.approx(s_m, abs=0.1))


@pytest.mark.parametrize("across_m", [5.0, 10.0, 13.0])
@pytest.mark.parametrize("share", [0.0, 0.3, 0.5, 1.0])
def test_where_the_line_jumps_sideways_the_car_is_where_it_drives(
    across_m: float, share: float
) -> None:
    """It drives straight on, between the two lines or along one of them."""
    s_m = np.arange(0.0, 301.0)
    y = np.where(s_m <= 150.0, 0.0, across_m)
    flat = np.zeros(len(s_m))
    car = Car.on(Route("jump", s_m, flat, flat + 20.0, flat, s_m, y))
    for x_m in np.arange(0.0, 300.0, 1.4):
        found = car.at(x_m, share * across_m, 14.0)
        if car.state == INPUT_OK:  # else it is further away than control.route_tolerance_m
            assert found == pytest.approx(x_m, abs=1.0)
        else:
            assert abs(y[round(x_m)] - share * across_m) > 7.0


def test_the_ends_of_the_way() -> None:
    car = Car.on(OUT_AND_BACK.route())
    assert (car.at(-6.9, 0.0), car.state) == (0.0, INPUT_OK)
    car = Car.on(OUT_AND_BACK.route())
    car.at(-7.1, 0.0)
    assert car.state == OFF_ROUTE
    length_m = OUT_AND_BACK.length_m
    for s_m in np.arange(0.0, length_m, 2.0):
        x, y = OUT_AND_BACK.beside(np.array([s_m]), 0.0)
        car.at(x[0], y[0], 20.0)
    assert car.at(-6.0, 7.0, 20.0) == np.floor(length_m)
    assert car.state == INPUT_OK
    car.at(-8.0, 7.0, 20.0)
    assert car.state == OFF_ROUTE
