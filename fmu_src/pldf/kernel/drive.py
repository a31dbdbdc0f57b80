"""One communication step: sample -> record -> mode and set speed -> request -> outputs."""

from __future__ import annotations

from .arrays import ProfileArrays, RouteArrays, TraceArrays
from .cluster import confidence_at, update_cluster
from .codes import (
    ACTIVE,
    FAULT,
    GAS_OVERRIDE,
    INPUT_INVALID,
    INPUT_OK,
    XY,
)
from .following import confirm_restart, look_ahead
from .hmi import notice_new_limit, show_event
from .interpolation import place_at, value_at, value_of
from .lever import (
    CANCEL_CONTACT,
    RESUME_CONTACT,
    automatic_set_speed,
    closed_contacts,
    notice_temporary_limit,
    temporary_limit,
    update_set_speed,
)
from .localization import expected_place, locate
from .log import log_nodes, note_for_log
from .modes import (
    BRAKE_PRESS,
    CANCEL,
    FAIL,
    GAS_PRESS,
    GAS_RELEASE,
    LOST,
    RECOVER,
    RESUME,
    SWITCH_OFF,
    SWITCH_ON,
    next_mode,
)
from .recorder import learns, may_learn, note_set_speed, record_sample
from .state import PldfState
from .teach import hear_driver
from .tracking import target_of, update_request

# Inputs beyond these (m, m/s, m/s2, pedal travel) are a fault of the wiring, not a drive. A
# comparison with NaN is false, so NaN is caught by the same test.
POSITION_BOUND = 1e8
SPEED_BOUND = 1e3
ACCELERATION_BOUND = 1e3
PEDAL_BOUND = 1e3


def drive_step(
    st: PldfState,
    route: RouteArrays,
    profile: ProfileArrays,
    trace: TraceArrays,
    step_s: float,
) -> None:
    """Advance by one communication step of ``step_s`` > 0 seconds with constant inputs."""
    check_inputs(st)
    if st.input_state != INPUT_INVALID:
        locate(st, route, expected_place(st))
        notice_temporary_limit(st, route)
        record_sample(st, route, trace)
        log_nodes(st, profile, trace)
        update_mode_and_set_speed(st, route, profile)
        hear_driver(st, route, profile, trace)
    else:  # no sample either: what is not known is neither recorded nor a place
        st.mode = next_mode(st.mode, FAIL)
    st.stepped = 1
    st.sampled_s_m = st.vehicle_s_m
    st.sampled_x_m = st.vehicle_x_m
    st.sampled_y_m = st.vehicle_y_m
    look_ahead(st, route, profile, step_s)
    update_request(st, route, profile, step_s)
    st.time_ns += int(1e9 * step_s + 0.5)  # whole: a sum of float steps would drift
    show_event(st)
    st.ahead_m = 0.0
    if st.input_state != INPUT_INVALID:
        st.ahead_m = max(st.vehicle_speed_mps, 0.0) * step_s
    update_outputs(st, route, profile)
    notice_new_limit(st)
    update_cluster(st, route, profile)
    note_set_speed(st)
    note_for_log(st)


def refresh(st: PldfState, route: RouteArrays, profile: ProfileArrays) -> None:
    """Recompute the outputs from new inputs without advancing time, recording or deciding.

    The outputs are a function of the memory that the last step left and of the present inputs. All
    memory stays as it is, so it does not matter whether and how often somebody reads an output.
    What follows the position follows no other input, not even one that is no number.
    """
    s_m, ahead_m, localized = st.s_m, st.ahead_m, st.localized
    input_state, valid_ns = st.input_state, st.valid_ns
    if is_position(st) and is_placed_anew(st):
        locate(st, route, s_m + ahead_m)
        st.ahead_m = 0.0
    update_outputs(st, route, profile)
    st.s_m, st.ahead_m, st.localized = s_m, ahead_m, localized
    st.input_state, st.valid_ns = input_state, valid_ns


def is_placed_anew(st: PldfState) -> bool:
    """Tell whether the position inputs are others than those of the last step.

    As long as they are not, they are a step old: the car is ``ahead_m`` behind them, whatever else
    was set since.
    """
    if st.stepped == 0:
        return True
    if st.localization == XY:
        return st.vehicle_x_m != st.sampled_x_m or st.vehicle_y_m != st.sampled_y_m
    return st.vehicle_s_m != st.sampled_s_m


def check_inputs(st: PldfState) -> None:
    """Set ``input_state`` to INVALID if an input in use is NaN, infinite or beyond any car."""
    good = -SPEED_BOUND < st.vehicle_speed_mps < SPEED_BOUND
    good = good and -ACCELERATION_BOUND < st.vehicle_acceleration_mps2 < ACCELERATION_BOUND
    good = good and -PEDAL_BOUND < st.driver_gas_pedal < PEDAL_BOUND
    good = good and -PEDAL_BOUND < st.driver_brake_pedal < PEDAL_BOUND
    good = good and is_position(st)
    if st.lead_present != 0:
        good = good and -POSITION_BOUND < st.lead_gap_m < POSITION_BOUND
        good = good and -SPEED_BOUND < st.lead_speed_mps < SPEED_BOUND
    good = good and 0.0 <= st.limit_override_mps < SPEED_BOUND
    st.input_state = INPUT_OK
    if not good:
        st.input_state = INPUT_INVALID
        st.invalid_ns = st.time_ns


def is_position(st: PldfState) -> bool:
    """Tell whether the position inputs in use are numbers that can be a place."""
    if st.localization != XY:
        return -POSITION_BOUND < st.vehicle_s_m < POSITION_BOUND
    east = -POSITION_BOUND < st.vehicle_x_m < POSITION_BOUND
    return east and -POSITION_BOUND < st.vehicle_y_m < POSITION_BOUND


def update_mode_and_set_speed(st: PldfState, route: RouteArrays, profile: ProfileArrays) -> None:
    """Feed this sample's events to the table of transitions; brake and failures come last."""
    closed = closed_contacts(st)
    mode = next_mode(st.mode, SWITCH_ON if st.main_switch != 0 else SWITCH_OFF)
    if mode == FAULT and st.time_ns - st.invalid_ns >= 1e9 * st.control_fault_hold_s:
        mode = next_mode(mode, RECOVER)
    if closed & RESUME_CONTACT:
        mode = next_mode(mode, RESUME)
        confirm_restart(st)
    if closed & CANCEL_CONTACT:
        mode = next_mode(mode, CANCEL)
    pressed = st.driver_gas_pedal > st.control_pedal_threshold
    mode = next_mode(mode, GAS_PRESS if pressed else GAS_RELEASE)
    if st.driver_brake_pedal > st.control_pedal_threshold:
        mode = next_mode(mode, BRAKE_PRESS)
    if st.input_state != INPUT_OK:
        mode = next_mode(mode, LOST)
    st.mode = mode
    update_set_speed(st, route, profile, closed)


def update_outputs(st: PldfState, route: RouteArrays, profile: ProfileArrays) -> None:
    """Fill the outputs for the position ``ahead_m`` behind the last sample."""
    s_m = st.s_m + st.ahead_m
    place = place_at(len(route.limit_mps), s_m)
    cell = place[0]
    limit = route.limit_mps[cell]
    automatic = automatic_set_speed(route, profile, cell)
    temporary = temporary_limit(st, route, cell)
    if temporary > 0.0:
        limit = automatic = temporary
    manual = st.manual_set_mps if s_m < st.manual_end_m else 0.0
    target = target_of(st, route, profile, s_m, place)
    base = value_of(profile.base_mps, place)
    learned = value_of(profile.learned_mps, place)
    lessons = int(profile.lessons[cell])
    confidence = confidence_at(st, profile, place)
    turn_m = profile.turn_m[cell]
    settled = value_at(profile.learned_mps, turn_m)
    # All is read before the first is written: the compiler must take any of them for the other.
    st.function_active = 1 if st.mode in (ACTIVE, GAS_OVERRIDE) else 0
    st.target_speed_mps = target
    st.base_speed_mps = base
    st.set_speed_mps = manual if manual > 0.0 else automatic
    st.set_speed_offset_mps = st.set_speed_mps - automatic
    st.limit_mps = limit
    if st.total_ns > 0:
        st.rate_pedal = st.pedal_ns / st.total_ns
        st.rate_set_speed = st.set_speed_ns / st.total_ns
        st.rate_combined = st.combined_ns / st.total_ns
    st.profile_status_code = st.profile_status
    st.hmi_learned_delta_mps = learned - base
    st.hmi_learning = 1 if learns(st) and may_learn(st) else 0
    st.hmi_learned_in_drives = lessons
    st.hmi_confidence = confidence
    st.hmi_next_speed_mps = settled
    st.hmi_next_distance_m = max(turn_m - s_m, 0.0)
