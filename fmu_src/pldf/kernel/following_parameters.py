"""Every number of following another car (section 8), each with its default and unit."""

from __future__ import annotations

from dataclasses import dataclass

from .signals import real_parameter, since, tunable


@dataclass
class FollowingParameters:
    """Another car ahead, section 8."""

    following_desired_time_gap_s: float = since(
        "0.3",
        tunable(
            real_parameter("Time gap kept behind a lead car", "s", start=1.8, low=0.8, high=3.0)
        ),
    )
    following_standstill_gap_m: float = since(
        "0.3",
        tunable(
            real_parameter(
                "Gap kept behind a lead car that stands", "m", start=3.0, low=1.0, high=20.0
            )
        ),
    )
    following_gap_gain_per_s: float = since(
        "0.3",
        tunable(real_parameter(
            "How fast a small error of the gap falls, in proportion to it",
            "1/s", start=0.25, low=0.01, high=2.0,
        )),
    )  # fmt: skip
    following_accel_min_mps2: float = since(
        "0.3",
        tunable(real_parameter(
            "Comfortable deceleration behind a lead car, negative; stronger where it has to be",
            "m/s2", start=-1.0, low=-5.0, high=-0.1,
        )),
    )  # fmt: skip
    following_lead_accel_min_mps2: float = since(
        "0.3",
        tunable(real_parameter(
            "Braking of the lead car up to which no contact is promised, negative",
            "m/s2", start=-3.5, low=-12.0, high=-0.5,
        )),
    )  # fmt: skip
    following_vehicle_lag_s: float = since(
        "0.3",
        tunable(real_parameter(
            "Time constant with which the vehicle follows a request to brake",
            "s", start=0.2, low=0.0, high=2.0,
        )),
    )  # fmt: skip
    following_restart_s: float = since(
        "0.3",
        tunable(real_parameter(
            "Standing no longer than this, the car follows by itself; later on RESUME or gas",
            "s", start=3.0, low=0.0, high=600.0,
        )),
    )  # fmt: skip
    following_lost_s: float = since(
        "0.3",
        tunable(real_parameter(
            "A lead car that is lost counts this much longer, as if its speed stayed",
            "s", start=0.6, low=0.0, high=5.0,
        )),
    )  # fmt: skip
    following_limits_s: float = since(
        "0.3",
        tunable(real_parameter(
            "The lead car counts as limiting for so long after following asked for less than the "
            "profile",
            "s", start=1.0, low=0.0, high=10.0,
        )),
    )  # fmt: skip
