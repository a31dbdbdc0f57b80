"""The scripts in studies/: the fit sees system A only, and the tables say what was measured."""

from __future__ import annotations

import ast
import tomllib
from pathlib import Path

import numpy as np
import pytest
from pldf.analysis.analysis import analyse
from pldf.analysis.drives_table import read_drives
from pldf.analysis.published import PUBLISHED
from pldf.analysis.study_folder import StudyFolder
from pldf.kernel.codes import LEARN_CONSISTENT, LEARN_FAITHFUL
from pldf.study.population import Distribution, read_distribution, sample_participants
from pldf.study.study_file import read_study, study_path

from studies import fit_population, predict_study

STUDIES = Path(fit_population.__file__).parent
FIT_INPUTS = ("fit_population.py", "population.toml", "population_constant_wish.toml")


def population(name: str) -> dict[str, dict]:
    return tomllib.loads((STUDIES / f"{name}.toml").read_text())


@pytest.mark.parametrize("name", FIT_INPUTS)
def test_the_fit_contains_nothing_of_system_b(name: str) -> None:
    text = (STUDIES / name).read_text()
    numbers = [share for rate in PUBLISHED["B"] for share in (f"{100 * rate:.2f}", f"{rate:.4f}")]
    assert not [n for n in (*numbers, "PUBLISHED", "published", '"B') if n in text]
    assert f"{100 * PUBLISHED['A'].pedal:.2f}" in text  # the search would find such a number


def test_the_fit_imports_neither_results_of_the_paper_nor_other_drives() -> None:
    tree = ast.parse((STUDIES / "fit_population.py").read_text())
    imported = [
        (node.module, name.name)
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for name in node.names
    ]
    assert ("pldf.study.phases", "PHASES") in imported
    assert not [what for what in imported if "published" in " ".join(map(str, what)).lower()]
    job = fit_population.Fit(people=1, jobs=1).job
    assert [phase.name for phase in job.settings.phases] == ["A1", "A2"]
    assert not any(phase.apply_learned for phase in job.settings.phases)


def test_the_older_fit_is_that_of_the_older_study_and_reached_the_targets() -> None:
    found = population("population_constant_wish")
    older = tomllib.loads(study_path("paper_constant_wish").read_text())
    assert read_distribution(older["distribution"]) == read_distribution(found["distribution"])
    fit = found["fit"]
    assert fit["targets_percent"] == pytest.approx([100 * rate for rate in PUBLISHED["A"]])
    assert fit["reached_percent"] == pytest.approx(fit["targets_percent"], abs=0.7)


def test_fitted_numbers_are_those_of_the_paper_study_and_reach_the_targets() -> None:
    found = population("population")
    paper = tomllib.loads(study_path("paper").read_text())
    assert read_distribution(paper["distribution"]) == read_distribution(found["distribution"])
    fit = found["fit"]
    assert fit["targets_percent"] == pytest.approx([100 * rate for rate in PUBLISHED["A"]])
    assert fit["reached_percent"] == pytest.approx(fit["targets_percent"], abs=0.7)
    factors = next(np.array(f) for f, rates in fit["tried"] if rates == fit["reached_percent"])
    expected = fit_population.fitted(factors).as_table()
    assert list(expected) == list(found["distribution"])
    for name, law in found["distribution"].items():
        usual = expected[name]
        if isinstance(usual, dict):
            assert law.pop("law") == usual.pop("law")
        assert law == pytest.approx(usual, rel=1e-4)


def test_the_rule_splits_the_variance_as_the_literature_correlates() -> None:
    """Speeds of one driver correlate by .49 from place to place, .81 at the same place."""
    for parts, total in (
        (("offset_person_sd_mps", "offset_place_sd_mps", "offset_occasion_sd_mps"), 5.0 / 3.6),
        (("lateral_person_sigma", "lateral_place_sigma", "lateral_occasion_sigma"), 0.25),
    ):
        person, place, occasion = (fit_population.RULE[f"wish_{part}"] ** 2 for part in parts)
        variance = person + place + occasion
        assert variance == pytest.approx(total**2, rel=0.005)
        assert person / variance == pytest.approx(0.49, abs=0.005)
        assert (person + place) / variance == pytest.approx(0.81, abs=0.005)


def test_the_fit_starts_from_the_starting_values_and_repeats() -> None:
    start, usual = fit_population.fitted(fit_population.START), Distribution()
    assert start.laws.items() <= usual.laws.items()
    assert start.numbers == {
        "wish_offset_mps": usual.wish_offset_mps.mean,
        "wish_lateral_accel_max_mps2": usual.wish_lateral_accel_max_mps2.median,
        **fit_population.RULE,
    }
    fit = fit_population.Fit(people=2, jobs=1)
    first, second = fit.rates(fit_population.START), fit.rates(fit_population.START)
    np.testing.assert_array_equal(first, second)
    assert first[2] <= first[0] + first[1] + 1e-9  # a union is no more than its parts
    assert first[2] > 10.0


def two_systems() -> predict_study.Predicted:
    """Return three studies in which all rates fall, and two people never use the lever."""
    rates = np.zeros((3, 43, 4, 3))
    rates[..., :2, :] = np.linspace(20.0, 40.0, 43)[:, None, None]
    rates[..., 2:, :] = 10.0 + np.linspace(0.0, 1.0, 43)[::-1, None, None]
    rates[:, :2, :, 1] = 0.0
    return predict_study.Predicted(rates)


def test_tables_show_paper_and_models_side_by_side() -> None:
    fell = two_systems()
    same = predict_study.Predicted(np.full_like(fell.rates, 25.0))
    text = predict_study.tables(
        {"constant_wish": same, "varying_wish": fell, "person_and_place": fell}
    )
    assert "| rate % | paper | one wish for ever | wish that varies |" in text
    assert "| pedal, A | 22.32 | 25.00 [25.00, 25.00] | 30.00 [30.00, 30.00] |" in text
    assert "| pedal, B | 12.04 | 25.00 [25.00, 25.00] | 10.50 [10.50, 10.50] |" in text
    assert "| pedal, fall from A to B | 10.28 | 0.00 [0.00, 0.00] | 19.50 [19.50, 19.50] |" in text
    assert "| pedal, Cohen's d_z | 0.98 | 0.00 [0.00, 0.00] |" in text
    assert "| combined | W = 1 | 0.0 [0.0, 0.0] | 0.0 [0.0, 0.0] |" in text
    assert "| set speed, drivers who fell | 35 to 40 | 0 [0, 0] | 41 [41, 41] |" in text
    assert "| set speed, drivers without difference | 2 | 43 [43, 43] | 2 [2, 2] |" in text
    assert "| drivers who never use the lever | 2 | 0 [0, 0] | 2 [2, 2] |" in text
    assert "| pedal | wish that varies | 30.00 [30.00, 30.00] | 30.00" in text
    assert "| paper | 22.32 | 12.04 | 39.76 | 12.42 | 54.68 | 22.97 | 0.98 | 35 to 40 | 2 |" in text
    (split,) = (line for line in text.splitlines() if line.startswith("| person and place |"))
    assert split.endswith("| 41 [41, 41] | 2 [2, 2] |")


def test_a_variance_split_otherwise_stays_the_same_in_total() -> None:
    rule = dict(zip(("person", "place", "occasion"), (3.5, 2.8, 2.2), strict=True))
    names = [kind.format(part) for kind in predict_study.KINDS for part in rule]
    table = dict(zip(names, (*rule.values(), 0.2, 0.1, 0.05), strict=True))
    expected = {
        "person_and_occasion": [49 / 68, 0.0, 19 / 68],
        "person_and_place": [49 / 81, 32 / 81, 0.0],
        "twice_the_occasion": [0.62 * 49 / 81, 0.62 * 32 / 81, 0.38],
    }
    assert list(expected) == list(predict_study.SPLITS)
    for split, shares in predict_study.SPLITS.items():
        other = predict_study.split_otherwise({**table, "wish.offset_mps": 2.0}, shares)
        for kind in (names[:3], names[3:]):
            variances = np.array([other[name] ** 2 for name in kind])
            assert variances.sum() == pytest.approx(sum(table[name] ** 2 for name in kind))
            np.testing.assert_allclose(variances / variances.sum(), expected[split])
        assert other["wish.offset_mps"] == 2.0


def test_a_model_is_driven_and_its_folder_can_be_analysed(tmp_path: Path) -> None:
    predict_study.drive_all(
        {"old": population("population_constant_wish")["distribution"]}, tmp_path, studies=1, jobs=1
    )
    rows = read_drives(tmp_path / "old" / "drives.csv")
    predicted = predict_study.Predicted(predict_study.rates_of(rows))
    assert predicted.rates.shape == (1, 43, 4, 3)
    analysis = analyse(StudyFolder(tmp_path / "old"))
    for k, measure in enumerate(predict_study.MEASURES):
        for at, system in enumerate("AB"):
            np.testing.assert_allclose(
                predicted.per_person[0, :, at, k], 100.0 * analysis.per_participant(measure, system)
            )
        (compared,) = predicted.compared(k)
        assert compared.fell == analysis.comparisons[measure].fell
    set_speed = sum(analysis.per_participant("set_speed", system) for system in "AB")
    assert predicted.without_lever() == [np.count_nonzero(set_speed == 0.0)]


def test_studies_have_different_people_with_numbers_of_their_own() -> None:
    first, second = (predict_study.study_people(k, Distribution()) for k in (0, 1))
    assert first[0].values == sample_participants(1, 1)[0].values
    assert len({person.number for person in (*first, *second)}) == 86
    assert first[0].values != second[0].values


@pytest.mark.parametrize("name", ["long_run", "stretch_factor"])
def test_long_runs_are_driven_by_the_people_of_the_papers_study(name: str) -> None:
    study = read_study(STUDIES / f"{name}.toml")
    assert study.participants == read_study(study_path("paper")).participants
    assert [phase.name for phase in study.settings.phases] == [f"B{k + 1}" for k in range(30)]


def test_the_long_run_has_every_gain_with_every_way_of_learning() -> None:
    long_run = read_study(STUDIES / "long_run.toml")
    found = {
        (int(one.settings.function["learn"]), one.settings.function["learning.set_speed_gain"])
        for one in long_run.variants.values()
    }
    learns = (LEARN_FAITHFUL, LEARN_CONSISTENT)
    assert found == {(learn, gain) for learn in learns for gain in (1.0, 0.81, 0.63, 0.5)}
