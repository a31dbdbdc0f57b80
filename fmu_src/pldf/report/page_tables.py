"""The tables of the report as HTML: against the paper, and the questionnaires' scores."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Final

from ..analysis.analysis import RATES, Analysis
from ..analysis.published import DRIVERS, SOURCE, TESTS, published_means
from ..analysis.statistics import Comparison
from .figures.shares import RATE_TITLES

_SMALLEST_P: Final = 1e-300
_MINUS: Final = "&minus;"
_SCALES: Final = {
    "usefulness": "Usefulness (&minus;2 … +2)",
    "satisfying": "Satisfying (&minus;2 … +2)",
    "speed_profile": "Speed profile, six items (1 … 5)",
}


def against_paper(analysis: Analysis) -> str:
    """Return the rates and the paper's tests, next to the numbers of the paper."""
    rates = [_rates(measure, analysis.comparisons[measure]) for measure in RATES]
    tests = [_tests(measure, analysis.comparisons[measure]) for measure in RATES]
    return (
        _table(
            '<th></th><th>A</th><th class="paper">paper</th><th>B</th><th class="paper">paper</th>'
            '<th>A &minus; B, 95 %</th><th>change</th><th class="paper">paper</th>',
            rates,
        )
        + '<p class="note">Share of the driving time with interventions in %: means over '
        f"{_and(analysis.compared['A'])} and over {_and(analysis.compared['B'])}. Paper: {DRIVERS} "
        f"people, {escape(SOURCE)}.</p>"
        + _table(
            '<th></th><th class="left">Test</th><th class="left paper">paper</th>'
            "<th>d<sub>z</sub></th><th>r</th><th>fell</th>",
            tests,
        )
        + '<p class="note">Two-sided tests, those of the paper: paired t for the pedals, else '
        "Wilcoxon's signed ranks (exact without ties and zeros up to 50 pairs, else normal "
        "approximation without continuity correction). d<sub>z</sub>: Cohen's d of the "
        "differences; r: rank-biserial correlation; fell: participants with less in B than in A. "
        "Both tests of every measure are in tests.csv.</p>"
    )


def _table(heading: str, rows: Sequence[str]) -> str:
    return (
        f'<div class="scroll"><table><thead><tr>{heading}</tr></thead>'
        f"<tbody>{''.join(rows)}</tbody></table></div>"
    )


def _and(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _rates(measure: str, found: Comparison) -> str:
    paper_a, paper_b = published_means(measure)
    change = found.difference
    cells = (
        f"<th>{RATE_TITLES[measure]}</th>",
        _cell(f"{100 * found.mean_first:.2f}"),
        _cell(f"{100 * paper_a:.2f}", "paper"),
        _cell(f"{100 * found.mean_second:.2f}"),
        _cell(f"{100 * paper_b:.2f}", "paper"),
        _cell(f"{100 * change.value:.2f} ({100 * change.low:.2f} … {100 * change.high:.2f})"),
        _cell(_change(found.mean_first, found.mean_second)),
        _cell(_change(paper_a, paper_b), "paper"),
    )
    return f"<tr>{''.join(cells)}</tr>"


def _tests(measure: str, found: Comparison) -> str:
    paper = TESTS[measure]
    cells = (
        f"<th>{RATE_TITLES[measure]}</th>",
        _cell(_test(found, paper.kind), "left"),
        _cell(f"{paper.text}, {_p(paper.p)}", "left paper"),
        _cell(f"{found.d_z:.2f}"),
        _cell(f"{found.rank_biserial:.2f}"),
        _cell(f"{found.fell} of {found.t.df + 1}"),
    )
    return f"<tr>{''.join(cells)}</tr>"


def _cell(content: str, style: str = "") -> str:
    return f'<td class="{style}">{content}</td>' if style else f"<td>{content}</td>"


def _test(found: Comparison, kind: str) -> str:
    if kind == "t":
        return f"t({found.t.df}) = {found.t.t:.2f}, {_p(found.t.p)}"
    ranks = found.signed_rank
    return f"W = {ranks.w:g}, n = {ranks.pairs}, {_p(ranks.p)} ({ranks.method})"


def _p(p: float) -> str:
    """Return ``p = 0.012``, small values with a power of ten."""
    if p >= 0.001:
        return f"p = {p:.3f}"
    if p < _SMALLEST_P:
        return "p &lt; 10<sup>&minus;300</sup>"
    digits, _, power = f"{p:.2e}".partition("e")
    return f"p = {digits} · 10<sup>&minus;{abs(int(power))}</sup>"


def _change(a: float, b: float) -> str:
    return f"{100 * (b - a) / a:+.0f} %".replace("-", _MINUS) if a > 0.0 else "&ndash;"


def percent(share: float) -> str:
    """Return ``12.3 %``."""
    return f"{100 * share:.1f} %"


def scores_table(analysis: Analysis) -> str:
    """Return the scores of each scale with system A and B, Wilcoxon's test and alpha."""
    assert analysis.questionnaire is not None
    rows = []
    for scale in analysis.questionnaire.scores:
        found = analysis.comparisons[scale]
        change = found.difference
        cells = (
            *(f"{mean:.2f}".replace("-", _MINUS) for mean in (found.mean_first, found.mean_second)),
            f"{-change.value:+.2f} ({-change.high:.2f} … {-change.low:.2f})".replace("-", _MINUS),
            _test(found, "wilcoxon"), f"{-found.rank_biserial:.2f}".replace("-", _MINUS),
            f"{analysis.questionnaire.reliability(scale):.2f}",
        )  # fmt: skip
        rows.append(f"<tr><th>{_SCALES[scale]}</th>{''.join(map(_cell, cells))}</tr>")
    heading = "".join(
        f"<th>{title}</th>"
        for title in ("", "A", "B", "B &minus; A, 95 %", "Wilcoxon", "r", "alpha")
    )
    return (
        _table(heading, rows) + '<p class="note">Higher is better. Usefulness and satisfying: the '
        "acceptance scale of Van der Laan, Heino and De Waard (1997). r: rank-biserial "
        "correlation, positive where B is rated higher. alpha: Cronbach's, over both systems.</p>"
    )
