"""What the page is told of a road, and that it sees the road as it is."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from node import ROOT, node
from pldf.cockpit.road_view import road_view
from pldf.roads import RoadOptions, fingerprint, open_road, route_arrays, write_route_csv

# Two roads one after the other, the second drawn against the way; the lanes are the keyword's.
NETWORK = """<?xml version="1.0"?>
<OpenDRIVE><header revMajor="1" revMinor="7" name="Two"/>
<road name="First" length="300" id="1" junction="-1" rule="{rule}">
 <link><successor elementType="road" elementId="2" contactPoint="end"/></link>
 <type s="0" type="rural"><speed max="80" unit="km/h"/></type>
 <type s="200" type="townLocal"><speed max="30" unit="km/h"/></type>
 <planView><geometry s="0" x="0" y="0" hdg="0" length="300"><line/></geometry></planView>
 <lanes><laneSection s="0">
  <left>{left}</left><center><lane id="0" type="none"/></center><right>{right}</right>
 </laneSection></lanes>
 <objects><bridge s="50" length="20" id="1" name="Au" type="concrete"/></objects>
</road>
<road name="Second" length="200" id="2" junction="-1" rule="{rule}">
 <link><successor elementType="road" elementId="1" contactPoint="end"/></link>
 <type s="0" type="rural"><speed max="80" unit="km/h"/></type>
 <type s="150" type="town"><speed max="30" unit="km/h"/></type>
 <planView>
  <geometry s="0" x="500" y="0" hdg="3.141592653589793" length="200"><line/></geometry>
 </planView>
 <lanes><laneSection s="0">
  <left>{right}</left><center><lane id="0" type="none"/></center><right>{left}</right>
 </laneSection></lanes>
 <objects><bridge s="10" length="40" id="2" type="concrete"/></objects>
</road></OpenDRIVE>
"""
LANE = '<lane id="{}" type="driving"><width sOffset="0" a="{}" b="0" c="0" d="0"/></lane>'


def network(folder: Path, rule: str, left: int, right: int, width_m: float) -> dict[str, Any]:
    lanes = ("".join(LANE.format(k + 1, width_m) for k in range(count)) for count in (left, right))
    of_left, of_right = lanes
    path = folder / "two.xodr"
    path.write_text(NETWORK.format(rule=rule, left=of_left, right=of_right), encoding="utf-8")
    return road_view(open_road(str(path), RoadOptions(start_road="1")))


def seen(view: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return what the page's model of the road has in it."""
    (folder / "road.prepared").write_bytes(view["prepared"])
    page = ROOT / "fmu_src/pldf/cockpit/page/engine/road.js"
    script = f"""
        import {{ readFileSync }} from "node:fs";
        import {{ roadOf }} from {json.dumps(page.as_uri())};
        const told = JSON.parse(readFileSync(0, "utf8"));
        const prepared = new Uint8Array(readFileSync(told.file));
        const road = roadOf({{ ...told.road, prepared }});
        const names = ["x_m", "y_m", "z_m", "curvature_per_m", "limit_mps"];
        const arrays = Object.fromEntries(names.map((name) => [name, [...road[name]]]));
        console.log(JSON.stringify({{ ...arrays, key: road.key, limits: road.limits }}));
    """
    road = {key: value for key, value in view.items() if key != "prepared"}
    given = json.dumps({"road": road, "file": str(folder / "road.prepared")})
    result = node("--input-type=module", "--eval", script, given=given)
    assert result.returncode == 0, result.stderr
    return dict(json.loads(result.stdout))


def test_the_page_sees_the_study_road_as_it_is(tmp_path: Path) -> None:
    road = open_road("study")
    route, arrays = road.route, route_arrays(road.route)
    page = seen(road_view(road), tmp_path)
    assert page["key"] == fingerprint(route)
    assert page["limit_mps"] == list(arrays.limit_mps)
    for name, tolerance_m in (("x_m", 0.02), ("y_m", 0.02)):
        np.testing.assert_allclose(page[name], getattr(arrays, name), rtol=0.0, atol=tolerance_m)
    heights_m = np.interp([600, 1960, 4500], np.arange(4501), page["z_m"])
    np.testing.assert_allclose(heights_m, [8.0, -2.5, -8.0], rtol=0.0, atol=0.05)
    signed = np.interp(np.arange(4501), route.s_m, route.curvature_per_m)
    np.testing.assert_allclose(page["curvature_per_m"], signed, rtol=0.0, atol=6e-4)


def test_the_study_road_has_its_bridge_and_its_village() -> None:
    view = road_view(open_road("study"))
    assert view["stretches"] == [
        {"kind": "bridge", "from_m": 1720.0, "to_m": 1940.0, "name": "Bridge"},
        {"kind": "village", "from_m": 2710.0, "to_m": 3040.0, "name": ""},
    ]
    lanes = {name: view[name] for name in ("lane_width_m", "lanes_right", "lanes_left", "traffic")}
    assert lanes == {"lane_width_m": 3.5, "lanes_right": 1, "lanes_left": 1, "traffic": "RHT"}


def test_places_on_a_road_that_is_driven_against_its_direction(tmp_path: Path) -> None:
    view = network(tmp_path, "RHT", 1, 2, 3.25)
    assert view["stretches"] == [
        {"kind": "bridge", "from_m": 50.0, "to_m": 70.0, "name": "Au"},
        {"kind": "village", "from_m": 200.0, "to_m": 350.0, "name": ""},  # goes on behind the link
        {"kind": "bridge", "from_m": 450.0, "to_m": 490.0, "name": ""},
    ]


@pytest.mark.parametrize(
    ("rule", "left", "right", "along", "against"),
    [("RHT", 1, 2, 2, 1), ("LHT", 2, 1, 2, 1), ("RHT", 0, 3, 3, 0)],
)
def test_lanes_are_counted_in_the_direction_of_driving(
    rule: str, left: int, right: int, along: int, against: int, tmp_path: Path
) -> None:
    view = network(tmp_path, rule, left, right, 3.25)
    found = (view["traffic"], view["lanes_right"], view["lanes_left"], view["lane_width_m"])
    assert found == (rule, along, against, 3.25)


def test_a_width_that_no_lane_has_is_not_drawn(tmp_path: Path) -> None:
    assert network(tmp_path, "RHT", 1, 1, 0.5)["lane_width_m"] == 3.5


def test_a_csv_has_a_lane_in_each_direction(tmp_path: Path) -> None:
    write_route_csv(open_road("study").route, tmp_path / "road.csv")
    view = road_view(open_road(str(tmp_path / "road.csv")))
    assert (view["lanes_right"], view["lanes_left"], view["stretches"]) == (1, 1, [])


def test_a_road_without_a_line_turns_to_the_sides_of_its_curvature(tmp_path: Path) -> None:
    rows = ["s_m,curvature_per_m,speed_limit_mps"]
    bends = {100: 0.0, 110: 0.01, 150: 0.01, 160: 0.0, 200: 0.0, 210: 0.02, 240: -0.02, 250: 0.0}
    rows += [f"{s},{value},20" for s, value in ({0: 0.0} | bends | {300: 0.0}).items()]
    (tmp_path / "road.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    view = road_view(open_road(str(tmp_path / "road.csv")))
    sides = [(each["kind"], each["from_m"], each["to_m"]) for each in view["stretches"]]
    assert sides == [
        ("bend_left", 100.0, 160.0), ("bend_left", 200.0, 225.0), ("bend_right", 225.0, 250.0),
    ]  # fmt: skip
    curvature = seen(view, tmp_path)["curvature_per_m"]
    assert [round(curvature[s], 3) for s in (50, 130, 180, 214)] == [0.0, 0.01, 0.0, 0.015]
    assert curvature[235] < -0.01
