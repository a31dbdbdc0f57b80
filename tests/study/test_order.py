"""The script on the order of the drives: who drives what, and what the table and figure say."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy
from pldf.study.participants import order_of
from pldf.study.phases import PHASES
from pldf.study.population import sample_participants

from studies import order

PEOPLE = sample_participants(2, 1)


def test_ways_differ_in_the_order_and_in_what_is_learned() -> None:
    fixed, balanced, nothing = (order.settings_of(way, 0.05) for way in order.DRAWN)
    assert {s.threshold_growth_per_drive for s in (fixed, balanced, nothing)} == {0.05}
    for settings in (fixed, balanced):
        assert settings.phases == tuple(PHASES.values())
    orders = [[phase.name for phase in order_of(balanced, person)] for person in PEOPLE]
    assert orders == [
        ["A1", "A2", "A3", "B1", "B2", "B3"],
        ["A2", "B1", "B2", "B3", "A1", "A3"],
    ]
    assert [phase.name for phase in order_of(nothing, PEOPLE[1])] == list(PHASES)
    assert not any(phase.apply_learned or phase.learn for phase in nothing.phases)
    assert [p.intervenes for p in nothing.phases] == [p.intervenes for p in fixed.phases]


def test_who_learns_nothing_and_gets_used_to_it_intervenes_less() -> None:
    rates = order.drive(order.NOTHING, 1.0, PEOPLE, jobs=1)
    assert rates.shape == (2, 2, 3)
    assert (rates[:, 1, 2] < rates[:, 0, 2]).all()  # thresholds of 8 to 16 times at the end


def test_falls_have_the_t_interval_of_their_mean() -> None:
    rates = np.random.default_rng(3).uniform(0.0, 100.0, (9, 2, 3))
    found = list(order.effects(order.FIXED, 0.02, rates))
    assert [effect.measure for effect in found] == ["pedal", "set_speed", "combined"]
    for k, effect in enumerate(found):
        falls = rates[:, 0, k] - rates[:, 1, k]
        expected = scipy.stats.ttest_1samp(falls, 0.0).confidence_interval(0.95)
        assert (effect.fall.low, effect.fall.high) == pytest.approx(tuple(expected))
        assert effect.a - effect.b == pytest.approx(effect.fall.value)


def test_table_and_files_hold_every_share_and_way(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    falls = {order.FIXED: 40.0, order.COUNTERBALANCED: 36.0, order.NOTHING: 10.0}
    found = []
    for share in order.SHARES:
        for way, fall in falls.items():
            b = rng.uniform(0.0, 20.0, (4, 1, 3))
            found += order.effects(way, share, np.concatenate((b + fall, b), axis=1))
    lines = order.table(found).splitlines()
    assert len(lines) == 2 + 3 * len(order.SHARES)
    assert lines[-1] == (
        "| pedals or set speed | 10 % | 40.00 [40.00, 40.00] | 36.00 [36.00, 36.00] "
        "| 10.00 [10.00, 10.00] | 25.0 % |"
    )
    order.write(found, tmp_path)
    header, *rows = (tmp_path / "order.csv").read_text().splitlines()
    assert header.startswith("threshold_growth_per_drive,way,measure,a_percent,b_percent,fall")
    assert len(rows) == 3 * len(order.SHARES) * len(order.DRAWN)
    assert (tmp_path / "order.png").stat().st_size > 10_000
