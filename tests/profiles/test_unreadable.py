"""What cannot be read or written now: nothing is touched, nothing that was learned is lost."""

from __future__ import annotations

import builtins
import errno
import os
import stat
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from pldf.errors import ModelError
from pldf.files.disk import LOCK_NAME, folder_lock
from pldf.function import DrivingFunction
from pldf.kernel.codes import PROFILE_STATUS
from pldf.profiles.profile_file import encode
from pldf.profiles.store import (
    ProfileConflict,
    ProfileUnreadable,
    continue_profile,
    write_profile,
)
from profile_examples import DRIVER, ROUTE, drive_result, new_profile
from stored import NAME, NOBODY_ELSE, content, failing, load, saved_store

READ_ERRORS = [errno.EMFILE, errno.EIO, errno.ENOMEM, errno.EACCES]
CONFLICT = NAME.replace(".pldf", ".conflict-1.pldf")

needs_users = pytest.mark.skipif(
    not hasattr(os, "geteuid") or os.geteuid() != 0, reason="needs to become another user"
)


@contextmanager
def unreadable(monkeypatch: pytest.MonkeyPatch, number: int, name: str = NAME) -> Iterator[None]:
    """Let opening a profile for reading fail."""
    really_open = builtins.open

    def fail(path: Any, mode: str = "r", **more: Any) -> Any:
        if str(path).endswith(name) and mode == "rb":
            raise OSError(number, os.strerror(number))
        return really_open(path, mode, **more)

    with monkeypatch.context() as patched:
        patched.setattr(builtins, "open", fail)
        yield


@pytest.mark.parametrize("number", READ_ERRORS, ids=os.strerror)
def test_what_cannot_be_read_at_the_end_is_not_touched_and_the_lesson_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    profiles = saved_store(tmp_path)
    before = content(tmp_path)
    profile = load(profiles)
    result = drive_result(profile)
    with unreadable(monkeypatch, number), pytest.raises(ProfileConflict) as caught:
        profiles.append(profile, result)
    assert f"cannot be read now ({os.strerror(number)}) and left as it is" in str(caught.value)
    assert str(tmp_path / CONFLICT) in str(caught.value)
    assert content(tmp_path) == {**before, CONFLICT: encode(profile.with_iteration(result))}
    assert profiles.files() == [tmp_path / CONFLICT, tmp_path / NAME]


@pytest.mark.parametrize("number", READ_ERRORS, ids=os.strerror)
def test_what_cannot_be_read_at_the_start_is_not_touched_and_compared_at_the_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    profiles = saved_store(tmp_path)
    before = content(tmp_path)
    with unreadable(monkeypatch, number):
        with pytest.raises(ProfileUnreadable, match=r"cannot be read now"):
            load(profiles)
        with pytest.raises(ModelError, match="cannot be read now"):
            profiles.rollback(DRIVER, ROUTE, 0)
    assert content(tmp_path) == before
    with pytest.raises(ProfileConflict, match="changed by another process"):
        profiles.append(new_profile(), drive_result(new_profile()))
    assert content(tmp_path)[NAME] == before[NAME]


def test_a_file_that_ends_while_it_is_read_is_not_bad(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    profiles = saved_store(tmp_path)
    before = content(tmp_path)
    really_status = os.fstat

    def one_byte_more(descriptor: int) -> os.stat_result:
        status = list(really_status(descriptor))
        status[stat.ST_SIZE] += stat.S_ISREG(status[stat.ST_MODE])
        return os.stat_result(status)

    monkeypatch.setattr(os, "fstat", one_byte_more)
    with pytest.raises(ProfileUnreadable, match="ends while it is read"):
        load(profiles)
    assert content(tmp_path) == before


def test_a_bad_file_gets_its_name_back_if_the_write_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    profiles = saved_store(tmp_path)
    profile = load(profiles)
    (tmp_path / NAME).write_bytes(b"bad")
    really_replace = os.replace

    def full(source: Path, target: Path) -> None:
        if str(source).endswith(".tmp"):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        really_replace(source, target)

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(ModelError, match="what was there is unchanged"):
        profiles.append(profile, drive_result(profile))
    assert content(tmp_path) == {NAME: b"bad"}


def test_a_bad_file_that_does_not_get_its_name_back_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    profiles = saved_store(tmp_path)
    profile = load(profiles)
    (tmp_path / NAME).write_bytes(b"bad")
    really_replace = os.replace

    def once(source: Path, target: Path) -> None:
        if not str(target).endswith("refused-1"):
            raise OSError(errno.EIO, os.strerror(errno.EIO))
        really_replace(source, target)

    monkeypatch.setattr(os, "replace", once)
    with pytest.raises(ModelError, match=rf"what was there is now .*{NAME}\.refused-1$"):
        profiles.append(profile, drive_result(profile))
    assert content(tmp_path) == {f"{NAME}.refused-1": b"bad"}


def test_a_name_with_braces_is_a_name(tmp_path: Path) -> None:
    path = tmp_path / "{driver}.2.pldf"
    mine = new_profile()
    late = mine.with_iteration(drive_result(mine, "late"))
    write_profile(path, mine.with_iteration(drive_result(mine, "first", 1)))
    with pytest.raises(ProfileConflict) as caught:
        continue_profile(path, late)
    assert caught.value.kept.name == "{driver}.2.conflict-1.pldf"
    kept = write_profile(path, late, force=True)
    assert kept is not None and kept.name == "{driver}.2.pldf.replaced-1"


# The lock


def as_other_user(action: Callable[[], None]) -> str:
    """Do it in a process of another user; return what it says of a ModelError."""
    out, told = os.pipe()
    process = os.fork()
    if process == 0:
        try:
            os.setgid(12345)
            os.setuid(12345)
            action()
        except ModelError as error:
            os.write(told, str(error).encode())
        except BaseException as error:
            os.write(told, repr(error).encode())
        os._exit(0)
    os.close(told)
    os.waitpid(process, 0)
    with open(out, encoding="utf-8") as file:
        return file.read()


def lock_once(folder: Path) -> None:
    with folder_lock(folder, NOBODY_ELSE):
        pass


@pytest.fixture
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Return a folder into which everybody may write."""
    import tempfile  # noqa: PLC0415 - pytest's folders are closed to others

    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o777)
        yield Path(folder)


@needs_users
@pytest.mark.parametrize("mode", [0o644, 0o444], ids=oct)
def test_a_left_over_lock_of_another_user_blocks_nobody(shared: Path, mode: int) -> None:
    (shared / LOCK_NAME).touch()
    os.chmod(shared / LOCK_NAME, mode)
    assert as_other_user(lambda: lock_once(shared)) == ""
    with folder_lock(shared, NOBODY_ELSE):
        assert "held by another process" in as_other_user(lambda: lock_once(shared))


@pytest.mark.skipif(os.name == "nt", reason="no such rights there")
@pytest.mark.parametrize(("folder", "file"), [(0o777, 0o666), (0o770, 0o664), (0o700, 0o644)])
def test_a_lock_is_shared_as_its_folder_is_whatever_the_umask(
    tmp_path: Path, folder: int, file: int
) -> None:
    tmp_path.chmod(folder)
    before = os.umask(0o077)
    try:
        with folder_lock(tmp_path, NOBODY_ELSE):
            assert stat.S_IMODE((tmp_path / LOCK_NAME).stat().st_mode) == file
    finally:
        os.umask(before)


# A store that cannot be written to


def started(store: Path, learn: int = 1) -> tuple[str, list[str]]:
    """Initialize a driving function; return its status of the profile, and its warnings."""
    function, told = DrivingFunction(), []
    function.report = lambda level, text: told.append(text) if level == "warning" else None  # type: ignore[method-assign, assignment]
    function.texts.profile_store = str(store)
    function.record.learn = learn
    function.initialize()
    return PROFILE_STATUS.items[function.record.profile_status], told


def test_an_unwritable_store_is_told_before_the_drive(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert started(tmp_path / "new" / "store") == ("BASE", [])
    monkeypatch.setattr(os, "open", failing(errno.EROFS))
    status, (text,) = started(tmp_path / "new" / "store")
    assert status == "NOT_WRITABLE"
    assert text.startswith(
        f"what this drive teaches cannot be saved: {tmp_path}: cannot be written"
    )
    assert started(tmp_path, learn=0) == ("BASE", [])
    assert not list(tmp_path.iterdir())
