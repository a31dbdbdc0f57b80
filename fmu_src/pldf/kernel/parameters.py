"""Every number of the algorithm, each with its default and unit.

One class per section of the algorithm; ``state`` puts them into the flat record.
"""

from __future__ import annotations

from dataclasses import dataclass

from .codes import (
    ARC_LENGTH,
    LANGUAGE,
    LANGUAGE_EN,
    LEARN,
    LEARN_OFF,
    LOCALIZATION,
    STRETCH,
    STRETCH_RECORDED,
    UNIT,
    UNIT_KMH,
)
from .signals import (
    choice_parameter,
    count_parameter,
    flag_parameter,
    real_parameter,
    since,
    tunable,
)
from .units import MPS_PER_KMH


@dataclass
class GeneralParameters:
    """Which route, which driver, which phase of a study."""

    route_id: int = count_parameter(
        "Index of the packed route, 0 = the shipped study road", start=0, low=0, high=999
    )
    driver_id: int = count_parameter(
        "Driver whose profile is used", start=0, low=0, high=999_999_999, name="driver_id"
    )
    apply_learned: int = flag_parameter("Drive the learned profile (else the base)", start=True)
    learn: int = choice_parameter("What is learned when the drive ends", LEARN, start=LEARN_OFF)
    learn_faithful: int = flag_parameter(
        "Learn as with learn = FAITHFUL, for importers that cannot set enumerations", start=False
    )
    learn_consistent: int = since(
        "0.3",
        flag_parameter(
            "Learn as with learn = CONSISTENT, for importers that cannot set enumerations; before "
            "learn_faithful",
            start=False,
        ),
    )
    localization: int = choice_parameter(
        "Position from vehicle.s_m or from vehicle.x_m and vehicle.y_m",
        LOCALIZATION,
        start=ARC_LENGTH,
    )
    main_switch: int = flag_parameter("Function switched on (else mode OFF)", start=True)


@dataclass
class PlannerParameters:
    """Base profile, section 1."""

    planner_lateral_accel_max_mps2: float = real_parameter(
        "Lateral acceleration that limits the speed in curves",
        "m/s2", start=2.5, low=0.1, high=10.0,
    )  # fmt: skip
    planner_accel_max_mps2: float = real_parameter(
        "Strongest planned acceleration", "m/s2", start=1.2, low=0.1, high=5.0
    )
    planner_accel_min_mps2: float = real_parameter(
        "Strongest planned deceleration, negative", "m/s2", start=-1.0, low=-10.0, high=-0.1
    )
    planner_jerk_max_mps3: float = real_parameter(
        "Largest planned jerk; 0 = not limited", "m/s3", start=1.0, low=0.0, high=50.0
    )


@dataclass
class ControlParameters:
    """Modes, lever and tracking, section 2."""

    control_request_max_mps2: float = real_parameter(
        "Largest acceleration request (ISO 15622)", "m/s2", start=2.0, low=0.1, high=5.0
    )
    control_request_min_mps2: float = real_parameter(
        "Smallest acceleration request (ISO 15622)", "m/s2", start=-3.5, low=-10.0, high=-0.1
    )
    control_request_jerk_max_mps3: float = real_parameter(
        "Largest change of the request per second (ISO 15622)",
        "m/s3", start=2.5, low=0.1, high=50.0,
    )  # fmt: skip
    control_recovery_accel_max_mps2: float = real_parameter(
        "Comfortable acceleration back to the profile", "m/s2", start=1.2, low=0.1, high=5.0
    )
    control_recovery_accel_min_mps2: float = real_parameter(
        "Comfortable deceleration back to the profile, negative",
        "m/s2", start=-1.0, low=-10.0, high=-0.1,
    )  # fmt: skip
    control_speed_gain_per_s: float = real_parameter(
        "Acceleration requested per speed error", "1/s", start=0.6, low=0.01, high=10.0
    )
    control_preview_s: float = real_parameter(
        "Look-ahead that makes up for the vehicle's delay", "s", start=0.3, low=0.0, high=3.0
    )
    control_pedal_threshold: float = real_parameter(
        "Pedal travel from which a pedal counts as pressed", "", start=0.02, low=0.0, high=0.5
    )
    control_tip_short_mps: float = tunable(
        real_parameter(
            "Set-speed change by a short tip", "m/s", start=MPS_PER_KMH, low=0.0, high=20.0
        )
    )
    control_tip_long_mps: float = tunable(
        real_parameter(
            "Set-speed change by a long tip", "m/s", start=5.0 * MPS_PER_KMH, low=0.0, high=20.0
        )
    )
    control_set_speed_min_mps: float = real_parameter(
        "Lowest manual set speed", "m/s", start=20.0 * MPS_PER_KMH, low=1.0, high=100.0
    )
    control_set_speed_max_mps: float = real_parameter(
        "Highest manual set speed", "m/s", start=180.0 * MPS_PER_KMH, low=1.0, high=100.0
    )
    control_lever_bounce_s: float = real_parameter(
        "Lever contacts that close this soon after another are chatter",
        "s",
        start=0.05,
        low=0.0,
        high=1.0,
    )
    control_route_tolerance_m: float = real_parameter(
        "Distance from the route's line beyond which the function is inactive",
        "m", start=7.0, low=0.5, high=100.0,
    )  # fmt: skip
    control_position_jump_max_m: float = real_parameter(
        "Change of position, beyond the distance driven, that counts as a jump",
        "m", start=20.0, low=1.0, high=1000.0,
    )  # fmt: skip
    control_fault_hold_s: float = real_parameter(
        "Time with valid inputs after which FAULT ends in STANDBY",
        "s", start=1.0, low=0.0, high=60.0,
    )  # fmt: skip


@dataclass
class LearningParameters:
    """Interventions and learning, sections 2 to 4."""

    learning_pedal_gap_s: float = real_parameter(
        "Gap between pedal interventions below which they merge",
        "s", start=0.3, low=0.0, high=10.0,
    )  # fmt: skip
    learning_stretch_factor: float = real_parameter(
        "Stretch factor alpha of eq. (1)", "", start=0.5, low=0.0, high=5.0
    )
    learning_stretch_time_s: float = real_parameter(
        "Longest travel time that stretching reaches back", "s", start=3.0, low=0.0, high=30.0
    )
    learning_stretch_time_mode: int = choice_parameter(
        "Travel taken from the recording, or as time times the first speed",
        STRETCH,
        start=STRETCH_RECORDED,
    )
    learning_stretch_curvature_low_per_m: float = real_parameter(
        "Curvature up to which stretching is not reduced",
        "1/m", start=0.004, low=0.0, high=1.0,
    )  # fmt: skip
    learning_stretch_curvature_high_per_m: float = real_parameter(
        "Curvature from which nothing is stretched", "1/m", start=0.016, low=0.0, high=1.0
    )
    learning_deviation_min_mps: float = real_parameter(
        "Deviation from the profile that is learned", "m/s", start=MPS_PER_KMH, low=0.0, high=20.0
    )
    learning_segment_gap_s: float = real_parameter(
        "Gap between learned runs below which they merge", "s", start=1.0, low=0.0, high=30.0
    )
    learning_recording_gap_s: float = real_parameter(
        "Hole in the recording that costs what overlaps it", "s", start=1.5, low=0.01, high=60.0
    )
    learning_speed_min_mps: float = real_parameter(
        "Speed below which nothing is learned", "m/s", start=10.0 * MPS_PER_KMH, low=1.0, high=50.0
    )
    learning_weight: float = real_parameter(
        "Weight of the driver against the profile in the mean of eq. (3)",
        "", start=0.5, low=0.0, high=1.0,
    )  # fmt: skip
    learning_smoothing_window_m: int = count_parameter(
        "Length of the Savitzky-Golay window in metres, odd", start=51, low=1, high=501
    )
    learning_fade_m: int = count_parameter(
        "Length of the cross-fade at each end of a learned segment", start=10, low=1, high=501
    )
    learning_offset_new_limit_s: float = real_parameter(
        "Set speed changed this soon after a new limit counts from the limit's sign",
        "s", start=5.0, low=0.0, high=60.0,
    )  # fmt: skip
    learning_offset_settled_s: float = real_parameter(
        "The same, this soon after the car has settled at the new speed",
        "s", start=3.0, low=0.0, high=60.0,
    )  # fmt: skip
    learning_offset_settled_max_s: float = real_parameter(
        "Longest time after the sign that counts as settling",
        "s", start=12.0, low=0.0, high=120.0,
    )  # fmt: skip
    learning_offset_settled_mps: float = real_parameter(
        "Distance from the new speed at which the car counts as settled",
        "m/s",
        start=MPS_PER_KMH,
        low=0.0,
        high=20.0,
    )
    learning_lateral_accel_max_mps2: float = real_parameter(
        "Lateral acceleration never exceeded by a learned profile",
        "m/s2", start=4.0, low=0.1, high=10.0,
    )  # fmt: skip
    learning_over_limit_max_mps: float = real_parameter(
        "How far a learned profile may exceed the legal limit, 0 = not at all",
        "m/s", start=20.0 * MPS_PER_KMH, low=0.0, high=50.0,
    )  # fmt: skip
    learning_accel_max_mps2: float = real_parameter(
        "Strongest acceleration of a learned profile", "m/s2", start=2.0, low=0.1, high=10.0
    )
    learning_accel_min_mps2: float = real_parameter(
        "Strongest deceleration of a learned profile, negative",
        "m/s2", start=-3.0, low=-10.0, high=-0.1,
    )  # fmt: skip
    learning_jerk_max_mps3: float = since(
        "0.3",
        real_parameter(
            "Largest jerk that following a learned profile demands; 0 = not limited",
            "m/s3", start=2.0, low=0.0, high=50.0,
        ),
    )  # fmt: skip
    learning_offset_tolerance_mps: float = since(
        "0.3",
        real_parameter(
            "Offset of the set speed up to which it is rounding of a recording or a display",
            "m/s", start=0.5 * MPS_PER_KMH, low=0.0, high=5.0,
        ),
    )  # fmt: skip
    learning_offset_series_s: float = since(
        "0.3",
        real_parameter(
            "Presses of the lever at most this far apart are one series: one wish",
            "s", start=5.0, low=0.0, high=60.0,
        ),
    )  # fmt: skip
    learning_set_speed_gain: float = since(
        "0.3",
        real_parameter(
            "Share of the way to the driver's set speed that a drive learns, 1 = as it was set",
            "", start=1.0, low=0.0, high=1.0,
        ),
    )  # fmt: skip
    learning_evidence_gain: float = since(
        "0.3",
        real_parameter(
            "CONSISTENT: evidence by a pass with an intervention",
            "",
            start=1.25,
            low=0.0,
            high=10.0,
        ),
    )
    learning_evidence_loss: float = since(
        "0.3",
        real_parameter(
            "CONSISTENT: evidence lost by a pass without", "", start=0.98, low=0.0, high=10.0
        ),
    )
    learning_evidence_accept: float = since(
        "0.3",
        real_parameter(
            "CONSISTENT: evidence from which an intervention is learned",
            "", start=2.2, low=0.0, high=2.2,
        ),
    )  # fmt: skip


@dataclass
class ClusterParameters:
    """How the instrument cluster speaks."""

    hmi_language: int = since(
        "0.3", tunable(choice_parameter("Language of hmi.text", LANGUAGE, start=LANGUAGE_EN))
    )
    hmi_unit: int = since(
        "0.3", tunable(choice_parameter("Unit of speeds in hmi.text", UNIT, start=UNIT_KMH))
    )
