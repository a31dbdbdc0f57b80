"""Where the car is: what is found again after it had left the route."""

from __future__ import annotations

import pytest
from laboratory import PointMass, function, road
from pldf.kernel.codes import INPUT_OK, OFF_ROUTE, POSITION_JUMP, XY


def beside(away_s: float) -> PointMass:
    """A car that stood still at 500 m and has been away from the road for a while."""
    car = PointMass(function(road(3000.0), localization=XY), speed_mps=0.0)
    car.step(0.1, vehicle_x_m=500.0, vehicle_y_m=0.0)
    assert (car.made.record.input_state, car.made.record.s_m) == (INPUT_OK, 500.0)
    for _ in range(round(away_s / 0.1)):
        car.step(0.1, vehicle_y_m=300.0)
        assert car.made.record.input_state == OFF_ROUTE
    return car


@pytest.mark.parametrize(("away_s", "ahead_m"), [(1.0, 60.0), (1.0, -60.0), (10.0, 800.0)])
def test_the_longer_a_car_was_away_the_further_it_is_looked_for(
    away_s: float, ahead_m: float
) -> None:
    car = beside(away_s)
    car.step(0.1, vehicle_x_m=500.0 + ahead_m, vehicle_y_m=0.0)
    assert car.made.record.input_state == POSITION_JUMP  # it is found, and was not expected there
    assert car.made.record.s_m == pytest.approx(500.0 + ahead_m)


def test_a_car_is_not_looked_for_beyond_what_100_mps_reach() -> None:
    car = beside(1.0)
    car.step(0.1, vehicle_x_m=500.0 + 300.0, vehicle_y_m=0.0)
    assert car.made.record.input_state == OFF_ROUTE
