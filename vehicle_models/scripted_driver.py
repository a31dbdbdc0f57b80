"""FMU of the driver."""

from pldf.fmi.slave import ModelSlave

from vehicle_models.driver import ScriptedDriver as Driver


class ScriptedDriver(ModelSlave):
    """A driver who works pedals and lever.

    Connect the state of the vehicle and mode, target and set speed of the driving function; the
    outputs go to the driving function, the pedals to the vehicle as well. The driver follows a
    script of events or a hidden wish.
    """

    about = "Driver that follows a script or a hidden wish"

    @staticmethod
    def create() -> Driver:
        """Return a new driver."""
        return Driver()
