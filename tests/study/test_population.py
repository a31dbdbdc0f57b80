"""Sampling people: repeatable, independent of the study's size, distributed as described."""

from __future__ import annotations

import numpy as np
import pytest
from pldf.errors import ModelError
from pldf.study.population import (
    FIELDS,
    Distribution,
    Lognormal,
    Normal,
    read_distribution,
    sample_participants,
)

from vehicle_models.driver import ScriptedDriver

KMH = 1.0 / 3.6


def column(name: str, count: int = 4000, seed: int = 1) -> np.ndarray:
    return np.array([p.values[name] for p in sample_participants(count, seed)])


def test_the_same_seed_gives_the_same_people_in_a_study_of_any_size() -> None:
    small, large = sample_participants(5, 7), sample_participants(60, 7)
    assert small == large[:5]
    assert small != sample_participants(5, 8)
    assert len({p.seed for p in large}) == 60
    assert [p.id for p in small] == ["P001", "P002", "P003", "P004", "P005"]


def test_starting_values_are_those_described() -> None:
    offset = column("wish_offset_mps") / KMH
    assert offset.mean() == pytest.approx(7.0, abs=0.3)
    assert offset.std() == pytest.approx(5.0, abs=0.3)
    lateral = np.log(column("wish_lateral_accel_max_mps2"))
    assert np.exp(np.median(lateral)) == pytest.approx(2.9, rel=0.02)
    assert lateral.std() == pytest.approx(0.25, abs=0.015)
    assert np.median(column("driver_threshold_mps")) == pytest.approx(5.0 * KMH, rel=0.03)
    reaction = column("driver_reaction_s")
    assert (reaction.min(), np.median(reaction)) == (0.5, pytest.approx(1.0, rel=0.03))
    assert reaction.max() == 2.0
    anticipation = column("wish_anticipation_s")
    assert (anticipation.min(), np.median(anticipation)) == (0.0, pytest.approx(2.0, abs=0.1))
    overshoot = column("driver_overshoot")
    assert (overshoot.min(), overshoot.max()) == pytest.approx((0.0, 1.2), abs=0.01)
    assert column("driver_uses_lever").mean() == pytest.approx(0.95, abs=0.01)
    assert np.median(column("driver_reactivation_s")) == pytest.approx(2.0, rel=0.03)


def test_parameters_are_independent() -> None:
    people = sample_participants(4000, 2)
    columns = np.array([[p.values[name] for name in FIELDS] for p in people])
    correlation = np.corrcoef(columns, rowvar=False) - np.eye(len(FIELDS))
    assert np.abs(correlation).max() < 0.06


def test_every_person_can_be_simulated() -> None:
    for person in sample_participants(500, 3):
        driver = ScriptedDriver()
        for name, value in person.values.items():
            setattr(driver.record, name, value)
        driver.record.seed = person.seed + 30
        driver.check_parameters()


def test_moving_a_median_moves_every_person_and_nothing_else() -> None:
    moved = Distribution().with_laws({"driver_threshold_mps": Lognormal(1.0, 0.3)})
    for before, after in zip(
        sample_participants(9, 1), sample_participants(9, 1, moved), strict=True
    ):
        changed = {name for name in FIELDS if before.values[name] != after.values[name]}
        assert changed == {"driver_threshold_mps"}
        ratio = after.values["driver_threshold_mps"] / before.values["driver_threshold_mps"]
        assert ratio == pytest.approx(1.0 / (5.0 * KMH))


def test_a_distribution_survives_its_table() -> None:
    ours = Distribution().with_laws({"wish_offset_mps": Normal(1.0, 0.5, low=0.0)})
    table = ours.as_table()
    assert table["wish.offset_mps"] == {"law": "normal", "mean": 1.0, "sd": 0.5, "low": 0.0}
    assert read_distribution(table) == ours
    assert read_distribution({}) == Distribution()
    numbers = {"wish_offset_mps": 2.1, "wish_accel_min_mps2": -2.0, "driver_uses_lever": 1.0}
    same = ours.with_numbers(numbers)
    assert same.as_table()["wish.offset_mps"] == 2.1
    assert read_distribution(same.as_table()) == same.with_laws(
        {name: getattr(Distribution(), name) for name in numbers}
    )


def test_a_number_is_the_same_for_everybody_and_nothing_else_moves() -> None:
    said = {"wish.offset_mps": 2, "driver.uses_lever": True, "wish.jerk_max_mps3": 0.8}
    same = sample_participants(9, 1, read_distribution(said))
    numbers = {"wish_offset_mps": 2.0, "driver_uses_lever": 1.0, "wish_jerk_max_mps3": 0.8}
    for drawn, one in zip(sample_participants(9, 1), same, strict=True):
        assert (one.id, one.seed) == (drawn.id, drawn.seed)
        assert dict(one.values) == {**drawn.values, **numbers}


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (
            {"wish.hope": {"law": "share", "share": 1}},
            "not a driver parameter; there are e.g. wish.offset_mps",
        ),
        ({"seed": 3}, "not a driver parameter"),
        (
            {"wish.jerk_max_mps3": {"law": "share", "share": 1}},
            "no law, since .* the same for everybody: a number from 0 to 50 m/s3",
        ),
        ({"wish.offset_mps": 31}, "= 31 must be a number from -20 to 30 m/s; or a law, in braces$"),
        ({"wish.jerk_max_mps3": -1.0}, "= -1.0 must be a number from 0 to 50 m/s3$"),
        ({"wish.offset_mps": float("nan")}, "= nan must be a number from -20"),
        ({"wish.offset_mps": True}, "= true must be a number from -20"),
        ({"wish.offset_mps": "much"}, '= "much" must be a number from -20'),
        ({"driver.uses_lever": 0.5}, "= 0.5 must be true or false; or a law, in braces$"),
        ({"wish.offset_mps": {"law": "gauss"}}, "law = one of normal, lognormal"),
        (
            {"wish.offset_mps": {"law": "lognormal", "median": 1.0, "sigma": 1e9}},
            r"sigma = 1e\+09 must lie between 0 and 10",
        ),
        ({"wish.offset_mps": {"mean": 2.0, "sd": 1.0}}, "law = one of"),
        ({"wish.offset_mps": {"law": "normal", "mean": 1}}, "missing 1 required .* 'sd'"),
        ({"wish.offset_mps": {"law": "normal", "mean": 1, "sd": "x"}}, "could not convert"),
    ],
)
def test_unusable_tables_are_refused(table: dict[str, object], message: str) -> None:
    with pytest.raises(ModelError, match=message):
        read_distribution(table)
