"""What is set in FMUs and what they say; known also where nobody drives FMUs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from ..instance import Level

Value = float | int | str
# part -> variable -> value
Values = Mapping[str, Mapping[str, Value]]


class FmuMessage(NamedTuple):
    """A message of an FMU's logger; ``fmu`` is the name of the model."""

    fmu: str
    level: Level
    text: str
