"""The folder of a study after a kill, a full disk, damage, or an older release."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from laboratory import files
from pldf import cli
from pldf.errors import ModelError
from pldf.files.disk import replace_file
from pldf.study import results
from pldf.study.runner import in_processes, run_missing
from pldf.study.study_file import Study, read_study
from pldf.study.unit import Job
from small_study import COUNT, opened, write_study

OLD_STUDY = {"phases": ["A1"], "route_fingerprint": "0", "fmus": {}}


@pytest.fixture
def again(finished: Path, tmp_path: Path) -> Callable[..., int]:
    def run(*more: str) -> int:
        out = ["--out", str(tmp_path / "out"), "--jobs", "1"]
        return cli.main(["study", str(finished / "small.toml"), *out, *more])

    return run


def write(folder: Path, content: dict[str, bytes]) -> None:
    for name, data in content.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)


class Killed(BaseException):
    """The process is no more."""


def failing_at(number: int, failure: BaseException) -> Callable[[Path, bytes], None]:
    """``replace_file`` that ends with ``failure`` instead of writing its ``number``-th file."""
    calls = iter(range(1, number + 1))

    def replace(path: Path, data: bytes) -> None:
        if next(calls) == number:
            raise failure
        replace_file(path, data)

    return replace


@pytest.mark.parametrize("more", [(), ("--restart",)])
@pytest.mark.parametrize("failure", [OSError(28, "No space left on device"), Killed()])
@pytest.mark.parametrize("number", [1, 2, 3, 4, 7])
def test_a_folder_whose_study_stopped_at_any_file_goes_on(  # noqa: PLR0913, PLR0917
    number: int,
    failure: BaseException,
    more: tuple[str, ...],
    again: Callable[..., int],
    expected: dict[str, bytes],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(results, "replace_file", failing_at(number, failure))
        if isinstance(failure, Killed):
            with pytest.raises(Killed):
                again()
        else:
            assert again() == 1
            told = capsys.readouterr().err
            assert "cannot be written (No space left on device); what is done is kept" in told
    assert again(*more) == 0
    assert files(tmp_path / "out") == expected


@pytest.mark.parametrize("more", [(), ("--restart",)])
@pytest.mark.parametrize("written", [(), ("participants.csv",)])
def test_a_folder_that_release_0_2_0_could_not_begin(
    written: tuple[str, ...],
    more: tuple[str, ...],
    again: Callable[..., int],
    expected: dict[str, bytes],
    tmp_path: Path,
) -> None:
    (tmp_path / "out" / "parts").mkdir(parents=True)
    write(tmp_path / "out", {name: expected[name] for name in written})
    assert again(*more) == 0
    assert files(tmp_path / "out") == expected


def test_a_folder_of_release_0_1_0_is_told_and_restarted(
    again: Callable[..., int],
    expected: dict[str, bytes],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    theirs = {"recordings/mine.csv": b"1", "paper/drives.csv": b"2", "notes.txt": b"3"}
    old = {
        "study.json": json.dumps(OLD_STUDY).encode(),
        "rates.csv": b"",
        "recordings/A1.csv": b"",
        "profiles/driver-000001_route-0a1b.pldf": b"",
        "profile_after/B1.csv": b"",
    }
    write(tmp_path / "out", {**old, **theirs})
    assert again() == 1
    assert "holds a study of release 0.1.0" in capsys.readouterr().err
    assert files(tmp_path / "out") == {**old, **theirs}
    assert again("--restart") == 0
    assert files(tmp_path / "out") == {**expected, **theirs}


def test_a_restart_takes_away_what_the_study_wrote_alone(
    again: Callable[..., int], expected: dict[str, bytes], tmp_path: Path
) -> None:
    theirs = {
        "recordings/P002_drive to work.csv": b"1",
        "profiles/notes.txt": b"2",
        "parts/readme": b"3",
        "drives.png": b"4",
    }
    assert again() == 0
    write(tmp_path / "out", theirs)
    assert again("--restart") == 0
    assert files(tmp_path / "out") == {**expected, **theirs}


@pytest.mark.parametrize(
    "theirs",
    [
        {"parts/screws.csv": b"M6"},
        {"parts/P001.json": b"[]", "participants.csv": b"name\nAnn\n"},
        {"versions.json": b'{"mine": 1}'},
        {"study.json": b'{"phases": []}', "profiles/driver-000001_route-0a.pldf": b""},
        {"recordings/P001_A1.csv": b""},
    ],
)
def test_what_somebody_else_put_there_stays(
    theirs: dict[str, bytes],
    again: Callable[..., int],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    write(tmp_path / "out", theirs)
    for more in ((), ("--restart",)):
        assert again(*more) == 1
        assert "not from a study of participants" in capsys.readouterr().err
    assert files(tmp_path / "out") == theirs


DAMAGES: dict[str, Callable[[bytes], bytes]] = {
    "empty": lambda _: b"",
    "truncated": lambda data: data[:-20],
    "not UTF-8": lambda data: b"\xff\xfe" + data,
    "another's": lambda data: data.replace(b"P003", b"P004"),
    "a drive less": lambda data: json.dumps(json.loads(data)[:1]).encode(),
    "a share above 1": lambda data: data.replace(b"0.", b"7."),
    "no rows": lambda _: b'{"rows": 3}',
    "texts": lambda _: b'["P003", "A2"]',
    "deep": lambda _: b"[" * 100_000,
}  # fmt: skip


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_part_is_told_kept_aside_and_driven_anew(
    damage: str,
    study: Study,
    finished: Path,
    expected: dict[str, bytes],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    folder, out = opened(study, tmp_path / "out"), tmp_path / "out"
    for result in in_processes(1)(Job(study.settings), list(study.participants)):
        folder.keep(result)
    part = out / "parts" / "P003.json"
    damaged = DAMAGES[damage](part.read_bytes())
    part.write_bytes(damaged)
    assert cli.main(["study", str(finished / "small.toml"), "--out", str(out)]) == 0
    told = capsys.readouterr().err
    aside = out / "damaged" / "P003-1.json"
    assert told.startswith(f"pldf: {part}: damaged (")
    assert told.endswith(f"; it is kept as {aside}, P003 is driven anew\n")
    assert files(out) == {**expected, "damaged/P003-1.json": damaged}


def test_a_part_that_is_damaged_meanwhile_makes_no_tables(study: Study, tmp_path: Path) -> None:
    folder = opened(study, tmp_path / "out")

    def damage(done: Any) -> None:
        (tmp_path / "out" / "parts" / f"{done.participant}.json").write_bytes(b"[]")

    with pytest.raises(ModelError, match=r"damaged .*; the same command drives P001 anew"):
        run_missing(folder, Job(study.settings), in_processes(1), damage)
    assert not folder.complete
    assert len(folder.open(restart=False)) == COUNT
    assert len(folder.missing()) == COUNT


def test_tables_that_cannot_be_written_are_written_by_the_next(
    expected: dict[str, bytes],
    again: Callable[..., int],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def fail(path: Path, data: Any) -> None:
        raise ModelError(f"{path}: cannot be written (No space left on device)")

    with monkeypatch.context() as patch:
        patch.setattr(results, "write_table", fail)
        assert again() == 1
    assert "drives.csv: cannot be written" in capsys.readouterr().err
    assert again() == 0
    assert files(tmp_path / "out") == expected


def test_another_study_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    opened(read_study(write_study(tmp_path, count=2)), tmp_path / "out")
    before = files(tmp_path / "out")
    with pytest.raises(ModelError, match="another study"):
        opened(read_study(write_study(tmp_path, count=3)), tmp_path / "out")
    assert files(tmp_path / "out") == before
