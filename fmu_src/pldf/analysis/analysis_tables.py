"""The tables of an analysis as CSV: for spreadsheets, R and papers."""

from __future__ import annotations

from collections.abc import Sequence
from math import isnan
from pathlib import Path

import numpy as np

from ..files.tables import Cell, write_table
from .analysis import PARTICIPANTS_MIN, RATES, Analysis
from .statistics import Comparison, compare


def write_tables(analysis: Analysis, folder: Path) -> list[Path]:
    """Write the tables into ``folder`` and return their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    tables = {
        "participants.csv": _participants(analysis),
        "phases.csv": _phases(analysis),
        "tests.csv": _tests(analysis),
    }
    if analysis.questionnaire:
        tables["items.csv"] = _items(analysis)
    for name, (header, *rows) in tables.items():
        columns = zip(*rows, strict=True)
        write_table(folder / name, dict(zip(map(str, header), columns, strict=True)))
    return [folder / name for name in tables]


def _participants(analysis: Analysis) -> list[Sequence[Cell]]:
    """One row per participant and system: what entered the tests."""
    measures = [*RATES, *(analysis.questionnaire.scores if analysis.questionnaire else ())]
    names = [f"{name}_rate" if name in RATES else name for name in measures]
    rows: list[Sequence[Cell]] = [("participant", "system", *names)]
    values = {
        system: np.column_stack([analysis.per_participant(name, system) for name in measures])
        for system in "AB"
    }
    for at, participant in enumerate(analysis.participants):
        rows += [(participant, system, *map(_cell, values[system][at])) for system in "AB"]
    return rows


def _cell(value: float) -> Cell:
    """Return a cell, empty for what is not known."""
    return "" if isnan(value) else float(value)


def _phases(analysis: Analysis) -> list[Sequence[Cell]]:
    """One row per phase and rate: mean with its 95 % confidence interval."""
    rows: list[Sequence[Cell]] = [("phase", "rate", "participants", "mean", "low", "high")]
    for phase in analysis.phases:
        for measure in RATES:
            interval = analysis.interval(phase, measure)
            count = int(np.isfinite(analysis.rate(phase, measure)).sum())
            rows.append((phase, measure, count, interval.value, interval.low, interval.high))
    return rows


def _tests(analysis: Analysis) -> list[Sequence[Cell]]:
    """One row per measure: both tests and the effect sizes."""
    heading = (
        "measure", "participants", "mean_a", "mean_b", "difference", "low", "high",
        "t", "df", "p_t", "w", "pairs", "zeros", "p_wilcoxon", "wilcoxon_method",
        "p_wilcoxon_normal", "p_wilcoxon_corrected", "cohen_dz", "rank_biserial", "fell",
    )  # fmt: skip
    return [
        heading,
        *((name, *_cells(comparison)) for name, comparison in analysis.comparisons.items()),
    ]


def _cells(comparison: Comparison) -> Sequence[Cell]:
    t, ranks, difference = comparison.t, comparison.signed_rank, comparison.difference
    return (
        comparison.people, comparison.mean_first, comparison.mean_second,
        difference.value, difference.low, difference.high,
        t.t, t.df, t.p, ranks.w, ranks.pairs, ranks.zeros, ranks.p, ranks.method,
        ranks.p_normal, ranks.p_corrected,
        comparison.d_z, comparison.rank_biserial, comparison.fell,
    )  # fmt: skip


def _items(analysis: Analysis) -> list[Sequence[Cell]]:
    """One row per item of the questionnaire, scored; of those who answered it in A and B."""
    assert analysis.questionnaire is not None
    rows: list[Sequence[Cell]] = [
        ("item", "participants", "mean_a", "mean_b", "w", "pairs", "p_wilcoxon")
    ]
    for item, answers in analysis.questionnaire.items.items():
        both = [n for n in analysis.participants if answers.keys() >= {(n, "A"), (n, "B")}]
        if len(both) < PARTICIPANTS_MIN:
            rows.append((item, len(both), "", "", "", "", ""))
            continue
        a, b = ([answers[name, system] for name in both] for system in "AB")
        found = compare(a, b)
        ranks = found.signed_rank
        means = found.mean_first, found.mean_second
        rows.append((item, len(both), *means, ranks.w, ranks.pairs, ranks.p))
    return rows
