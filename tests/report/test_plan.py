"""The plan view of a route: to scale, limits in colours, what binds, texts where there is room."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from pldf.report import figures, paper, screen
from pldf.report.figures.labels import Labels, Rectangle
from pldf.report.scene import Line, Note, Panel
from pldf.roads import packed_route, read_route
from pldf.route_facts import route_facts

Written = Callable[[list[tuple[float, ...]]], Panel]
COLUMNS = "s_m,curvature_per_m,speed_limit_mps,grade,x_m,y_m"


@pytest.fixture
def written(tmp_path: Path) -> Written:
    """Return a function that draws a road of these rows."""

    def draw(rows: list[tuple[float, ...]]) -> Panel:
        path = tmp_path / "road.csv"
        lines = [",".join(map(repr, row)) for row in rows]
        path.write_text("\n".join([COLUMNS, *lines]) + "\n")
        return drawn_of(path)

    return draw


def drawn_of(path: Path) -> Panel:
    scene = figures.plan(route_facts(read_route(path)))
    assert scene is not None
    return scene.panels[0]


def circle(laps: float = 1.0, radius_m: float = 100.0, limit_mps: float = 20.0) -> list:
    angles = np.linspace(0.0, 2.0 * np.pi * laps, 721)
    return [
        (
            float(radius_m * a), 1.0 / radius_m, limit_mps, 0.0,
            float(radius_m * np.sin(a)), float(radius_m * (1.0 - np.cos(a))),
        )
        for a in angles
    ]  # fmt: skip


def straight(limits_kmh: list[float], metres: float = 200.0) -> list:
    rows = [(k * metres, 0.0, v / 3.6, 0.0, k * metres, 0.0) for k, v in enumerate(limits_kmh)]
    end = metres * len(limits_kmh)
    return [*rows, (end, 0.0, limits_kmh[-1] / 3.6, 0.0, end, 0.0)]


def lines(panel: Panel) -> dict[str, Line]:
    return {e.label: e for e in panel.elements if isinstance(e, Line) and e.label}


def texts(panel: Panel) -> list[str]:
    return [e.text for e in panel.elements if isinstance(e, Note)]


def test_limits_are_drawn_where_they_hold() -> None:
    facts = route_facts(packed_route(0))
    scene = figures.plan(facts)
    assert scene is not None
    drawn = lines(scene.panels[0])
    speeds = ["50 km/h", "60 km/h", "80 km/h", "100 km/h"]
    assert [label for label in drawn if label.endswith("0 km/h")] == speeds
    strokes = [drawn[label].stroke for label in speeds]
    assert len({stroke.colour for stroke in strokes}) == 4
    assert sorted(strokes, key=lambda stroke: stroke.width_pt) == strokes  # told apart in print
    # The village: from its sign to the next, as the knots of the road say.
    x = drawn["50 km/h"].x
    ends = np.interp([2710.0, 3040.0], facts.route.s_m, facts.route.x_m)
    assert (np.nanmin(x), np.nanmax(x)) == pytest.approx(ends, abs=2.0)
    # All limits together draw the whole line, and no more.
    metres = sum(float(np.nansum(np.hypot(np.diff(e.x), np.diff(e.y)))) for e in
                 (drawn[label] for label in speeds))  # fmt: skip
    assert metres == pytest.approx(4500.0, rel=1e-3)


def test_a_map_is_to_scale_on_paper_and_on_the_page() -> None:
    scene = figures.plan(route_facts(packed_route(0)))
    assert scene is not None
    assert scene.to_scale
    figure = paper.drawn(scene)
    (axes,) = figure.axes
    box = axes.get_window_extent()
    per_px = [np.ptp(axes.get_xlim()) / box.width, np.ptp(axes.get_ylim()) / box.height]
    assert per_px[0] == pytest.approx(per_px[1], rel=1e-3)
    layout = screen.drawn(scene).layout
    assert not any(trace.line.simplify for trace in screen.drawn(scene).data)
    assert (layout.yaxis.scaleanchor, layout.yaxis.fixedrange) == ("x", False)
    bar = next(e for e in scene.panels[0].elements if isinstance(e, Line) and not e.label
               and len(e.x) == 6)  # fmt: skip
    assert f"{np.ptp(bar.x):g} m" in texts(scene.panels[0])


def test_binding_curves_have_radius_and_speed(written: Written) -> None:
    panel = written(circle(0.5, radius_m=60.0, limit_mps=25.0))
    # sqrt(2.5 m/s² * 60 m) = 44 km/h
    assert "R 60 m, 44 km/h" in texts(panel)
    assert any(label.startswith("Curve binds") for label in lines(panel))
    free = written(circle(0.5, radius_m=600.0, limit_mps=15.0))
    assert not any(text.startswith("R ") for text in texts(free))


def test_a_closed_loop_starts_where_it_ends(written: Written) -> None:
    assert "start and end" in texts(written(circle()))
    half = texts(written(circle(0.5)))
    assert {"start", "end"} < set(half)


def test_arrows_point_the_way_driven(written: Written) -> None:
    def tips(panel: Panel) -> np.ndarray:
        (arrows,) = (
            e for e in panel.elements if isinstance(e, Line) and len(e.x) == 28 and np.isnan(e.x[3])
        )
        return (arrows.x[1::4] - arrows.x[0::4]) + (arrows.x[1::4] - arrows.x[2::4])

    rows = straight([50.0])
    assert np.all(tips(written(rows)) > 0.0)
    back = [(s, 0.0, v, g, -x, y) for s, _, v, g, x, y in rows]
    assert np.all(tips(written(back)) < 0.0)


def test_many_limits_are_classes(written: Written) -> None:
    few = lines(written(straight([30, 40, 50, 60, 70, 80, 90])))
    assert sum(label.endswith("km/h") for label in few) == 7
    many = lines(written(straight([30, 40, 50, 60, 70, 80, 90, 140])))
    names = ["up to 30 km/h", "up to 50", "up to 70", "up to 90", "over 130"]
    assert [label for label in many if label in names] == names
    assert np.nanmax(many["over 130"].x) == pytest.approx(1600.0)
    assert np.nanmin(many["over 130"].x) == pytest.approx(1400.0, abs=1.0)


def test_texts_hide_neither_each_other_nor_the_line() -> None:
    line = np.linspace(0.0, 10.0, 500)
    labels = Labels(line, np.zeros(500), 1.0, Rectangle(-1.0, 11.0, -1.0, 1.0))
    added = [labels.add(x, 0.0, "a sign") for x in np.linspace(0.0, 10.0, 120)]
    assert 10 < sum(added) < 120  # it was full
    assert len(labels.notes) == sum(added)
    for one, other in combinations(labels.notes, 2):
        # On paper a letter of 8 pt is about 0.07 in wide and 0.12 in high.
        assert abs(one.x - other.x) > 6 * 0.07 or abs(one.y - other.y) > 0.12
    assert all(abs(n.y) > 0.06 or not -0.2 < n.x < 10.2 for n in labels.notes)
    assert all(-1.0 < note.x < 11.0 and -1.0 < note.y < 1.0 for note in labels.notes)


def test_roads_and_signs_are_named(tmp_path: Path) -> None:
    piece = '<geometry s="0" x="{0}" y="0" hdg="0" length="300"><line/></geometry>'
    road = (
        '<road name="{1}" id="{0}" length="300" junction="-1"><link>{2}</link>'
        '<type s="0" type="town"><speed max="{3}" unit="km/h"/></type>'
        "<planView>" + piece.replace("{0}", "{4}") + "</planView></road>"
    )
    after = '<successor elementType="road" elementId="8" contactPoint="start"/>'
    before = '<predecessor elementType="road" elementId="7" contactPoint="end"/>'
    text = road.format(7, "Main Street", after, 50, 0) + road.format(8, "Road 8", before, 70, 300)
    path = tmp_path / "town.xodr"
    path.write_text(f"<OpenDRIVE>{text}</OpenDRIVE>")
    panel = drawn_of(path)
    assert {"road 7 Main Street", "road 8", "50", "70"} <= set(texts(panel))
    signs = lines(panel)["Sign"]
    assert list(signs.x) == pytest.approx([300.0])
    assert "70 km/h" in signs.hover[0]


def test_a_long_road_is_thinned(written: Written) -> None:
    rows = straight([50.0, 80.0] * 500, metres=1000.0)
    panel = written(rows)
    points = sum(len(e.x) for e in panel.elements if isinstance(e, Line))
    assert points < 20_000
    assert panel.x.unit == "km"
    signs = lines(panel)["Sign"].x  # those that can be told apart
    assert np.min(np.diff(signs)) * 10.0 / np.ptp(panel.x.ends) > 0.1


def test_a_road_without_a_line_has_no_plan(tmp_path: Path) -> None:
    path = tmp_path / "flat.csv"
    path.write_text("s_m,curvature_per_m,speed_limit_mps\n0,0,20\n900,0,20\n")
    assert figures.plan(route_facts(read_route(path))) is None
