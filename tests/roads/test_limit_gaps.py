"""OpenDRIVE: limits that a way does not state are those of its neighbours."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from opendrive_text import geometry, lane, link, road, straight
from pldf.errors import ModelError
from pldf.kernel.arrays import FloatArray
from pldf.roads import Route, route_arrays

KMH = 1.0 / 3.6
Reader = Callable[..., Route]
Records = list[tuple[int, float | None]]  # from which metre on which limit in m/s


def chain(stated: list[Records], length: int, against: list[bool]) -> list[str]:
    """Return straight roads behind each other, some drawn against the way."""
    roads = []
    for i, (records, turned) in enumerate(zip(stated, against, strict=True)):
        types = "".join(
            f'<type s="{s}" type="rural">{"" if v is None else f"""<speed max="{v!r}"/>"""}</type>'
            for s, v in records
        )
        x, heading = (i + 1) * length if turned else i * length, np.pi if turned else 0.0
        plan = geometry(0, length, pose=f'x="{x}" y="0" hdg="{heading}"')
        ahead, back = ("predecessor", "successor") if turned else ("successor", "predecessor")
        links = ""
        if i + 1 < len(stated):
            links += link(ahead, str(i + 1), "end" if against[i + 1] else "start")
        if i > 0:
            links += link(back, str(i - 1), "start" if against[i - 1] else "end")
        roads.append(road(str(i), plan, length=length, link=links, inside=types))
    return roads


def by_metre(stated: list[Records], length: int, against: list[bool]) -> FloatArray:
    """Return what counts per metre of the way, in numpy alone: stated, before, else behind."""
    metres = []
    for records, turned in zip(stated, against, strict=True):
        own = np.full(length, np.nan)
        for s, v in sorted(records, key=lambda record: record[0]):
            own[s:] = np.nan if v is None else v
        metres.append(own[::-1] if turned else own)
    limits = np.concatenate(metres)
    known = np.flatnonzero(~np.isnan(limits))
    before = np.searchsorted(known, np.arange(len(limits)), side="right") - 1
    filled: FloatArray = limits[known[np.maximum(before, 0)]]
    return filled


@pytest.mark.parametrize("seed", range(60))
def test_no_way_has_gaps_and_every_limit_is_one_that_is_stated(read: Reader, seed: int) -> None:
    rng = np.random.default_rng(seed)
    length, count = 40, int(rng.integers(1, 6))
    values = [None, None, 8.0, 11.25, 13.9, 22.2]
    stated: list[Records] = [
        [
            (int(s), values[rng.integers(len(values))])
            for s in np.sort(rng.choice(np.arange(0, length, 2), rng.integers(0, 4), replace=False))
        ]
        for _ in range(count)
    ]
    against = [bool(rng.integers(2)) if i else False for i in range(count)]
    roads = chain(stated, length, against)
    if not any(v for records in stated for _, v in records):
        with pytest.raises(ModelError, match="no speed limit"):
            read(*roads, start_road="0")
        stated[0], default = [(0, 9.0)], 9.0
        route = read(*roads, start_road="0", default_limit_mps=default)
    else:
        route = read(*roads, start_road="0")
    expected = by_metre(stated, length, against)
    np.testing.assert_array_equal(np.asarray(route_arrays(route).limit_mps)[:-1], expected)
    # What is filled is what would be read if it were stated everywhere.
    each = expected.reshape(count, length)
    full: list[Records] = [
        [(s, float(v)) for s, v in enumerate(row[::-1] if turned else row)]
        for row, turned in zip(each, against, strict=True)
    ]
    complete = read(*chain(full, length, against), start_road="0")
    assert not complete.notes
    for name, values_read in complete.knots.items():
        if len(route.s_m) == len(complete.s_m):
            np.testing.assert_array_equal(values_read, route.knots[name])


def three(middle: str, *, first: str = "", last: str = "", junction: str = "9") -> list[str]:
    """Return three roads behind each other, the middle one leading through a junction."""
    stated = '<type s="0" type="rural"><speed max="{}" unit="km/h"/></type>'
    last_link = link("predecessor", "1", "end")
    return [
        straight("0", inside=first or stated.format(100), link=link("successor", "1", "start")),
        straight(
            "1",
            100,
            inside=middle,
            link=link("predecessor", "0", "end") + link("successor", "2", "start"),
            attributes=f'junction="{junction}"',
        ),
        straight("2", 200, inside=last or stated.format(60), link=last_link),
    ]


@pytest.mark.parametrize("default", [None, 50 * KMH])
def test_a_connecting_road_has_the_limit_of_the_road_before_whatever_the_default(
    read: Reader, default: float | None
) -> None:
    route = read(*three(""), start_road="0", default_limit_mps=default)
    limit = np.asarray(route_arrays(route).limit_mps) / KMH
    np.testing.assert_allclose(limit[[0, 100, 199]], 100.0)
    np.testing.assert_allclose(limit[[200, 299]], 60.0)
    (note,) = route.notes
    assert note.severity == "note"
    assert note.place == "road 1, s = 0 m"
    assert "1 connecting road states no limit (100 m): 100 km/h from 0 m of road 1 on" in note.text
    assert ("--default-limit" in note.way_out) == (default is not None)


def test_a_long_road_that_is_no_connection_is_a_warning(read: Reader) -> None:
    first, _, last = three("")
    plan = geometry(0, 150, pose='x="100" y="0" hdg="0"')
    links = link("predecessor", "0", "end") + link("successor", "2", "start")
    long = road("1", plan, length=150, link=links, inside="")
    last = last.replace('x="200.0"', 'x="250"').replace('x="200"', 'x="250"')
    (note,) = read(first, long, last, start_road="0").notes
    assert (note.severity, "1 road states no limit (150 m)" in note.text) == ("warning", True)


def test_marks_name_the_limits_where_they_change(read: Reader) -> None:
    route = read(*three(""), start_road="0")
    signs = [(mark.s_m, mark.name) for mark in route.marks if mark.kind == "sign"]
    assert signs == [(0.0, "legal limit 100 km/h"), (200.0, "legal limit 60 km/h")]


@pytest.mark.parametrize("late", [0.01, 0.5])
def test_a_limit_that_begins_just_late_counts_from_the_start(read: Reader, late: float) -> None:
    stated = f'<type s="{late}" type="rural"><speed max="80" unit="km/h"/></type>'
    route = read(*three(stated), start_road="0")
    limit = np.asarray(route_arrays(route).limit_mps) / KMH
    np.testing.assert_allclose(limit[[99, 100, 101]], [100.0, 80.0, 80.0])
    assert [note.severity for note in route.notes] == ([] if late < 0.1 else ["note"])
    speed = f'<speed sOffset="{late}" max="80" unit="km/h"/>'
    in_lane = f'<lanes><laneSection s="{late}">{lane(speed)}</laneSection></lanes>'
    (other,) = {float(v) for v in read(straight("1", inside=in_lane)).speed_limit_mps}
    assert other == pytest.approx(80 * KMH)


def test_a_road_driven_against_its_drawing_has_the_limits_of_its_other_side(read: Reader) -> None:
    sides = (
        '<lanes><laneSection s="0">'
        + lane('<speed sOffset="0" max="12"/>', side="left", lane_id=1)
        + lane('<speed sOffset="0" max="21"/>')
        + "</laneSection></lanes>"
    )
    assert set(read(straight("1", inside=sides)).speed_limit_mps) == {21.0}
    assert set(read(straight("1", inside=sides), reverse=True).speed_limit_mps) == {12.0}


def test_of_ramps_the_limit_counts_where_there_is_no_other_lane(read: Reader) -> None:
    ramp = lane('<speed sOffset="0" max="11"/>', kind="exit")
    both = lane('<speed sOffset="0" max="20"/>') + lane(
        '<speed sOffset="0" max="11"/>', kind="exit", lane_id=-2
    )
    for lanes_there, limit in ((ramp, 11.0), (both, 20.0)):
        inside = f'<lanes><laneSection s="0">{lanes_there}</laneSection></lanes>'
        assert set(read(straight("1", inside=inside)).speed_limit_mps) == {limit}
