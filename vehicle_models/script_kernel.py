"""Drives a script's events: which control is operated now. In the numba subset."""

from __future__ import annotations

from typing import Annotated, Final, NamedTuple

from pldf.kernel.arrays import Floats
from pldf.kernel.ranges import TIME_MAX_NS, Range

from .clock import NS_PER_S
from .driver_state import DriverState

# Control codes of a script; those from RESUME to DOWN_LONG are the lever's contacts.
GAS: Final = 1
BRAKE: Final = 2
RESUME: Final = 3
CANCEL: Final = 4
UP: Final = 5
DOWN: Final = 6
UP_LONG: Final = 7
DOWN_LONG: Final = 8
# The driver's last word: buttons of the cabin.
PAUSE: Final = 9
FORGET_HERE: Final = 10
UNDO: Final = 11

AT_TIME: Final = 0
AT_POSITION: Final = 1

FINITE_MAX = 1e300


class ScriptArrays(NamedTuple):
    """Events, one per index, in the order of the file."""

    at: Floats  # s or m
    unit: Annotated[Floats, Range(0, 1)]  # AT_TIME or AT_POSITION
    control: Annotated[Floats, Range(1, 11)]  # control code
    value: Annotated[Floats, Range(0, 1)]  # pedal travel; 1 for lever and buttons
    duration_s: Floats
    began_ns: Annotated[Floats, Range(-1, TIME_MAX_NS)]  # when it began, -1 = not yet


def follow_script(st: DriverState, script: ScriptArrays) -> None:
    """Operate what the events ask for at ``st.time_ns``; on one pedal the strongest wins."""
    for k in range(len(script.at)):
        if script.began_ns[k] < 0.0 and _is_due(st, script, k):
            script.began_ns[k] = _beginning_ns(st, script, k)
        if script.began_ns[k] >= 0.0:
            lasts_ns = script.duration_s[k] * NS_PER_S
            if st.time_ns < script.began_ns[k] + lasts_ns:
                operate(st, int(script.control[k]), script.value[k])


def _is_due(st: DriverState, script: ScriptArrays, k: int) -> bool:
    if script.unit[k] == AT_POSITION:
        return FINITE_MAX > st.vehicle_s_m >= script.at[k]
    return st.time_ns >= script.at[k] * NS_PER_S


def _beginning_ns(st: DriverState, script: ScriptArrays, k: int) -> float:
    """A timed event lasts from its time, a placed one from the first step at or behind it."""
    if script.unit[k] == AT_POSITION:
        return float(st.time_ns)
    return script.at[k] * NS_PER_S


def release_all(st: DriverState) -> None:
    """Let go of pedals, lever and buttons."""
    st.driver_gas_pedal = 0.0
    st.driver_brake_pedal = 0.0
    release_lever(st)
    st.teach_pause = 0
    st.teach_forget_here = 0
    st.teach_undo = 0


def release_lever(st: DriverState) -> None:
    """Let go of the lever."""
    st.lever_resume = 0
    st.lever_cancel = 0
    st.lever_up = 0
    st.lever_down = 0
    st.lever_up_long = 0
    st.lever_down_long = 0


def operate(st: DriverState, control: int, value: float) -> None:
    """Press a pedal to at least ``value``, close one of the lever's contacts or hold a button."""
    if control == GAS:
        st.driver_gas_pedal = max(st.driver_gas_pedal, value)
    elif control == BRAKE:
        st.driver_brake_pedal = max(st.driver_brake_pedal, value)
    elif control == PAUSE:
        st.teach_pause = 1
    elif control == FORGET_HERE:
        st.teach_forget_here = 1
    elif control == UNDO:
        st.teach_undo = 1
    else:
        hold_lever(st, control)


def hold_lever(st: DriverState, control: int) -> None:
    """Close one of the lever's contacts for this step."""
    if control == RESUME:
        st.lever_resume = 1
    elif control == CANCEL:
        st.lever_cancel = 1
    elif control == UP:
        st.lever_up = 1
    elif control == DOWN:
        st.lever_down = 1
    elif control == UP_LONG:
        st.lever_up_long = 1
    elif control == DOWN_LONG:
        st.lever_down_long = 1
