"""The state of the driving function: parameters, inputs, outputs and memory, and all in one record.

The compiled kernels need a flat record: one number after the other, no records inside. So each
section is a class of its own, all are bases of ``PldfState``, and it holds their fields in slots.
"""

from __future__ import annotations

from dataclasses import dataclass

from .codes import EVENT, INPUT_STATE, LAP, MODE, PROFILE_STATUS, REASON, WORDS_MAX
from .following_parameters import FollowingParameters
from .inputs import LIMITED, POSITION, Inputs
from .parameters import (
    ClusterParameters,
    ControlParameters,
    GeneralParameters,
    LearningParameters,
    PlannerParameters,
)
from .ranges import (
    LAST_NODE,
    NODES,
    TIME_MAX_NS,
    anything,
    code,
    flag,
    holds,
    nanoseconds,
    whole,
)
from .sentences import EVENT_SENTENCES
from .signals import (
    choice_output,
    count_output,
    flag_output,
    real_output,
    since,
)

COUNT_MAX = 999_999_999


@dataclass
class Outputs:
    """What the function tells vehicle, driver and researcher."""

    acceleration_request_mps2: float = real_output(
        "Requested acceleration", "m/s2", low=-10.0, high=5.0
    )
    function_active: int = flag_output(
        "The vehicle shall follow the request (ACTIVE, GAS_OVERRIDE)"
    )
    # Numbers, not an enumeration: libcosim drops enumerations, and the driver needs the mode.
    mode: int = holds(code(MODE), count_output(f"Mode of the function: {MODE.legend}"))
    target_speed_mps: float = real_output("Speed the function aims at here", "m/s", follows=LIMITED)
    base_speed_mps: float = real_output("Base profile here", "m/s", follows=POSITION)
    set_speed_mps: float = real_output("Set speed in force", "m/s", follows=LIMITED)
    set_speed_offset_mps: float = real_output(
        "Offset that the driver set in this drive, 0 = none", "m/s", follows=LIMITED
    )
    limit_mps: float = real_output("Legal limit here", "m/s", follows=LIMITED)
    rate_pedal: float = real_output("Share of this drive with a pedal intervention", "")
    rate_set_speed: float = real_output("Share of this drive with a set-speed offset", "")
    rate_combined: float = real_output("Share of this drive with either", "")
    drive_interventions: int = holds(
        whole(0, COUNT_MAX, at_most=NODES),
        count_output("Pedal interventions in this drive"),
    )
    profile_iteration: int = holds(
        whole(0, COUNT_MAX), count_output("Number of drives learned so far")
    )
    profile_status: int = choice_output("What became of the stored profile", PROFILE_STATUS)
    hmi_reason: int = choice_output("Why the car drives at this speed", REASON)
    hmi_learned_delta_mps: float = real_output(
        "Learned minus base speed here", "m/s", follows=POSITION
    )
    hmi_next_speed_mps: float = real_output(
        "Next speed that the profile settles at", "m/s", follows=POSITION
    )
    hmi_next_distance_m: float = real_output("Distance to that speed", "m", follows=POSITION)
    hmi_learning: int = flag_output(
        "This drive is being learned from", follows=("eligible", "teach_pause")
    )
    hmi_reason_code: int = since(
        "0.3",
        holds(code(REASON), count_output(f"hmi.reason as a number: {REASON.legend}")),
    )
    profile_status_code: int = since(
        "0.3",
        holds(
            code(PROFILE_STATUS),
            count_output(f"profile.status as a number: {PROFILE_STATUS.legend}"),
        ),
    )
    hmi_learned_in_drives: int = since(
        "0.3",
        holds(
            whole(0, COUNT_MAX), count_output("How many drives shaped this place", follows=POSITION)
        ),
    )
    hmi_confidence: float = since(
        "0.3",
        real_output(
            "How sure the function is of what it learned here",
            "",
            low=0.0,
            high=1.0,
            follows=POSITION,
        ),
    )
    hmi_event: int = since(
        "0.3",
        holds(
            code(EVENT),
            count_output(f"What just happened, for a second: {EVENT.legend}"),
        ),
    )
    hmi_sentence: int = since(
        "0.3",
        holds(
            whole(0, EVENT_SENTENCES + len(EVENT.items) - 1),
            count_output(
                "Which sentence hmi.text says: the code of a reason, or "
                f"{EVENT_SENTENCES} + the code of an event",
            ),
        ),
    )
    hmi_sentence_speed: int = since(
        "0.3",
        holds(whole(0, COUNT_MAX), count_output("Speed that it names, in hmi.unit")),
    )
    hmi_sentence_base: int = since(
        "0.3",
        holds(whole(0, COUNT_MAX), count_output("Base speed that it names, in hmi.unit")),
    )
    hmi_sentence_limit: int = since(
        "0.3",
        holds(whole(0, COUNT_MAX), count_output("Limit that it names, in hmi.unit")),
    )
    hmi_sentence_drive: int = since(
        "0.3", holds(whole(0, COUNT_MAX), count_output("Drive that it names"))
    )
    hmi_take_over: int = since(
        "0.3", flag_output("The driver has to brake: following alone may not do")
    )
    following_limits: int = since(
        "0.3",
        flag_output("The car ahead sets the speed, or did and the profile's is not reached yet"),
    )
    following_time_gap_s: float = since(
        "0.3",
        real_output("Time gap to the car ahead, 0 = none", "s", low=0.0, high=1e3),
    )


@dataclass
class Memory:
    """What the function remembers from step to step. Times are whole nanoseconds."""

    time_ns: int = nanoseconds()
    s_m: float = 0.0
    ahead_m: float = 0.0  # travel from the last sample to the end of the step
    stepped: int = flag()  # not before the first step, which may be too short to count as time
    sampled_s_m: float = anything()  # the position inputs of the last step
    sampled_x_m: float = anything()
    sampled_y_m: float = anything()
    localized: int = flag()
    input_state: int = code(INPUT_STATE)
    valid_ns: int = nanoseconds(at_most="time_ns")  # when the inputs were last valid
    invalid_ns: int = nanoseconds(at_most="time_ns")  # when they were last not
    lever_was: int = whole(0, 63)  # sum of the contacts' codes
    lever_free_ns: int = nanoseconds()
    manual_set_mps: float = 0.0  # 0 = none
    manual_end_m: float = 0.0
    manual_behind_mps: float = 0.0  # the profile's speed there
    shown_set_mps: float = 0.0  # manual set speed shown at the end of the last step, 0 = none
    lap: int = code(LAP)
    set_back_ns: int = nanoseconds(low=-1, start=-1, at_most="time_ns")  # since when; -1: it is not
    # the function's own recording: the node behind the last one logged, and what was shown there
    logged_end: int = whole(0, COUNT_MAX, at_most=NODES)
    logged_set_mps: float = 0.0
    logged_offset_mps: float = 0.0
    logged_reason: int = code(REASON)
    activated: int = flag()  # the function was active in a sample of this drive
    # recorder: the last two knots of the resampled drive, and the sample before this one
    samples: int = whole(0, TIME_MAX_NS)
    from_s_m: float = 0.0
    from_speed_mps: float = 0.0
    from_time_s: float = 0.0
    knot_s_m: float = 0.0
    knot_speed_mps: float = 0.0
    knot_time_s: float = 0.0
    previous_ns: int = nanoseconds(at_most="time_ns")
    previous_s_m: float = 0.0
    previous_speed_mps: float = 0.0
    previous_mode: int = code(MODE)
    previous_brake: int = flag()
    previous_set_mps: float = 0.0
    # recorded are the nodes first_node .. first_node + nodes - 1
    first_node: int = whole(0, COUNT_MAX, at_most=LAST_NODE)
    nodes: int = whole(0, COUNT_MAX, at_most=NODES, plus="first_node")
    intervening: int = whole(0, 1, at_most="drive_interventions")
    intervention_end_ns: int = nanoseconds(low=-1, start=-1, at_most="time_ns")
    gap_uncovered_ns: int = nanoseconds()
    set_series: int = whole(0, COUNT_MAX, at_most=NODES)  # of presses of the lever, once learned
    holds: int = whole(0, COUNT_MAX, at_most=NODES)  # runs of nodes that a bound cut, once learned
    evidence_places: int = whole(0, COUNT_MAX, at_most=NODES)  # whose evidence changed, the same
    noticed_limit_mps: float = 0.0  # the legal limit at the end of the last step
    event_ns: int = nanoseconds(at_most="time_ns")  # when the event shown began
    event_untold: int = code(EVENT)  # the newest that no sentence has told yet
    reason_ns: int = nanoseconds(at_most="time_ns")  # since when the reason is shown
    reason_speed_mps: float = 0.0  # the speed that its sentence names
    reason_base_mps: float = 0.0  # what that would be without lessons
    numbers_ns: int = nanoseconds(at_most="time_ns")  # since when the sentence has its numbers
    # the driver's last word
    teach_was: int = whole(0, 7)  # sum of the switches' codes
    teach_wanted: int = whole(0, WORDS_MAX)  # what the runtime has to answer behind the step
    settling: int = whole(-1, 1)  # sign of what the car still is off what a word put in force
    words: int = whole(0, COUNT_MAX, at_most=NODES)
    taken_back: int = whole(0, COUNT_MAX)  # number of the iteration that an undo takes back
    previous_limits: int = flag()
    gap_limited_ns: int = nanoseconds()  # time behind a lead car since the last intervention
    temporary_mps: float = 0.0  # the temporary limit where it binds, 0 = it does not
    # the car ahead: as last seen, moved on with its speed while it is lost
    lead_counts: int = flag()
    lead_ahead_m: float = 0.0
    lead_mps: float = 0.0
    lead_seen_ns: int = nanoseconds(at_most="time_ns")
    lead_ns: int = nanoseconds(at_most="time_ns")  # of this gap
    lead_acts: int = flag()  # following asks for less, or did a moment ago
    less_ns: int = nanoseconds(low=-1, start=-1, at_most="time_ns")  # following asked for less
    standing: int = flag()  # held behind a lead car
    standing_ns: int = nanoseconds(at_most="time_ns")  # since then, or since RESUME
    total_ns: int = nanoseconds()
    pedal_ns: int = nanoseconds(at_most="total_ns")
    set_speed_ns: int = nanoseconds(at_most="total_ns")
    combined_ns: int = nanoseconds(at_most="total_ns")


# A dataclass takes the fields of its LAST base first; value references follow from their order
# within a release (``signals.by_reference``).
@dataclass(slots=True)
class PldfState(
    Memory,
    Outputs,
    Inputs,
    ClusterParameters,
    FollowingParameters,
    LearningParameters,
    ControlParameters,
    PlannerParameters,
    GeneralParameters,
):
    """Everything of one instance but the per-metre arrays."""
