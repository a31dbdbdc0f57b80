"""The driver from step to step: hands off, script or preference driver.

The preference driver watches the car, compares it with the wish and acts only if a deviation above
the threshold lasts longer than the reaction time and the function is not about to end it. In the
numba subset (see ``pldf.kernel``).
"""

from __future__ import annotations

from math import floor

from pldf.kernel.codes import ACTIVE, GAS_OVERRIDE
from pldf.kernel.interpolation import cell_at, value_at
from pldf.kernel.substeps import substep_count

from .ahead_kernel import has_to_wave_on, is_blocked, is_in_danger
from .chance import draw, sow
from .clock import NS_PER_S, to_ns
from .driver_state import AWAY, HANDS_OFF, ON_BRAKE, ON_GAS, SCRIPT, WATCHING, DriverState
from .pedal_kernel import brake_towards_wish, gas_towards_wish
from .script_kernel import (
    DOWN_LONG,
    RESUME,
    UP_LONG,
    ScriptArrays,
    follow_script,
    hold_lever,
    release_all,
    release_lever,
)
from .wish_kernel import WishArrays

FINITE_MAX = 1e300
# A contact of the lever is held this long; a series of tips has this rhythm.
PRESS_NS = 200_000_000
TIP_NS = 700_000_000
RETRY_NS = 1_000_000_000
# After so many vain attempts to activate, the driver drives without the function.
PATIENCE_ATTEMPTS = 3
# The function counts as under way to the wish, or as settled, at this acceleration.
UNDER_WAY_MPS2 = 0.3
# The lever is used when the car is this close to the set speed.
SETTLED_MPS = 1.0
# The wish counts as its plateau this close to it: nothing but the limit binds it.
PLATEAU_MARGIN_MPS = 0.3


def driver_start(st: DriverState) -> None:
    """Put the driver into the car, hands and feet off."""
    sow(st, st.seed)
    st.phase = AWAY
    st.delay_ns = to_ns(st.driver_start_s)
    release_all(st)


def driver_step(st: DriverState, wish: WishArrays, script: ScriptArrays, step_s: float) -> None:
    """Advance by ``step_s`` seconds in equal internal steps of at most 10 ms."""
    count = substep_count(step_s)
    begin_ns = st.time_ns
    end_ns = begin_ns + to_ns(step_s)
    for k in range(count):
        now_ns = begin_ns + floor((end_ns - begin_ns) * (k + 1.0) / count + 0.5)
        _advance(st, wish, script, now_ns)


def _advance(st: DriverState, wish: WishArrays, script: ScriptArrays, now_ns: int) -> None:
    passed_ns = now_ns - st.time_ns
    st.time_ns = now_ns
    st.invalid_input = int(not _perceives(st))
    if st.kind == SCRIPT:
        release_all(st)
        follow_script(st, script)
    elif st.invalid_input != 0:
        release_all(st)
    else:
        st.phase_ns += passed_ns
        st.button_ns += passed_ns
        _decide(st, wish, passed_ns)
        _move_lever(st)


def _perceives(st: DriverState) -> bool:
    """Tell whether all inputs are usable numbers (comparisons with NaN are false)."""
    return (
        abs(st.vehicle_s_m) < FINITE_MAX
        and abs(st.vehicle_speed_mps) < FINITE_MAX
        and abs(st.vehicle_acceleration_mps2) < FINITE_MAX
        and abs(st.target_speed_mps) < FINITE_MAX
        and abs(st.set_speed_mps) < FINITE_MAX
        and abs(st.limit_mps) < FINITE_MAX
    )


def _decide(st: DriverState, wish: WishArrays, passed_ns: int) -> None:
    """One table of phases: what is done now, and which phase comes next."""
    if has_to_wave_on(st):
        _press(st, RESUME)
    if st.kind == HANDS_OFF:
        if st.was_active == 0:
            _activate(st)
        return
    if st.phase == ON_GAS:
        if gas_towards_wish(st, wish, passed_ns / NS_PER_S):
            _enter(st, WATCHING, 0)
    elif st.phase == ON_BRAKE:
        if brake_towards_wish(st, wish, passed_ns / NS_PER_S):
            _enter(st, AWAY, varied_ns(st, st.driver_reactivation_s))
    elif st.phase == WATCHING:
        if st.mode in (ACTIVE, GAS_OVERRIDE):
            _watch(st, wish, passed_ns)
        else:
            _enter(st, AWAY, varied_ns(st, st.driver_reactivation_s))
    else:
        _activate(st)
        _drive_alone(st, wish, passed_ns)


def _enter(st: DriverState, phase: int, delay_ns: int) -> None:
    st.phase = phase
    st.phase_ns = 0
    st.delay_ns = delay_ns
    st.urge = 0
    st.urge_ns = 0
    st.settled_ns = 0
    st.tipping = 0


def _activate(st: DriverState) -> None:
    """Press RESUME when the delay is over, again every second until the function is active."""
    if st.mode == ACTIVE:
        st.was_active = 1
        st.attempts = 0
        _enter(st, WATCHING, 0)
    elif st.phase_ns >= st.delay_ns:
        _press(st, RESUME)
        st.attempts += 1
        st.delay_ns = st.phase_ns + RETRY_NS


def _drive_alone(st: DriverState, wish: WishArrays, passed_ns: int) -> None:
    """While the function is not active: slow down if needed; keep going if it stays away."""
    if st.phase != AWAY or st.was_active + st.attempts == 0:
        return
    urge = _urge(st, wish)
    if urge < 0 or st.attempts >= PATIENCE_ATTEMPTS:
        _follow_urge(st, urge, passed_ns)
    else:
        _follow_urge(st, 0, passed_ns)


def _watch(st: DriverState, wish: WishArrays, passed_ns: int) -> None:
    """Supervise the function: the lever where it will do, else a pedal."""
    st.settled_ns = st.settled_ns + passed_ns if _is_settled(st) else 0
    if _lever_will_do(st, wish):
        _follow_urge(st, 0, passed_ns)
        _tip(st, wish)
    else:
        st.tipping = 0
        _follow_urge(st, _urge(st, wish), passed_ns)


def _is_settled(st: DriverState) -> bool:
    """Tell whether the car cruises at the set speed."""
    return (
        abs(st.vehicle_acceleration_mps2) < UNDER_WAY_MPS2
        and abs(st.vehicle_speed_mps - st.set_speed_mps) < SETTLED_MPS
    )


def _follow_urge(st: DriverState, urge: int, passed_ns: int) -> None:
    """Press a pedal once the same urge has lasted for the reaction time."""
    if urge != st.urge:  # another wish starts its own reaction time, drawn once
        st.urge = urge
        st.urge_ns = 0
        st.delay_ns = varied_ns(st, st.driver_reaction_s) if st.phase == WATCHING else st.delay_ns
        return
    st.urge_ns += passed_ns
    reaction_ns = st.delay_ns if st.phase == WATCHING else to_ns(st.driver_reaction_s)
    if urge == 0 or st.urge_ns < reaction_ns:
        return
    st.releasing = 0
    _enter(st, ON_GAS if urge > 0 else ON_BRAKE, 0)


def _urge(st: DriverState, wish: WishArrays) -> int:
    """Tell which pedal (1 gas, -1 brake, 0 none) the deviation from the wish calls for.

    Both the deviation now and the one expected after the reaction time must exceed the threshold,
    and the function must not be under way to a speed that will do. A car ahead comes first.
    """
    if is_in_danger(st):
        return -1
    speed = st.vehicle_speed_mps
    acceleration = st.vehicle_acceleration_mps2
    here = value_at(wish.wish_mps, st.vehicle_s_m)
    there = value_at(wish.wish_mps, st.vehicle_s_m + speed * st.driver_reaction_s)
    soon = speed + acceleration * st.driver_reaction_s
    aim = here - st.target_speed_mps
    if min(here - speed, there - soon) > st.driver_threshold_mps:
        helps = acceleration > UNDER_WAY_MPS2 and aim <= st.driver_threshold_mps
        return 0 if helps or is_blocked(st) else 1
    if min(speed - here, soon - there) > st.driver_threshold_mps:
        helps = acceleration < -UNDER_WAY_MPS2 and aim >= -st.driver_threshold_mps
        return 0 if helps else -1
    return 0


def _lever_will_do(st: DriverState, wish: WishArrays) -> bool:
    """Tell whether the set speed is off the wish at a place where the lever is used."""
    if st.driver_uses_lever == 0 or st.limit_mps <= 0.0 or st.mode != ACTIVE or is_blocked(st):
        return False
    needed = 0.5 * st.driver_lever_step_mps if st.tipping != 0 else st.driver_threshold_mps
    if abs(_set_speed_error(st, wish)) <= max(needed, 0.5 * st.driver_lever_step_mps):
        return False
    i = cell_at(len(wish.limit_end_m), st.vehicle_s_m)
    speed = st.vehicle_speed_mps
    plateau = st.limit_mps + wish.offset_mps[i]
    return (
        abs(wish.wish_mps[i] - plateau) < PLATEAU_MARGIN_MPS
        and wish.limit_end_m[i] - st.vehicle_s_m > speed * st.driver_lever_limit_s
        and wish.straight_end_m[i] - st.vehicle_s_m > speed * st.driver_lever_straight_s
    )


def _set_speed_error(st: DriverState, wish: WishArrays) -> float:
    offset = wish.offset_mps[cell_at(len(wish.offset_mps), st.vehicle_s_m)]
    return st.limit_mps + offset - st.set_speed_mps


def _tip(st: DriverState, wish: WishArrays) -> None:
    """Tip the lever after a while of steady cruise; further tips follow in rhythm."""
    cruising = st.settled_ns >= to_ns(st.driver_lever_settled_s)
    if st.button_ns >= TIP_NS and (cruising or st.tipping != 0):
        st.tipping = 1
        _press(st, UP_LONG if _set_speed_error(st, wish) > 0.0 else DOWN_LONG)


def _press(st: DriverState, control: int) -> None:
    st.button = control
    st.button_ns = 0


def _move_lever(st: DriverState) -> None:
    """Hold the contact that was pressed, then let go: each press is one edge."""
    release_lever(st)
    if st.button_ns < PRESS_NS:
        hold_lever(st, st.button)


def varied_ns(st: DriverState, seconds: float) -> int:
    """A delay of about ``seconds``, with the driver's spread, as whole nanoseconds."""
    return to_ns(seconds * (1.0 + st.driver_spread * (2.0 * draw(st) - 1.0)))
