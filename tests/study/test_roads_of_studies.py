"""A road that needs a start or a default limit: kernels and FMUs drive the same."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from laboratory import files
from pldf import cli
from pldf.cosim.road_values import road_values
from pldf.roads import RoadOptions, open_road, read_route, route_arrays
from pldf.roads.load import DATA, PACKED

LIMIT_MPS = 50.0 / 3.6
STUDY = f"""
[participants]
count = 1
[drives]
phases = ["A2", "B1"]
step_s = 0.1
[road]
route = "without.xodr"
default_limit_mps = {LIMIT_MPS!r}
[recordings]
participants = "all"
"""


def without_limits(folder: Path) -> Path:
    """Write the study road without its speed limits."""
    text = (DATA / PACKED[0]).read_text(encoding="utf-8")
    path = folder / "without.xodr"
    path.write_text(re.sub(r"<speed [^>]*>", "", text), encoding="utf-8")
    return path


def test_the_fmus_are_handed_the_same_route_to_the_bit(tmp_path: Path) -> None:
    road = open_road(str(without_limits(tmp_path)), RoadOptions(default_limit_mps=LIMIT_MPS))
    told = road_values(road, tmp_path)
    again = read_route(str(told["route_file"]))
    for one, other in zip(route_arrays(road.route), route_arrays(again), strict=True):
        assert np.asarray(one).tobytes() == np.asarray(other).tobytes()
    assert road_values(open_road("study"), tmp_path) == {"route_id": 0}


def test_kernels_and_fmus_drive_it_alike(fmu_folder: Path, tmp_path: Path) -> None:
    without_limits(tmp_path)
    (tmp_path / "s.toml").write_text(STUDY, encoding="utf-8")
    results = []
    for out, more in (("k", []), ("f", ["--fmu", "python", "--fmus", str(fmu_folder)])):
        arguments = ["study", str(tmp_path / "s.toml"), "--out", str(tmp_path / out)]
        assert cli.main([*arguments, *more]) == 0
        results.append({k: v for k, v in files(tmp_path / out).items() if not k.endswith("png")})
        results[-1].pop("versions.json")
    assert results[0] == results[1]
