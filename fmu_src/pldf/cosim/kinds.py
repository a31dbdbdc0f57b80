"""The FMUs, their two kinds, and where ``pldf build`` puts them: all that commands need."""

from __future__ import annotations

from pathlib import Path
from typing import Final, Literal

Kind = Literal["native", "python"]
KINDS: Final[tuple[Kind, ...]] = ("native", "python")
# Where the native FMUs are: in the folder of the Python ones.
NATIVE_FOLDER: Final = "native"
# And those for a page in a browser.
WASM_FOLDER: Final = "wasm"
USUAL_FOLDER: Final = Path("dist")
# The vehicle comes first: the function plans its first outputs from where the vehicle is.
PARTS: Final = {
    "vehicle": "LongitudinalVehicle",
    "driver": "ScriptedDriver",
    "pldf": "AdaptivePLDF",
}
# With a car ahead, which sees where ours is and is seen by driver and function.
PARTS_IN_TRAFFIC: Final = {
    "vehicle": PARTS["vehicle"],
    "lead": "LeadVehicle",
    "driver": PARTS["driver"],
    "pldf": PARTS["pldf"],
}
