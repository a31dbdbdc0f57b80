"""Both renderers draw all of a scene, and nothing but what is in it."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_hex, to_rgba
from matplotlib.patches import Rectangle
from pldf.cli import main
from pldf.errors import ModelError
from pldf.recordings.interventions import Rates
from pldf.report import figures, paper, screen
from pldf.report.contents import Contents
from pldf.report.figures.study import study_figures
from pldf.report.scene import (
    Axis,
    Band,
    Box,
    Boxes,
    Fill,
    Line,
    Note,
    Panel,
    Scene,
    Stroke,
    Tick,
)
from sample_recording import sample_recording

FIGURES = ("rates", "compared", "drives", "development", "steps", "long_run", "plan", "base")

ONE, TWO = np.array([0.0, 1.0, 2.0]), np.array([3.0, np.nan, 5.0])
EVERYTHING = Panel(
    (
        Line(ONE, TWO, Stroke("#0072B2", 1.5, "dashdot", "diamond", 5.0, True, 0.5), "Line & <b>"),
        Line(ONE, TWO + 1, Stroke("#D55E00", 2.0, "dash"), "Steps", stepped=True, raised=True),
        Line(ONE, TWO + 2, Stroke("#000000", 1.0, "dot"), "Later", optional=True),
        Line(ONE, TWO + 3, Stroke("#000000", 1.0), "Steps", listed=False, name="Other steps"),
        Line(ONE, TWO + 4, Stroke("#009E73", 1.0), "Told", hover=("a", "b", "c")),
        Line(ONE, ONE, Stroke("#666666", 0.8)),
        Band(ONE, ONE - 1, ONE + 1, Fill("#56B4E9", 0.3), "Band"),
        Boxes(
            (Box(0.0, 1.0, 2.0, 3.0, "here"), Box(1.5, 2.0, 2.0, 4.0)),
            Fill("#E69F00", 0.9, hatched=True),
            "Boxes",
        ),
        Note(1.0, 4.0, "above"),
        Note(1.0, 3.0, "below", "below", boxed=True),
    ),
    Axis("Distance", "km", low=0.0, high=2.0),
    Axis("Height", "m", "over all", low=10.0, high=-1.0, ticks=(Tick(2.0, "two", "#D55E00"),)),
    2.0,
    "Panel title",
)  # fmt: skip
SCENE = Scene((EVERYTHING, EVERYTHING), "Scene title", stages=("Line & <b>", "Steps"))


@pytest.fixture(scope="module")
def scenes(contents: Contents) -> dict[str, Scene]:
    """All figures of the project, and one with everything that a scene can say."""
    recording = sample_recording(1.0)
    return {
        **study_figures(contents),
        "one": figures.one_drive(recording, "title"),
        "bars": figures.rate_bars({"A1": Rates(0.1, 0.2, 0.3), "B1": Rates(0, 0, 0)}, "title"),
        "everything": SCENE,
    }


def test_a_study_has_all_figures(contents: Contents) -> None:
    assert tuple(study_figures(contents)) == FIGURES


def of(panel: Panel, kind: type) -> list[Any]:
    return [element for element in panel.elements if isinstance(element, kind)]


def same(one: Any, two: Any) -> bool:
    return np.allclose(np.asarray(one, float), two, equal_nan=True, atol=1e-4)


def panels_on_paper(scene: Scene) -> Iterator[tuple[Panel, Axes]]:
    yield from zip(scene.panels, paper.drawn(scene).axes, strict=True)


@pytest.mark.parametrize("name", [*FIGURES, "one", "bars", "everything"])
def test_paper_draws_every_element(scenes: dict[str, Scene], name: str) -> None:
    for panel, axes in panels_on_paper(scenes[name]):
        lines = [line for line in of(panel, Line) if not line.optional]
        assert len(axes.lines) == len(lines)
        for line, drawn in zip(lines, axes.lines, strict=True):
            assert same(drawn.get_xdata(), line.x)
            assert same(drawn.get_ydata(), line.y)
            assert to_hex(drawn.get_color()).upper() == line.stroke.colour
            assert (drawn.get_drawstyle() == "steps-post") == line.stepped
        bands = [c for c in axes.collections if isinstance(c, PolyCollection)]
        assert [to_hex(b.get_facecolor()[0]).upper() for b in bands] == [
            band.fill.colour for band in of(panel, Band)
        ]
        boxes = [(box, e.fill) for e in of(panel, Boxes) for box in e.boxes]
        assert len(axes.patches) == len(boxes)
        for (box, fill), patch in zip(boxes, axes.patches, strict=True):
            assert isinstance(patch, Rectangle)
            expected = (box.start, box.low, box.end - box.start, box.high - box.low)
            assert patch.get_bbox().bounds == pytest.approx(expected)
            assert bool(patch.get_hatch()) == fill.hatched
        assert [text.get_text() for text in axes.texts] == [n.text for n in of(panel, Note)]
        assert axes.get_title(loc="left") == panel.title
        for which, axis in (("x", panel.x), ("y", panel.y)):
            ends = getattr(axes, f"get_{which}lim")()
            for end, wanted in zip(ends, (axis.low, axis.high), strict=True):
                assert wanted is None or end == pytest.approx(wanted)


@pytest.mark.parametrize("name", [*FIGURES, "one", "bars", "everything"])
def test_the_page_draws_every_element(scenes: dict[str, Scene], name: str) -> None:
    scene = scenes[name]
    figure = screen.drawn(scene)
    traces = list(figure.data)
    annotations = [unescape(note.text) for note in figure.layout.annotations]
    for panel in scene.panels:
        for line in of(panel, Line):
            found = [t for t in traces if t.fill is None and same_line(t, line)]
            assert found, line.label
            assert (found[0].visible == "legendonly") == line.optional
            assert (found[0].line.shape == "hv") == line.stepped
            traces.remove(found[0])
        for band in of(panel, Band):
            y = np.concatenate((band.high, band.low[::-1]))
            found = [t for t in traces if t.fill == "toself" and len(t.y) == len(y)]
            found = [t for t in found if same(t.y, y)]
            assert found, band.label
            traces.remove(found[0])
        for boxes in of(panel, Boxes):
            x = [[b.start, b.end, b.end, b.start, b.start, np.nan] for b in boxes.boxes]
            found = [t for t in traces if t.fill == "toself" and len(t.x) == 6 * len(x)]
            found = [t for t in found if same(t.x, np.ravel(x))]
            assert found, boxes.label
            assert bool(found[0].fillpattern.shape) == boxes.fill.hatched
            traces.remove(found[0])
        for text in (*(note.text for note in of(panel, Note)), panel.title):
            if text:
                annotations.remove(text)
    assert (traces, annotations) == ([], [])


def same_line(trace: Any, line: Line) -> bool:
    return len(trace.y) == len(line.y) and same(trace.x, line.x) and same(trace.y, line.y)


@pytest.mark.parametrize("name", [*FIGURES, "one", "bars", "everything"])
def test_both_legends_are_that_of_the_scene(scenes: dict[str, Scene], name: str) -> None:
    scene = scenes[name]
    optional = {e.label for p in scene.panels for e in of(p, Line) if e.optional}
    (legend,) = paper.drawn(scene).legends
    on_paper = [text.get_text() for text in legend.get_texts()]
    assert on_paper == [label for label in scene.legend if label not in optional]
    listed = sorted(
        (t for t in screen.drawn(scene).data if t.showlegend), key=lambda trace: trace.legendrank
    )
    assert [unescape(trace.name) for trace in listed] == list(scene.legend)


def test_axes_are_told_on_paper() -> None:
    figure = paper.drawn(SCENE)
    upper, lower = figure.axes
    assert figure.get_suptitle() == "Scene title"
    assert (upper.get_xlabel(), lower.get_xlabel()) == ("", "Distance (km)")
    assert upper.get_ylabel() == "Height (m)\nover all"
    (tick,) = upper.get_yticklabels()
    assert (tick.get_text(), tick.get_color()) == ("two", "#D55E00")
    hollow = upper.lines[0]
    assert to_rgba(hollow.get_markerfacecolor())[:3] == (1.0, 1.0, 1.0)
    assert upper.lines[1].get_zorder() > upper.lines[2].get_zorder()


def test_axes_are_told_on_the_page() -> None:
    layout = screen.drawn(SCENE).layout
    assert layout.yaxis.title.text == "Height (m)<br>over all"
    assert layout.yaxis.ticktext == ('<span style="color:#D55E00">two</span>',)
    assert layout.yaxis.range == (10.0, -1.0)
    assert (layout.xaxis.ticksuffix, layout.xaxis2.ticksuffix) == (" km", " km")
    assert layout.xaxis.matches == "x2"  # zoomed together
    assert (layout.yaxis.fixedrange, layout.xaxis.fixedrange) == (True, False)


def test_hovering_tells_names_units_and_texts() -> None:
    data = screen.drawn(SCENE).data
    templates = [trace.hovertemplate for trace in data]
    assert "Line &amp; &lt;b&gt;: %{y:.1f} m<extra></extra>" in templates
    assert "Other steps: %{y:.1f} m<extra></extra>" in templates
    told = next(trace for trace in data if trace.name == "Told")
    assert (told.text, told.hovertemplate) == (("a", "b", "c"), "%{text}<extra></extra>")
    boxes = next(trace for trace in data if trace.name == "Boxes")
    assert boxes.text[0] == "here"
    unnamed = next(trace for trace in data if not trace.name)
    assert unnamed.hoverinfo == "skip"
    # Elements of one label are hidden and shown together.
    assert len({trace.legendgroup for trace in data if trace.name == "Steps"}) == 1


def test_areas_lie_below_lines_and_raised_lines_above() -> None:
    names = [trace.name for trace in screen.drawn(Scene((EVERYTHING,))).data]
    assert names[:2] == ["Band", "Boxes"]
    assert names[-1] == "Steps"


def test_stages_are_shown_with_those_before() -> None:
    figure = screen.drawn(SCENE)
    (menu,) = figure.layout.updatemenus
    first, second = (button.args[0]["visible"] for button in menu.buttons)
    names = [trace.name for trace in figure.data]
    hidden = {name for name, visible in zip(names, first, strict=True) if not visible}
    assert hidden == {"Steps"}
    assert all(second)


def test_a_repeated_y_axis_has_no_numbers() -> None:
    scene = Scene((EVERYTHING, EVERYTHING), columns=2)
    left, right = paper.drawn(scene).axes
    assert (left.get_ylabel() != "", right.get_ylabel()) == (True, "")
    layout = screen.drawn(scene).layout
    assert layout.yaxis2.showticklabels is False


def test_figures_for_papers_are_the_same_bytes_every_time(
    contents: Contents, tmp_path: Path
) -> None:
    for folder in ("one", "two"):
        for name, scene in study_figures(contents).items():
            paper.save(tmp_path / folder / f"{name}.svg", scene)
    for name in FIGURES:
        one, two = (tmp_path / folder / f"{name}.svg" for folder in ("one", "two"))
        assert one.read_bytes() == two.read_bytes()


def test_an_unknown_ending_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"a\.doc: cannot be drawn .*use \.png, \.pdf or \.svg"):
        paper.save(tmp_path / "a.doc", SCENE)


def test_the_command_writes_figures_as_pdf(folder: Path, tmp_path: Path) -> None:
    shutil.copy(folder / "drives.csv", tmp_path)
    figures = tmp_path / "figures"
    command = ["analyse", str(tmp_path), "--figures", str(figures), "--format", "pdf"]
    assert main(command) == 0
    assert {path.name for path in figures.iterdir()} == {"base.pdf", "plan.pdf", "rates.pdf"}
    assert (figures / "rates.pdf").read_bytes().startswith(b"%PDF")
