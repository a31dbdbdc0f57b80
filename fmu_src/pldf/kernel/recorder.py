"""Recording by metre while driving, and the intervention rates (sections 2, 3.1 and 4).

``record_sample`` is called once per sample, online by the driving function and offline for every
row of a recording; both therefore learn the same. A sample is what an observer sees at a
communication point: position, speed and pedals together with mode and set speed then in force.
"""

from __future__ import annotations

from .arrays import RouteArrays, TraceArrays
from .codes import ACTIVE, GAS_OVERRIDE, LEARN_CONSISTENT, LEARN_OFF, OUTCOME_FOLLOWING, STANDBY
from .interpolation import cell_at
from .lap import end_lap, is_far, is_over, takes_sample
from .state import PldfState

SECOND_NS = 1e-9


def record_sample(st: PldfState, route: RouteArrays, trace: TraceArrays) -> None:
    """Add the sample in ``st`` (time_ns, s_m, inputs, mode, shown_set_mps) to trace and rates."""
    if st.samples > 0 and st.time_ns <= st.previous_ns:
        return
    if not takes_sample(st):
        return
    _count_time(st)
    if st.mode in (ACTIVE, GAS_OVERRIDE):
        st.activated = 1
    if not _is_stray(st, route):
        _follow_intervention(st, trace)
        _advance_knots(st, route, trace)
        end_lap(st, route)
        st.previous_s_m = st.s_m
    st.samples += 1
    st.previous_ns = st.time_ns
    st.previous_speed_mps = st.vehicle_speed_mps
    st.previous_mode = st.mode
    st.previous_brake = _brakes(st)
    st.previous_set_mps = st.shown_set_mps
    st.previous_limits = st.following_limits


def learns(st: PldfState) -> bool:
    """Whether this drive is learned from when it ends."""
    return st.learn != LEARN_OFF or st.learn_faithful != 0 or st.learn_consistent != 0


def learns_consistent(st: PldfState) -> bool:
    """Tell whether this drive is learned from as CONSISTENT says: it wins over FAITHFUL."""
    return st.learn == LEARN_CONSISTENT or st.learn_consistent != 0


def may_learn(st: PldfState) -> bool:
    """Tell whether what the driver does now may be learned, for all that learning reads of it."""
    wanted = not is_over(st) and st.eligible != 0 and st.teach_pause == 0 and st.settling == 0
    return wanted and st.following_limits == 0 and st.temporary_mps == 0.0


def note_set_speed(st: PldfState) -> None:
    """Remember the manual set speed that the outputs show, 0 = none, for the next sample.

    The outputs follow new inputs as soon as somebody reads them; what is recorded must not.
    """
    st.shown_set_mps = 0.0
    if abs(st.set_speed_offset_mps) > st.learning_offset_tolerance_mps:
        st.shown_set_mps = st.set_speed_mps


def _brakes(st: PldfState) -> int:
    return 1 if st.driver_brake_pedal > st.control_pedal_threshold else 0


def _count_time(st: PldfState) -> None:
    """Charge the time since the previous sample to what was in force at that sample.

    Time behind a lead car that limits is no time of the drive, for no rate (section 8).
    """
    if st.samples == 0:
        return
    passed = st.time_ns - st.previous_ns
    if st.previous_limits != 0:
        st.gap_limited_ns += passed
        return
    st.total_ns += passed
    if st.intervening != 0:
        st.pedal_ns += passed
    if st.previous_set_mps > 0.0:
        st.set_speed_ns += passed
    if st.intervening != 0 or st.previous_set_mps > 0.0:
        st.combined_ns += passed
    else:
        st.gap_uncovered_ns += passed


def _follow_intervention(st: PldfState, trace: TraceArrays) -> None:
    """Open, extend or close the pedal intervention; its end is always the latest sample."""
    if st.intervening != 0 and not _still_inactive(st):
        st.intervening = 0
        st.intervention_end_ns = st.time_ns
        st.gap_uncovered_ns = 0
        st.gap_limited_ns = 0
        _extend(st, trace)
    elif st.intervening != 0:
        _extend(st, trace)
        _bar_behind_lead(st, trace)
    elif _driver_took_over(st):
        _open_intervention(st, trace)


def _still_inactive(st: PldfState) -> bool:
    if st.mode == GAS_OVERRIDE:
        return True
    # Standby after gas without any brake is the lever's doing, not the pedal's.
    by_pedal = st.previous_mode == STANDBY or st.previous_brake + _brakes(st) > 0
    return st.mode == STANDBY and by_pedal


def _driver_took_over(st: PldfState) -> bool:
    if st.mode == GAS_OVERRIDE:
        return True
    was_driving = st.previous_mode in (ACTIVE, GAS_OVERRIDE)
    braked = st.previous_brake + _brakes(st) > 0
    return st.samples > 0 and st.mode == STANDBY and was_driving and braked


def _open_intervention(st: PldfState, trace: TraceArrays) -> None:
    gap_ns = st.time_ns - st.intervention_end_ns
    st.intervening = 1
    # Pedal bounce: the gap belongs to the intervention after all, so its time is charged late, for
    # the combined rate only what no set-speed offset has covered already.
    if st.drive_interventions > 0 and gap_ns < 1e9 * st.learning_pedal_gap_s:
        st.pedal_ns += gap_ns - st.gap_limited_ns
        st.combined_ns += st.gap_uncovered_ns
        _extend(st, trace)
    elif st.drive_interventions < len(trace.start_m):  # there is room for one per metre
        st.drive_interventions += 1
        trace.start_m[st.drive_interventions - 1] = _furthest(st)
        _extend(st, trace)
    _bar_behind_lead(st, trace)


def _bar_behind_lead(st: PldfState, trace: TraceArrays) -> None:
    """An intervention during which a lead car limits may be about that car (section 8)."""
    if st.following_limits != 0:
        trace.barred[st.drive_interventions - 1] = OUTCOME_FOLLOWING


def _extend(st: PldfState, trace: TraceArrays) -> None:
    trace.end_m[st.drive_interventions - 1] = _furthest(st)


def _furthest(st: PldfState) -> float:
    # A car that rolls back has not left what it drove through before.
    return st.s_m if st.samples == 0 else max(st.s_m, st.knot_s_m)


def _advance_knots(st: PldfState, route: RouteArrays, trace: TraceArrays) -> None:
    """Section 3.1: drop samples that do not advance; at standstill keep the lowest speed."""
    time_s = SECOND_NS * st.time_ns
    speed = st.vehicle_speed_mps
    if st.samples == 0:
        st.from_s_m = st.s_m - 1e-9  # so that a drive that begins at a node records this node
        st.from_speed_mps = speed
        st.from_time_s = time_s
        st.knot_s_m = st.s_m
        st.knot_speed_mps = speed
        st.knot_time_s = time_s
    elif st.s_m > st.knot_s_m:
        st.from_s_m = st.knot_s_m
        st.from_speed_mps = st.knot_speed_mps
        st.from_time_s = st.knot_time_s
        st.knot_s_m = st.s_m
        st.knot_speed_mps = speed
        st.knot_time_s = time_s
    elif st.s_m == st.knot_s_m and speed < st.knot_speed_mps:
        st.knot_speed_mps = speed
    else:
        return
    _write_nodes(st, route, trace)


def _write_nodes(st: PldfState, route: RouteArrays, trace: TraceArrays) -> None:
    """Interpolate the nodes in (from, knot]; most samples reach none."""
    first = int(max(st.from_s_m, -1.0) + 1.0)
    last = min(int(max(st.knot_s_m, -1.0) + 1.0), len(trace.speed_mps))
    if first >= last:
        return
    hole = _is_hole(st)
    if st.nodes == 0:
        st.first_node = first
    st.nodes = last - st.first_node
    for i in range(first, last):
        part = (i - st.from_s_m) / (st.knot_s_m - st.from_s_m)
        speed = st.from_speed_mps + part * (st.knot_speed_mps - st.from_speed_mps)
        trace.speed_mps[i] = speed
        trace.time_s[i] = st.from_time_s + part * (st.knot_time_s - st.from_time_s)
        trace.eligible[i] = 1.0 if may_learn(st) else 0.0
        trace.active[i] = 1.0 if st.mode == ACTIVE else 0.0
        trace.gap[i] = 1.0 if hole else 0.0
        trace.set_speed_mps[i] = _set_speed_for(st, route, i)


def _is_stray(st: PldfState, route: RouteArrays) -> bool:
    """Tell whether the sample lies off the route and was not driven to: a glitch, not a place.

    Followed, a single one far ahead would end the recording, since only progress is recorded.
    """
    off_route = st.s_m < 0.0 or st.s_m > len(route.limit_mps) - 1.0
    return off_route and st.samples > 0 and is_far(st)


def _is_hole(st: PldfState) -> bool:
    """Tell whether too long a time or too far a jump lies before this sample."""
    if st.samples == 0:
        return False
    passed_s = SECOND_NS * (st.time_ns - st.previous_ns)
    return passed_s > st.learning_recording_gap_s or is_far(st)


def _set_speed_for(st: PldfState, route: RouteArrays, node: int) -> float:
    """Return the manual set speed in force at ``node``: it does not outlive its legal limit."""
    before = cell_at(len(route.limit_mps), st.previous_s_m)
    if st.samples == 0 or route.limit_mps[before] != route.limit_mps[node]:
        return 0.0
    return st.previous_set_mps
