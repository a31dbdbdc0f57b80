"""What a recording says against itself, against the road, or against what a car can do.

Each check is a generator of findings. Thresholds leave room for what honest recordings have:
rounding to four decimals or whole metres, float32, one sample per second, noise of sensors. An
error is only what makes every number wrong, such as a speed in km/h; all else is a warning.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Final

import numpy as np

from ..errors import ModelError
from ..findings import Finding, Severity
from ..kernel.arrays import RouteArrays
from ..kernel.codes import ACTIVE, GAS_OVERRIDE, MODE
from . import against_road, apart, frozen, set_speeds, unit_doubts
from .columns import RECORDING
from .interventions import PRESSED
from .quality import HOLE_S, Hole, holes
from .recording import Recording

# Pedals are held against the mode from here on; below, feet and sensors rest.
_CLEARLY_PRESSED: Final = 0.05
_PEDAL_MAX: Final = 1.05
_PERCENT_MIN: Final = 1.5  # a pedal travel above this is no share any more
_CONTRADICTED_SHARE: Final = 0.05
_CONTRADICTED_S: Final = 2.0
_TOLD: Final = 4  # holes told in full
_MOVES_M: Final = 1.0


def contradictions(
    recording: Recording, path: str | Path, route: RouteArrays | None
) -> list[Finding]:
    """Return what contradicts itself in ``recording``, errors first.

    Args:
        recording: as it was read.
        path: its file, as findings name it.
        route: the road it was driven on; None: not known, and nothing is said about it.
    """
    file = str(path)
    for check in (_missing, _not_numbers, _time_order):
        if unusable := list(check(recording, file)):
            return unusable
    found = [*unit_doubts.unit_doubts(recording, file, route)]
    scales_fit = not any(finding.severity == "error" for finding in found)
    if route is not None:
        found += against_road.against_road(recording, file, route, scales_fit)
    if scales_fit:
        found += frozen.frozen(recording, file)
        if not (_about("speed_mps", found) or _about("s_m", found)):
            found += apart.apart(recording, file)
        found += [*_standing(recording, file), *_holes(recording, file)]
    found += [*_never_active(recording, file), *_never_eligible(recording, file)]
    found += _pedals(recording, file)
    if not _about("set_speed_mps", found):
        found += set_speeds.set_speeds(recording, file)
    return sorted(found, key=lambda finding: finding.severity != "error")


def _about(column: str, found: list[Finding]) -> bool:
    """Tell whether a column is doubted already: what follows from that needs no finding."""
    return any(column in finding.place.split(", ") for finding in found)


def require_sound(
    recording: Recording, path: str | Path, route: RouteArrays | None
) -> list[Finding]:
    """Return the warnings among the contradictions.

    Raises:
        ModelError: there are errors; with all of them, a line each.
    """
    found = contradictions(recording, path, route)
    if errors := [str(finding) for finding in found if finding.severity == "error"]:
        raise ModelError("\n  ".join(errors))
    return found


def _missing(recording: Recording, file: str) -> Iterator[Finding]:
    """Yield what no file is without, but a recording made in Python may be."""
    needed = [column.name for column in RECORDING.columns if column.needed]
    if missing := [name for name in needed if name not in recording]:
        text = f"missing column {', '.join(missing)}"
        yield Finding("error", file, 0, "", text, "", "every recording needs them")
    elif len(recording) < RECORDING.rows_min:
        text = f"{len(recording)} samples"
        yield Finding("error", file, 0, "", text, "", f"{RECORDING.rows_min} are needed at least")


def _not_numbers(recording: Recording, file: str) -> Iterator[Finding]:
    for name, values in recording.columns.items():
        wrong = np.flatnonzero(~np.isfinite(values))
        if len(wrong):
            at = "" if wrong[0] == 0 else f", first in sample {wrong[0] + 1}"
            yield Finding(
                "error", file, 0, name, f"{len(wrong)} of {len(values)} samples are no number{at}",
                "nothing can be computed from them",
                "leave those samples out, or the column if it may be absent",
            )  # fmt: skip


def _time_order(recording: Recording, file: str) -> Iterator[Finding]:
    time = recording["time_s"]
    for row in np.flatnonzero(np.diff(time) <= 0.0)[:_TOLD].tolist():
        again = "stands still at" if time[row + 1] == time[row] else "runs backwards from"
        to = "" if time[row + 1] == time[row] else f" to {time[row + 1]:.10g} s"
        yield Finding(
            "error", file, 0, f"sample {row + 2}, time_s", f"time {again} {time[row]:.10g} s{to}",
            "durations and rates would be wrong",
            "sort the samples by time, or cut the recording where the logger began anew",
        )  # fmt: skip


def _standing(recording: Recording, file: str) -> Iterator[Finding]:
    s = recording["s_m"]
    if (driven := float(np.ptp(s))) < _MOVES_M:
        moving = bool(np.median(np.abs(recording["speed_mps"])) > _MOVES_M)
        severity: Severity = "error" if moving else "warning"
        yield Finding(
            severity, file, 0, "s_m", f"the car covers {driven:.3g} m",
            "there is no drive to learn from or to take rates of",
            "record the position along the road (s_m)" if moving else "leave the recording out",
        )  # fmt: skip


def _holes(recording: Recording, file: str) -> Iterator[Finding]:
    found = holes(recording)
    if not found:
        return
    lost = sum(hole.lost_m for hole in found)
    if 2 * len(found) > len(recording) - 1:
        period = float(np.median(np.diff(recording["time_s"])))
        yield Finding(
            "error", file, 0, "time_s",
            f"a sample every {period:.3g} s; more than {HOLE_S:g} s is a hole",
            "nothing is learned, and short interventions are missed",
            "record at least once per second; is the unit of time_s s?",
        )  # fmt: skip
        return
    many = f"{len(found)} drop-outs" if len(found) > 1 else "a drop-out"
    more = f" and {len(found) - _TOLD} more" if len(found) > _TOLD else ""
    yield Finding(
        "warning", file, 0, "",
        f"{many} of more than {HOLE_S:g} s: {'; '.join(map(_told, found[:_TOLD]))}{more}",
        f"{lost:.0f} m are not learned, nor interventions that touch them",
        "look for what stopped the logger; nothing else is lost",
    )  # fmt: skip


def _told(hole: Hole) -> str:
    return (
        f"{hole.duration_s:.1f} s at {hole.time_s:.1f} s ({hole.from_m:.0f} to {hole.to_m:.0f} m)"
    )


def _never_active(recording: Recording, file: str) -> Iterator[Finding]:
    mode = recording["mode"]
    if np.any(mode == ACTIVE):
        return
    seen = ", ".join(MODE.items[int(code)] for code in np.unique(mode))
    yield Finding(
        "warning", file, 0, "mode", f"never ACTIVE, only {seen}",
        "without the function there are no interventions: rates of 0, nothing learned",
        "check which words or numbers of the logger mean ACTIVE ([mode] in a mapping file), or "
        "leave the recording out",
    )  # fmt: skip


def _never_eligible(recording: Recording, file: str) -> Iterator[Finding]:
    if "eligible" in recording and not np.any(recording["eligible"]):
        yield Finding(
            "warning", file, 0, "eligible", "0 in every row: learning was allowed nowhere",
            "nothing is learned", "leave the column out if learning was allowed everywhere",
        )  # fmt: skip


def _pedals(recording: Recording, file: str) -> Iterator[Finding]:
    for name in ("gas_pedal", "brake_pedal"):
        if name in recording:
            highest, lowest = float(np.max(recording[name])), float(np.min(recording[name]))
            if highest > _PERCENT_MIN:
                in_percent = highest <= 100.0 * _PEDAL_MAX
                yield Finding(
                    "warning", file, 0, name, f"up to {highest:.4g}, wanted is 0 to 1"
                    + ("; percent?" if in_percent else ""),
                    f"a foot that rests counts as pressed (from {PRESSED:g} on)",
                    unit_doubts.stated((name, "%"))
                    if in_percent else "scale it to 0 to 1 by a factor in a mapping file",
                )  # fmt: skip
            elif highest > _PEDAL_MAX or lowest < 1.0 - _PEDAL_MAX:
                yield Finding(
                    "warning", file, 0, name, f"from {lowest:.4g} to {highest:.4g}, wanted is "
                    "0 to 1", "presses may be missed or seen where there are none",
                    "calibrate the pedal by factor and add in a mapping file",
                )  # fmt: skip
            else:
                yield from _pressed_while_active(recording, name, file)
    yield from _override_without_gas(recording, file)


def _pressed_while_active(recording: Recording, name: str, file: str) -> Iterator[Finding]:
    active = recording["mode"][:-1] == ACTIVE
    passed_s = np.diff(recording["time_s"])
    pressed = recording[name][:-1] > _CLEARLY_PRESSED
    together_s, active_s = float(passed_s[active & pressed].sum()), float(passed_s[active].sum())
    if together_s > max(_CONTRADICTED_S, _CONTRADICTED_SHARE * active_s):
        yield Finding(
            "warning", file, 0, f"{name}, mode",
            f"pressed for {together_s:.1f} s of the {active_s:.1f} s in which mode is ACTIVE",
            "a pressed pedal ends ACTIVE, so mode or pedal is not what it is taken for; "
            "interventions go by mode",
            "record the driver's pedal, not what the function asks of the car, and the mode of "
            "the same moment",
        )  # fmt: skip


def _override_without_gas(recording: Recording, file: str) -> Iterator[Finding]:
    if "gas_pedal" not in recording:
        return
    override = recording["mode"][:-1] == GAS_OVERRIDE
    passed_s = np.diff(recording["time_s"])
    released = recording["gas_pedal"][:-1] <= 0.0
    apart_s, override_s = (float(passed_s[m].sum()) for m in (override & released, override))
    if apart_s > max(_CONTRADICTED_S, 0.5 * override_s):
        yield Finding(
            "warning", file, 0, "gas_pedal, mode",
            f"mode is GAS_OVERRIDE for {override_s:.1f} s, in {apart_s:.1f} s of it without gas",
            "interventions go by mode; if the pedal is right, they are too long",
            "check that mode and gas_pedal are of the same drive and moment",
        )  # fmt: skip
