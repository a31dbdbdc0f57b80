"""One drive is one lap: from its first sample to the road's end, or until the car is set back.

Behind the end nothing is recorded: however long a simulation goes on, no rate falls. A car that is
set back without a reset drives the road a second time; what it does there is another drive and
must not be mixed into this one.
"""

from __future__ import annotations

from .arrays import RouteArrays
from .codes import (
    LAP_ARRIVED,
    LAP_BEGUN_ANEW,
    LAP_SET_BACK,
    OFF_ROUTE,
    XY,
)
from .state import PldfState

# Decision: a shorter jump back is a correction of the position, and the lap goes on.
SET_BACK_M = 100.0


def is_over(st: PldfState) -> bool:
    """Tell whether nothing more of this drive is recorded, and so neither learned nor counted."""
    return st.lap in (LAP_ARRIVED, LAP_SET_BACK)


def takes_sample(st: PldfState) -> bool:
    """Tell whether the sample in ``st`` belongs to the lap; notice if the car was set back.

    A single position far back is a glitch. So the lap is over once the car has been back there
    longer than what counts as a hole; until that is known the samples are left out, as in a hole.
    """
    if st.samples == 0:
        return True
    if st.lap == LAP_SET_BACK:
        return False
    if not _is_back(st):
        st.set_back_ns = -1
        return not _waits_behind_end(st)
    if st.set_back_ns < 0:
        st.set_back_ns = st.time_ns
    if st.time_ns - st.set_back_ns > 1e9 * st.learning_recording_gap_s:
        _set_back(st)
    return st.samples == 0


def end_lap(st: PldfState, route: RouteArrays) -> None:
    """End the lap if the sample in ``st``, which was recorded, has reached the road's end."""
    end_m = len(route.limit_mps) - 1.0
    s_m = st.s_m
    if st.localization == XY and st.input_state == OFF_ROUTE and st.valid_ns == st.previous_ns:
        # Just off the line: along it no place tells how far the car went beyond the end.
        s_m += st.vehicle_speed_mps * 1e-9 * (st.time_ns - st.valid_ns)
    if st.nodes > 0 and s_m >= end_m:
        st.lap = LAP_ARRIVED


def is_far(st: PldfState) -> bool:
    """Tell whether the car cannot have driven here since the sample before."""
    passed_s = 1e-9 * (st.time_ns - st.previous_ns)
    fastest = max(st.previous_speed_mps, st.vehicle_speed_mps)
    reach = fastest * passed_s + st.control_position_jump_max_m
    return abs(st.s_m - st.previous_s_m) > reach


def _is_back(st: PldfState) -> bool:
    back = st.s_m < st.previous_s_m - SET_BACK_M and st.s_m >= 0.0
    return back and is_far(st)


def _waits_behind_end(st: PldfState) -> bool:
    """Tell whether the car has arrived; follow it there, so that a jump back is seen as one."""
    if st.lap != LAP_ARRIVED:
        return False
    st.previous_s_m = st.s_m
    st.previous_ns = st.time_ns
    st.previous_speed_mps = st.vehicle_speed_mps
    return True


def _set_back(st: PldfState) -> None:
    """End the lap; or begin anew, if the car was only brought to where its drive begins."""
    if st.activated != 0 or st.lap == LAP_ARRIVED:
        st.lap = LAP_SET_BACK
        return
    st.lap = LAP_BEGUN_ANEW
    st.set_back_ns = -1
    st.samples = 0
    st.nodes = 0
    st.total_ns = 0
    st.pedal_ns = 0
    st.set_speed_ns = 0
    st.combined_ns = 0
    st.gap_uncovered_ns = 0
