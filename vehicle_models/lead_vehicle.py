"""FMU of the car ahead."""

from pldf.fmi.slave import ModelSlave

from vehicle_models.lead import LeadVehicle as Lead


class LeadVehicle(ModelSlave):
    """The car ahead of ours, as a sensor sees it.

    Connect position and speed of the vehicle; the outputs go to the driving function, and to a
    driver model that looks ahead. kind chooses who is ahead: one car by the parameters scene.*, a
    script of events, or traffic from a seed that drives the road by itself, cuts in and stops.
    """

    about = "Car ahead: by parameters, by script, or traffic from a seed"

    @staticmethod
    def create() -> Lead:
        """Return a new car ahead."""
        return Lead()
