"""The set-speed lever: contacts, tips and the manual set speed (section 2)."""

from __future__ import annotations

from .arrays import ProfileArrays, RouteArrays
from .codes import FAULT, OFF
from .interpolation import cell_at, value_at
from .state import PldfState

RESUME_CONTACT = 1
CANCEL_CONTACT = 2
UP_CONTACT = 4
DOWN_CONTACT = 8
UP_LONG_CONTACT = 16
DOWN_LONG_CONTACT = 32

SAME_SPEED_MPS = 1e-6  # tips are added up: 5 down and 5 up is the limit again, but for rounding


def closed_contacts(st: PldfState) -> int:
    """Return the lever contacts that closed since the last step, as a sum of contact codes.

    A contact that closes again within ``control_lever_bounce_s`` of the last one accepted is
    chatter and does not count.
    """
    now = (
        RESUME_CONTACT * (st.lever_resume != 0)
        + CANCEL_CONTACT * (st.lever_cancel != 0)
        + UP_CONTACT * (st.lever_up != 0)
        + DOWN_CONTACT * (st.lever_down != 0)
        + UP_LONG_CONTACT * (st.lever_up_long != 0)
        + DOWN_LONG_CONTACT * (st.lever_down_long != 0)
    )
    closed = now & ~st.lever_was
    st.lever_was = now
    if closed == 0 or st.time_ns < st.lever_free_ns:
        return 0
    st.lever_free_ns = st.time_ns + int(1e9 * st.control_lever_bounce_s)
    return closed


def automatic_set_speed(route: RouteArrays, profile: ProfileArrays, cell: int) -> float:
    """Return legal limit plus learned offset in ``cell``, in m/s."""
    return route.limit_mps[cell] + profile.offset_mps[cell]


def temporary_limit(st: PldfState, route: RouteArrays, cell: int) -> float:
    """Return the temporary limit in m/s if it is lower than the legal one of ``cell``, else 0."""
    temporary = st.limit_override_mps
    return temporary if 0.0 < temporary < route.limit_mps[cell] else 0.0


def notice_temporary_limit(st: PldfState, route: RouteArrays) -> None:
    """Remember the temporary limit that binds at this sample, 0 = none.

    Where it changes the manual set speed is dropped, as at a sign.
    """
    temporary = temporary_limit(st, route, cell_at(len(route.limit_mps), st.s_m))
    if temporary != st.temporary_mps:
        st.manual_set_mps = 0.0
    st.temporary_mps = temporary


def update_set_speed(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, closed: int
) -> None:
    """Apply tips of the lever; drop the manual set speed where the legal limit changes."""
    if st.manual_set_mps > 0.0 and st.s_m >= st.manual_end_m:
        st.manual_set_mps = 0.0
    tip = _tip(st, closed)
    if tip == 0.0 or st.mode in (OFF, FAULT):
        return
    cell = cell_at(len(route.limit_mps), st.s_m)
    automatic = st.temporary_mps
    if automatic == 0.0:
        automatic = automatic_set_speed(route, profile, cell)
    wanted = (st.manual_set_mps if st.manual_set_mps > 0.0 else automatic) + tip
    wanted = min(max(wanted, st.control_set_speed_min_mps), st.control_set_speed_max_mps)
    # Learned, not planned: behind the sign the car goes on with the profile it follows.
    st.manual_end_m = profile.limit_end_m[cell]
    st.manual_behind_mps = value_at(profile.learned_mps, st.manual_end_m)
    st.manual_set_mps = wanted
    if abs(wanted - automatic) < SAME_SPEED_MPS:
        st.manual_set_mps = 0.0


def _tip(st: PldfState, closed: int) -> float:
    tip = 0.0
    if closed & UP_CONTACT:
        tip += st.control_tip_short_mps
    if closed & DOWN_CONTACT:
        tip -= st.control_tip_short_mps
    if closed & UP_LONG_CONTACT:
        tip += st.control_tip_long_mps
    if closed & DOWN_LONG_CONTACT:
        tip -= st.control_tip_long_mps
    return tip
