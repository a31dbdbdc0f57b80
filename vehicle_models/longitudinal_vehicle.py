"""FMU of the vehicle."""

from pldf.fmi.slave import ModelSlave

from vehicle_models.vehicle import LongitudinalVehicle as Vehicle


class LongitudinalVehicle(ModelSlave):
    """A car on its route.

    Connect acceleration_request_mps2 and function_active to the driving function and the pedals to
    the driver. While function_active is true the car follows the request and gas adds to it; else
    the pedals alone drive it; the brake pedal always wins.
    """

    about = "Longitudinal dynamics of one documented car with pedals"

    @staticmethod
    def create() -> Vehicle:
        """Return a new vehicle."""
        return Vehicle()
