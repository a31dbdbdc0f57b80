"""Events of the instrument cluster, and what it says before the first step."""

from __future__ import annotations

from .codes import EVENT_NEW_LIMIT, EVENT_NONE, OFF, REASON_OFF, REASON_STANDBY
from .state import PldfState

HOLD_NS = 1_000_000_000  # an event, a reason and a sentence are shown for a second


def start_event(st: PldfState, event: int) -> None:
    """Show ``event`` (EVENT in codes) for a second; a newer one takes its place."""
    st.hmi_event = event
    st.event_ns = st.time_ns
    st.event_untold = event


def show_event(st: PldfState) -> None:
    """Take down the event whose second is over."""
    if st.hmi_event != EVENT_NONE and st.time_ns - st.event_ns > HOLD_NS:
        st.hmi_event = EVENT_NONE


def notice_new_limit(st: PldfState) -> None:
    """Show that the legal limit is another one than at the end of the last step."""
    if st.noticed_limit_mps > 0.0 and st.limit_mps != st.noticed_limit_mps:
        start_event(st, EVENT_NEW_LIMIT)
    st.noticed_limit_mps = st.limit_mps


def begin_cluster(st: PldfState) -> None:
    """Say before the first step what does not depend on any input: whether it is switched on."""
    st.hmi_reason = REASON_STANDBY if st.mode != OFF else REASON_OFF
    st.hmi_reason_code = st.hmi_reason
    st.hmi_sentence = st.hmi_reason
