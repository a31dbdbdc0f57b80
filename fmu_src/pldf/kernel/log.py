"""What the function's own recording keeps by metre, beside what learning reads of the trace.

Nothing here is read while driving or learning: it is written when the drive ends, if somebody
asked for it (``pldf.own_recording``).
"""

from __future__ import annotations

from .arrays import ProfileArrays, TraceArrays
from .state import PldfState


def log_nodes(st: PldfState, profile: ProfileArrays, trace: TraceArrays) -> None:
    """Keep what was in force at the nodes that the last sample reached; most samples reach none."""
    end = st.first_node + st.nodes
    if st.logged_end == end or st.samples == 1:  # nothing was shown before the first step
        return
    first = st.logged_end if st.first_node < st.logged_end < end else st.first_node
    for i in range(first, end):
        trace.mode[i] = st.mode
        trace.gas_pedal[i] = st.driver_gas_pedal
        trace.brake_pedal[i] = st.driver_brake_pedal
        trace.shown_mps[i] = st.logged_set_mps
        trace.offset_mps[i] = st.logged_offset_mps
        trace.profile_mps[i] = profile.learned_mps[i]
        trace.reason[i] = st.logged_reason
    st.logged_end = end


def note_for_log(st: PldfState) -> None:
    """Remember what the outputs show: they follow new inputs as soon as somebody reads them."""
    st.logged_set_mps = st.set_speed_mps
    st.logged_offset_mps = st.set_speed_offset_mps
    st.logged_reason = st.hmi_reason
