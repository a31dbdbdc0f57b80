"""The foot of the preference driver: drives towards the wish with one pedal, then lets go.

A pedal is moved until the car accelerates as the driver wants (a proportional demand plus the
wish's own acceleration), at a limited rate: the driver need not know the car. In the numba subset.
"""

from __future__ import annotations

from pldf.kernel.interpolation import value_at

from .ahead_kernel import ALONE_BRAKES_MPS2, is_blocked, needed_brake_mps2
from .driver_state import DriverState
from .wish_kernel import SLOWEST_MPS, WishArrays, wish_acceleration

# Where the foot first goes: beyond the travel at which a pedal counts as pressed.
TOUCH = 0.05
# Weakest acceleration worth holding a pedal for; the end is reached in finite time.
WEAKEST_MPS2 = 0.3
# A wish that falls (rises) faster than this ends the gas (brake): the function will do it.
TURN_MPS2 = 0.3
# Lifting a foot is faster than pressing.
LIFT_RATE_PER_S = 3.0


def gas_towards_wish(st: DriverState, wish: WishArrays, step_s: float) -> bool:
    """Move the gas pedal; return True when the foot has left it."""
    aim = value_at(wish.wish_mps, st.vehicle_s_m) + st.driver_overshoot * st.driver_threshold_mps
    trend = wish_acceleration(wish, st.vehicle_s_m)
    error = aim - st.vehicle_speed_mps
    demand = trend + st.driver_speed_gain_per_s * error
    if error <= 0.0 or demand < -TURN_MPS2 or is_blocked(st):
        st.releasing = 1
    demand = max(WEAKEST_MPS2, min(demand, st.wish_accel_max_mps2))
    correction = (demand - st.vehicle_acceleration_mps2) / st.driver_gas_gain_mps2
    st.driver_gas_pedal = _moved(st, st.driver_gas_pedal, correction, step_s)
    return st.driver_gas_pedal <= 0.0


def brake_towards_wish(st: DriverState, wish: WishArrays, step_s: float) -> bool:
    """Move the brake pedal; return True when the foot has left it."""
    wished = value_at(wish.wish_mps, st.vehicle_s_m)
    aim = max(wished - st.driver_overshoot * st.driver_threshold_mps, min(wished, SLOWEST_MPS))
    trend = wish_acceleration(wish, st.vehicle_s_m)
    error = st.vehicle_speed_mps - aim
    demand = st.driver_speed_gain_per_s * error - trend
    needed = needed_brake_mps2(st)
    if needed > ALONE_BRAKES_MPS2:
        st.releasing = 0
    elif (error <= 0.0 and trend > -TURN_MPS2) or demand < -TURN_MPS2:
        st.releasing = 1
    # The wish's own strength holds at the wish; a driver who is late brakes harder, and as hard as
    # a car ahead needs it.
    demand = max(WEAKEST_MPS2, min(demand, -2.0 * st.wish_accel_min_mps2), needed)
    correction = (demand + st.vehicle_acceleration_mps2) / st.driver_brake_gain_mps2
    st.driver_brake_pedal = _moved(st, st.driver_brake_pedal, correction, step_s)
    return st.driver_brake_pedal <= 0.0


def _moved(st: DriverState, pedal: float, correction: float, step_s: float) -> float:
    """Pedal after one step: lifted off if releasing, else moved by the (limited) correction."""
    if st.releasing != 0:
        return max(0.0, pedal - LIFT_RATE_PER_S * step_s)
    rate = st.driver_pedal_rate_per_s
    moved = pedal + step_s * max(-rate, min(correction / st.driver_pedal_time_s, rate))
    return max(TOUCH, min(moved, 1.0))
