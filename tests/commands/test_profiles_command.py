"""``pldf profiles``: what it prints and writes, and how it fails."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from pldf import cli
from pldf.kernel.codes import BOUND_ACCEL, BOUND_JERK, BOUND_LEGAL_LIMIT
from pldf.profiles.profile_file import encode
from pldf.profiles.profile_format_1 import encode_1
from pldf.profiles.store import ProfileStore, StoredProfile, read_profile, write_profile
from pldf.profiles.stored_profile import COLUMN_NAMES
from pldf.roads import fingerprint, write_route_csv
from profile_examples import DRIVER, ROUTE, drive_result, new_profile
from two_readings import lesson, newer_reading, older_reading, other_road

Run = Callable[..., tuple[int, str, str]]
NAME = f"driver-000017_route-{ROUTE}.pldf"


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Run:
    """Return a function that runs ``pldf profiles`` in a folder with the store ``store``."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("PLDF_PROFILE_STORE", raising=False)
    store = ProfileStore("store")
    profile = example()
    for iteration in profile.iterations:
        loaded = replace(profile, iterations=profile.iterations[: iteration.number - 1])
        store.append(loaded, iteration)

    def runner(*arguments: str) -> tuple[int, str, str]:
        try:
            status = cli.main(["profiles", *arguments])
        except SystemExit as stop:
            status = int(stop.code or 0)
        captured = capsys.readouterr()
        return status, captured.out, captured.err

    return runner


def example() -> StoredProfile:
    """Return 1001 nodes: 36 km/h more from 100 m to 199 m, then -7.2 km/h from 500 m to 509 m."""
    profile = replace(new_profile(), base_mps=np.full(1001, 20.0))
    first = drive_result(profile, "B1")
    learned = profile.base_mps.copy()
    learned[100:200] += 10.0
    zeros = np.zeros(1001)
    first = replace(first, learned_mps=learned, offset_mps=zeros, interventions=3)
    first = replace(first, lessons=zeros, bound=zeros, drive=(learned > 20.0) + zeros)
    unknown = {name: zeros for name in COLUMN_NAMES if "evidence" in name or "pending" in name}
    first = replace(first, **unknown)
    learned = learned.copy()
    learned[500:510] -= 2.0
    offset = np.zeros(1001)
    offset[700:] = 5.0 / 3.6
    lessons, bound = np.zeros(1001), np.zeros(1001)
    lessons[100:200], lessons[500:510], lessons[150] = 1.0, 1.0, 2.0
    bound[120:171], bound[501:505], bound[505:510] = BOUND_LEGAL_LIMIT, BOUND_ACCEL, BOUND_JERK
    second = replace(first, number=2, note="B2", learned_mps=learned, offset_mps=offset)
    drive = first.drive + 2.0 * (learned < 20.0)
    second = replace(second, lessons=lessons, bound=bound, drive=drive)
    return replace(profile, iterations=(first, replace(second, interventions=1)))


def columns(line: str) -> list[str]:
    return line.split()


PLACES = columns("from m to m mean km/h peak km/h lessons cut by drives evidence")


def test_list(run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    other = new_profile(driver_id=2, route="f" * 16)
    ProfileStore("store").append(other, drive_result(other))
    status, out, err = run("list", "--store", "store")
    assert (status, err) == (0, "")
    assert [columns(line) for line in out.splitlines()] == [
        ["driver", "route", "length", "m", "iterations", "file"],
        [
            "2",
            "f" * 16,
            "10",
            "1",
            str(tmp_path / "store" / f"driver-000002_route-{'f' * 16}.pldf"),
        ],
        ["17", ROUTE, "1000", "2", str(tmp_path / "store" / NAME)],
    ]
    monkeypatch.setenv("PLDF_PROFILE_STORE", "store")
    assert run("list") == (0, out, "")


def test_list_tells_what_cannot_be_used_and_touches_nothing(run: Run, tmp_path: Path) -> None:
    (tmp_path / "store" / "a.pldf").write_bytes(b"bad")
    (tmp_path / "store" / "b.pldf.refused-1").write_bytes(b"worse")
    status, out, err = run("list", "--store", "store")
    assert status == 0
    assert len(out.splitlines()) == 2
    bad, worse = err.splitlines()
    assert "a.pldf, line 1: not a profile file" in bad
    assert "b.pldf.refused-1: put aside because it could not be used" in worse
    assert (tmp_path / "store" / "a.pldf").read_bytes() == b"bad"


def test_show_newest_and_older_state(run: Run) -> None:
    status, out, err = run("show", f"store/{NAME}")
    assert (status, err) == (0, "")
    assert [columns(line) for line in out.splitlines()] == [
        ["driver", "17"],
        ["route", f"{ROUTE},", "1000", "m"],
        ["iteration", "2", "of", "2:", "drive,", "B2"],
        ["learned", "minus", "base", "speed:"],
        PLACES,
        ["100", "199", "+36.0", "+36.0", "2", "legal_limit", "1", "0.00"],
        ["500", "509", "-7.2", "-7.2", "1", "accel,", "jerk", "2", "0.00"],
        ["learned", "offset", "of", "the", "set", "speed:"],
        PLACES,
        ["700", "1000", "+5.0", "+5.0", "0", "-", "-", "0.00"],
        ["bounds:"],
        [
            "held",
            "at",
            "108",
            "km/h",
            "from",
            "120",
            "to",
            "170",
            "m",
            "by",
            "legal",
            "limit",
            "+",
            "tolerance",
        ],
    ]
    _, out, _ = run("show", f"store/{NAME}", "--iteration", "0")
    assert out.splitlines()[2:] == [
        "iteration  0 of 2: base",
        "learned minus base speed: none",
        "learned offset of the set speed: none",
        "bounds: none holds it",
    ]


def test_show_plot(run: Run) -> None:
    status, out, _ = run("show", f"store/{NAME}", "--plot", "p.png")
    assert status == 0
    assert "plot       p.png (the file does not hold the legal limit; name the road with" in out
    image = matplotlib.image.imread("p.png")[:, :, :3]
    assert (image.reshape(-1, 3).std(axis=1) > 0.1).mean() > 0.001  # coloured curves
    status, _, err = run("show", f"store/{NAME}", "--plot", "p.unknown")
    assert status == 1
    assert err.startswith("pldf: p.unknown: cannot be written")


def test_history(run: Run) -> None:
    status, out, err = run("history", f"store/{NAME}")
    assert (status, err) == (0, "")
    first, second = (columns(line) for line in out.splitlines()[4:])
    change = f"{36 * 100 / 1001:.2f}"
    assert first == ["1", "drive", "3", "100", change, "36.00", "0", "0", "yes", "B1"]
    change = f"{7.2 * 10 / 1001:.2f}"
    assert second == ["2", "drive", "1", "10", change, "7.20", "110", "60", "yes", "B2"]


def test_export_is_exact_csv(run: Run, tmp_path: Path) -> None:
    status, out, err = run("export", f"store/{NAME}")
    assert (status, err) == (0, "")
    lines = out.splitlines()
    assert lines[0] == "s_m,base_mps,learned_mps,offset_mps"
    assert lines[1] == "0.0,20.0,20.0,0.0"
    assert lines[701] == "700.0,20.0,20.0,1.3888888888888888"
    table = np.array([[float(text) for text in line.split(",")] for line in lines[1:]])
    newest = example().iterations[-1]
    expected = (np.arange(1001.0), example().base_mps, newest.learned_mps, newest.offset_mps)
    assert np.array_equal(table, np.column_stack(expected))

    assert run("export", f"store/{NAME}", "--out", "out.csv") == (0, "", "")
    assert (tmp_path / "out.csv").read_bytes() == out.encode()

    _, older, _ = run("export", f"store/{NAME}", "--iteration", "1")
    assert older.splitlines()[502] == "501.0,20.0,20.0,0.0"
    assert lines[502] == "501.0,20.0,18.0,0.0"


def test_export_for_a_release_that_knows_format_1(run: Run, tmp_path: Path) -> None:
    status, out, err = run("export", f"store/{NAME}", "--format", "1", "--out", "old.pldf")
    assert (status, err) == (0, "")
    assert out == (
        f"old.pldf: store/{NAME} in format 1; kinds, lessons, bounds and evidence are left out: "
        "it does not know them\n"
    )
    assert (tmp_path / "old.pldf").read_bytes() == encode_1(example())
    status, out, err = run("export", f"store/{NAME}", "--format", "1", "--out", "old.pldf")
    assert (status, out) == (1, "")
    assert err == "pldf: old.pldf: it is there already; choose another file\n"
    assert run("history", "old.pldf")[0] == 0


def test_export_into_a_pipe_that_closes_early_is_no_error(tmp_path: Path) -> None:
    profile = replace(new_profile(), base_mps=np.full(20_000, 20.0))
    write_profile(tmp_path / "p.pldf", profile)
    code = "import sys; from pldf import cli; sys.exit(cli.main())"
    with subprocess.Popen(
        [sys.executable, "-c", code, "profiles", "export", str(tmp_path / "p.pldf")],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.readline()
        process.stdout.close()
        assert process.stderr.read() == b""
    assert process.returncode == 0


def test_rollback_adds_an_iteration(run: Run) -> None:
    status, out, err = run("rollback", "17", "--store", "store", "--to", "1")
    assert (status, err) == (0, "")
    assert out.endswith(f"{NAME}: iteration 3 is now a copy of iteration 1\n")
    profile = read_profile(f"store/{NAME}")
    assert encode(replace(profile, iterations=profile.iterations[:2])) == encode(example())
    assert profile.iteration().note == "rollback of 1"
    assert run("rollback", f"store/{NAME}", "--to", "0")[0] == 0
    assert np.array_equal(read_profile(f"store/{NAME}").iteration().learned_mps, profile.base_mps)


def test_forget_and_undo_add_iterations(run: Run) -> None:
    status, out, err = run("forget", "17", "--store", "store", "--from", "90", "--to", "300")
    assert (status, err) == (0, "")
    assert out.endswith(f"{NAME}: iteration 3 is at base between 90 and 300 m\n")
    profile = read_profile(f"store/{NAME}")
    assert encode(replace(profile, iterations=profile.iterations[:2])) == encode(example())
    assert (profile.iteration().kind, profile.iteration().note) == ("forget", "forget 90 to 300 m")
    assert np.array_equal(profile.iteration().learned_mps[:400], profile.base_mps[:400])
    _, out, _ = run("forget", "17", "--store", "store", "--from", "90", "--to", "300")
    assert out.endswith("nothing is learned between 90 and 300 m: nothing to forget\n")
    assert run("undo", f"store/{NAME}")[1].endswith(
        "iteration 4 is without what iteration 2 taught\n"
    )
    newest = read_profile(f"store/{NAME}").iteration()
    assert np.array_equal(newest.learned_mps, profile.base_mps)  # and 1 was forgotten
    assert not newest.offset_mps.any()
    _, out, _ = run("history", "17", "--store", "store")
    told = [columns(line) for line in out.splitlines()[4:]]
    assert [row[1] for row in told] == ["drive", "drive", "forget", "undo"]
    assert [row[8] for row in told] == ["yes", "no", "-", "-"]


def test_delete_deletes_all_of_a_driver_and_says_what(run: Run, tmp_path: Path) -> None:
    store = tmp_path / "store"
    other = new_profile(driver_id=2)
    ProfileStore(store).append(other, drive_result(other))
    stem = NAME.removesuffix(".pldf")
    beside = [f"{stem}.conflict-1.pldf", f"{NAME}.refused-1", f"{NAME}.replaced-2", "copy.pldf"]
    for name in (*beside, f"{NAME}.tmp"):
        (store / name).write_bytes(encode(example()))
    status, out, err = run("delete", "17", "--store", "store")
    assert (status, err) == (0, "")
    gone = sorted([NAME, f"{NAME}.tmp", *beside])
    assert sorted(line.rpartition("/")[2] for line in out.splitlines()) == gone
    assert [path.name for path in store.iterdir()] == [f"driver-000002_route-{ROUTE}.pldf"]
    _, out, _ = run("delete", "17", "--store", "store")
    assert out.endswith("nothing is kept of driver 17\n")


def test_delete_of_a_file_leaves_the_driver_s_other_roads(run: Run, tmp_path: Path) -> None:
    other = new_profile(driver_id=DRIVER, route="f" * 16)
    ProfileStore("store").append(other, drive_result(other))
    assert run("delete", f"store/{NAME}")[0] == 0
    assert [p.name for p in (tmp_path / "store").iterdir()] == [
        f"driver-000017_route-{'f' * 16}.pldf"
    ]


def test_show_says_what_waits_for_evidence(run: Run, tmp_path: Path) -> None:
    profile = example()
    waiting, wish, evidence = np.zeros(1001), np.zeros(1001), np.zeros(1001)
    waiting[800:900], wish[800:900], evidence[800:900] = 1.0, 22.5, 1.25
    columns_ = {"pending_faster": waiting, "pending_faster_mps": wish, "evidence_faster": evidence}
    write_profile(
        "w.pldf", profile.with_iteration(profile.next_iteration("drive", "", 1, columns_))
    )
    _, out, _ = run("show", "w.pldf")
    assert ["800", "899", "+9.0", "1", "1.25", "faster", "by", "pedals"] in map(
        columns, out.splitlines()
    )


def test_show_draws_the_limit_of_the_shipped_road_and_of_the_one_named(
    run: Run, older: StoredProfile, tmp_path: Path
) -> None:
    write_profile("o.pldf", older)
    write_route_csv(older_reading(), tmp_path / "old.csv")
    status, out, _ = run("show", "o.pldf", "--plot", "p.png", "--route", "old.csv")
    assert (status, out.splitlines()[-1]) == (0, "plot       p.png")


@pytest.mark.parametrize("action", ["show", "history", "export"])
def test_driver_number_stands_for_the_file(run: Run, action: str) -> None:
    assert run(action, "17", "--store", "store") == run(action, f"store/{NAME}")


def test_driver_with_two_routes_must_be_named_by_file(run: Run) -> None:
    other = new_profile(driver_id=DRIVER, route="f" * 16)
    ProfileStore("store").append(other, drive_result(other))
    status, out, err = run("show", "17", "--store", "store")
    assert (status, out) == (1, "")
    assert err.startswith("pldf: driver 17 has 2 profiles, name one: ")
    assert NAME in err


ERRORS = [
    (1, "nothing.pldf: no such profile file", ("show", "nothing.pldf")),
    (1, "bad.pldf, line 1: not a profile file", ("history", "bad.pldf")),
    (1, "bad.pldf, line 1: not a profile file", ("rollback", "bad.pldf", "--to", "0")),
    (
        1,
        "there is no iteration 9; this profile has 0 (base) to 2",
        ("show", "17", "--iteration", "9"),
    ),
    (1, "there is no iteration 9;", ("rollback", "17", "--to", "9")),
    (1, "there is no iteration -1;", ("rollback", "17", "--to", "-1")),
    (1, "no profile of driver 18", ("export", "18")),
    (1, "none/x.csv: cannot be written", ("export", "17", "--out", "none/x.csv")),
    (1, "elsewhere: no such folder", ("list", "--store", "elsewhere")),
    (2, "required: --to", ("rollback", "17")),
    (2, "invalid int value", ("export", "17", "--iteration", "two")),
    (2, "--format 1 needs --out FILE", ("export", "17", "--format", "1")),
    (2, "invalid choice: 2", ("export", "17", "--format", "2", "--out", "x.pldf")),
    (2, "--iteration", ("export", "17", "--format", "1", "--out", "x", "--iteration", "1")),
    (2, "required: FILE", ("show",)),
    (2, "required: ACTION", ()),
    (2, "invalid choice", ("erase",)),
    (2, "required: --from, --to", ("forget", "17")),
    (
        1,
        "from 900 to 800 m: no piece of this road",
        ("forget", "17", "--from", "900", "--to", "800"),
    ),
    (
        1,
        "no piece of this road, which goes from 0 to 1000 m",
        ("forget", "17", "--from", "900", "--to", "1001"),
    ),
    (1, "nothing.pldf: no such profile file", ("delete", "nothing.pldf")),
    (1, "the profile belongs to route", ("show", "17", "--route", "study")),
]


@pytest.mark.parametrize(("expected", "text", "arguments"), ERRORS)
def test_errors(
    run: Run,
    monkeypatch: pytest.MonkeyPatch,
    expected: int,
    text: str,
    arguments: tuple[str, ...],
) -> None:
    monkeypatch.setenv("PLDF_PROFILE_STORE", "store")
    Path("bad.pldf").write_bytes(b"bad")
    status, out, err = run(*arguments)
    assert (status, out) == (expected, "")
    assert text in err
    if expected == 1:
        assert err.startswith("pldf: ")
        assert len(err.splitlines()) == 1
    assert Path("bad.pldf").read_bytes() == b"bad"
    assert not Path("elsewhere").exists()


@pytest.mark.parametrize("arguments", [("list",), ("show", "17")])
def test_no_store_at_all_is_wrong_usage(run: Run, arguments: tuple[str, ...]) -> None:
    status, out, err = run(*arguments)
    assert (status, out) == (2, "")
    assert "give --store FOLDER, or set PLDF_PROFILE_STORE" in err


@pytest.mark.parametrize(
    "action", ["list", "show", "history", "export", "rollback", "forget", "undo", "delete"]
)
def test_help_shows_an_example(run: Run, action: str) -> None:
    status, out, _ = run(action, "--help")
    assert status == 0
    assert f"example:\n  pldf profiles {action} " in out
    assert f"pldf profiles {action} " in run("--help")[1]


@pytest.fixture(scope="module")
def older() -> StoredProfile:
    """Return what driver 0 learned on an older reading of a road."""
    return lesson(older_reading())[1]


def moving(folder: Path, older: StoredProfile) -> tuple[Path, Path]:
    """Keep ``older`` in a store and write the road as it is read now; return file and road."""
    path = ProfileStore(folder / "moves").path(0, older.route)
    write_profile(path, older)
    road = folder / "road.csv"
    write_route_csv(newer_reading(), road)
    return path, road


@pytest.mark.parametrize("by_number", [True, False])
def test_move(run: Run, older: StoredProfile, tmp_path: Path, by_number: bool) -> None:
    path, road = moving(tmp_path, older)
    before = path.read_bytes()
    name = ("0", "--store", "moves") if by_number else (str(path),)
    status, out, err = run("move", *name, "--route", str(road))
    assert (status, err) == (0, "")
    new = ProfileStore(path.parent).path(0, fingerprint(newer_reading()))
    assert out.splitlines()[-1] == f"written    {new}; {path} is left as it is"
    assert "driver     0, 1 iterations carried over" in out
    # The new bend, from where the car brakes for it to where it is as fast again.
    assert "changed    1368 to 1939 m: base profile 98.2 to 69.1 km/h on average" in out
    assert path.read_bytes() == before
    moved = read_profile(new)
    assert np.array_equal(
        moved.iteration().learned_mps[:1300], older.iteration().learned_mps[:1300]
    )
    assert run("move", *name, "--route", str(road))[0] == 0  # the same again changes nothing
    assert encode(read_profile(new)) == encode(moved)


def test_move_takes_nothing_away(run: Run, older: StoredProfile, tmp_path: Path) -> None:
    """What was learned on the new reading meanwhile stays, unless it is replaced by force."""
    path, road = moving(tmp_path, older)
    new = ProfileStore(path.parent).path(0, fingerprint(newer_reading()))
    write_profile(new, lesson(newer_reading(), gas=((2400.0, 2500.0),))[1])
    there = new.read_bytes()
    status, _, err = run("move", str(path), "--route", str(road))
    assert status == 1
    assert "does not continue; not overwritten" in err and "--force" in err
    assert new.read_bytes() == there
    status, _, err = run("move", str(path), "--route", str(road), "--force")
    assert status == 0
    kept = new.with_name(new.name + ".replaced-1")
    assert f"kept as {kept}" in err
    assert kept.read_bytes() == there


def test_move_refuses_what_is_no_older_reading(
    run: Run, older: StoredProfile, tmp_path: Path
) -> None:
    path, road = moving(tmp_path, older)
    write_route_csv(other_road(), road)
    status, _, err = run("move", str(path), "--route", str(road))
    assert status == 1
    assert err.startswith(f"pldf: {path}: the profile of driver 0 (3000 m) and road (3000 m) do")
    status, _, err = run("move", "0", "--store", "moves", "--route", str(road))
    assert status == 1
    assert f"name the file (there is: {path.name})" in err
    status, _, err = run("move", "5", "--store", "moves", "--route", str(road))
    assert "there is: none" in err
    assert sorted(p.name for p in path.parent.iterdir()) == [path.name]
    assert run("move", str(path))[0] == 2
    status, out, _ = run("move", str(path), "--route", str(road), "--force", "--out", "forced.pldf")
    assert status == 0 and "cut " in out
    assert read_profile("forced.pldf").route == fingerprint(other_road())
