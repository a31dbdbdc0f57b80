"""How many participants would find the effects of a study again?

    python studies/power.py out/prediction/varying_wish       # after studies/predict_study.py

Groups of n people are drawn from those of a folder with drives (of predict_study.py, of
`pldf study`, or of real people), each person at most once in a group, and tested as the paper did
(pldf/analysis/statistics.py). The power is the share of the groups whose rate falls significantly
from A to B, two-sided at --alpha. Given is, for each hypothesis and for all three in one study,
the number of participants from which on the power is reached.

The people in the folder were themselves drawn by chance. In brackets is therefore the range that
holds 95 % of the answers when every person gets a random weight (Bayesian bootstrap).
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Mapping
from math import ceil, sqrt
from pathlib import Path
from typing import Final

import numpy as np
import scipy
from numpy.typing import NDArray
from pldf.analysis import implied
from pldf.analysis.analysis import RATES, Analysis, analyse
from pldf.analysis.published import DRIVERS, TESTS
from pldf.analysis.statistics import EXACT_PAIRS_MAX, differences
from pldf.analysis.study_folder import SYSTEMS, StudyFolder
from pldf.errors import ModelError
from pldf.kernel.arrays import FloatArray

BoolArray = NDArray[np.bool_]
# Power by number of participants.
Curve = dict[int, float]

TARGETS: Final = (0.80, 0.90, 0.95)
GROUPS: Final = 20_000
WEIGHTINGS: Final = 200
GROUPS_PER_WEIGHTING: Final = 1000
PEOPLE_MIN: Final = 3
# Groups of more of the people have too many in common to stand for different studies.
LARGEST_GROUP: Final = 0.25
# The power of exact tests goes up and down a little from n to n + 1: so often it must be reached.
LASTING: Final = 3
SEED: Final = 1
ALL: Final = "all three"


def falls(analysis: Analysis) -> dict[str, FloatArray]:
    """Return by how much each person's rates fall from A to B, by measure.

    Raises:
        ModelError: there are too few people to draw groups from.
    """
    people, least = len(analysis.participants), ceil((PEOPLE_MIN + LASTING) / LARGEST_GROUP)
    if people < least:
        raise ModelError(
            f"{analysis.source}: {people} participants; groups are drawn from at least {least} and "
            "are up to a quarter of them; drive more with 'count' in a study file"
        )
    return {
        measure: differences(*(analysis.per_participant(measure, s) for s in SYSTEMS))
        for measure in RATES
    }


def is_found(kind: str, d: FloatArray, alpha: float) -> BoolArray:
    """Tell of each row of differences whether the test of this kind says that they fall.

    Two-sided at ``alpha``, and in this direction: half of it on this side.
    """
    p = _t_p(d) if kind == "t" else _rank_p(d)
    return p < alpha / 2.0  # type: ignore[no-any-return]


def _t_p(d: FloatArray) -> FloatArray:
    constant = (d == d[:, :1]).all(axis=1)
    p = np.where(d[:, 0] > 0.0, 0.0, 1.0)  # what ``statistics`` says of differences without spread
    p[~constant] = scipy.stats.ttest_1samp(d[~constant], 0.0, axis=1, alternative="greater").pvalue
    return p


def _rank_p(d: FloatArray) -> FloatArray:
    """Exact without zeros and ties, else by the normal approximation, as in ``statistics``."""
    size = np.sort(np.abs(d), axis=1)
    exact = (size[:, 0] > 0.0) & (size[:, 1:] > size[:, :-1]).all(axis=1)
    exact &= d.shape[1] <= EXACT_PAIRS_MAX
    p = np.ones(len(d))
    for rows, method in (exact, "exact"), (~exact & (size[:, -1] > 0.0), "asymptotic"):
        if rows.any():
            p[rows] = scipy.stats.wilcoxon(
                d[rows], axis=1, alternative="greater", method=method, correction=False
            ).pvalue
    return p


def drawn(
    people: int, groups: int, rng: np.random.Generator, weights: FloatArray | None = None
) -> NDArray[np.intp]:
    """Return groups[group, place] of different people, ``LARGEST_GROUP`` of all.

    One after the other is drawn with odds as ``weights`` from those who are left (Gumbel's trick).
    The first n of a group are a group of n.
    """
    size = int(LARGEST_GROUP * people)
    keys = rng.gumbel(size=(groups, people)) + (0.0 if weights is None else np.log(weights))
    return np.argsort(-keys, axis=1)[:, :size]


def power_curves(
    fall: Mapping[str, FloatArray], groups: NDArray[np.intp], alpha: float
) -> dict[str, Curve]:
    """Return the power of each hypothesis and of all together by number of participants.

    As far as it takes until the largest target is reached ``LASTING`` times by all of them.
    """
    curves: dict[str, Curve] = {name: {} for name in (*fall, ALL)}
    for n in range(PEOPLE_MIN, groups.shape[1] + 1):
        found = {m: is_found(TESTS[m].kind, d[groups[:, :n]], alpha) for m, d in fall.items()}
        found[ALL] = np.logical_and.reduce(list(found.values()))
        for name, hits in found.items():
            curves[name][n] = float(hits.mean())
        if len(curves[ALL]) >= LASTING and min(list(curves[ALL].values())[-LASTING:]) >= max(
            TARGETS
        ):
            break
    return curves


def needed(curve: Curve, target: float) -> float:
    """Return from how many participants on the power is reached; infinite if it is not."""
    below = [n for n, power in curve.items() if power < target]
    first = max(below, default=min(curve) - 1) + 1
    return float(first) if first in curve else np.inf


def t_needed(d_z: float, target: float, alpha: float) -> int:
    """Return the same for a t test of normal differences of this size (noncentral t)."""
    return next(n for n in range(PEOPLE_MIN, 10**6) if t_power(d_z, n, alpha) >= target)


def t_power(d_z: float, n: int, alpha: float) -> float:
    """Return the power of a paired t test to find a fall; differences are normal."""
    critical = scipy.stats.t.isf(alpha / 2.0, n - 1)
    return float(scipy.stats.nct.sf(critical, n - 1, d_z * sqrt(n)))


def weighed(
    fall: Mapping[str, FloatArray], weightings: int, alpha: float, rng: np.random.Generator
) -> Iterator[dict[str, Curve]]:
    """Yield the power curves of the same people with random weights."""
    people = len(next(iter(fall.values())))
    for _ in range(weightings):
        groups = drawn(people, GROUPS_PER_WEIGHTING, rng, rng.exponential(size=people))
        yield power_curves(fall, groups, alpha)


def table(fall: Mapping[str, FloatArray], alpha: float, weightings: int = WEIGHTINGS) -> str:
    """Return the participants needed as a Markdown table."""
    rng = np.random.default_rng(SEED)
    people = len(next(iter(fall.values())))
    curves = power_curves(fall, drawn(people, GROUPS, rng), alpha)
    others = list(weighed(fall, weightings, alpha, rng))
    head = [f"{100.0 * target:.0f} %" for target in TARGETS]
    lines = [_row("participants for a power of", *head), "|---|" + "---|" * len(head)]
    for name in curves:
        cells = []
        for target in TARGETS:
            counts = [needed(other[name], target) for other in others]
            low, high = np.quantile(counts, [0.025, 0.975], method="nearest")
            shown = (_count(n, people) for n in (needed(curves[name], target), low, high))
            cells.append("{} [{}, {}]".format(*shown))
        lines.append(_row(_title(name), *cells))
    d_z = implied.d_z(TESTS["pedal"])
    cells = [str(t_needed(d_z, target, alpha)) for target in TARGETS]
    lines.append(_row(f"pedal, if d_z is the paper's {d_z:.2f} (noncentral t)", *cells))
    return "\n".join(lines) + "\n"


def _row(*cells: str) -> str:
    return "| " + " | ".join(cells) + " |"


def _title(name: str) -> str:
    if name == ALL:
        return f"{ALL} in one study"
    return f"{name.replace('_', ' ')} ({'paired t' if TESTS[name].kind == 't' else 'Wilcoxon'})"


def _count(n: float, people: int) -> str:
    return f"{n:.0f}" if np.isfinite(n) else f"more than {int(LARGEST_GROUP * people)}"


def _level(text: str) -> float:
    """Return a level of significance; at more than 0.5 chance would do."""
    level = float(text)
    if not 0.0 < level <= 0.5:
        raise argparse.ArgumentTypeError(f"{text} must lie above 0 and be at most 0.5")
    return level


def main() -> int:
    """Draw and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="with drives.csv or recordings")
    parser.add_argument("--alpha", type=_level, default=0.05, help="level, two-sided; default 0.05")
    options = parser.parse_args()
    try:
        fall = falls(analyse(StudyFolder(options.folder)))
    except ModelError as problem:
        print(f"error: {problem}", file=sys.stderr)
        return 1
    people = len(fall["pedal"])
    print(f"{people} people, two-sided at {options.alpha:g}; the paper had {DRIVERS}\n")
    print(table(fall, options.alpha), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
