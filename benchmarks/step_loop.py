"""A closed loop around the driving function, in the subset that numba compiles."""

from pldf.kernel.arrays import ProfileArrays, RouteArrays, TraceArrays
from pldf.kernel.drive import drive_step
from pldf.kernel.state import PldfState


def run(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, trace: TraceArrays, steps: int
) -> None:
    """Drive ``steps`` steps of 10 ms; the car does what the function asks for."""
    st.vehicle_s_m = 0.0
    st.vehicle_speed_mps = 20.0
    for k in range(steps):
        st.lever_resume = 1 if k == 100 else 0
        st.driver_gas_pedal = 0.3 if k % 3000 > 2800 else 0.0
        drive_step(st, route, profile, trace, 0.01)
        acceleration = st.acceleration_request_mps2 if st.function_active != 0 else 0.0
        st.vehicle_acceleration_mps2 = acceleration
        st.vehicle_speed_mps += 0.01 * acceleration
        st.vehicle_s_m += 0.01 * st.vehicle_speed_mps
