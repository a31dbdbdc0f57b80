"""Figures of drives: speed over distance, interventions, pedals."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from math import ceil, floor
from typing import Final

import numpy as np

from ...kernel.units import KMH_PER_MPS
from ...profiles.stored_profile import StoredProfile
from ...recordings.interventions import Interval, pedal_interventions, set_speed_interventions
from ...recordings.recording import Recording
from .. import palette
from ..scene import Axis, Band, Box, Boxes, Element, Fill, Line, Panel, Scene, Stroke, Tick
from .reasons import reason_panels
from .speeds import (
    KM,
    base_line,
    distance_of,
    limit_line,
    speed_axis,
    speed_line,
    thinned,
    zero_line,
)

_STRIP: Final = 0.045  # height of the set-speed strip, share of the panel
_BAR_OPACITY: Final = 0.75  # of interventions in lanes, which hide nothing
_CHANGED_MPS: Final = 1e-6
_NOT_RECORDED: Final = {
    "profile_mps": "profile followed",
    "set_speed_offset_mps": "where the driver set the speed",
}
_PEDAL_REACH_MIN: Final = 10.0  # percent
_PEDAL_TICKS_MAX: Final = 6


def recorded(
    recordings: Mapping[str, Recording], title: str, profile: StoredProfile | None = None
) -> Scene:
    """Return the figure of one complete recording, or of several to compare."""
    if len(recordings) > 1:
        return compared(recordings, title, profile)
    return one_drive(next(iter(recordings.values())), title, profile)


def one_drive(recording: Recording, title: str, profile: StoredProfile | None = None) -> Scene:
    """Return speed, interventions and pedals of one recording."""
    x, speeds = distance_of(recording), speed_axis([recording])
    travel = thinned(recording)
    s_km, gas, brake = travel["s_m"] * KM, travel["gas_pedal"], travel["brake_pedal"]
    none = np.zeros(len(s_km))
    up, down = Fill(palette.GREEN, 0.8), Fill(palette.VERMILLION, 0.8)
    pedals: tuple[Element, ...] = (
        Band(s_km, none, 100.0 * gas, up, "Gas pedal travel", listed=False),
        Band(s_km, -100.0 * brake, none, down, "Brake pedal travel", listed=False),
        zero_line(x),
    )
    elements = (*_drive(recording, speeds), *_newest(profile))
    drive = Panel(elements, x, speeds, 3.6, not_known(recording).strip())
    feet = Panel(pedals, x, _pedal_axis([recording]), 1.3)
    return Scene((drive, *reason_panels(recording, x), feet), title)


def compared(
    recordings: Mapping[str, Recording], title: str, profile: StoredProfile | None = None
) -> Scene:
    """Return speeds of several recordings, below them where drivers intervened, and pedals.

    Args:
        recordings: by name; limits and base profile are those of the first.
        title: of the whole figure.
        profile: show the newest state of this profile too.
    """
    first = next(iter(recordings.values()))
    x = distance_of(first)
    rows = thinned(first)
    speeds: list[Element] = [
        limit_line(first["s_m"], first["limit_mps"]), base_line(rows["s_m"], rows["base_mps"]),
        *_newest(profile),
    ]  # fmt: skip
    pedals: list[Element] = [zero_line(x)]
    for number, (name, recording) in enumerate(recordings.items()):
        speeds.append(driven_line(number, name, recording))
        pedals += _pedal_lines(number, name, recording)
    lanes = Axis(
        "Driver acts in", low=len(recordings) - 0.5, high=-0.5,
        ticks=tuple(
            Tick(lane, name, _stroke(lane).colour) for lane, name in enumerate(recordings)
        ),
    )  # fmt: skip
    return Scene(
        (
            Panel(tuple(speeds), x, speed_axis(recordings.values()), 3.4),
            Panel(
                tuple(_lanes(recordings)),
                x,
                lanes,
                0.4 + 0.22 * len(recordings),
                _set_speeds_not_known(recordings),
            ),
            Panel(tuple(pedals), x, _pedal_axis(recordings.values()), 1.2),
        ),
        title,
    )


def drives(recordings: Mapping[str, Recording], titles: Mapping[str, str], title: str) -> Scene:
    """Return a panel per drive: limit, profiles, speed, interventions shaded, reasons below.

    What is not known of a drive stands in its title.

    Args:
        recordings: complete, by drive, in order of driving.
        titles: what each drive was.
        title: of the whole figure.
    """
    x, speeds = distance_of(next(iter(recordings.values()))), speed_axis(recordings.values())
    panels: list[Panel] = []
    for name, recording in recordings.items():
        about = f"{name}  {titles[name]}{not_known(recording)}"
        panels.append(Panel(_drive(recording, speeds), x, speeds, 2.2, about))
        panels += reason_panels(recording, x)
    return Scene(tuple(panels), title)


def not_known(recording: Recording) -> str:
    """Return which parts of a figure are missing since the recording does not tell, in brackets."""
    absent = [what for name, what in _NOT_RECORDED.items() if name not in recording]
    return f" (not known: {', '.join(absent)})" if absent else ""


def driven_line(number: int, name: str, recording: Recording) -> Line:
    """Return the speed of the recording with this number, from 0, among several."""
    rows = thinned(recording)
    label = f"Speed driven in {name}"
    return speed_line(rows["s_m"], rows["speed_mps"], _stroke(number), label)


def _stroke(number: int) -> Stroke:
    return palette.COMPARED[number % len(palette.COMPARED)]


def _drive(recording: Recording, speeds: Axis) -> tuple[Element, ...]:
    """Return limit, base profile, profile followed and speed, with the interventions shaded."""
    rows = thinned(recording).columns
    s_m, base = rows["s_m"], rows["base_mps"]
    followed = rows.get("profile_mps", base)
    elements: list[Element] = [
        limit_line(recording["s_m"], recording["limit_mps"]),
        base_line(s_m, base),
    ]
    if np.any(np.abs(followed - base) > _CHANGED_MPS):
        label = "Learned profile, followed"
        ends = base * KMH_PER_MPS, followed * KMH_PER_MPS
        elements += [
            Band(s_m * KM, *ends, palette.LEARNED, label, listed=False),
            speed_line(s_m, followed, palette.FOLLOWED, label),
        ]
    elements.append(speed_line(s_m, rows["speed_mps"], palette.DRIVEN, "Speed driven"))
    low, high = speeds.ends
    for kind, intervals in _interventions(recording).items():
        top = low + _STRIP * (high - low) if kind == "set_speed" else high
        boxes = (_box(recording, interval, low, top) for interval in intervals)
        name, fill = palette.INTERVENTIONS[kind]
        elements.append(Boxes(tuple(boxes), fill, name))
    return tuple(elements)


def _interventions(recording: Recording) -> dict[str, list[Interval]]:
    """Return the interventions of a recording by kind; kinds that do not occur are left out."""
    every = [*pedal_interventions(recording), *set_speed_interventions(recording)]
    by_kind = {kind: [i for i in every if i.kind == kind] for kind in palette.INTERVENTIONS}
    return {kind: intervals for kind, intervals in by_kind.items() if intervals}


def _box(recording: Recording, interval: Interval, low: float, high: float, drive: str = "") -> Box:
    rows = [interval.first, interval.last]
    (start, end), (begin_s, end_s) = recording["s_m"][rows] * KM, recording["time_s"][rows]
    name = palette.INTERVENTIONS[interval.kind][0]
    where = f"{drive}, {name}" if drive else name
    return Box(float(start), float(end), low, high, f"{where}: {end_s - begin_s:.1f} s")


def _lanes(recordings: Mapping[str, Recording]) -> list[Element]:
    """Return bars where the driver intervened, one lane per recording; set speed below pedals."""
    ends = {"gas": (-0.35, 0.0), "brake": (-0.35, 0.0), "set_speed": (0.03, 0.3)}
    bars: dict[str, list[Box]] = {kind: [] for kind in palette.INTERVENTIONS}
    for lane, (name, recording) in enumerate(recordings.items()):
        for kind, intervals in _interventions(recording).items():
            low, high = (lane + end for end in ends[kind])
            bars[kind] += [_box(recording, interval, low, high, name) for interval in intervals]
    return [
        Boxes(tuple(boxes), replace(fill, opacity=_BAR_OPACITY), name)
        for (name, fill), boxes in zip(palette.INTERVENTIONS.values(), bars.values(), strict=True)
        if boxes
    ]


def _set_speeds_not_known(recordings: Mapping[str, Recording]) -> str:
    names = [name for name, r in recordings.items() if "set_speed_offset_mps" not in r]
    return f"not known: where the driver set the speed in {', '.join(names)}" if names else ""


def _pedal_lines(number: int, name: str, recording: Recording) -> list[Element]:
    """Return gas upwards and brake downwards; they are hidden and shown with the speed."""
    rows, stroke = thinned(recording), replace(_stroke(number), width_pt=1.1)
    label = f"Speed driven in {name}"
    return [
        Line(rows["s_m"] * KM, sign * 100.0 * rows[column], stroke, label, listed=False, name=pedal)
        for column, sign, pedal in (
            ("gas_pedal", 1.0, f"Gas pedal in {name}"),
            ("brake_pedal", -1.0, f"Brake pedal (negative) in {name}"),
        )
    ]


def _pedal_axis(recordings: Collection[Recording]) -> Axis:
    """Return an axis in percent that gas and brake of all recordings fit into."""
    reach = {
        pedal: max(_PEDAL_REACH_MIN, *(100.0 * float(np.max(r[pedal])) for r in recordings))
        for pedal in ("gas_pedal", "brake_pedal")
    }
    low, high = -1.2 * reach["brake_pedal"], 1.2 * reach["gas_pedal"]
    step = next(step for step in (5, 10, 20, 50, 100) if (high - low) / step < _PEDAL_TICKS_MAX)
    places = range(step * ceil(low / step), floor(high) + 1, step)
    ticks = tuple(Tick(place, str(abs(place))) for place in places)
    return Axis("Pedals", "%", note="brake | gas", low=low, high=high, ticks=ticks)


def _newest(profile: StoredProfile | None) -> tuple[Element, ...]:
    if profile is None:
        return ()
    newest = profile.iteration()
    label = f"Profile after drive {newest.number}"
    s_m = np.arange(float(profile.nodes))
    return (speed_line(s_m, newest.learned_mps, palette.NEWEST, label),)
