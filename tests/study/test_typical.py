"""The typical person: nearest to the medians, in standard deviations, drawn parts included."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
import scipy
from pldf.errors import ModelError
from pldf.roads import Route, open_route
from pldf.study.participants import DRIVER_SIGNALS, Participant
from pldf.study.population import (
    FIELDS,
    Distribution,
    Law,
    Lognormal,
    Normal,
    Share,
    Uniform,
    sample_participants,
)
from pldf.study.study_file import ONE_DRIVER, PACKAGED, read_study, study_path
from pldf.study.typical import distance, typical

from studies import adopt_population
from vehicle_models.variation_kernel import (
    LATERAL_OF_PERSON,
    LATERAL_OF_PLACE,
    OFFSET_OF_PERSON,
    OFFSET_OF_PLACE,
    keyed_uniform,
)

QUANTILES = np.linspace(0.01, 0.99, 21)
# Everybody is at the medians: only what the driver model draws tells people apart.
AT_THE_MEDIANS = Distribution().with_numbers(
    {
        "wish_offset_mps": 2.0, "wish_lateral_accel_max_mps2": 2.9, "wish_accel_max_mps2": 1.5,
        "wish_accel_min_mps2": -1.3, "wish_anticipation_s": 2.0, "driver_threshold_mps": 1.4,
        "driver_reaction_s": 1.0, "driver_overshoot": 0.6, "driver_reactivation_s": 2.0,
        "driver_uses_lever": 1.0, "driver_lever_settled_s": 3.0,
    }
)  # fmt: skip


@pytest.mark.parametrize(
    ("law", "expected"),
    [
        (Normal(2.0, 1.5), scipy.stats.norm.ppf(QUANTILES)),
        (Lognormal(-1.3, 0.2), scipy.stats.norm.ppf(QUANTILES)),
        (Uniform(0.0, 1.2), (1.2 * QUANTILES - 0.6) / scipy.stats.uniform(0.0, 1.2).std()),
        (Share(0.75), -1.0 * (QUANTILES >= 0.75) / scipy.stats.bernoulli(0.75).std()),
        (Share(0.2), (QUANTILES < 0.2) / scipy.stats.bernoulli(0.2).std()),
        (Normal(2.0, 0.0), 0.0 * QUANTILES),
        (Lognormal(2.0, 0.0), 0.0 * QUANTILES),
        (Uniform(2.0, 2.0), 0.0 * QUANTILES),
        (Share(1.0), 0.0 * QUANTILES),
    ],
)
def test_laws_tell_deviations_in_standard_deviations(law: Law, expected: np.ndarray) -> None:
    found = [law.deviation(law.at(float(u))) for u in QUANTILES]
    np.testing.assert_allclose(found, expected, atol=1e-12)


def test_a_value_at_an_end_deviates_as_the_end_does() -> None:
    assert Normal(2.0, 1.0, low=1.5).deviation(Normal(2.0, 1.0, low=1.5).at(0.01)) == -0.5
    assert Lognormal(1.0, 1.0, high=0.0).deviation(0.0) == -np.inf


def test_the_typical_person_is_nearest_by_all_laws() -> None:
    distribution, route = Distribution(), open_route("study")
    people = sample_participants(30, 4, distribution)
    values = np.array([[person.values[name] for name in FIELDS] for person in people])
    normal = {"wish_offset_mps": (7.0 / 3.6, 5.0 / 3.6), "wish_anticipation_s": (2.0, 1.5)}
    total = np.zeros(30)
    for name, column in zip(FIELDS, values.T, strict=True):
        law = getattr(distribution, name)
        if isinstance(law, Lognormal):
            total += (np.log(column / law.median) / law.sigma) ** 2
        elif name in normal:
            mean, sd = normal[name]
            total += ((column - mean) / sd) ** 2
        elif name == "driver_overshoot":
            total += (column - 0.6) ** 2 / (1.2**2 / 12.0)
        else:
            total += (1.0 - column) / (0.95 * 0.05)
    found = [distance(person, distribution, route) for person in people]
    np.testing.assert_allclose(found, np.sqrt(total), rtol=1e-12)
    assert typical(people, distribution, route) is people[int(np.argmin(total))]


def drawn(person: Participant, purpose: int, metre: int) -> float:
    return float(scipy.special.ndtri(keyed_uniform(person.seed, purpose, metre)))


def road(curvature: tuple[float, ...]) -> Route:
    s_m = np.array([0.0, 200.0, 300.0, 1000.0])
    limit = np.array([20.0, 20.0, 25.0, 25.0])
    return Route("a road", s_m, np.array(curvature), limit, *np.zeros((3, 4)), has_line=False)


def test_what_the_driver_model_draws_of_the_wish_counts_over_the_road() -> None:
    sds = {"wish_offset_person_sd_mps": 0.9, "wish_offset_place_sd_mps": 0.4}
    distribution = AT_THE_MEDIANS.with_numbers({**sds, "wish_offset_occasion_sd_mps": 3.0})
    people = sample_participants(20, 1, distribution)
    straight = road((0.0, 0.0, 0.0, 0.0))
    for person in people:
        parts = [
            0.9 * drawn(person, OFFSET_OF_PERSON, 0) + 0.4 * drawn(person, OFFSET_OF_PLACE, metre)
            for metre in (0, 300)
        ]
        # 300 m with the first limit, 701 nodes with the second.
        square = (300 * parts[0] ** 2 + 701 * parts[1] ** 2) / 1001
        expected = np.sqrt(square) / np.hypot(0.9, 0.4)
        assert distance(person, distribution, straight) == pytest.approx(expected, rel=1e-9)


def test_the_accepted_lateral_acceleration_counts_in_curves() -> None:
    sigmas = {"wish_lateral_person_sigma": 0.2, "wish_lateral_place_sigma": 0.1}
    distribution = AT_THE_MEDIANS.with_numbers({**sigmas, "wish_lateral_occasion_sigma": 0.3})
    one, *_ = sample_participants(1, 1, distribution)
    assert distance(one, distribution, road((0.0, 0.0, 0.0, 0.0))) == 0.0
    bent = road((0.004, 0.004, 0.004, 0.004))
    part = 0.2 * drawn(one, LATERAL_OF_PERSON, 0) + 0.1 * drawn(one, LATERAL_OF_PLACE, 0)
    expected = abs(part) / np.hypot(0.2, 0.1)
    assert distance(one, distribution, bent) == pytest.approx(expected, rel=1e-9)


def test_a_study_file_records_the_typical_person(tmp_path: Path) -> None:
    path = tmp_path / "my.toml"
    path.write_text(
        '[participants]\ncount = 12\n[recordings]\nparticipants = "typical"\n', encoding="utf-8"
    )
    study = read_study(path)
    expected = typical(study.participants, Distribution(), study.settings.route)
    assert study.settings.recorded == {expected.id}
    path.write_text('[participants]\ncount = 1\n[driver]\n[recordings]\nparticipants = "typical"\n')
    with pytest.raises(ModelError, match=r"line 5, recordings.participants: .* are not drawn; wri"):
        read_study(path)


def test_the_one_driver_is_the_one_whom_the_papers_study_records() -> None:
    person = adopt_population.example(study_path("paper"))
    (one,) = read_study(study_path(ONE_DRIVER)).participants
    assert one.seed == person.seed
    assert {field: one.value(field) for field in DRIVER_SIGNALS} == {
        field: person.value(field) for field in DRIVER_SIGNALS
    }


def copies(folder: Path) -> tuple[Path, Path]:
    paths = tuple(
        Path(shutil.copy(PACKAGED / f"{name}.toml", folder)) for name in ("paper", ONE_DRIVER)
    )
    return paths[0], paths[1]


def test_packaged_studies_are_what_the_script_writes(tmp_path: Path) -> None:
    for path in copies(tmp_path):
        before = path.read_bytes()
        adopt_population.adopt(adopt_population.POPULATION, *copies(tmp_path))
        assert path.read_bytes() == before


def test_another_population_has_another_example(tmp_path: Path) -> None:
    population = tmp_path / "population.toml"
    population.write_text(
        '[fit]\npeople = 3\n\n[distribution]\n"wish.offset_mps" = 2.5\n'
        '"driver.uses_lever" = { law = "share", share = 0.5 }\n'
    )
    paper, one_driver = copies(tmp_path)
    person = adopt_population.adopt(population, paper, one_driver)
    assert person.values["wish_offset_mps"] == 2.5
    study = read_study(paper)
    assert study.settings.recorded == {person.id}
    assert study.settings.phases == read_study(study_path("paper")).settings.phases
    (one,) = read_study(one_driver).participants
    assert (one.seed, one.values) == (person.seed, person.values)
    paper.write_text("[drives]\n")
    with pytest.raises(ValueError, match="there 0 times"):
        adopt_population.adopt(population, paper, one_driver)
