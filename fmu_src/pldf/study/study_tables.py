"""The tables and keys of a study file: types, ranges and what is usual."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Any, Final, Literal

import msgspec
from msgspec import Meta, Struct

from ..cosim.drive_limits import STEP_S
from ..kernel.signals import Signal
from ..kernel.units import KMH_PER_MPS
from ..roads.options import LimitUnit
from .phases import SEED_MAX

COUNT_MAX: Final = 1_000_000
PER_PHASE_MAX: Final = 1000
STEP_MIN_S: Final = 1e-4
STEP_MAX_S: Final = 0.1
LIMIT_MAX_MPS: Final = 300.0 / KMH_PER_MPS

PRACTICE_MAX: Final = 9
FOV_MIN_DEG: Final = 20.0
FOV_MAX_DEG: Final = 150.0

PhaseName = Literal["A1", "A2", "A3", "B1", "B2", "B3"]
Text = Annotated[str, Meta(pattern=r"\S", description="a text in quotes")]
RoadId = Annotated[str | int, Meta(description='the id of a road, such as 12 or "Main Street"')]
Via = Annotated[
    tuple[str | int, ...], Meta(description="a list of the ids of roads, such as [12, 45, 7]")
]
Count = Annotated[
    int, Meta(ge=1, le=COUNT_MAX, description=f"a whole number from 1 to {COUNT_MAX}")
]
Number = Annotated[int, Meta(ge=1, le=SEED_MAX, description=f"a whole number from 1 to {SEED_MAX}")]
Seed = Annotated[int, Meta(ge=0, le=SEED_MAX, description=f"a whole number from 0 to {SEED_MAX}")]
PerPhase = Annotated[
    int, Meta(ge=1, le=PER_PHASE_MAX, description=f"a whole number from 1 to {PER_PHASE_MAX}")
]
Growth = Annotated[float, Meta(ge=0.0, le=1.0, description="a number from 0 to 1")]
Step = Annotated[
    float,
    Meta(
        ge=STEP_MIN_S, le=STEP_MAX_S, description=f"a number from {STEP_MIN_S:g} to {STEP_MAX_S:g}"
    ),
]
Limit = Annotated[
    float,
    Meta(gt=0.0, le=LIMIT_MAX_MPS, description=f"a number above 0 and up to {LIMIT_MAX_MPS:.4g}"),
]
Smoothing = Annotated[float, Meta(ge=0.0, le=1000.0, description="a number from 0 to 1000")]
Recorded = Annotated[
    list[str] | Literal["all", "typical"],
    Meta(description='"all", "typical" or a list of participants'),
]
Pages = Annotated[
    str | dict[Literal["en", "de"], str],
    Meta(description='the name of a file in quotes, or { en = "...", de = "..." }'),
]
Explanation = Literal["none", "icon", "text"]
Practice = Annotated[
    int, Meta(ge=0, le=PRACTICE_MAX, description=f"a whole number from 0 to {PRACTICE_MAX}")
]
PracticeEnd = Annotated[float, Meta(ge=100.0, description="a number from 100, in m")]
FieldOfView = Annotated[
    float,
    Meta(
        ge=FOV_MIN_DEG,
        le=FOV_MAX_DEG,
        description=f"a number from {FOV_MIN_DEG:g} to {FOV_MAX_DEG:g}, in degrees",
    ),
]


class ParticipantsTable(Struct, forbid_unknown_fields=True, frozen=True):
    """``[participants]``."""

    count: Count = 43
    seed: Seed = 1
    first: Number = 1
    file: Text = ""


class DrivesTable(Struct, forbid_unknown_fields=True, frozen=True):
    """``[drives]``."""

    phases: tuple[PhaseName, ...] = ("A1", "A2", "A3", "B1", "B2", "B3")
    order: Literal["fixed", "counterbalanced"] = "fixed"
    per_phase: PerPhase = 1
    threshold_growth_per_drive: Growth = 0.0
    step_s: Step = STEP_S
    through: Literal["kernels", "fmus"] = "kernels"


class RoadTable(Struct, forbid_unknown_fields=True, frozen=True):
    """``[road]``."""

    route: Text = "study"
    start_road: RoadId | None = None
    via: Via = ()
    to: RoadId | None = None
    reverse: bool = False
    default_limit_mps: Limit | None = None
    limit_unit: LimitUnit | None = None
    signs: bool = True
    smoothing_m: Smoothing | None = None


class RecordingsTable(Struct, forbid_unknown_fields=True, frozen=True):
    """``[recordings]``."""

    participants: Recorded = []


class CockpitTable(Struct, forbid_unknown_fields=True, frozen=True):
    """``[cockpit]``: the study with people who drive it themselves (``pldf cockpit``)."""

    language: Literal["en", "de"] = "en"
    welcome: Pages = ""
    consent: Pages = ""
    thanks: Pages = ""
    questionnaires: Text = ""
    practice: Practice = 1
    practice_end_m: PracticeEnd = 1000.0
    explanations: tuple[Explanation, ...] = ("text",)
    steering: Literal["assisted", "person"] = "assisted"
    traffic: bool = False
    fov_deg: FieldOfView = 60.0
    breaks: dict[str, Any] = {}
    ask: dict[str, Any] = {}


class StudyTables(Struct, forbid_unknown_fields=True, frozen=True):
    """The whole file; the tables of parameters are read by ``parameter_table``."""

    title: Text = ""
    output: Text = ""
    variant: Text = ""
    participants: ParticipantsTable = ParticipantsTable()
    drives: DrivesTable = DrivesTable()
    road: RoadTable = RoadTable()
    function: dict[str, Any] = {}
    vehicle: dict[str, Any] = {}
    driver: dict[str, Any] | None = None
    distribution: dict[str, Any] = {}
    recordings: RecordingsTable = RecordingsTable()
    variants: dict[str, Any] = {}
    cockpit: CockpitTable = CockpitTable()


def parameter_table(signals: Iterable[Signal]) -> type[Struct]:
    """Return the type of a table that sets some of these parameters, by FMI name."""
    return msgspec.defstruct(
        "Parameters",
        [(s.field, _type_of(s), msgspec.field(default=None, name=s.name)) for s in signals],
        forbid_unknown_fields=True,
        frozen=True,
    )


def _type_of(signal: Signal) -> Any:
    """Return the type of a parameter's value in the file, with its range."""
    if signal.enumeration is not None:
        return Literal[signal.enumeration.items]
    if signal.kind == "Boolean":
        return bool
    low, high = signal.range
    if signal.kind == "Integer":
        about = f"a whole number from {int(low)} to {int(high)}"
        return Annotated[int, Meta(ge=int(low), le=int(high), description=about)]
    return Annotated[float, Meta(ge=low, le=high, description=f"a number from {low:g} to {high:g}")]
