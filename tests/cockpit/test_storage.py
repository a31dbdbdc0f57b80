"""The folder of a study at a desk: only its own files, whole, and nothing lost."""

from __future__ import annotations

from http import HTTPStatus
from pathlib import Path

import pytest
from pldf.cockpit.storage import FILE_MAX, NOT_THERE, Folder, Refused

OUTSIDE = (
    "",
    "/etc/passwd",
    "../secret.csv",
    "recordings/../../secret.csv",
    "recordings/..",
    "recordings/sub/P07_A1.csv",
    "recordings//P07_A1.csv",
    "recordings\\..\\..\\secret.csv",
    "recordings/P07_A1.exe",
    "recordings/.hidden.csv",
    "recordings/con.csv",
    "recordings/P07:A1.csv",
    "recordings/P07\0.csv",
    "C:/secret.csv",
    "profiles/P07.csv",
    "sessions/a/b/c/d.json",
    "earlier/recordings/P07_A1-1.csv",
    "index.html",
    "Session.json",
    "con.csv",
    "recordings/NUL.csv",
)
OURS = (
    "recordings/P07_A1.csv",
    "inputs/P07_A1.csv",
    "practice/P07_1.csv",
    "profiles/driver-000007_route-0123456789abcdef.pldf",
    "sessions/P07.json",
    "sessions/P07/A2/driver-000007_route-0123456789abcdef.pldf",
)


@pytest.mark.parametrize("path", OUTSIDE)
def test_what_is_no_file_of_a_study_is_refused(path: str, tmp_path: Path) -> None:
    (tmp_path / "secret.csv").write_text("secret")
    folder = Folder(tmp_path / "study")
    for call in (lambda: folder.read(path), lambda: folder.write(path, b"x", NOT_THERE)):
        with pytest.raises(Refused) as refused:
            call()
        assert refused.value.status == HTTPStatus.FORBIDDEN
    assert not (tmp_path / "study").exists()
    assert (tmp_path / "secret.csv").read_text() == "secret"


def test_links_lead_nowhere(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "P07_A1.csv").write_text("secret")
    root = tmp_path / "study"
    root.mkdir()
    (root / "recordings").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(Refused):
        Folder(root).read("recordings/P07_A1.csv")
    with pytest.raises(Refused):
        Folder(root).write("recordings/P07_A1.csv", b"mine")


@pytest.mark.parametrize("path", OURS)
def test_a_file_comes_back_as_it_was_written(path: str, tmp_path: Path) -> None:
    folder = Folder(tmp_path)
    assert folder.read(path) is None
    mark = folder.write(path, b"1,2\n")
    stored = folder.read(path)
    assert stored is not None
    assert (stored.data, stored.mark) == (b"1,2\n", mark)
    assert folder.list() == [path]
    assert [file for file in tmp_path.rglob("*") if file.is_file()] == [tmp_path / path]


def test_the_list_shows_the_studys_own_files_only(tmp_path: Path) -> None:
    folder = Folder(tmp_path)
    for path in OURS:
        folder.write(path, b"x")
    folder.write("session.json", b"{}", NOT_THERE)
    (tmp_path / "notes.txt").write_text("mine")
    assert folder.list() == sorted([*OURS, "session.json"])
    assert folder.list("recordings/") == ["recordings/P07_A1.csv"]
    assert Folder(tmp_path / "none").list() == []


def test_a_recording_that_is_replaced_is_kept(tmp_path: Path) -> None:
    folder = Folder(tmp_path)
    for content in (b"first", b"second", b"second", b"second and more"):
        folder.write("recordings/P07_A1.csv", content)
    kept = [file for file in (tmp_path / "earlier").rglob("*") if file.is_file()]
    assert [file.read_bytes() for file in kept] == [b"first"]
    assert kept[0].name == "P07_A1-1.csv"


def profile(iterations: int) -> bytes:
    head = "PLDF-PROFILE 2\ndriver 7\nroute 0123456789abcdef\nnodes 9\nstep_m 1\n"
    return f"{head}iterations {iterations}\nblocks 1\n".encode()


def test_a_profile_that_has_learned_less_does_not_bury_one_that_has_more(tmp_path: Path) -> None:
    folder = Folder(tmp_path)
    name = OURS[3]
    for iterations in (1, 2, 3):
        folder.write(name, profile(iterations))
    assert not (tmp_path / "earlier").exists()
    folder.write(name, profile(1))
    (kept,) = (file for file in (tmp_path / "earlier").rglob("*") if file.is_file())
    assert kept.read_bytes() == profile(3)


def test_shared_tables_are_replaced_by_who_has_read_them(tmp_path: Path) -> None:
    folder = Folder(tmp_path)
    with pytest.raises(Refused, match="is shared") as unread:
        folder.write("questionnaire.csv", b"mine")
    assert unread.value.status == HTTPStatus.PRECONDITION_REQUIRED
    first = folder.write("questionnaire.csv", b"mine", NOT_THERE)
    for stale in (NOT_THERE, '"0"'):
        with pytest.raises(Refused, match="somebody else") as refused:
            folder.write("questionnaire.csv", b"theirs", stale)
        assert refused.value.status == HTTPStatus.PRECONDITION_FAILED
    folder.write("questionnaire.csv", b"both", first)
    assert (tmp_path / "questionnaire.csv").read_bytes() == b"both"


def test_study_file_and_road_lie_beside_the_data(tmp_path: Path) -> None:
    root = tmp_path / "laboratory"
    first = Folder(root, {"cockpit.toml": b"one", "road.csv": b"road"})
    assert not first.of_another_study
    assert not root.exists()
    for _ in range(2):
        first.write("recordings/P07_A1.csv", b"x")
    assert (root / "cockpit.toml").read_bytes() == b"one"
    second = Folder(root, {"cockpit.toml": b"two", "road.csv": b"road"})
    assert second.of_another_study
    second.write("recordings/P07_A2.csv", b"x")
    assert not second.of_another_study
    assert (root / "cockpit.toml").read_bytes() == b"two"
    assert [path.name for path in (root / "earlier").iterdir()] == ["cockpit-1.toml"]


def test_neither_nothing_nor_too_much_is_stored(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert FILE_MAX > 10_000_000  # a drive
    monkeypatch.setattr("pldf.cockpit.storage.FILE_MAX", 4)
    folder = Folder(tmp_path)
    folder.write("recordings/P07_A1.csv", b"1234")
    for data, status in (
        (b"", HTTPStatus.BAD_REQUEST),
        (b"12345", HTTPStatus.REQUEST_ENTITY_TOO_LARGE),
    ):
        with pytest.raises(Refused) as refused:
            folder.write("recordings/P07_A1.csv", data)
        assert refused.value.status == status
    assert (tmp_path / "recordings" / "P07_A1.csv").read_bytes() == b"1234"
