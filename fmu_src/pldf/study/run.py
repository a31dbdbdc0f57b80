"""The study: drives one driver through the phases and keeps everything that came out."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from ..cosim.fmu import Fmu
from ..cosim.master import Drive, drive
from ..files.disk import replace_file
from ..instance import ModelError
from ..profiles.store import ProfileStore, StoredProfile
from ..recordings.interventions import Rates
from ..recordings.recording import Recording, write_recording
from ..roads import fingerprint
from .phases import Phase, Setting, values_of

RATES: Final = (
    "drive",
    "apply_learned",
    "learn",
    "driver_intervenes",
    "interventions",
    "time_s",
    "rate_pedal",
    "rate_set_speed",
    "rate_combined",
)
_SETTINGS: Final = "study.json"

# Called with the phase that is driven and the position in m.
Progress = Callable[[Phase, float], None]


@dataclass(frozen=True, eq=False)
class Driven:
    """One phase of a study and what came out.

    Attributes:
        iteration: number of drives that the profile had been learned from afterwards.
    """

    phase: Phase
    drive: Drive
    iteration: int

    @property
    def recording(self) -> Recording:
        """One row per step."""
        return self.drive.recording

    @property
    def rates(self) -> Rates:
        """The intervention rates that the driving function reported."""
        outputs = self.drive.outputs
        return Rates(*(outputs[f"rate.{name}"] for name in Rates._fields))

    @property
    def interventions(self) -> int:
        """Number of pedal interventions."""
        return int(self.drive.outputs["drive.interventions"])

    @property
    def time_s(self) -> float:
        """Duration of the drive."""
        return float(self.recording["time_s"][-1])


def run_study(
    fmus: Mapping[str, Fmu],
    phases: Sequence[Phase],
    setting: Setting,
    out: Path,
    progress: Progress,
) -> tuple[list[Driven], StoredProfile | None]:
    """Drive all ``phases`` and write recordings, profiles and rates into ``out``.

    Returns:
        The drives, and the profile at the end (None if nothing was learned).

    Raises:
        ModelError: a drive did not reach the end, or an FMU reported an error.
    """
    if setting.store is None:
        raise ModelError("a study needs a profile store of its own")
    _make_fresh(out, setting)
    replace_file(out / _SETTINGS, _described(fmus, phases, setting))
    (out / "recordings").mkdir(exist_ok=True)
    driven = []
    for number, phase in enumerate(phases):
        course = setting.course(lambda s_m, phase=phase: progress(phase, s_m))  # type: ignore[misc]
        result = drive(fmus, values_of(phase, setting, number), course)
        _require_good(phase, result)
        write_recording(out / "recordings" / f"{phase.name}.csv", result.recording)
        profile = _stored(setting)
        driven.append(Driven(phase, result, len(profile.iterations) if profile else 0))
    replace_file(out / "rates.csv", _rates_csv(driven))
    profile = _stored(setting)
    if profile is not None:
        (out / "profile_after").mkdir(exist_ok=True)
        for one in driven:
            csv = _profile_csv(profile, one.iteration)
            replace_file(out / "profile_after" / f"{one.phase.name}.csv", csv)
    return driven, profile


def mean_rates(driven: Sequence[Driven], group: str) -> Rates:
    """Return the mean rates of the drives of one group (A or B) in which the driver intervenes."""
    chosen = [one.rates for one in driven if one.phase.name[0] == group and one.phase.intervenes]
    return Rates(*(float(np.mean(values)) for values in zip(*chosen, strict=True)))


def _make_fresh(out: Path, setting: Setting) -> None:
    """Take away what an earlier study learned in ``out``, and nothing that somebody else put there.

    Raises:
        ModelError: there are profiles in ``out`` that are not from a study.
    """
    store = ProfileStore(setting.store or out)
    old = [*store.files(), *store.refused()]
    if old and not (out / _SETTINGS).exists():
        raise ModelError(
            f"{store.folder}: holds profiles that are not from a study; choose another --out"
        )
    for file in old:
        file.unlink()
    out.mkdir(parents=True, exist_ok=True)


def _described(fmus: Mapping[str, Fmu], phases: Sequence[Phase], setting: Setting) -> bytes:
    """Return what determines the results, as JSON."""
    described = {
        "phases": [phase.name for phase in phases],
        "driver_id": setting.driver_id,
        "seed": setting.seed,
        "step_s": setting.step_s,
        "route": setting.route.name,
        "route_fingerprint": fingerprint(setting.route),
        "set": setting.more,
        "fmus": {part: fmu.about for part, fmu in fmus.items()},
    }
    return (json.dumps(described, indent=2) + "\n").encode()


def _require_good(phase: Phase, result: Drive) -> None:
    for said in result.said:
        if said.level == "error":
            raise ModelError(f"drive {phase.name}: {said.fmu}: {said.text}")
    if not result.arrived:
        raise ModelError(f"drive {phase.name} was given up: the vehicle {result.ending}")


def _stored(setting: Setting) -> StoredProfile | None:
    route = setting.route
    store = ProfileStore(setting.store or "")
    return store.load(setting.driver_id, fingerprint(route), route.nodes)


def _rates_csv(driven: Sequence[Driven]) -> bytes:
    rows = [RATES] + [
        (
            one.phase.name,
            *(str(int(flag)) for flag in one.phase[1:]),
            str(one.interventions),
            *(repr(value) for value in (one.time_s, *one.rates)),
        )
        for one in driven
    ]
    return ("\n".join(",".join(row) for row in rows) + "\n").encode()


def _profile_csv(profile: StoredProfile, number: int) -> bytes:
    """Return one state of a profile with the columns of ``pldf profiles export``."""
    state = profile.iteration(number)
    s_m = np.arange(float(profile.nodes))
    columns = (s_m, profile.base_mps, state.learned_mps, state.offset_mps)
    rows = zip(*(column.tolist() for column in columns), strict=True)
    lines = ["s_m,base_mps,learned_mps,offset_mps", *(",".join(map(repr, row)) for row in rows)]
    return ("\n".join(lines) + "\n").encode()
