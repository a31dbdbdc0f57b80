"""How many participants a study needs, on people whose power is known by other ways."""

from __future__ import annotations

from math import inf, sqrt
from pathlib import Path

import numpy as np
import pytest
import scipy
from pldf.analysis.analysis import analyse
from pldf.analysis.statistics import paired_t, signed_rank
from pldf.analysis.study_folder import StudyFolder
from pldf.errors import ModelError
from pldf.files.tables import write_table

from studies import power

ALPHA = 0.05


def rng() -> np.random.Generator:
    return np.random.default_rng(7)


def test_tests_of_many_groups_are_those_of_one() -> None:
    groups = rng().normal(0.5, 1.0, (300, 9))
    groups[100:200] = np.round(2.0 * groups[100:200])  # zeros and ties
    groups[:4, :] = np.array([[0.0], [1.0], [-1.0], [2.0]])  # no spread
    t, rank = (power.is_found(kind, groups, ALPHA) for kind in ("t", "wilcoxon"))
    for d, by_t, by_rank in zip(groups, t, rank, strict=True):
        t_test, ranked = paired_t(d, 0.0 * d), signed_rank(d, 0.0 * d)
        falls = scipy.stats.rankdata(np.abs(d))[d > 0.0].sum() - (d == 0.0).sum() * (d > 0.0).sum()
        assert by_t == (t_test.p < ALPHA and t_test.t > 0.0)
        assert by_rank == (ranked.p < ALPHA and falls > ranked.w)
    assert 0.1 < t.mean() < 0.9
    assert 0.1 < rank.mean() < 0.9


def test_the_power_of_normal_differences_is_that_of_the_noncentral_t() -> None:
    fall = {"pedal": rng().normal(0.7, 1.0, 40_000)}
    curves = power.power_curves(fall, power.drawn(40_000, 400, rng())[:, :25], ALPHA)
    for n in (8, 15, 24):
        expected = power.t_power(0.7, n, ALPHA)
        assert curves["pedal"][n] == pytest.approx(expected, abs=4.0 * sqrt(0.25 / 400))


def test_noncentral_t_against_printed_tables() -> None:
    # Cohen's d_z 0.5: 34 pairs for a power of 0.8, 0.8077 with them (Faul et al. 2007, G*Power).
    assert power.t_needed(0.5, 0.8, ALPHA) == 34
    assert power.t_power(0.5, 34, ALPHA) == pytest.approx(0.8077, abs=1e-4)


def test_six_people_who_all_fall_are_needed_for_the_exact_test() -> None:
    # Whatever they are, p = 2 / 2^n: 0.0625 with five, 0.03125 with six.
    fall = {"combined": rng().uniform(1.0, 2.0, 400)}
    curve = power.power_curves(fall, power.drawn(400, 50, rng()), ALPHA)["combined"]
    assert [curve[n] for n in (4, 5, 6, 7, 8)] == [0.0, 0.0, 1.0, 1.0, 1.0]
    assert max(curve) == 8  # reached three times
    assert [power.needed(curve, target) for target in power.TARGETS] == [6.0, 6.0, 6.0]


def test_needed_is_from_where_on_the_power_lasts() -> None:
    curve = {3: 0.2, 4: 0.81, 5: 0.79, 6: 0.85, 7: 0.9}
    assert power.needed(curve, 0.8) == 6.0
    assert power.needed(curve, 0.1) == 3.0
    assert power.needed(curve, 0.95) == inf


def test_groups_are_of_different_people_and_follow_the_weights() -> None:
    weights = np.linspace(0.0, 2.0, 81)[1:]
    groups = power.drawn(80, 20_000, rng(), weights)
    assert groups.shape == (20_000, 20)
    assert all(len(set(group)) == 20 for group in groups[:100].tolist())
    share = np.bincount(groups[:, 0], minlength=80) / 20_000
    np.testing.assert_allclose(share, weights / weights.sum(), atol=4.0 * sqrt(0.025 / 20_000))


def test_the_interval_holds_what_other_people_need(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of people drawn anew the answer lies within, about as often as is said."""
    monkeypatch.setattr(power, "GROUPS_PER_WEIGHTING", 200)
    expected = power.t_needed(1.0, 0.8, ALPHA)
    within = []
    for seed in range(8):
        fall = {"pedal": np.random.default_rng(seed).normal(1.0, 1.0, 200)}
        curves = power.weighed(fall, 30, ALPHA, rng())
        counts = [power.needed(curve["pedal"], 0.8) for curve in curves]
        within.append(min(counts) <= expected <= max(counts))
    assert sum(within) >= 6


def write_drives(folder: Path, people: int) -> None:
    rates = np.clip(rng().normal(0.4, 0.05, (people, 4)) - [0.0, 0.0, 0.2, 0.2], 0.0, 1.0)
    phases = ("A1", "A2", "B1", "B2")
    cells = [
        (f"P{k:03d}", name, rates[k, d]) for k in range(people) for d, name in enumerate(phases)
    ]
    who, phase, rate = zip(*cells, strict=True)
    names = ("pedal_rate", "set_speed_rate", "combined_rate")
    write_table(
        folder / "drives.csv", {"participant": who, "phase": phase, **dict.fromkeys(names, rate)}
    )


def test_table_of_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_drives(tmp_path, 48)
    monkeypatch.setattr(power, "GROUPS", 200)
    monkeypatch.setattr(power, "GROUPS_PER_WEIGHTING", 100)
    text = power.table(power.falls(analyse(StudyFolder(tmp_path))), ALPHA, weightings=5)
    assert "| participants for a power of | 80 % | 90 % | 95 % |" in text
    assert "| set speed (Wilcoxon) | 6 [6, 6] | 6 [6, 6] | 6 [6, 6] |" in text
    assert "| pedal, if d_z is the paper's 0.98 (noncentral t) | 11 | 14 | 16 |" in text


@pytest.mark.parametrize("alpha", ["0", "5", "nan"])
def test_a_level_that_is_none_is_refused(
    alpha: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["power.py", "out", "--alpha", alpha])
    with pytest.raises(SystemExit):
        power.main()
    assert f"{alpha} must lie above 0 and be at most 0.5" in capsys.readouterr().err


def test_too_few_people_are_told(tmp_path: Path) -> None:
    write_drives(tmp_path, 8)
    with pytest.raises(ModelError, match=r"8 participants; groups are drawn from at least 24"):
        power.falls(analyse(StudyFolder(tmp_path)))
