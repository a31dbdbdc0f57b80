"""A table whose line and curvature tell of different roads."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pldf.findings import Finding
from pldf.roads import Route, packed_route, read_route
from pldf.roads.route import COLUMNS


def written(route: Route, path: Path, every: int = 1) -> tuple[Finding, ...]:
    """Write the knots as somebody else would, and return what is told of the file."""
    rows = np.stack([route.knots[name] for name in COLUMNS]).T
    kept = np.unique(np.concatenate((np.arange(0, len(rows), every), [len(rows) - 1])))
    lines = [",".join(map(repr, row)) for row in rows[kept].tolist()]
    path.write_text("\n".join([",".join(COLUMNS), *lines]))
    return read_route(path).notes


@pytest.mark.parametrize("every", [1, 5, 20])
def test_a_road_that_is_one_is_not_doubted(tmp_path: Path, every: int) -> None:
    assert written(packed_route(0), tmp_path / "road.csv", every) == ()


@pytest.mark.parametrize("factor", [0.0, -1.0, 57.3])
@pytest.mark.parametrize("every", [1, 10])
def test_curvature_of_another_road_is_told(tmp_path: Path, factor: float, every: int) -> None:
    study = packed_route(0)
    wrong = replace(study, curvature_per_m=np.clip(factor * study.curvature_per_m, -0.9, 0.9))
    told = [n for n in written(wrong, tmp_path / "road.csv", every) if "x_m and y_m turn" in n.text]
    assert len(told) == 1
    assert told[0].severity == "warning"
    assert told[0].line > 1
    at_m = float(told[0].place.removesuffix(" m"))
    near = np.interp(np.arange(at_m - 50, at_m + 50), study.s_m, study.curvature_per_m)
    assert np.max(np.abs(near)) > 1.0 / 250.0


def test_a_line_in_feet_is_told(tmp_path: Path) -> None:
    study = packed_route(0)
    feet = replace(study, x_m=study.x_m / 0.3048, y_m=study.y_m / 0.3048)
    (told,) = written(feet, tmp_path / "road.csv")
    assert "the line of x_m and y_m is 14763.8 m long, s_m 4500 m" in told.text


def test_knots_too_far_apart_to_tell_are_not_doubted(tmp_path: Path) -> None:
    assert not any("turn" in n.text for n in written(packed_route(0), tmp_path / "r.csv", 300))
