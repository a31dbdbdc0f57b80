"""The inputs of the driving function."""

from __future__ import annotations

from dataclasses import dataclass

from .signals import flag_input, real_input, since


@dataclass
class Inputs:
    """What the simulator delivers, constant over a communication step."""

    vehicle_s_m: float = real_input(
        "Arc length along the route", "m", start=0.0, low=-1e7, high=1e7
    )
    vehicle_x_m: float = real_input(
        "East coordinate, used when localization is XY", "m", start=0.0, low=-1e7, high=1e7
    )
    vehicle_y_m: float = real_input(
        "North coordinate, used when localization is XY", "m", start=0.0, low=-1e7, high=1e7
    )
    vehicle_speed_mps: float = real_input("Ego speed", "m/s", start=0.0, low=-10.0, high=150.0)
    vehicle_acceleration_mps2: float = real_input(
        "Ego acceleration", "m/s2", start=0.0, low=-50.0, high=50.0
    )
    driver_gas_pedal: float = real_input("Gas pedal travel", "", start=0.0, low=0.0, high=1.0)
    driver_brake_pedal: float = real_input("Brake pedal travel", "", start=0.0, low=0.0, high=1.0)
    lever_resume: int = flag_input("Lever: activate or resume", start=False)
    lever_cancel: int = flag_input("Lever: cancel", start=False)
    lever_up: int = flag_input("Lever: set speed up, short tip", start=False)
    lever_down: int = flag_input("Lever: set speed down, short tip", start=False)
    lever_up_long: int = flag_input("Lever: set speed up, long tip", start=False)
    lever_down_long: int = flag_input("Lever: set speed down, long tip", start=False)
    eligible: int = flag_input("Learning is allowed here (free driving)", start=True)
    teach_pause: int = since(
        "0.3", flag_input("While true, nothing of this drive is learned", start=False)
    )
    teach_forget_here: int = since(
        "0.3", flag_input("At its rising edge, what was learned here is forgotten", start=False)
    )
    teach_undo: int = since(
        "0.3", flag_input("At its rising edge, the newest lesson is taken back", start=False)
    )
    lead_present: int = since(
        "0.3", flag_input("A car drives ahead; else the other two are ignored", start=False)
    )
    lead_gap_m: float = since(
        "0.3",
        real_input("Gap to the car ahead, bumper to bumper", "m", start=0.0, low=-1e3, high=1e4),
    )
    lead_speed_mps: float = since(
        "0.3", real_input("Speed of the car ahead", "m/s", start=0.0, low=-50.0, high=150.0)
    )
    limit_override_mps: float = since(
        "0.3",
        real_input(
            "Temporary limit from the scenario, 0 = none; counts where it is the lower one",
            "m/s", start=0.0, low=0.0, high=150.0, name="limit.override_mps",
        ),
    )  # fmt: skip


# Which of them counts says the parameter ``localization``.
POSITION = ("vehicle_s_m", "vehicle_x_m", "vehicle_y_m")
LIMITED = (*POSITION, "limit_override_mps")
