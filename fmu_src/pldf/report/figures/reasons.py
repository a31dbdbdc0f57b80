"""The band of reasons: why the car drove at its speed, where."""

from __future__ import annotations

from itertools import pairwise
from types import SimpleNamespace
from typing import Any, Final, cast

import numpy as np

from ...hmi_texts import text_of
from ...kernel.codes import LANGUAGE_EN, REASON
from ...kernel.sentences import NUMBERS
from ...recordings.recording import Recording
from .. import palette
from ..scene import Axis, Box, Boxes, Panel, Tick
from .speeds import KM

_SENTENCE: Final = "hmi_sentence"
_Y: Final = Axis("", low=0.0, high=1.0, ticks=(Tick(0.5, "Reason"),), grid=False)
HEIGHT_IN: Final = 0.28


def reason_panels(recording: Recording, x: Axis) -> tuple[Panel, ...]:
    """Return the band under a drive; none if the recording does not tell reasons.

    Hovering says what the cluster said where a reason began, and from where to where it held.
    """
    if "hmi_reason" not in recording:
        return ()
    boxes: dict[str, list[Box]] = {}
    for first, last in _runs(recording):
        name = REASON.items[int(recording["hmi_reason"][first])]
        boxes.setdefault(name, []).append(_box(recording, first, last, name))
    elements = tuple(
        Boxes(tuple(boxes[name]), fill, label)
        for name, (label, fill) in palette.REASONS.items()
        if name in boxes
    )
    return (Panel(elements, x, _Y, HEIGHT_IN),)


def _runs(recording: Recording) -> list[tuple[int, int]]:
    """Return first row and the row at which it is over of each reason that moved the car on."""
    reason, s_m = recording["hmi_reason"], recording["s_m"]
    edges = [0, *(np.flatnonzero(np.diff(reason)) + 1).tolist(), len(reason) - 1]
    runs = pairwise(edges)
    return [(first, last) for first, last in runs if s_m[last] > s_m[first]]


def _box(recording: Recording, first: int, last: int, name: str) -> Box:
    start, end = recording["s_m"][[first, last]].tolist()
    said = _said(recording, first) or palette.REASONS[name][0]
    return Box(start * KM, end * KM, 0.0, 1.0, f"{said} ({start:.0f} to {end:.0f} m)")


def _said(recording: Recording, row: int) -> str:
    """Return the sentence of the cluster in a row, in English; empty if it was not recorded."""
    fields = (_SENTENCE, *(f"{_SENTENCE}_{name}" for name in NUMBERS))
    if any(field not in recording for field in fields):
        return ""
    numbers = {field: int(recording[field][row]) for field in fields}
    return text_of(cast(Any, SimpleNamespace(hmi_language=LANGUAGE_EN, **numbers)))
