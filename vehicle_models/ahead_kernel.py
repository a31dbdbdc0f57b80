"""What the driver makes of a car ahead. In the numba subset (see ``pldf.kernel``).

Without a car ahead, or with numbers about it that make no sense, it is as if this did not exist.
"""

from __future__ import annotations

from pldf.kernel.codes import ACTIVE

from .driver_state import DriverState

# Nobody presses the gas nearer to a car ahead than this: standing, driving, and closing in.
SPACE_M = 5.0
SPACE_S = 2.5
CLOSING_MPS2 = 1.5
# The driver stops this far behind, and brakes where the function would have to brake harder than
# this; without the function, harder than that.
STOP_SPACE_M = 2.0
FUNCTION_BRAKES_MPS2 = 4.0
ALONE_BRAKES_MPS2 = 1.0
# A car stands and drives off.
STANDS_MPS = 0.1
DRIVES_OFF_MPS = 0.5
SOON_NS = 1_000_000_000
FINITE_MAX = 1e300


def sees_car(st: DriverState) -> bool:
    """Tell whether there is a car ahead (comparisons with NaN are false)."""
    return (
        st.lead_present != 0
        and abs(st.lead_gap_m) < FINITE_MAX
        and abs(st.lead_speed_mps) < FINITE_MAX
    )


def is_blocked(st: DriverState) -> bool:
    """Tell whether a car ahead is so near that faster would be no use."""
    if not sees_car(st):
        return False
    closing = max(0.0, st.vehicle_speed_mps - st.lead_speed_mps)
    space = SPACE_M + SPACE_S * st.vehicle_speed_mps + 0.5 * closing * closing / CLOSING_MPS2
    return st.lead_gap_m < space


def needed_brake_mps2(st: DriverState) -> float:
    """Deceleration that keeps the car from the one ahead, if that keeps its speed; 0: none."""
    closing = st.vehicle_speed_mps - st.lead_speed_mps
    if closing <= 0.0 or not sees_car(st):
        return 0.0
    return 0.5 * closing * closing / max(st.lead_gap_m - STOP_SPACE_M, 0.5)


def is_in_danger(st: DriverState) -> bool:
    """Tell whether the driver has to brake for the car ahead."""
    bearable = FUNCTION_BRAKES_MPS2 if st.mode == ACTIVE else ALONE_BRAKES_MPS2
    return needed_brake_mps2(st) > bearable


def has_to_wave_on(st: DriverState) -> bool:
    """Tell whether the function has to be told that the car which stood ahead drives off.

    Once in a second; the function goes on by itself only after short stops.
    """
    if st.vehicle_speed_mps > STANDS_MPS or st.mode != ACTIVE:
        st.stood_behind = 0
    elif st.lead_present != 0 and st.lead_speed_mps < STANDS_MPS:
        st.stood_behind = 1
    gone = st.lead_present == 0 or st.lead_speed_mps > DRIVES_OFF_MPS
    return st.stood_behind != 0 and gone and st.button_ns >= SOON_NS
