"""The phases of the study as SSP packages, each with its own start values.

All phases have the same structure; what differs are the parameter sets. Nothing is wired or set
here: connections and values are those of the coupled drives.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from fmpy.ssp.ssd import read_ssd  # type: ignore[import-untyped]

from ..cosim.drive_limits import STEP_S
from ..cosim.fmu import Fmu
from ..cosim.kinds import PARTS
from ..cosim.master import connections
from ..cosim.values import Value
from ..errors import ModelError
from ..kernel.codes import LEARN_FAITHFUL
from ..roads import packed_route
from ..roads.load import STUDY_ROAD_ID
from ..study.phases import PHASES, DriveSetting, Phase, seed_of_drive, values_of
from . import ssp
from .archive import write_archive

# The function alone needs 211 s for the road; drivers who intervene are faster. No longer than
# that, because time behind the end of the road lowers the rates that the function reports.
STOP_TIME_S: Final = 220.0


def sources(fmus: Mapping[str, Fmu]) -> dict[str, bytes]:
    """Return the readable content of all packages: the structure and each phase's values.

    Args:
        fmus: from ``unpacked``.

    Returns:
        Text by path: ``SystemStructure.ssd`` and ``PHASE/PART.ssv``.

    Raises:
        ModelError: a connection or a value cannot be expressed for every importer.
    """
    components = [
        ssp.Component(part, f"{PARTS[part]}.fmu", fmu.signals) for part, fmu in fmus.items()
    ]
    system = ssp.System(
        name="study",
        about="Driving function, vehicle and driver on the road of the study",
        components=components,
        connections=connections(fmus),
        stop_time_s=STOP_TIME_S,
        step_s=STEP_S,
    )
    try:
        texts = {ssp.STRUCTURE: ssp.structure(system)}
        for drive, phase in enumerate(PHASES.values()):
            values = start_values(phase, drive)
            for component in components:
                text = ssp.parameter_set(component.signals, values[component.name])
                texts[f"{phase.name}/{component.name}.ssv"] = text
    except ValueError as problem:
        raise ModelError(f"SSP packages: {problem}") from None
    return texts


def start_values(phase: Phase, drive: int) -> dict[str, dict[str, Value]]:
    """Return the values of a drive on the study's road, without enumerations, by part and name."""
    setting = DriveSetting(
        packed_route(STUDY_ROAD_ID), {"route_id": STUDY_ROAD_ID}, seed=seed_of_drive(1, drive)
    )
    values = values_of(phase, setting)
    portable = {part: dict(chosen) for part, chosen in values.items()}
    learn = portable["pldf"].pop("learn")
    portable["pldf"]["learn_faithful"] = int(learn == LEARN_FAITHFUL)
    return portable


def write_packages(folder: Path, fmus: Mapping[str, Fmu]) -> list[Path]:
    """Write ``study_PHASE.ssp`` for every phase into ``folder``, where the FMUs are.

    Raises:
        ModelError: from ``sources``, or a package is not valid.
    """
    texts = sources(fmus)
    archives = {
        f"{ssp.RESOURCES}/{name}.fmu": (folder / f"{name}.fmu").read_bytes()
        for name in PARTS.values()
    }
    written = []
    for phase in PHASES:
        sets = {ssp.parameter_file(part): texts[f"{phase}/{part}.ssv"] for part in PARTS}
        path = folder / f"study_{phase}.ssp"
        write_archive(path, {ssp.STRUCTURE: texts[ssp.STRUCTURE], **sets, **archives})
        _require_valid(path)
        written.append(path)
    return written


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
