"""A drive along the study road that leaves a recording of its own."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from laboratory import PointMass
from pldf.function import DrivingFunction


def started(folder: Path | str, **settings: Any) -> PointMass:
    """A car on the study road whose function records into ``folder``; '' leaves it to others."""
    made = DrivingFunction()
    made.texts.recording_folder = str(folder)
    for name, value in settings.items():
        setattr(made.record, name, value)
    made.initialize()
    return PointMass(made, 20.0)


def drive(car: PointMass) -> None:
    """Gas, lever, brake, and a stop of some seconds, in two minutes."""
    car.tip("lever_resume")
    car.run(20.0)
    car.run(5.0, driver_gas_pedal=0.3)
    car.run(10.0, driver_gas_pedal=0.0)
    car.tip("lever_up_long")
    car.run(20.0)
    car.run(2.0, driver_brake_pedal=0.2)
    car.run(2.0, driver_brake_pedal=0.0)
    car.tip("lever_resume")
    car.run(10.0, eligible=0)
    car.run(6.0, driver_brake_pedal=1.0, eligible=1)
    car.run(5.0, driver_brake_pedal=0.0)
    car.tip("lever_resume")
    car.run(20.0)
