"""OpenDRIVE: speed signs are read where no speed is stated."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from opendrive_text import RIGHT_100, lane, link, straight
from pldf.errors import ModelError
from pldf.kernel.arrays import FloatArray
from pldf.roads import Route, route_arrays
from pldf.roads.limits.sign_types import country_rows, sign_type

KMH = 1.0 / 3.6
Reader = Callable[..., Route]
LANES = (
    f'<lanes><laneSection s="0">{lane("")}{lane("", side="left", lane_id=1)}</laneSection></lanes>'
)


def sign(s: float, kind: str = "274", value: str = "", inside: str = "", **more: str) -> str:
    given = {"id": f"s{s}", "orientation": "+", "dynamic": "no", "country": "DE", **more}
    attributes = " ".join(f'{name}="{text}"' for name, text in given.items())
    shown = f'value="{value}"' if value else ""
    return f'<signal s="{s}" t="-4" type="{kind}" {shown} {attributes}>{inside}</signal>'


def signed(*signs: str, stated: str = "", **more: object) -> str:
    inside = f"{stated}{LANES}<signals>{''.join(signs)}</signals>"
    return straight("1", inside=inside, **more)


def kmh(route: Route) -> FloatArray:
    return np.asarray(route_arrays(route).limit_mps) / KMH


@pytest.mark.parametrize(
    ("country", "kind", "subtype", "value", "expected"),
    [
        ("DE", "274", "70", "70", ("limit", 70, "km/h")),
        ("de", "274", "", "50", ("limit", 50, "km/h")),  # esmini
        ("DE", "274", "70", "", ("limit", 70, "km/h")),
        ("OpenDRIVE", "274", "55", "5.0000000000000000e+01", ("limit", 50, "km/h")),  # VTD
        ("OpenDRIVE", "274", "57", "", ("limit", 70, "km/h")),  # the numbers until 2017
        ("", "274-30", "-1", "", ("limit", 30, "km/h")),
        ("DEU", "274.1", "", "", ("limit", 30, "km/h")),
        ("DE", "274.1", "20", "", ("limit", 20, "km/h")),
        ("DE", "274.1", "50", "", ("limit", 30, "km/h")),
        ("DE", "274.2", "", "", ("end", None, "km/h")),
        ("DE", "278", "70", "", ("end", None, "km/h")),
        ("DE", "282", "", "", ("end", None, "km/h")),
        ("DE", "310", "", "", ("implied", None, "km/h")),
        ("CHN", "274", "", "60", ("limit", 60, "km/h")),  # CommonRoad
        ("SE", "c", "31", "5", ("limit", 50, "km/h")),  # esmini
        ("SE", "C31", "5", "", ("limit", 50, "km/h")),
        ("se", "C31", "", "70", ("limit", 70, "km/h")),
        ("US", "R2-1", "", "55", ("limit", 55, "mph")),
        ("USA", "R2-1", "35", "", ("limit", 35, "mph")),
        ("OpenDRIVE", "R2-1", "", "25", ("limit", 25, "mph")),
        ("GB", "670", "", "30", ("limit", 30, "mph")),
        ("GB", "671", "", "", ("end", None, "mph")),
        ("FR", "B14", "", "90", ("limit", 90, "km/h")),
        ("FR", "B33", "", "", ("end", None, "km/h")),
        ("ES", "r301", "", "90", ("limit", 90, "km/h")),  # CommonRoad
        ("CH", "2.30", "", "80", ("limit", 80, "km/h")),
        ("NL", "A1", "50", "", ("limit", 50, "km/h")),
    ],
)
def test_types_of_speed_signs_by_country(
    country: str, kind: str, subtype: str, value: str, expected: tuple[str, float | None, str]
) -> None:
    found = sign_type(country, kind, subtype, value)
    assert found is not None
    assert (found.meaning, found.number, found.unit) == expected


@pytest.mark.parametrize(
    ("country", "kind", "subtype"),
    [
        ("DE", "206", ""), ("DE", "275", "50"), ("DE", "1274", ""), ("OpenDRIVE", "1000001", "-1"),
        ("US", "R2-4", "40"), ("US", "R2-11", ""), ("DE", "B14", "90"), ("SE", "a", "20"),
        ("", "-1", "-1"), ("GB", "278", ""),
    ],
)  # fmt: skip
def test_other_signals_are_no_speed_signs(country: str, kind: str, subtype: str) -> None:
    assert sign_type(country, kind, subtype, "50") is None


@pytest.mark.parametrize(
    ("value", "subtype", "number", "doubt"),
    [
        ("50", "70", 50, "70"),
        ("", "60", 60, "60 or 100"),
        ("50", "55", 50, ""),
        ("60", "60", 60, ""),
    ],
)
def test_numbers_that_contradict_each_other_are_in_doubt(
    value: str, subtype: str, number: float, doubt: str
) -> None:
    found = sign_type("DE", "274", subtype, value)
    assert found is not None
    assert found.number == number
    assert found.doubt == (f"its subtype means {doubt}" if doubt else "")


def test_signs_hold_from_where_they_stand_and_the_end_returns_to_the_default(read: Reader) -> None:
    road = signed(sign(20, value="70"), sign(50, value="50"), sign(80, "282"))
    route = read(road, default_limit_mps=100 * KMH)
    limits = kmh(route)
    np.testing.assert_allclose(limits[[0, 19, 20, 49]], [100, 100, 70, 70])
    np.testing.assert_allclose(limits[[50, 79, 80, 99]], [50, 50, 100, 100])
    marks = [(mark.s_m, mark.name) for mark in route.marks if mark.kind == "sign"]
    assert marks == [
        (0.0, "default limit 100 km/h"),
        (20.0, "70 km/h sign"),
        (50.0, "50 km/h sign"),
        (80.0, "end of limit sign"),
    ]
    assert ["3 speed signs read" in note.text for note in route.notes] == [True]


def test_without_a_default_what_is_not_known_is_told(read: Reader) -> None:
    route = read(signed(sign(20, value="70"), sign(80, "278")))
    assert set(np.round(kmh(route), 6)) == {70.0}
    warnings = [note.text for note in route.notes if note.severity == "warning"]
    assert any("before the first sign" in text for text in warnings)
    assert any("ends a limit, and none is stated before" in text for text in warnings)


def test_signs_hold_on_the_next_road_until_a_speed_is_stated(read: Reader) -> None:
    stated = '<type s="50" type="rural"><speed max="60" unit="km/h"/></type>'
    first = signed(sign(100, value="80"), stated="", link=link("successor", "2", "start"))
    second = straight("2", 100, inside=stated, link=link("predecessor", "1", "end"))
    limits = kmh(read(first, second, start_road="1", default_limit_mps=100 * KMH))
    np.testing.assert_allclose(limits[[99, 100, 149, 150]], [100, 80, 80, 60])


def test_where_a_speed_is_stated_a_sign_that_contradicts_it_is_told(read: Reader) -> None:
    route = read(signed(sign(60, value="70"), sign(70, value="100"), stated=RIGHT_100))
    assert set(np.round(kmh(route), 6)) == {100.0}
    (note,) = route.notes
    assert note.place == "road 1, s = 60 m"
    assert "1 speed sign is not read (70 km/h at 60 m of road 1)" in note.text
    assert "the road states 100 km/h there" in note.consequence


def test_a_sign_beside_the_place_where_the_road_states_its_limit_does_not(read: Reader) -> None:
    stated = RIGHT_100 + '<type s="60"><speed max="70" unit="km/h"/></type>'
    assert not read(signed(sign(50, value="70"), stated=stated)).notes


@pytest.mark.parametrize("seed", range(40))
def test_what_counts_per_metre_is_what_a_walk_along_the_road_finds(read: Reader, seed: int) -> None:
    rng = np.random.default_rng(seed)
    stated = {int(s): rng.choice([0, 60, 90]) for s in rng.choice(100, 3, replace=False)}
    posted = {int(s): rng.choice([0, 30, 50, 70]) for s in rng.choice(100, 4, replace=False)}
    against = bool(rng.integers(2))
    types = "".join(
        f'<type s="{s}">{f"""<speed max="{v}" unit="km/h"/>""" if v else ""}</type>'
        for s, v in {0: 0, **stated}.items()
    )
    facing = "-" if against else "+"
    signs = [
        sign(s, "274" if v else "282", value=str(v) if v else "", orientation=facing)
        for s, v in posted.items()
    ]
    road = signed(*signs, stated=types)
    limits = kmh(read(road, default_limit_mps=100 * KMH, reverse=against))
    # The walk: metre by metre, who states a speed there, and which sign is passed.
    own = np.zeros(100)
    for s in sorted({0: 0, **stated}):
        own[s:] = {0: 0, **stated}[s]
    now, back, ahead = np.nan, 100.0, 100.0
    expected = []
    for s in reversed(range(100)) if against else range(100):
        passed = posted.get(s + 1 if against else s)
        if own[s]:
            ahead = own[s] if np.isnan(now) else ahead  # what is stated first holds before it, too
            now = back = own[s]
        elif passed is not None:
            now = passed or back
        expected.append(now)
    np.testing.assert_allclose(limits[:100], np.where(np.isnan(expected), ahead, expected))


def test_signs_can_be_left_out(read: Reader) -> None:
    road = signed(sign(20, value="70"))
    with pytest.raises(ModelError, match=r"\(1 speed sign left out\).*--default-limit"):
        read(road, signs=False)
    route = read(road, signs=False, default_limit_mps=20.0)
    assert set(route.speed_limit_mps) == {20.0}
    assert not read(signed(sign(60, value="70"), stated=RIGHT_100), signs=False).notes


@pytest.mark.parametrize("rule", ["RHT", "LHT"])
def test_a_sign_counts_for_those_whom_it_faces(read: Reader, rule: str) -> None:
    road = signed(
        sign(20, value="70"),
        sign(60, value="50", orientation="-"),
        sign(80, value="30", orientation="none"),
        attributes=f'junction="-1" rule="{rule}"',
    )
    along = kmh(read(road, default_limit_mps=100 * KMH))
    np.testing.assert_allclose(along[[19, 20, 79, 80]], [100, 70, 70, 30])
    against = kmh(read(road, default_limit_mps=100 * KMH, reverse=True))
    np.testing.assert_allclose(against[[19, 20, 39, 40, 99]], [100, 30, 30, 50, 50])


def test_a_sign_for_lanes_that_are_not_driven_does_not_count(read: Reader) -> None:
    for lanes_named, limit in (((1, 1), 100.0), ((-1, -1), 70.0), ((-2, 0), 70.0)):
        validity = '<validity fromLane="{}" toLane="{}"/>'.format(*lanes_named)
        road = signed(sign(20, value="70", inside=validity))
        assert kmh(read(road, default_limit_mps=100 * KMH))[50] == pytest.approx(limit)


def test_a_sign_may_stand_on_another_road(read: Reader) -> None:
    first = signed(sign(90, value="70", id="s7"), link=link("successor", "2", "start"))
    reference = '<signals><signalReference s="40" t="3" id="s7" orientation="+"/></signals>'
    second = straight("2", 100, inside=LANES + reference, link=link("predecessor", "1", "end"))
    limits = kmh(read(first, second, start_road="2", default_limit_mps=100 * KMH))
    np.testing.assert_allclose(limits[[39, 40]], [100, 70])


@pytest.mark.parametrize(
    ("unit", "options", "mps"),
    [
        ("km/h", {}, KMH),
        ("mph", {}, 0.44704),
        ("kmh", {}, KMH),
        ("m/s", {}, 1.0),
        ("", {"limit_unit": "mph"}, 0.44704),
        ("", {"limit_unit": "m/s"}, KMH),
    ],
)
def test_the_unit_of_a_sign(read: Reader, unit: str, options: dict[str, str], mps: float) -> None:
    road = signed(sign(0, value="40", unit=unit))
    assert set(read(road, **options).speed_limit_mps) == {40 * mps}


def test_signs_that_cannot_be_read_are_told(read: Reader) -> None:
    odd = [
        sign(10, value="80", dynamic="yes"),
        sign(20),
        sign(30, "310"),
        sign(40, "XY7", value="60", country="KE", unit="km/h"),
        sign(50, value="40", unit="furlongs"),
        sign(60, "206"),
    ]
    route = read(signed(*odd, stated=RIGHT_100))
    told = " ".join(note.text for note in route.notes)
    for metres in (10, 20, 30, 40, 50):
        assert f"at {metres} m of road 1" in told
    assert "at 60 m" not in told


def test_a_signal_that_is_broken_does_not_cost_the_road(read: Reader) -> None:
    light = sign(10, "1000001").replace('s="10"', 's="x"')
    nowhere = sign(20, value="80").replace('s="20"', 's="nan"')
    lanes_odd = sign(30, value="80", inside='<validity fromLane="a" toLane=""/>')
    inside = '<signals><signalReference id="none"/></signals>'
    road = signed(light, nowhere, lanes_odd, sign(40, value="nan"), stated=inside)
    route = read(road, default_limit_mps=30.0)
    assert kmh(route)[[29, 30, 99]] == pytest.approx([108, 80, 80])
    told = [note.text for note in route.notes]
    assert any("its s is no number" in text for text in told)
    assert any("no number at 40 m" in text for text in told)


def test_of_two_at_one_place_the_lower_counts_after_the_end_of_another(read: Reader) -> None:
    stated = '<type s="0"><speed max="100" unit="km/h"/></type><type s="10"/>'
    road = signed(sign(50, value="50"), sign(50, value="30"), sign(50, "278"), stated=stated)
    assert kmh(read(road))[[49, 50]] == pytest.approx([100, 30])


def test_a_sign_where_what_is_stated_ends_counts(read: Reader) -> None:
    until = '<type s="0"><speed max="100" unit="km/h"/></type><type s="50"/>'
    assert kmh(read(signed(sign(50, value="30"), stated=until)))[[49, 50]] == pytest.approx(
        [100, 30]
    )
    behind = '<type s="0"/><type s="50"><speed max="100" unit="km/h"/></type>'
    road = signed(sign(50, value="30", orientation="-"), stated=behind)
    assert kmh(read(road, reverse=True))[[49, 50]] == pytest.approx([100, 30])


def test_a_supplementary_sign_at_the_same_post_is_told(read: Reader) -> None:
    wet = sign(20, "1053", subtype="35", country="DE")
    route = read(signed(sign(20.2, value="80"), wet, sign(60, value="50")))
    told = [note for note in route.notes if "in doubt" in note.text]
    assert [note.severity for note in told] == ["warning"]
    assert "1 speed sign read, but in doubt: 80 km/h at 20.2 m of road 1" in told[0].text
    assert told[0].consequence == "the supplementary sign 1053-35 restricts it"
    assert not read(signed(sign(20, value="100"), wet, stated=RIGHT_100)).notes


def test_the_page_on_roads_names_the_countries_whose_signs_are_read() -> None:
    page = (Path(__file__).parents[2] / "docs" / "roads.md").read_text(encoding="utf-8")
    section = page.split("## Limits and signs")[1].split("\n## ")[0]
    missing = [code for code in country_rows() if f"| {code} |" not in section]
    assert not missing
