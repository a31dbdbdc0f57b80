"""A recorded drive, row by row, through the recorder that also runs while driving."""

from __future__ import annotations

from typing import NamedTuple

from .arrays import Floats, RouteArrays, TraceArrays
from .lever import notice_temporary_limit
from .recorder import note_set_speed, record_sample
from .state import PldfState


class Samples(NamedTuple):
    """The columns of a recording that learning needs, one value per row."""

    time_s: Floats
    s_m: Floats
    speed_mps: Floats
    mode: Floats
    brake_pedal: Floats
    set_speed_mps: Floats
    set_speed_offset_mps: Floats
    eligible: Floats
    teach_pause: Floats
    following_limits: Floats
    limit_override_mps: Floats


def replay(st: PldfState, route: RouteArrays, trace: TraceArrays, samples: Samples) -> None:
    """Fill ``trace`` and the rates in ``st`` from ``samples``; times must increase."""
    for k in range(len(samples.time_s)):
        st.time_ns = int(1e9 * (samples.time_s[k] - samples.time_s[0]) + 0.5)
        st.s_m = samples.s_m[k]
        st.vehicle_speed_mps = samples.speed_mps[k]
        st.mode = int(samples.mode[k])
        st.driver_brake_pedal = samples.brake_pedal[k]
        st.set_speed_mps = samples.set_speed_mps[k]
        st.set_speed_offset_mps = samples.set_speed_offset_mps[k]
        st.eligible = int(samples.eligible[k])
        st.teach_pause = int(samples.teach_pause[k])
        st.following_limits = int(samples.following_limits[k])
        st.limit_override_mps = samples.limit_override_mps[k]
        notice_temporary_limit(st, route)
        note_set_speed(st)
        record_sample(st, route, trace)
