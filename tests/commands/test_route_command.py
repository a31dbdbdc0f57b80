"""``pldf route``: what it prints, draws and writes, and how it fails."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from networks import crossing
from pldf import cli
from pldf.cosim.prepared import prepared_route
from pldf.durations import minutes
from pldf.roads import fingerprint, packed_route, read_route, route_arrays
from pldf.route_facts import route_facts

Run = Callable[..., tuple[int, str, str]]

NO_SPEED = (
    '<OpenDRIVE>\n<road id="{0}" length="300" junction="-1">\n<planView>'
    '<geometry s="0" x="0" y="0" hdg="0" length="300"><line/></geometry>'
    "</planView></road>\n</OpenDRIVE>\n"
)


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Run:
    """Return a function that runs ``pldf route`` in an empty folder."""
    monkeypatch.chdir(tmp_path)

    def runner(*arguments: str) -> tuple[int, str, str]:
        try:
            status = cli.main(["route", *arguments])
        except SystemExit as stop:
            status = int(stop.code or 0)
        captured = capsys.readouterr()
        return status, captured.out, captured.err

    return runner


def test_the_summary_of_the_study_road(run: Run) -> None:
    status, out, err = run("study")
    facts = route_facts(packed_route(0))
    assert (status, err) == (0, "")
    assert "length       4500.0 m\n" in out
    assert "1000 m: 80 km/h;" in out
    assert f"{len(facts.curves)} bind" in out
    assert f"base profile {int(facts.driving_time_s) // 60}:" in out
    assert f"fingerprint  {fingerprint(facts.route)}\n" in out
    assert max(len(line) for line in out.splitlines()) <= 100


def test_an_exported_route_is_the_same_route(run: Run) -> None:
    assert run("study", "--export", "out.csv")[0] == 0
    first, again = packed_route(0), read_route("out.csv")
    assert fingerprint(first) == fingerprint(again)
    for one, other in zip(route_arrays(first), route_arrays(again), strict=True):
        np.testing.assert_array_equal(one, other)
    exported = run("out.csv", "--export", "again.csv")
    assert exported[0] == 0
    lines = [Path(name).read_text().split("\n", 1) for name in ("out.csv", "again.csv")]
    assert lines[0][1] == lines[1][1]  # all but the comment with the name


def test_a_route_is_prepared_for_native_fmus(run: Run) -> None:
    status, out, err = run("study", "--export", "out.prepared")
    assert (status, err) == (0, "")
    assert out.endswith("written      out.prepared\nnothing to tell\n")
    assert Path("out.prepared").read_bytes() == prepared_route(packed_route(0))
    assert [path.name for path in Path().iterdir()] == ["out.prepared"]


@pytest.mark.parametrize("source", ["study", "flat.csv"])
def test_the_plot_is_a_picture_with_something_on_it(run: Run, source: str) -> None:
    Path("flat.csv").write_text("s_m,curvature_per_m,speed_limit_mps\n0,0,20\n900,0,20\n")
    status, out, _ = run(source, "--plot", "road.png")
    assert status == 0
    without = "" if source == "study" else " (without a plan view: the file has no x and y)"
    assert out.endswith(f"drawn        road.png{without}\nnothing to tell\n")
    picture = matplotlib.image.imread("road.png")
    assert min(picture.shape[:2]) >= 600
    blue = np.array([0x00, 0x72, 0xB2]) / 255.0  # the base profile's colour
    assert np.sum(np.all(np.abs(picture[:, :, :3] - blue) < 0.02, axis=2)) > 500


def test_a_road_without_limits_takes_the_default(run: Run) -> None:
    Path("road.xodr").write_text(NO_SPEED.format("77"))
    status, out, err = run("road.xodr")
    assert (status, out) == (1, "")
    assert err.startswith("pldf: road.xodr, line 2, road 77: no speed limit from s = 0 m on")
    assert "--default-limit" in err
    status, out, _ = run("road.xodr", "--default-limit", "70")
    assert status == 0
    assert "0 m: 70 km/h" in out
    assert "curves       0 bind" in out


def test_the_start_road_can_be_chosen(run: Run) -> None:
    Path("road.xodr").write_text(NO_SPEED.format("77"))
    arguments = ("road.xodr", "--default-limit", "70", "--start-road")
    assert run(*arguments, "77")[0] == 0
    status, _, err = run(*arguments, "78")
    told = "no road '78'; it has 77; pldf route road.xodr --list shows all"
    assert (status, err) == (1, f"pldf: road.xodr: {told}\n")


def test_bad_files_exit_with_1_and_one_or_two_lines(run: Run) -> None:
    Path("bad.csv").write_text("s_m,curvature_per_m,speed_limit_mps\n0,0,20\n5,x,20\n")
    Path("foreign.csv").write_text("s_m,kappa_1pm,maxspeed_kmh\n0,0,50\n")
    Path("folder").mkdir()
    for name, told in {
        "bad.csv": "bad.csv, line 3, curvature_per_m: 'x' is not a number",
        "foreign.csv": "missing column curvature_per_m, speed_limit_mps",
        "none.csv": "none.csv: cannot be read (No such file or directory)",
        "folder": "folder: cannot be read",
    }.items():
        status, out, err = run(name)
        assert (status, out) == (1, "")
        assert told in err
        assert err.startswith("pldf: ")
        assert len(err.splitlines()) <= 2


@pytest.mark.parametrize(
    ("option", "name"),
    [("--plot", "road.png"), ("--export", "road.csv"), ("--export", "road.prepared")],
)
def test_a_folder_that_does_not_exist_is_bad_input(run: Run, option: str, name: str) -> None:
    status, _, err = run("study", option, f"nowhere/{name}")
    assert status == 1
    assert "nowhere" in err
    assert len(err.splitlines()) == 1


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ((), "required: ROAD"),
        (("study", "--plot", "road.doc"), "must end in .png"),
        (("study", "--default-limit", "0"), "above 0"),
        (("study", "--default-limit", "fast"), "above 0"),
        (("study", "--plott"), "unrecognized"),
        (("study", "--list", "--to", "1"), "--list shows all roads of the file; --to is for one"),
        (("study", "--list", "--export", "x.csv"), "--export is for one way"),
    ],
)
def test_wrong_usage_exits_with_2(run: Run, arguments: tuple[str, ...], told: str) -> None:
    status, out, err = run(*arguments)
    assert (status, out) == (2, "")
    assert told in err


def test_the_help_has_an_example(run: Run) -> None:
    status, out, _ = run("--help")
    assert status == 0
    assert "example:\n  pldf route study --plot study.png" in out


def test_long_routes_are_summed_up(run: Run) -> None:
    rows = (f"{100 * i},0,{20 + i % 2}" for i in range(101))
    Path("long.csv").write_text("\n".join(["s_m,curvature_per_m,speed_limit_mps", *rows]))
    status, out, _ = run("long.csv")
    assert status == 0
    assert "and 76 more" in out
    assert len(out.splitlines()) < 15


def test_what_is_told_of_a_road_is_one_list_at_the_end(run: Run) -> None:
    Path("road.csv").write_text("s_m;curvature_per_m;speed_limit_mps\n0;0,0;20\n900;0;20,5\n")
    status, out, err = run("road.csv", "--export", "again.csv")
    assert (status, err) == (0, "")
    lines = out.splitlines()
    assert lines[-4] == "written      again.csv"
    assert lines[-3].startswith("note         road.csv: ")
    assert lines[-2].startswith("note         road.csv: ")
    assert lines[-1] == "2 notes"


def test_minutes_are_rounded_as_a_whole() -> None:
    assert minutes(179.7) == "3:00"
    assert minutes(65.2) == "1:05"
    assert minutes(359_999.97, 1) == "6000:00.0"
    assert minutes(59.94, 1) == "0:59.9"


def test_the_way_is_shown_with_names_and_directions(run: Run) -> None:
    town = crossing()
    town.roads[1] = town.roads[1].replace('<road id="s"', '<road id="s" name="South Street"')
    Path("town.xodr").write_text(town.text)
    status, out, _ = run("town.xodr", "--start-road", "w", "--to", "s")
    assert status == 0
    assert "way          w; ws; s South Street (against)\n" in out
    exported = run("town.xodr", "--start-road", "w", "--to", "s", "--export", "my.csv")
    assert exported[0] == 0
    assert read_route("my.csv").length_m == pytest.approx(200.0 + 10.0 * 2.0**0.5, abs=0.01)


def test_the_roads_of_a_file_are_listed(run: Run) -> None:
    town = crossing()
    town.roads[0] = town.roads[0].replace('max="50"', 'max="70"')
    town.roads[3] = town.roads[3].replace("<speed", "<nothing")
    Path("town.xodr").write_text(town.text)
    status, out, err = run("town.xodr", "--list")
    assert (status, err) == (0, "")
    plain, inner = (part.splitlines() for part in out.split("\n\n")[:2])
    assert [line.split() for line in plain[1:]] == [
        ["w", "100.0", "m", "70", "km/h", "1", "+", "1", "s,", "e,", "n", "-"],
        ["s", "100.0", "m", "50", "km/h", "1", "+", "1", "w,", "e,", "n", "-"],
        ["e", "100.0", "m", "50", "km/h", "1", "+", "1", "-", "w,", "s,", "n"],
        ["n", "100.0", "m", "-", "1", "+", "1", "-", "w,", "s,", "e"],
    ]
    assert inner[1].split() == ["J", "ws", "14.1", "m", "50", "km/h", "1", "+", "0", "s", "-"]
    assert "4 roads, 12 connecting roads in junctions" in out
    assert "limits -: the road states none" in out


@pytest.mark.parametrize(("source", "row"), [("study", "1     Study road"), ("my.csv", "-")])
def test_a_file_may_be_one_road(run: Run, source: str, row: str) -> None:
    Path("my.csv").write_text("s_m,curvature_per_m,speed_limit_mps\n0,0,20\n900,0,20\n")
    status, out, _ = run(source, "--list")
    assert status == 0
    assert out.splitlines()[1].startswith(row)
    assert "\n1 road, 0 connecting roads in junctions\n" in out
