"""``pldf script``: what it says, what it prepares, and how it fails."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from pldf import cli
from pldf.cosim.prepared import prepared_script

from vehicle_models.driver_script import SCRIPTS, packed_script, read_script, script_arrays
from vehicle_models.lead_script import packed_traffic, read_traffic, traffic_arrays

Run = Callable[..., tuple[int, str, str]]

HEADER = "at,unit,control,value,duration_s\n"
SCRIPT = f"""# brake first
{HEADER}
300,m,brake,0.12,2.5
5,s,up_long,,0.3
100.5,m,gas,0.3,4
"""


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Run:
    """Return a function that runs ``pldf script`` in a folder with ``my.csv``."""
    monkeypatch.chdir(tmp_path)
    Path("my.csv").write_text(SCRIPT)

    def runner(*arguments: str) -> tuple[int, str, str]:
        try:
            status = cli.main(["script", *arguments])
        except SystemExit as stop:
            status = int(stop.code or 0)
        captured = capsys.readouterr()
        return status, captured.out, captured.err

    return runner


def test_events_are_listed_times_first_in_the_order_of_driving(run: Run) -> None:
    status, out, err = run("my.csv")
    assert (status, err) == (0, "")
    assert out.startswith(
        "script       my.csv\nevents       3: 1 at a time, 2 at a position\nnote "
    )
    lines = [line.split() for line in out.splitlines()]
    assert lines[4:] == [
        ["5", "s", "up_long", "0.3", "s"],
        ["100.5", "m", "gas", "0.3", "4", "s"],
        ["300", "m", "brake", "0.12", "2.5", "s"],
    ]


def test_a_traffic_script_is_known_by_its_header_and_prepared(run: Run, tmp_path: Path) -> None:
    scene = packed_traffic(1)
    status, out, err = run(str(scene), "--export", "scene.prepared")
    assert (status, err) == (0, "")
    assert "events       10: 8 at a time, 2 at a position" in out
    assert "       500 m appear     60 m    14 m/s\n" in out
    assert (tmp_path / "scene.prepared").read_bytes() == prepared_script(
        traffic_arrays(read_traffic(scene))
    )


def test_a_shipped_script_is_named_by_its_number(run: Run) -> None:
    for number, name in enumerate(("pedals_and_lever.csv", "brake_for_village.csv")):
        status, out, _ = run(str(number))
        assert status == 0
        assert out.startswith(f"script       {SCRIPTS / name}\n")
        assert "note" not in out
    status, _, err = run("2")
    assert status == 1
    assert "script_id 2 is unknown; packed scripts are 0 (pedals_and_lever.csv)" in err


def test_the_prepared_file_holds_the_arrays_of_the_kernel(run: Run) -> None:
    for file, path in (("my.csv", Path("my.csv")), ("0", packed_script(0))):
        status, out, _ = run(file, "--export", "out.prepared")
        assert status == 0
        assert out.endswith("written      out.prepared\n")
        expected = prepared_script(script_arrays(read_script(path)))
        assert Path("out.prepared").read_bytes() == expected
    assert sorted(path.name for path in Path().iterdir()) == ["my.csv", "out.prepared"]


def test_long_scripts_are_summed_up(run: Run) -> None:
    Path("long.csv").write_text(HEADER + "".join(f"{10 * k},m,gas,0.2,1\n" for k in range(100)))
    status, out, _ = run("long.csv")
    assert status == 0
    assert out.endswith(" and 60 more\n")
    assert len(out.splitlines()) < 50


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (HEADER, "bad.csv: no events"),
        (
            "at,unit\n1,s\n",
            "bad.csv, line 1: missing column control, value, duration_s; a",
        ),
        (HEADER + "\n# why\n1,s,horn,,1\n", "bad.csv, line 4, control: 'horn' is not one of gas"),
        (HEADER + "1,s,gas,30,1\n", "bad.csv, line 2, value: '30' is not a number from 0 to 1"),
        (None, "bad.csv: cannot be read (No such file or directory)"),
    ],
)
def test_bad_scripts_exit_with_1_one_line_and_no_file(
    run: Run, content: str | None, told: str
) -> None:
    if content is not None:
        Path("bad.csv").write_text(content)
    status, out, err = run("bad.csv", "--export", "bad.prepared")
    assert (status, out) == (1, "")
    assert err.startswith("pldf: ")
    assert told in err
    assert err.count("\n") == 1
    assert not Path("bad.prepared").exists()


def test_a_folder_that_does_not_exist_is_bad_input(run: Run) -> None:
    status, _, err = run("my.csv", "--export", "nowhere/my.prepared")
    assert status == 1
    assert "my.prepared: cannot be written" in err


@pytest.mark.parametrize("arguments", [(), ("my.csv", "--export", "my.csv"), ("my.csv", "more")])
def test_wrong_usage_exits_with_2_and_harms_nothing(run: Run, arguments: tuple[str, ...]) -> None:
    status, out, err = run(*arguments)
    assert (status, out) == (2, "")
    assert "error: " in err
    assert Path("my.csv").read_text() == SCRIPT


def test_the_help_has_an_example(run: Run) -> None:
    status, out, _ = run("--help")
    assert status == 0
    assert "example:\n  pldf script my_drive.csv --export my_drive.prepared" in out
