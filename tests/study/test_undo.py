"""A wrong lesson can be undone by pedals alone (section 3.4): the script that counts the drives."""

from __future__ import annotations

import pytest
from pldf.study.participants import StudySettings
from pldf.study.simulation import Simulation

from studies.undo import MISTAKES, THRESHOLDS_KMH, Undoing, mistakes, sampled, straight_road, undo


@pytest.fixture(scope="module")
def undone() -> list[Undoing]:
    simulation = Simulation(StudySettings(road=straight_road(), phases=()))
    return [
        undo(simulation, stored, threshold_kmh, name)
        for name, stored in mistakes(simulation)
        for threshold_kmh in THRESHOLDS_KMH
    ]


def test_every_mistake_is_gone_after_about_as_many_drives_as_halving_takes(
    undone: list[Undoing],
) -> None:
    assert len(undone) == len(MISTAKES) * len(THRESHOLDS_KMH)
    for row in undone:
        assert 0 <= row.drives <= row.halvings + 1, row
        assert row.left_kmh < 1.2 * row.threshold_kmh, row


def test_drawn_mistakes_are_gone_as_fast_in_nine_of_ten_cases() -> None:
    simulation = Simulation(StudySettings(road=straight_road(), phases=()))
    rows = list(sampled(simulation, 30))
    assert len(rows) == 30
    assert sum(row.is_fast for row in rows) >= 27
    assert sum(row.halvings > 0 for row in rows) > 20  # there was something to undo


def test_mistakes_are_learned_but_a_stop_is_not(undone: list[Undoing]) -> None:
    taught = {row.mistake: row.taught_kmh for row in undone}
    assert taught.pop("stop") == 0.0
    assert min(taught.values()) > 5.0
