"""Curves as a car drives them: corners, chords, spikes and noise, against what is known of them."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from opendrive_text import geometry, road
from pldf.roads import Route, open_route, packed_route, read_route, route_arrays, write_route_csv
from pldf.roads.curves.joints import NO_JOINTS, Joints
from pldf.roads.curves.judge import judged
from pldf.roads.opendrive.geometry import Geometries

Reader = Callable[..., Route]
Array = NDArray[np.float64]
LATERAL_MPS2 = 2.5


def knots_of(s: Array, curvature: Array, limit_mps: float = 27.78) -> Array:
    zero = np.zeros(len(s))
    return np.stack([s, curvature, zero + limit_mps, zero, s, zero])


def judge(knots: Array, joints: Joints = NO_JOINTS, smoothing_m: float | None = None):  # type: ignore[no-untyped-def]
    return judged(knots, joints, smoothing_m, "road", lambda s: (1, f"{s:g} m"))


def turn(knots: Array, start: float, end: float) -> float:
    """Return the change of heading, by the trapezium rule on a fine grid."""
    s = np.arange(start, end, 0.01) + 0.005
    return float(np.sum(np.interp(s, knots[0], knots[1])) * 0.01)


def chords(points: Array) -> str:
    """Return a plan view of straight lines from point to point."""
    steps = np.diff(points)
    starts = np.concatenate(([0.0], np.cumsum(np.abs(steps))))
    return "".join(
        geometry(
            float(s), float(abs(step)), pose=f'x="{p.real}" y="{p.imag}" hdg="{np.angle(step)}"'
        )
        for s, step, p in zip(starts[:-1], steps, points[:-1], strict=True)
    )


def polygon_bend(radius_m: float, angle_rad: float, chord_m: float) -> tuple[Array, float]:
    """Return points on an arc between two straights of 200 m, and the length along the chords."""
    count = max(int(np.ceil(radius_m * angle_rad / chord_m)), 1)
    arc = 1j * radius_m * (1.0 - np.exp(1j * np.linspace(0.0, angle_rad, count + 1)))
    points = np.concatenate(([-200.0], arc, [arc[-1] + 200.0 * np.exp(1j * angle_rad)]))
    return points, float(np.sum(np.abs(np.diff(points))))


@pytest.mark.parametrize(
    ("radius_m", "angle_deg", "chord_m"),
    [(55, 94, 9), (30, 90, 5), (20, 90, 10), (104, 129, 26), (200, 60, 20), (12, 90, 1)],
)  # fmt: skip
@pytest.mark.parametrize("against", [False, True])
def test_a_bend_drawn_as_chords_is_that_bend(
    read: Reader, radius_m: float, angle_deg: float, chord_m: float, against: bool
) -> None:
    angle = np.radians(angle_deg)
    points, length = polygon_bend(radius_m, angle, chord_m)
    route = read(road("1", chords(points), length=length), reverse=against)
    curvature = np.asarray(route_arrays(route).curvature_per_m)
    assert np.max(curvature) == pytest.approx(1.0 / radius_m, rel=0.1)
    knots = np.stack(list(route.knots.values()))
    assert abs(turn(knots, 0.0, route.length_m)) == pytest.approx(angle, rel=0.01)
    (note,) = route.notes
    assert note.severity == "warning"
    assert f"by {angle_deg} degrees in all: a bend drawn as chords?" in note.text
    assert note.line > 0
    assert "road 1, s = " in note.place


def test_90_degrees_in_30_m_at_72_are_a_bend(read: Reader) -> None:
    points, length = polygon_bend(30.0 / (np.pi / 2.0), np.pi / 2.0, 5.0)
    speed = '<type s="0" type="rural"><speed max="72" unit="km/h"/></type>'
    curvature = route_arrays(
        read(road("1", chords(points), length=length, inside=speed))
    ).curvature_per_m
    slowest_kmh = 3.6 * np.sqrt(LATERAL_MPS2 / np.max(np.asarray(curvature)))
    assert slowest_kmh == pytest.approx(3.6 * np.sqrt(2.5 * 60.0 / np.pi), rel=0.1)


@pytest.mark.parametrize("angle_deg", [5.0, 9.4, 30.0, -20.0])
def test_a_corner_is_rounded_as_wide_as_half_a_metre_allows(read: Reader, angle_deg: float) -> None:
    angle = np.radians(angle_deg)
    points = np.array([-200.0, 0.0, 200.0 * np.exp(1j * angle)])
    route = read(road("1", chords(points), length=400.0))
    knots = np.stack(list(route.knots.values()))
    assert turn(knots, 150.0, 250.0) == pytest.approx(angle, rel=0.01)
    radius = 1.0 / np.max(np.abs(route.curvature_per_m))
    # How far an arc between two tangents passes from their corner.
    leaves_m = radius * (1.0 / np.cos(0.5 * angle) - 1.0)
    widest_m = 50.0 / abs(angle)
    assert leaves_m == pytest.approx(0.5, rel=0.1) or radius == pytest.approx(widest_m, rel=0.01)
    assert f"turns by {abs(angle_deg):.1f} degrees at a point" in route.notes[0].text


def test_headings_that_are_only_rounded_are_no_corners(read: Reader) -> None:
    rng = np.random.default_rng(7)
    points = np.cumsum(np.concatenate(([0.0], np.full(100, 2.0)))) + 0j
    plan = "".join(
        geometry(float(2 * i), 2.0, pose=f'x="{p.real}" y="0" hdg="{rng.uniform(-4e-4, 4e-4)}"')
        for i, p in enumerate(points[:-1])
    )
    route = read(road("1", plan, length=200.0))
    assert route.notes == ()
    assert not np.any(route.curvature_per_m)


def spike(curvature_per_m: float, length_m: float, around_per_m: float = 0.0) -> Array:
    s = np.array([0.0, 1000.0, 1000.0, 1000.0 + length_m, 1000.0 + length_m, 2000.0])
    high, low = curvature_per_m, around_per_m
    return knots_of(s, np.array([low, low, high, high, low, low]))


@pytest.mark.parametrize(
    ("curvature_per_m", "length_m"),
    [(0.05, 1.0), (1.2, 0.05), (-0.2, 0.4), (0.02, 4.0), (40.0, 1e-3)],
)  # fmt: skip
@pytest.mark.parametrize("around_per_m", [0.0, 0.002])
def test_what_is_shorter_than_a_car_is_no_curve(
    curvature_per_m: float, length_m: float, around_per_m: float
) -> None:
    after, (told,) = judge(spike(curvature_per_m, length_m, around_per_m))
    own = (curvature_per_m - around_per_m) * length_m
    assert turn(after, 900.0, 1100.0) == pytest.approx(own + 200.0 * around_per_m, abs=2e-4)
    # Half a metre off the line: an arc of length l and turn a passes l a / 8 from the corner.
    assert np.max(np.abs(after[1])) < around_per_m + 1.1 * max(own * own / 4.0, abs(own) / 50.0)
    assert told.severity == "warning"
    assert "is no curve of a road" in told.text
    assert re.search(r"; driven as (straight on|R \d+ m \(\d+ km/h\))$", told.text)
    assert told.place == "1000 m"


@pytest.mark.parametrize("ramp_m", [0.5, 1.0, 2.0, 4.0])
def test_what_is_repaired_is_never_sharper_than_it_was(ramp_m: float) -> None:
    """A spike with ramps: its turn is spread over no less than they take."""
    s = np.array([0.0, 1000.0, 1000.0 + ramp_m, 1002.0 + ramp_m, 1002.0 + 2.0 * ramp_m, 2000.0])
    knots = knots_of(s, np.array([0.0, 0.0, 0.25, 0.25, 0.0, 0.0]))
    after, told = judge(knots)
    assert bool(told) or after is knots
    assert told or ramp_m > 1.0
    assert np.max(after[1]) <= 0.25
    assert turn(after, 900.0, 1100.0) == pytest.approx(turn(knots, 900.0, 1100.0), abs=1e-3)


@pytest.mark.parametrize(
    ("radius_m", "length_m"), [(6.0, 8.0), (6.0, 5.5), (30.0, 6.0), (150.0, 60.0)]
)
def test_an_arc_as_long_as_a_car_is_a_curve(radius_m: float, length_m: float) -> None:
    knots = spike(1.0 / radius_m, length_m)
    after, told = judge(knots)
    assert told == []
    assert after is knots


def test_what_nobody_feels_keeps_its_bits() -> None:
    knots = spike(2.5 / (27.78 + 50.0 / 3.6) ** 2 * 0.99, 1.0)
    after, told = judge(knots)
    assert (told, after is knots) == ([], True)


def clean_road(pieces: list[tuple[float, float]]) -> Array:
    """Return knots per metre of straights and curves with clothoids of half a curve's length."""
    s, curvature = [0.0], [0.0]
    for length, bend in pieces:
        for part, value in ((0.5, bend), (1.0, bend), (0.5, 0.0), (1.0, 0.0)):
            s.append(s[-1] + part * length)
            curvature.append(value)
    grid = np.unique(np.concatenate((np.arange(0.0, s[-1]), s)))
    return knots_of(grid, np.interp(grid, s, curvature))


@settings(max_examples=80, deadline=None)
@given(st.lists(st.tuples(st.floats(8.0, 300.0), st.floats(-0.15, 0.15)), min_size=1, max_size=25))
def test_a_clean_road_keeps_its_bits(pieces: list[tuple[float, float]]) -> None:
    knots = clean_road(pieces)
    after, told = judge(knots)
    assert told == []
    assert after is knots


def test_the_study_road_keeps_its_bits() -> None:
    route = packed_route(0)
    assert route.notes == ()
    knots = np.stack(list(route.knots.values()))
    assert judge(knots)[0] is knots


def curves_of(knots: Array) -> tuple[int, float]:
    """Return how many curves bind by 5 km/h, and the mean speed through all caps, in km/h."""
    s = np.arange(knots[0, -1])
    cap = np.sqrt(LATERAL_MPS2 / np.maximum(np.abs(np.interp(s, knots[0], knots[1])), 1e-9))
    binding = cap < knots[2, 0] - 5.0 / 3.6
    count = int(np.sum(np.diff(binding.astype(int), prepend=0) > 0))
    return count, 3.6 / float(np.mean(1.0 / np.minimum(cap, knots[2, 0])))


@pytest.mark.parametrize("spacing_m", [1.0, 2.0, 5.0, 10.0])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_straight_road_with_noise_is_a_straight_road(spacing_m: float, seed: int) -> None:
    s = np.arange(0.0, 5000.1, spacing_m)
    knots = knots_of(s, np.random.default_rng(seed).normal(0.0, 0.004, len(s)))
    before, (after, told) = curves_of(knots), judge(knots)
    assert before[0] > 80
    assert curves_of(after)[0] <= 10
    assert curves_of(after)[1] > 97.0
    assert any("is noise over" in finding.text for finding in told)
    sizes = [re.search(r"([0-9.e-]+)/m between points", finding.text) for finding in told]
    assert float(next(size for size in sizes if size)[1]) == pytest.approx(0.004, rel=0.2)


@pytest.mark.parametrize("spacing_m", [2.0, 10.0])
def test_what_is_smoothed_turns_as_it_is_drawn(spacing_m: float) -> None:
    s = np.arange(0.0, 3000.1, spacing_m)
    noise = np.random.default_rng(11).normal(0.0, 0.004, len(s))
    bend = np.interp(s, [1000, 1040, 1160, 1200], [0.0, 0.008, 0.008, 0.0])
    knots = knots_of(s, noise + bend)
    after, told = judge(knots)
    assert told
    assert turn(after, 0.0, 3000.0) == pytest.approx(turn(knots, 0.0, 3000.0), abs=1e-3)
    for start in range(0, 2400, 100):
        own = turn(knots, start, start + 600.0)
        # Two means of 65 samples, one at each end, may each be off by their noise.
        assert turn(after, start, start + 600.0) == pytest.approx(own, abs=0.2)


@pytest.mark.parametrize("noise_per_m", [0.001, 0.002])
@pytest.mark.parametrize("spacing_m", [2.0, 5.0])
def test_bends_survive_the_smoothing_of_noise(noise_per_m: float, spacing_m: float) -> None:
    study = packed_route(0)
    s = np.arange(0.0, 4500.1, spacing_m)
    clean = np.interp(s, study.s_m, study.curvature_per_m)
    noise = np.random.default_rng(5).normal(0.0, noise_per_m, len(s))
    after, told = judge(knots_of(s, clean + noise))
    assert told
    off = np.interp(s, after[0], after[1]) - clean
    assert np.sqrt(np.mean(off**2)) < 0.5 * noise_per_m
    places = np.array([360, 590, 1240, 1520])[:, None] + np.arange(50, 100)
    bends = np.mean(np.interp(places, after[0], after[1]), axis=1)
    share = bends * [200.0, -180.0, 140.0, -150.0]
    assert np.mean(share) == pytest.approx(1.0, abs=0.12)
    assert np.min(share) > 0.65


def test_smoothing_can_be_switched_off_and_set(tmp_path: Path) -> None:
    s = np.arange(0.0, 500.1, 5.0)
    curvature = np.random.default_rng(3).normal(0.0, 0.004, len(s))
    path = tmp_path / "noisy.csv"
    rows = "\n".join(
        f"{a!r},{b!r},27.0" for a, b in zip(s.tolist(), curvature.tolist(), strict=True)
    )
    path.write_text(f"s_m,curvature_per_m,speed_limit_mps\n{rows}\n")
    plain = open_route(str(path), smoothing_m=0.0)
    np.testing.assert_array_equal(plain.curvature_per_m, curvature)
    smooth = open_route(str(path), smoothing_m=40.0)
    fine = np.arange(0.0, 500.0, 0.01) + 0.005
    value = np.interp(fine, s, curvature)
    for at in (100.0, 237.0, 400.0):
        mean = np.mean(value[(fine > at - 20.0) & (fine < at + 20.0)])
        got = np.interp(at, smooth.s_m, smooth.curvature_per_m)
        assert got == pytest.approx(mean, abs=1e-5)
    assert "smoothed over 40 m" in smooth.notes[0].text


def test_an_exported_route_is_read_as_it_was_written(tmp_path: Path) -> None:
    s = np.arange(0.0, 2000.1, 10.0)
    knots = knots_of(s, np.random.default_rng(2).normal(0.0, 0.004, len(s)))
    rows = "\n".join(",".join(map(repr, row)) for row in knots[:3].T.tolist())
    (tmp_path / "noisy.csv").write_text(f"s_m,curvature_per_m,speed_limit_mps\n{rows}\n")
    first = read_route(tmp_path / "noisy.csv")
    assert first.notes
    write_route_csv(first, tmp_path / "out.csv")
    again = read_route(tmp_path / "out.csv")
    assert again.notes == ()
    np.testing.assert_array_equal(first.curvature_per_m, again.curvature_per_m)
    # Changed by hand, it is judged like any other.
    text = (tmp_path / "out.csv").read_text().splitlines()
    at = next(i for i, line in enumerate(text) if line.startswith("1510"))
    text[at:at] = [
        f"{at},{bend},27.78,0"
        for at, bend in ((1500.1, 0), (1500.1, 0.5), (1500.5, 0.5), (1500.5, 0))
    ]
    (tmp_path / "out.csv").write_text("\n".join(text))
    assert read_route(tmp_path / "out.csv").notes


@st.composite
def any_roads(draw: st.DrawFn) -> tuple[Array, Joints]:
    gaps = draw(
        st.lists(st.sampled_from([0.05, 0.3, 1.0, 4.0, 11.0, 60.0]), min_size=3, max_size=40)
    )
    s = np.cumsum([0.0, *gaps, 7.0])
    size = st.floats(-0.3, 0.3)
    left = draw(st.lists(size, min_size=len(s), max_size=len(s)))
    right = draw(st.lists(size, min_size=len(s), max_size=len(s)))
    limit = draw(st.lists(st.sampled_from([8.3, 13.9, 27.8]), min_size=len(s), max_size=len(s)))
    twice = np.repeat(s, 2)[1:-1]
    curvature = np.stack([left, right], axis=1).ravel()[1:-1]
    knots = knots_of(twice, curvature)
    knots[2], knots[3] = np.repeat(limit, 2)[1:-1], 0.01 * curvature
    turns = draw(st.lists(st.floats(-1.5, 1.5), min_size=len(s) - 2, max_size=len(s) - 2))
    inner = s[1:-1]
    return knots, Joints(inner, np.array(turns), np.ones(len(inner)))


@settings(max_examples=150, deadline=None)
@given(any_roads())
def test_whatever_is_repaired_only_the_curvature_changes(made: tuple[Array, Joints]) -> None:
    knots, joints = made
    after, told = judge(knots, joints)
    assert np.all(np.diff(after[0]) >= 0.0)
    assert np.all(np.isfinite(after))
    assert after[0, 0] == knots[0, 0]
    assert after[0, -1] == knots[0, -1]
    assert bool(told) or after is knots or np.array_equal(after, knots)
    small = [np.array(k) for k in (knots, after)]
    for k in small:
        k[1] = np.clip(k[1], -1.0, 1.0)
    old, new = (route_arrays(Route("any", k[0], k[1], k[2], k[3], k[4], k[5])) for k in small)
    np.testing.assert_array_equal(old.limit_mps, new.limit_mps)
    for name in ("grade", "x_m", "y_m"):
        np.testing.assert_allclose(getattr(old, name), getattr(new, name), atol=1e-9)


def test_headings_of_geometries_meet_where_the_road_is_clean() -> None:
    """The joints are told from headings: those of a spiral against its own integral."""
    fine = np.linspace(0.0, 41.7, 100_001)
    piece = Geometries.linear(1.0, 2.0, 0.3, 41.7, 0.001, -0.02)
    points = piece.points(np.zeros(len(fine), dtype=np.intp), fine)
    turned = np.trapezoid(points.curvature_per_m, fine)
    assert points.heading_rad[-1] == pytest.approx(0.3 + turned, abs=1e-9)
