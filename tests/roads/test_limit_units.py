"""OpenDRIVE: units of speeds, how else they are spelled, and numbers in doubt."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from opendrive_text import straight
from pldf.errors import ModelError
from pldf.roads import Route

KMH = 1.0 / 3.6
Reader = Callable[..., Route]


def stated(*speeds: str) -> str:
    """Return a road whose limit changes every 10 m."""
    types = (f'<type s="{10 * i}" type="rural"><speed {s}/></type>' for i, s in enumerate(speeds))
    return straight("1", inside="\n".join(types))


@pytest.mark.parametrize(
    ("number", "kmh"), [(50, 180), (30, 108), (55, 198), (80, 288), (36.3, 130.7)]
)
def test_a_number_that_no_sign_shows_in_metres_per_second_is_told(
    read: Reader, number: float, kmh: float
) -> None:
    route = read(stated(f'max="{number}"'))
    (note,) = route.notes
    assert note.severity == "warning"
    assert note.line == 5
    assert f"{number:g} m/s = {kmh:g} km/h" in note.text
    assert "--limit-unit" in note.way_out
    assert set(route.speed_limit_mps) == {number}


@pytest.mark.parametrize("number", [8.33, 13.889, 25, 27.78, 33.33, 36.11])
def test_a_number_that_can_be_metres_per_second_is_not(read: Reader, number: float) -> None:
    assert not read(stated(f'max="{number}"')).notes


@pytest.mark.parametrize(("unit", "mps"), [("km/h", KMH), ("mph", 0.44704), ("m/s", 1.0)])
def test_the_unit_that_a_person_names_counts_where_the_file_names_none(
    read: Reader, unit: str, mps: float
) -> None:
    route = read(stated('max="50"', 'max="36" unit="km/h"'), limit_unit=unit)
    assert route.speed_limit_mps[0] == 50 * mps
    assert route.speed_limit_mps[-1] == pytest.approx(10.0)
    assert not route.notes


def test_a_unit_that_changes_nothing_is_told(read: Reader) -> None:
    (note,) = read(stated('max="50" unit="km/h"'), limit_unit="mph").notes
    assert "--limit-unit mph changes nothing" in note.text


@pytest.mark.parametrize("options", [{}, {"limit_unit": "m/s"}])
def test_beyond_300_kmh_the_unit_has_to_be_named(read: Reader, options: dict[str, str]) -> None:
    with pytest.raises(ModelError, match=r"line 5, road 1: speed limit 100 m/s") as caught:
        read(stated('max="100"'), **options)
    assert str(caught.value).endswith("--limit-unit km/h") == (not options)


@pytest.mark.parametrize(
    ("spelling", "mps"),
    [("kmh", KMH), ("KM/H", KMH), ("km/hr", KMH), ("kph", KMH), ("mps", 1.0), ("mi/h", 0.44704)],
)
def test_units_spelled_otherwise_are_understood_and_told(
    read: Reader, spelling: str, mps: float
) -> None:
    route = read(stated(f'max="20" unit="{spelling}"'))
    assert set(route.speed_limit_mps) == {20 * mps}
    (note,) = route.notes
    assert f"speed unit {spelling!r} is read as" in note.text


def test_a_limit_that_no_public_road_has_is_told_with_its_unit(read: Reader) -> None:
    (note,) = read(stated('max="50" unit="m/s"')).notes
    assert (note.severity, "180 km/h" in note.text) == ("warning", True)


def test_all_unusable_speeds_are_named_at_once(read: Reader) -> None:
    speeds = ('max="0"', 'max="-5" unit="mph"', 'max="nan"', 'max="9" unit="knots"', 'max="x"')
    with pytest.raises(ModelError) as caught:
        read(stated(*speeds))
    text = str(caught.value)
    for line, what in ((5, "limit 0 m/s"), (6, "limit -5 mph"), (7, "max = 'nan'")):
        assert f"line {line}, road 1" in text
        assert what in text
    assert text.endswith("and 2 more unusable numbers")
