"""A cart pushed by a force; it remembers its speed in an array and writes a line when it ends."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from pldf.errors import ModelError
from pldf.instance import Instance, Message
from pldf.kernel.arrays import Floats
from pldf.kernel.ranges import holds, whole
from pldf.kernel.signals import (
    Enumeration,
    choice_input,
    choice_output,
    choice_parameter,
    count_output,
    count_parameter,
    flag_input,
    flag_output,
    real_input,
    real_output,
    real_parameter,
    text_parameter,
)

GEAR = Enumeration("Gear", ("NEUTRAL", "FORWARD", "REVERSE"))
SPEED_UNIT = "m/s"


@dataclass(slots=True)
class CartRecord:
    """Signals and memory."""

    body_mass_kg: float = real_parameter("Mass", "kg", start=2.0, low=0.5, high=100.0)
    memory_size: int = count_parameter("Length of the memory", start=3, low=1, high=1000)
    first_gear: int = choice_parameter("Gear that the start is counted in", GEAR, start=1)
    force_n: float = real_input("Force", "N", start=0.0, low=-1e3, high=1e3)
    gear: int = choice_input("Gear", GEAR, start=1)
    brake: int = flag_input("Brake", start=False)
    position_m: float = real_output("Position", "m")
    speed_mps: float = real_output("Speed", SPEED_UNIT)
    acceleration_mps2: float = real_output(
        "Acceleration, follows the force at once", "m/s2", follows=("force_n", "gear", "brake")
    )
    steps: int = holds(whole(0, 2**60), count_output("Steps since the start"))
    moving: int = flag_output("The cart moves")
    engaged: int = choice_output("Gear in use", GEAR, follows=("gear",))
    hidden_m: float = 0.0


@dataclass
class CartTexts:
    """Strings."""

    log_file: str = text_parameter("File that gets a line when the run ends")


class Past(NamedTuple):
    """What the cart remembers."""

    speed_mps: Floats


class Cart(Instance[CartRecord]):
    """The cart."""

    groups = (Past,)

    def __init__(self) -> None:
        super().__init__(CartRecord(), CartTexts())

    def initialize(self) -> None:
        """Size the memory; ModelError for a log file in a folder that does not exist."""
        if self.texts.log_file and not Path(self.texts.log_file).parent.is_dir():
            raise ModelError(f"log_file {self.texts.log_file}: no such folder, 100% sure")
        self.attach((np.zeros(self.record.memory_size),))
        self.messages.append(Message("warning", f"memory of {self.record.memory_size}, 50% used"))
        (Path(__file__).parent / "data.txt").read_text("utf-8")
        self.refresh()

    def refresh(self) -> None:
        """Let acceleration and gear follow the inputs."""
        st = self.record
        sign = (0.0, 1.0, -1.0)[st.gear]
        st.acceleration_mps2 = 0.0 if st.brake else sign * st.force_n / st.body_mass_kg
        st.engaged = st.gear

    def step(self, step_s: float) -> None:
        """Integrate."""
        self.refresh()
        st = self.record
        if st.force_n == 666.0:
            raise ZeroDivisionError("the devil is in the 1% detail")
        memory = self.arrays[0]
        st.speed_mps += st.acceleration_mps2 * step_s + 1e-3 * float(memory.sum())
        st.position_m += st.speed_mps * step_s
        st.hidden_m += 0.125 * step_s
        st.position_m += st.hidden_m
        memory[st.steps % len(memory)] = st.speed_mps
        st.steps += 1
        st.moving = int(st.speed_mps != 0.0)

    def finish(self) -> None:
        """Append the line."""
        if self.texts.log_file:
            with Path(self.texts.log_file).open("a", encoding="utf-8") as file:
                file.write(f"{self.record.steps} steps\n")
