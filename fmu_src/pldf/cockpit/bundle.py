"""All that the page needs to know of models, road and study: the ``Bundle`` of ``types.js``.

``python -m pldf.cockpit.bundle OUT.json`` writes that of the packaged study.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

from .. import __version__, hmi_texts
from ..analysis.study_folder import OWN_ROAD
from ..cosim.fmu import Fmu, described
from ..cosim.kinds import PARTS_IN_TRAFFIC
from ..cosim.master import connections
from ..cosim.values import Value, Values
from ..kernel.signals import Signal
from ..roads import Route, write_route_csv
from ..study.participants import DRIVER_SIGNALS, Participant, StudySettings, order_of
from ..study.phases import TRAFFIC, DriveSetting, Phase, seed_of_drive, values_of
from .desk_study import DeskStudy, read_desk_study
from .page_json import as_json, plain
from .road_view import road_view
from .wasm_models import WasmModel, wasm_models

# ruff: noqa: PLC0415 - fmpy is slow to import, and the command line imports this module

Announce = Callable[[str], None]

# What the study file is called beside the data.
STUDY: Final = "cockpit.toml"
# Where the page puts the road among the files of each FMU.
ROAD_FILE: Final = "road.prepared"
_KINDS: Final = {"Enumeration": "Integer"}
_FLAGS: Final = {"true": True, "false": False, "": False}


def bundle(desk: DeskStudy, language: str = "", announce: Announce = print) -> dict[str, Any]:
    """Return the bundle of a study, with bytes as base64.

    Args:
        desk: the study.
        language: "en" or "de" in place of the study's.
        announce: hears what is being done if the FMUs have to be compiled, which takes minutes.

    Raises:
        ModelError: there are no FMUs as WebAssembly.
    """
    models = wasm_models(announce)
    parts = {part: models[name] for part, name in PARTS_IN_TRAFFIC.items()}
    fmus = {part: _fmu(model) for part, model in parts.items()}
    road = desk.study.settings.road
    made = {
        "version": __version__,
        "language": language or desk.table.language,
        "models": {part: _model(model, fmus[part]) for part, model in parts.items()},
        "wires": [[list(wire.source), list(wire.target)] for wire in connections(fmus)],
        "road": road_view(road),
        "plan": _plan(desk, fmus),
        "texts": json.loads(hmi_texts.as_json()),
        "pages": desk.pages,
        "questionnaires": desk.questionnaires,
        "beside": {STUDY: desk.study.source.encode(), OWN_ROAD: _road_csv(road.route)},
    }
    return dict(plain(made))


def _road_csv(route: Route) -> bytes:
    """Return the road as a file from which the analysis reads it again to the bit."""
    with TemporaryDirectory() as folder:
        path = Path(folder, OWN_ROAD)
        write_route_csv(route, path)
        return path.read_bytes()


def _fmu(model: WasmModel) -> Fmu:
    from fmpy import read_model_description  # type: ignore[import-untyped]

    with TemporaryDirectory() as folder:
        file = Path(folder, "modelDescription.xml")  # fmpy reads files, and archives
        file.write_bytes(model.description)
        return described(read_model_description(str(file)), Path())


def _model(model: WasmModel, fmu: Fmu) -> dict[str, Any]:
    return {
        "name": model.name,
        "guid": fmu.description.guid,
        "version": fmu.description.version,
        "wasm": model.wasm,
        "variables": [_variable(fmu, signal) for signal in fmu.signals.values()],
        "resources": {},
    }


def _variable(fmu: Fmu, signal: Signal) -> dict[str, Any]:
    return {
        "name": signal.name,
        "reference": fmu.references[signal.name],
        "kind": _KINDS.get(signal.kind, signal.kind),
        "causality": signal.causality,
        "start": _as_kind(signal, signal.start),
        "unit": signal.unit,
        "items": list(signal.enumeration.items) if signal.enumeration else [],
    }


def _as_kind(signal: Signal, value: object) -> Any:
    """Return a value as the page holds one of this kind."""
    if signal.kind == "String":
        return str(value)
    if signal.kind == "Boolean":
        return _FLAGS[value] if isinstance(value, str) else bool(value)
    number = float(str(value) or 0)
    return number if signal.kind == "Real" else int(number)


def _plan(desk: DeskStudy, fmus: Mapping[str, Fmu]) -> dict[str, Any]:
    study, table = desk.study, desk.table
    settings = study.settings
    return {
        "title": study.title,
        "drives": [_drive(desk, fmus, i, phase) for i, phase in enumerate(settings.phases)],
        "orders": {"AB": _order(settings, 1), "BA": _order(settings, 2)},
        "counterbalanced": settings.counterbalanced,
        "practice": table.practice,
        "practice_end_m": min(table.practice_end_m, _end_m(settings)),
        "step_s": settings.step_s,
        "end_m": _end_m(settings),
        "breaks": desk.breaks,
        "explanations": list(table.explanations),
        "steering": table.steering,
        "fov_deg": table.fov_deg,
    }


def _end_m(settings: StudySettings) -> float:
    return settings.route.nodes - 1.0


def _order(settings: StudySettings, number: int) -> list[str]:
    """Return the names of the phases as a participant with this number would drive them."""
    counterbalanced = replace(settings, counterbalanced=True)
    return [phase.name for phase in order_of(counterbalanced, Participant(f"P{number:03d}", 1))]


def _drive(desk: DeskStudy, fmus: Mapping[str, Fmu], number: int, phase: Phase) -> dict[str, Any]:
    settings, one = desk.study.settings, desk.study.participants[0]
    setting = DriveSetting(
        route=settings.route,
        road={"route_file": ROAD_FILE},
        seed=seed_of_drive(one.seed, number),
        person_seed=one.seed,
        learn=settings.learn,
        more={
            "pldf": {k: v for k, v in settings.function.items() if k != "learn"},
            "vehicle": settings.vehicle,
            "driver": {DRIVER_SIGNALS[name].name: one.value(name) for name in one.values},
        },
        traffic={"kind": TRAFFIC} if desk.table.traffic else None,
    )
    return {
        "phase": phase.name,
        "apply_learned": phase.apply_learned,
        "learn": phase.learn,
        "intervenes": phase.intervenes,
        "values": _typed(fmus, values_of(phase, setting)),
    }


def _typed(fmus: Mapping[str, Fmu], values: Values) -> dict[str, dict[str, Value]]:
    return {
        part: {name: _as_kind(fmus[part].signals[name], value) for name, value in chosen.items()}
        for part, chosen in values.items()
    }


def main() -> None:
    """Write the bundle of the packaged study into the file that is named."""
    Path(sys.argv[1]).write_bytes(as_json(bundle(read_desk_study())))


if __name__ == "__main__":
    main()
