"""The map of all roads of a file: each with its id and limit, connecting roads without."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from pldf.cli import main
from pldf.report import figures
from pldf.report.scene import Line, Note, Panel
from pldf.roads import roads_of


def drawn(path: Path) -> Panel:
    scene = figures.network(roads_of(str(path)), "town")
    assert scene is not None
    assert scene.to_scale
    return scene.panels[0]


def lines(panel: Panel) -> dict[str, Line]:
    return {e.label: e for e in panel.elements if isinstance(e, Line) and e.label}


def metres(line: Line) -> float:
    return float(np.nansum(np.hypot(np.diff(line.x), np.diff(line.y))))


def arc_town(path: Path) -> Path:
    """Two roads, one of them a quarter of a circle, and one within a junction."""
    road = (
        '<road id="{}" length="{}" junction="{}">{}<planView>'
        '<geometry s="0" x="{}" y="{}" hdg="0" length="{}">{}</geometry></planView></road>'
    )
    speed = '<type s="0" type="town"><speed max="{}" unit="km/h"/></type>'
    quarter = 50.0 * np.pi
    text = road.format("12", 300, -1, speed.format(30), 0, 0, 300, "<line/>")
    arc = '<arc curvature="0.01"/>'
    text += road.format("main", quarter, -1, speed.format(70), 320, 0, quarter, arc)
    text += road.format("7", 20, 5, "", 300, 0, 20, "<line/>")
    path.write_text(f"<OpenDRIVE>{text}</OpenDRIVE>")
    return path


def test_every_road_is_drawn_with_its_limit_and_id(tmp_path: Path) -> None:
    panel = drawn(arc_town(tmp_path / "town.xodr"))
    found = lines(panel)
    assert list(found) == ["Connecting road of a junction", "30 km/h", "70 km/h"]
    assert metres(found["30 km/h"]) == pytest.approx(300.0)
    assert metres(found["70 km/h"]) == pytest.approx(50.0 * np.pi, rel=1e-3)
    assert (np.nanmax(found["70 km/h"].x), np.nanmax(found["70 km/h"].y)) == pytest.approx(
        (420.0, 100.0)
    )
    assert metres(found["Connecting road of a junction"]) == pytest.approx(20.0)
    texts = [e.text for e in panel.elements if isinstance(e, Note)]
    assert {"12", "main"} < set(texts)
    assert "7" not in texts


def test_roads_without_a_limit_are_dashed(tmp_path: Path) -> None:
    path = arc_town(tmp_path / "town.xodr")
    path.write_text(path.read_text().replace('<speed max="30" unit="km/h"/>', ""))
    without = lines(drawn(path))["No limit stated"]
    assert metres(without) == pytest.approx(300.0)
    assert without.stroke.dash == "dash"


def test_the_command_lists_and_draws(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = arc_town(tmp_path / "town.xodr")
    out = tmp_path / "map.svg"
    assert main(["route", str(path), "--list", "--plot", str(out)]) == 0
    told = capsys.readouterr().out
    assert "main" in told
    assert told.endswith(f"drawn        {out}\n")
    assert out.stat().st_size > 1000


def test_a_file_without_any_line_cannot_be_drawn(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "flat.csv"
    path.write_text("s_m,curvature_per_m,speed_limit_mps\n0,0,20\n900,0,20\n")
    assert main(["route", str(path), "--list", "--plot", str(tmp_path / "map.png")]) == 1
    assert "no road has a line that can be drawn" in capsys.readouterr().err
