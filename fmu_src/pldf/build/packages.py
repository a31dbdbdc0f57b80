"""The phases of the study as SSP packages with their own start values, without and with traffic.

All phases have the same structure, and in traffic one with a car ahead; what differs are the
parameter sets. Nothing is wired or set
here: connections and values are those of the coupled drives.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final, NamedTuple

from fmpy.ssp.ssd import read_ssd  # type: ignore[import-untyped]

from ..cosim.drive_limits import STEP_S
from ..cosim.fmu import Fmu
from ..cosim.kinds import PARTS, PARTS_IN_TRAFFIC
from ..cosim.master import connections
from ..cosim.values import Value
from ..errors import ModelError
from ..kernel.codes import LEARN_FAITHFUL
from ..roads import packed_route
from ..roads.load import STUDY_ROAD_ID
from ..study.phases import PHASES, TRAFFIC, DriveSetting, Phase, seed_of_drive, values_of
from . import ssp
from .archive import write_archive


class Series(NamedTuple):
    """The packages of all phases with one structure.

    Attributes:
        name: of the packages, before the phase.
        folder: of what they say, below that of the sources.
        about: one sentence.
        parts: their FMUs.
        traffic: values of the car ahead, None without one.
        stop_time_s: end of the default experiment.
    """

    name: str
    folder: str
    about: str
    parts: Mapping[str, str]
    traffic: Mapping[str, Value] | None
    stop_time_s: float


# The function alone needs 211 s for the road; drivers who intervene are faster. No longer than
# that, because time behind the end of the road lowers the rates that the function reports. Traffic
# takes its time.
SERIES: Final = (
    Series(
        name="study",
        folder="",
        about="Driving function, vehicle and driver on the road of the study",
        parts=PARTS,
        traffic=None,
        stop_time_s=220.0,
    ),
    Series(
        name="study_traffic",
        folder="traffic/",
        about="Driving function, vehicle, driver and traffic on the road of the study",
        parts=PARTS_IN_TRAFFIC,
        traffic={"kind": TRAFFIC},
        stop_time_s=360.0,
    ),
)


INLINE: Final = "inline"  # folder of the packages without ``.ssv``


def sources(fmus: Mapping[str, Fmu]) -> dict[str, bytes]:
    """Return the readable content of all packages: structures and each phase's values.

    Args:
        fmus: those of ``PARTS_IN_TRAFFIC``, from ``unpacked``.

    Returns:
        Text by path: ``SystemStructure.ssd`` and ``PHASE/PART.ssv``, in ``traffic/`` once more.

    Raises:
        ModelError: a connection or a value cannot be expressed for every importer.
    """
    try:
        return {
            f"{series.folder}{name}": text
            for series in SERIES
            for name, text in _texts(series, fmus).items()
        }
    except ValueError as problem:
        raise ModelError(f"SSP packages: {problem}") from None


def inline_structures(series: Series, fmus: Mapping[str, Fmu]) -> dict[str, bytes]:
    """Return the structure by phase with the values in it, for importers that read no ``.ssv``."""
    system = _system(series, fmus)
    return {
        name: ssp.structure(system, start_values(phase, drive, series.traffic))
        for drive, (name, phase) in enumerate(PHASES.items())
    }


def _system(series: Series, fmus: Mapping[str, Fmu]) -> ssp.System:
    known = {part: fmus[part] for part in series.parts}
    components = [
        ssp.Component(part, f"{series.parts[part]}.fmu", fmu.signals) for part, fmu in known.items()
    ]
    return ssp.System(
        name=series.name,
        about=series.about,
        components=components,
        connections=connections(known),
        stop_time_s=series.stop_time_s,
        step_s=STEP_S,
    )


def _texts(series: Series, fmus: Mapping[str, Fmu]) -> dict[str, bytes]:
    system = _system(series, fmus)
    texts = {ssp.STRUCTURE: ssp.structure(system)}
    for drive, phase in enumerate(PHASES.values()):
        values = start_values(phase, drive, series.traffic)
        for component in system.components:
            text = ssp.parameter_set(component.signals, values[component.name])
            texts[f"{phase.name}/{component.name}.ssv"] = text
    return texts


def start_values(
    phase: Phase, drive: int, traffic: Mapping[str, Value] | None = None
) -> dict[str, dict[str, Value]]:
    """Return the values of a drive on the study's road, without enumerations, by part and name."""
    setting = DriveSetting(
        packed_route(STUDY_ROAD_ID),
        {"route_id": STUDY_ROAD_ID},
        seed=seed_of_drive(1, drive),
        traffic=traffic,
    )
    values = values_of(phase, setting)
    portable = {part: dict(chosen) for part, chosen in values.items()}
    learn = portable["pldf"].pop("learn")
    portable["pldf"]["learn_faithful"] = int(learn == LEARN_FAITHFUL)
    return portable


def write_packages(folder: Path, fmus: Mapping[str, Fmu]) -> list[Path]:
    """Write ``study_PHASE.ssp`` and ``study_traffic_PHASE.ssp`` into ``folder``, to the FMUs.

    In ``inline/`` they stand once more, with the values in the structure and without ``.ssv``.

    Raises:
        ModelError: from ``sources``, or a package is not valid.
    """
    texts = sources(fmus)
    archives = {
        f"{ssp.RESOURCES}/{name}.fmu": (folder / f"{name}.fmu").read_bytes()
        for name in PARTS_IN_TRAFFIC.values()
    }
    (folder / INLINE).mkdir(exist_ok=True)
    written = []
    for series in SERIES:
        inner = [f"{ssp.RESOURCES}/{name}.fmu" for name in series.parts.values()]
        inside = {name: archives[name] for name in inner}
        for phase, inline in inline_structures(series, fmus).items():
            sets = {
                ssp.parameter_file(part): texts[f"{series.folder}{phase}/{part}.ssv"]
                for part in series.parts
            }
            usual = {ssp.STRUCTURE: texts[f"{series.folder}{ssp.STRUCTURE}"], **sets}
            name = f"{series.name}_{phase}.ssp"
            written.append(_written(folder / name, {**usual, **inside}))
            written.append(_written(folder / INLINE / name, {ssp.STRUCTURE: inline, **inside}))
    return written


def _written(path: Path, members: Mapping[str, bytes]) -> Path:
    write_archive(path, members)
    _require_valid(path)
    return path


def write_sources(folder: Path, fmus: Mapping[str, Fmu]) -> None:
    """Write what ``sources`` returns into ``folder``."""
    for name, text in sources(fmus).items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text)


def _require_valid(path: Path) -> None:
    """Check structure and parameter sets against the schemas of SSP 1.0."""
    try:
        read_ssd(str(path))
    except Exception as problem:  # fmpy raises bare Exception
        path.unlink()
        raise ModelError(f"{path.name} is not a valid SSP package:\n  {problem}") from None
