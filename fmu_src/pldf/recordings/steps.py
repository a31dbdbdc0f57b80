"""One intervention and what learning makes of it, step by step, by the kernel's own functions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from ..kernel.arrays import FloatArray
from ..kernel.interpolation import value_at
from ..kernel.stretch import joined_speed, stretch_factor, stretched_position
from .offline import Learned

AROUND_M: Final = 60.0  # shown before and behind
_INTERESTING_MPS: Final = 1.5  # a smaller change is hard to see in a figure


@dataclass(frozen=True, eq=False)
class Steps:
    """What happens to one intervention; positions in m, speeds in m/s.

    Attributes:
        number: of the intervention in its drive, from 1.
        kind: "gas" if the driver wanted to be faster there, else "brake".
        alpha: stretch factor after its limits.
        piece_m, recorded_mps: the recorded piece.
        stretched_m: where its samples are after eq. (1).
        joined_mps: their speeds after eq. (2).
        node_m: the places shown, one per metre.
        driven_mps: recorded speed of the whole drive there.
        followed_mps: the profile that this drive followed.
        mean_mps: after eq. (3), bounds kept.
        learned_mps: smoothed and cross-faded: the profile of the next drive.
    """

    number: int
    kind: Literal["gas", "brake"]
    alpha: float
    piece_m: FloatArray
    recorded_mps: FloatArray
    stretched_m: FloatArray
    joined_mps: FloatArray
    node_m: FloatArray
    driven_mps: FloatArray
    followed_mps: FloatArray
    mean_mps: FloatArray
    learned_mps: FloatArray


def explain_steps(learned: Learned) -> Steps | None:
    """Return the steps of the most telling intervention of a drive with the base function.

    Args:
        learned: from that drive; its function is left with other parameters.

    Returns:
        None if nothing was learned from any intervention.
    """
    function = learned.function
    k = _most_telling(learned)
    if k is None:
        return None
    # Without smoothing and cross-fade, what the same drive teaches is the mean of eq. (3).
    function.record.learning_smoothing_window_m = 1
    function.record.learning_fade_m = 0
    return _steps(learned, k, function.learn().learned_mps)


def _most_telling(learned: Learned) -> int | None:
    """Return the most stretched intervention among those that changed the profile well visibly.

    One that was not over when the recording ended has no end to explain.
    """
    function, new = learned.function, learned.iteration
    st, trace = function.record, function.trace
    change = np.abs(new.learned_mps - np.asarray(function.profile.learned_mps))
    candidates = []
    for k in range(st.drive_interventions):
        mine = (new.intervention == k + 1) & (new.drive == new.number)
        whole = trace.start_m[k] < trace.end_m[k] <= st.first_node + st.nodes - 1
        if mine.any() and whole:
            alpha = stretch_factor(st, function.route, trace, k)
            seen = min(float(change[mine].max()), _INTERESTING_MPS)
            candidates.append((seen, alpha, -k))
    return -max(candidates)[2] if candidates else None


def _steps(learned: Learned, k: int, mean_mps: FloatArray) -> Steps:
    function = learned.function
    st, trace = function.record, function.trace
    ends = d_0, d_n = trace.start_m[k], trace.end_m[k]
    alpha = stretch_factor(st, function.route, trace, k)
    piece = np.concatenate(([d_0], np.arange(np.floor(d_0) + 1.0, d_n), [d_n]))
    recorded = np.array([value_at(trace.speed_mps, d) for d in piece])
    start = stretched_position(d_0, d_n, alpha)
    lift = value_at(trace.speed_mps, start) - value_at(trace.speed_mps, d_0)
    followed = np.asarray(function.profile.learned_mps)
    first = max(int(start - AROUND_M), 0)
    shown = slice(first, min(int(d_n + AROUND_M), len(followed) - 1) + 1)
    wish = np.mean(recorded) - np.mean(np.interp(piece, np.arange(len(followed)), followed))
    return Steps(
        number=k + 1,
        kind="gas" if wish > 0.0 else "brake",
        alpha=alpha,
        piece_m=piece,
        recorded_mps=recorded,
        stretched_m=np.array([stretched_position(d, d_n, alpha) for d in piece]),
        joined_mps=np.array(
            [joined_speed(v, d, ends, lift) for v, d in zip(recorded, piece, strict=True)]
        ),
        node_m=np.arange(float(shown.start), shown.stop),
        driven_mps=np.array(trace.speed_mps)[shown],
        followed_mps=np.array(followed)[shown],
        mean_mps=mean_mps[shown],
        learned_mps=learned.iteration.learned_mps[shown],
    )
