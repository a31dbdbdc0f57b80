"""A road of 3 km read in two ways, a third one, and a driver who drives them."""

from __future__ import annotations

from laboratory import KMH, Array, bent, function, play_override, road
from pldf.function import DrivingFunction
from pldf.profiles.stored_profile import StoredProfile
from pldf.roads import Route

LIMITS = ((0.0, 100.0 * KMH), (800.0, 70.0 * KMH), (1300.0, 100.0 * KMH), (2200.0, 50.0 * KMH))
CURVE = (400.0, 480.0, 1.0 / 80.0)
FAST = 100.0 * KMH
GAS = ((500.0, 600.0), (950.0, 1100.0), (2400.0, 2500.0))
# Metre and m/s: faster out of the curve, in the 70 and in the 50.
PLACES = (
    *((0, 27.0), (480, 17.0), (520, 24.0), (610, 26.4), (800, 19.5), (940, 19.5), (960, 23.6)),
    *((1100, 23.6), (1120, 19.5), (1300, 19.5), (1500, 27.7), (2200, 13.9), (2390, 13.9)),
    *((2410, 16.7), (2500, 16.7), (2520, 13.9), (3000, 13.9)),
)


def older_reading() -> Route:
    """The road as an older release read it."""
    return road(3000.0, LIMITS, [CURVE])


def newer_reading(length_m: float = 3000.0) -> Route:
    """A newer one finds a bend of 60 m radius at 1600 m, where there was none."""
    return road(length_m, LIMITS, [CURVE, (1600.0, 1660.0, 1.0 / 60.0)])


def other_road() -> Route:
    """A road as long, with limits and curves of its own."""
    limits = ((0.0, 50.0 * KMH), (600.0, 100.0 * KMH), (1500.0, 70.0 * KMH), (2500.0, FAST))
    return road(3000.0, limits, [(900.0, 950.0, 1.0 / 120.0)])


def wished(s_m: Array) -> Array:
    """The driver's speed: 95 km/h in the curve's exit, 85 in the 70, 60 in the 50."""
    return bent(*PLACES)(s_m)


def lesson(
    route: Route, stored: StoredProfile | None = None, gas: tuple[tuple[float, float], ...] = GAS
) -> tuple[DrivingFunction, StoredProfile]:
    """Drive once with the gas at some places and learn; what is stored then."""
    made = function(route, stored, apply_learned=1)
    play_override(made, wished, gas=gas)
    iteration = made.learn()
    assert made.stored is not None
    return made, made.stored.with_iteration(iteration)
