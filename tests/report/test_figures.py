"""What each figure shows, as data, whoever draws it."""

from __future__ import annotations

import re

import numpy as np
import pytest
from pldf.analysis.long_run import MEASURES
from pldf.kernel.units import KMH_PER_MPS
from pldf.profiles.stored_profile import StoredProfile
from pldf.recordings.interventions import Rates
from pldf.recordings.recording import Recording
from pldf.recordings.steps import Steps
from pldf.report import figures
from pldf.report.scene import Boxes, Line, Note, Panel, Scene
from pldf.roads import packed_route, read_route
from pldf.route_facts import route_facts
from sample_recording import sample_recording as sample


def labelled(panel: Panel, kind: type) -> dict:
    return {e.label: e for e in panel.elements if isinstance(e, kind) and e.label}


def spans_m(boxes: Boxes) -> list[tuple[int, int]]:
    return [(round(1000 * box.start), round(1000 * box.end)) for box in boxes.boxes]


def test_interventions_are_shaded_where_they_are() -> None:
    scene = figures.one_drive(sample(1.0), "title")
    speed, pedals = scene.panels
    assert scene.legend == (
        "Legal limit", "Base profile", "Learned profile, followed", "Speed driven",
        "Gas pedal", "Brake until reactivated", "Set speed changed",
    )  # fmt: skip
    shaded = labelled(speed, Boxes)
    assert spans_m(shaded["Gas pedal"]) == [(400, 600)]
    assert spans_m(shaded["Brake until reactivated"]) == [(1000, 1200)]
    assert spans_m(shaded["Set speed changed"]) == [(1200, 1998)]
    assert shaded["Gas pedal"].boxes[0].hover == "Gas pedal: 10.0 s"
    low, high = speed.y.low, speed.y.high
    assert low is not None
    assert high is not None
    assert low < 19.0 * KMH_PER_MPS < 25.0 * KMH_PER_MPS < high
    # The whole height for pedals, a strip at the foot for the set speed, no speed in its way.
    assert shaded["Gas pedal"].boxes[0][2:4] == (low, high)
    foot = shaded["Set speed changed"].boxes[0]
    assert foot.low == low < foot.high < 19.0 * KMH_PER_MPS
    assert pedals.y.title == "Pedals (%)\nbrake | gas"
    assert [tick.text for tick in pedals.y.ticks] == ["40", "20", "0", "20", "40", "60"]


def test_lines_are_in_the_units_of_their_axes() -> None:
    recording = sample(1.0)
    speed, _ = figures.one_drive(recording, "title").panels
    driven = labelled(speed, Line)["Speed driven"]
    assert (speed.x.title, speed.y.title) == ("Distance (km)", "Speed (km/h)")
    assert driven.x[-1] == pytest.approx(recording["s_m"][-1] / 1000)
    expected = np.interp(driven.x * 1000, recording["s_m"], recording["speed_mps"])
    assert driven.y == pytest.approx(3.6 * expected)


def test_a_base_drive_shows_no_learned_profile() -> None:
    assert "Learned profile, followed" not in figures.one_drive(sample(), "title").legend


def test_the_limit_holds_until_the_next_sign() -> None:
    recording = sample()
    recording.columns["limit_mps"][300:] = 10.0  # from 600 m
    limit = labelled(figures.one_drive(recording, "").panels[0], Line)["Legal limit"]
    assert limit.stepped
    assert limit.x == pytest.approx([0.0, 0.6, 1.998])
    assert limit.y == pytest.approx([90.0, 36.0, 36.0])


def test_several_recordings_are_compared() -> None:
    speeds, lanes, pedals = figures.compared({"a": sample(), "b": sample(1.0)}, "title").panels
    assert [tick.text for tick in lanes.y.ticks] == ["a", "b"]
    lines = labelled(speeds, Line)
    of_b = lines["Speed driven in b"]
    assert lanes.y.ticks[1].colour == of_b.stroke.colour
    strokes = [(lines[f"Speed driven in {n}"].stroke.colour) for n in "ab"]
    assert len(set(strokes)) == 2
    for boxes in labelled(lanes, Boxes).values():
        assert [round(box.low) for box in boxes.boxes] == [0, 1]  # a lane each
    # Pedals are hidden and shown with the speed of their drive.
    assert {e.label for e in pedals.elements if isinstance(e, Line) and e.label} == {
        "Speed driven in a", "Speed driven in b",
    }  # fmt: skip
    assert (
        figures.recorded({"a": sample()}, "").panels[0].y
        == figures.one_drive(sample(), "").panels[0].y
    )


def test_all_drives_have_one_scale() -> None:
    scene = figures.drives({"A1": sample(), "B1": sample(9.0)}, {"A1": "x", "B1": "y"}, "title")
    assert [panel.title for panel in scene.panels] == ["A1  x", "B1  y"]
    assert scene.panels[0].y == scene.panels[1].y
    assert scene.panels[0].y.high is not None
    assert scene.panels[0].y.high > KMH_PER_MPS * 30.0
    assert scene.legend[2] == "Learned profile, followed"  # of the panel with most


def profile(changes: tuple[float, ...]) -> StoredProfile:
    nodes = 2000
    base = np.full(nodes, 20.0)
    stored = StoredProfile(1, "0" * 16, base)
    for number, change in enumerate(changes, start=1):
        learned = base + change
        new = stored.next_iteration("drive", f"B{number}", 0, {"learned_mps": learned})
        stored = stored.with_iteration(new)
    return stored


def test_development_shows_each_state_and_its_change() -> None:
    stored = profile((1.0, 2.5))
    recordings = {"A1": sample(), "A2": sample(1.0)}
    scene = figures.development(stored, ["A2", "B1"], recordings, "t", with_speeds=True)
    speeds, changes = scene.panels
    assert labelled(changes, Line)["Profile after A2"].y == pytest.approx(np.full(2000, 3.6))
    assert labelled(changes, Line)["Profile after B1"].y == pytest.approx(np.full(2000, 9.0))
    assert labelled(speeds, Line)["Profile after B1"].y == pytest.approx(np.full(2000, 81.0))
    optional = {e.label for e in speeds.elements if isinstance(e, Line) and e.optional}
    assert optional == {"Speed driven in A1", "Speed driven in A2"}
    without = figures.development(stored, ["A2", "B1"], recordings, "t")
    assert set(scene.legend) - set(without.legend) == optional


def test_the_newest_state_of_a_profile_is_shown() -> None:
    scene = figures.one_drive(sample(), "", profile((1.0, 2.0)))
    assert labelled(scene.panels[0], Line)["Profile after drive 2"].y[7] == pytest.approx(79.2)


def test_bars_and_what_the_paper_reports() -> None:
    rates = {"A1": Rates(0.25, 0.5, 0.6), "A3": Rates(0.0, 0.0, 0.0), "B1": Rates(0.1, 0.0, 0.1)}
    (panel,) = figures.rate_bars(rates, "title").panels
    bars = labelled(panel, Boxes)
    assert [box.high for box in bars["Pedals"].boxes] == pytest.approx([25.0, 0.0, 10.0])
    assert [box.high for box in bars["Pedals or set speed"].boxes] == pytest.approx([60, 0, 10])
    assert bars["Set speed"].fill.hatched  # told apart in black and white, too
    marks = [e.y for e in panel.elements if isinstance(e, Line)]
    values = [mark[~np.isnan(mark)][::2] for mark in marks]
    # Means of A and B; none over A3, in which nobody intervenes.
    assert np.array(values) == pytest.approx(
        np.array([[22.32, 12.04], [39.76, 12.42], [54.68, 22.97]])
    )
    notes = [e.text for e in panel.elements if isinstance(e, Note)]
    assert notes == ["25", "0", "10", "50", "0", "0", "60", "0", "10"]


def test_the_steps_are_shown_one_after_the_other() -> None:
    line = np.linspace(100.0, 200.0, 5)
    steps = Steps(1, "gas", 0.5, line, line, line - 10, line, line, *[np.full(5, 20.0)] * 4)
    scene = figures.steps(steps)
    assert scene.stages == ("1 recorded", "2 stretched", "3 offset", "4 mean", "5 smoothed")
    assert scene.legend == ("Speed driven", "Profile followed", *scene.stages)
    lines = labelled(scene.panels[0], Line)
    assert lines["2 stretched"].x == pytest.approx(lines["1 recorded"].x - 0.01)
    assert [label for label, line in lines.items() if line.raised] == ["4 mean"]


def test_the_long_run_has_a_line_per_variant() -> None:
    runs = {f"gain {f}": {"drive": [1.0, 2.0], **{n: [f, f + k] for k, n in enumerate(MEASURES)}}
            for f in (0.0, 0.5)}  # fmt: skip
    scene = figures.long_run(runs)
    assert (len(scene.panels), scene.columns) == (6, 2)
    assert scene.legend == ("gain 0.0", "gain 0.5")
    ends = [labelled(p, Line)["gain 0.5"].y[-1] for p in scene.panels]
    shown = ("combined", "content", "pedal", "set_speed", "wish_error", "drive_wish_error")
    order = [next(k for k, n in enumerate(MEASURES) if n.startswith(name)) for name in shown]
    assert ends == [0.5 + k for k in order]
    assert all(panel.y.low == 0.0 for panel in scene.panels)


def test_a_route_shows_limits_curves_and_grade() -> None:
    facts = route_facts(packed_route(0))
    speeds, curvature, grade = figures.route(facts).panels
    assert re.match(r"Study road: 4\.50 km, base profile \d:\d\d min, binding", speeds.title)
    curves = labelled(speeds, Boxes)["Curve binds (over 5 km/h below the limit)"]
    expected = [(round(c.start_m), round(c.end_m)) for c in facts.curves]
    assert spans_m(curves) == expected
    assert "Curve speed at 2.5 m/s²" in labelled(speeds, Line)
    radii = [e.text for e in curvature.elements if isinstance(e, Note)]
    assert radii == [f"{c.radius_m:.0f} m" for c in facts.curves]
    assert labelled(grade, Line)["Grade"].y == pytest.approx(100 * facts.route.grade)


def test_a_flat_straight_road_has_neither_curves_nor_grade(tmp_path) -> None:
    path = tmp_path / "flat.csv"
    path.write_text("s_m,curvature_per_m,speed_limit_mps\n0,0,20\n900,0,20\n")
    scene = figures.route(route_facts(read_route(path)))
    assert scene.legend == ("Legal limit", "Base profile")
    assert len(scene.panels) == 2


def test_a_repeated_axis_is_told_once() -> None:
    panel = figures.one_drive(sample(), "").panels[0]
    scene = Scene((panel, panel), columns=2)
    assert (scene.repeats_y(0), scene.repeats_y(1)) == (False, True)
    assert scene.heights_in == (panel.height_in,)
    below = Scene((panel, panel))
    assert (below.repeats_y(1), below.at_foot(0), below.at_foot(1)) == (False, False, True)


def test_long_recordings_are_thinned_but_keep_their_end() -> None:
    time = np.arange(0.0, 5.0, 0.01)
    columns = {name: np.full(len(time), values[0]) for name, values in sample().columns.items()}
    recording = Recording({**columns, "time_s": time, "s_m": 20.0 * time})
    driven = labelled(figures.one_drive(recording, "").panels[0], Line)["Speed driven"]
    assert len(driven.x) == 51
    assert driven.x[-1] == pytest.approx(20.0 * time[-1] / 1000)
