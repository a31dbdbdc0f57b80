"""FMU of the driving function."""

from pldf.fmi.slave import ModelSlave
from pldf.function import DrivingFunction


class AdaptivePLDF(ModelSlave):
    """Follows a speed profile along a known route and learns it from its driver.

    To begin with, connect vehicle.s_m, vehicle.speed_mps, driver.gas_pedal, driver.brake_pedal and
    lever.resume, and let the vehicle follow acceleration_request_mps2 while function_active is
    true. A pulse on lever.resume activates the function; the brake pedal deactivates it.

    Set route_file to the road that is driven, or choose a packed one with route_id. With learn set
    to FAITHFUL and profile_store set to a folder, the drive is learned when the simulation ends and
    driven by the next one that has apply_learned set. An importer that cannot set strings uses the
    environment variable PLDF_PROFILE_STORE.
    """

    about = "Predictive longitudinal driving function that learns from its driver (PLDF with SPAA)"

    @staticmethod
    def create() -> DrivingFunction:
        """Return a new driving function."""
        return DrivingFunction()
