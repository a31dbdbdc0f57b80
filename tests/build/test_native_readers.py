"""The C reader and the Python reader say the same of every file, sound or hostile."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fmi_host import Host
from hostile_files import damaged, is_prepared, with_marks, with_notes, with_other_blocks
from native_drives import CASES, by_source
from pldf.errors import ModelError
from pldf.kernel.codes import PROFILE_BASE, PROFILE_LOADED, PROFILE_REFUSED
from pldf.profiles.profile_file import decode, encode
from pldf.profiles.profile_format_1 import encode_1
from pldf.profiles.store import ProfileStore
from pldf.profiles.stored_profile import StoredProfile

pytest.importorskip("ziglang", reason="needs the extra: pip install -e .[native]")

from pldf.cosim.prepared import prepared_route
from pldf.roads import Mark, packed_route


@pytest.fixture(scope="module")
def profile(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, bytes]:
    """Return name and bytes of a profile after two short drives."""
    case, store = CASES["learn"], tmp_path_factory.mktemp("store")
    for _ in range(2):
        by_source(case, case.script()[:500], store)
    (path,) = store.iterdir()
    return path.name, path.read_bytes()


def others(name: str, good: bytes) -> Iterator[bytes]:
    """Yield sound profiles of somebody else, of another road, and in another format."""
    profile = decode(good, name)
    yield encode(StoredProfile(profile.driver_id + 1, profile.route, profile.base_mps))
    yield encode(StoredProfile(profile.driver_id, "0" * 16, profile.base_mps))
    yield encode(StoredProfile(profile.driver_id, profile.route, profile.base_mps[:-1]))
    yield encode(StoredProfile(profile.driver_id, profile.route, profile.base_mps))
    yield encode_1(StoredProfile(profile.driver_id, profile.route, profile.base_mps))
    yield encode_1(profile)
    yield good


def by_python(store: Path, wanted: StoredProfile) -> tuple[int, int]:
    """Return the status of a driver's profile and its number of iterations."""
    try:
        found = ProfileStore(store).load(wanted.driver_id, wanted.route, wanted.nodes)
    except ModelError:
        return PROFILE_REFUSED, 0
    count = len(found.iterations) if found is not None else 0
    return (PROFILE_LOADED if count else PROFILE_BASE), count


def by_c(host: Host, store: Path) -> tuple[int, int]:
    """Return the same from the native FMU."""
    slave = host.instantiate().start(profile_store=str(store))
    found = slave.get("profile.status"), slave.get("profile.iteration")
    slave.free()
    return found


def in_store(top: Path, name: str, data: bytes) -> Path:
    """Return a new store with this file in it."""
    shutil.rmtree(top, ignore_errors=True)
    top.mkdir()
    (top / name).write_bytes(data)
    return top


def kept(store: Path) -> dict[str, bytes]:
    """Return the files in a store."""
    return {path.name: path.read_bytes() for path in store.iterdir()}


def test_profiles(native_folder: Path, profile: tuple[str, bytes], tmp_path: Path) -> None:
    host, (name, good) = Host(native_folder / "AdaptivePLDF.fmu"), profile
    wanted = decode(good, name)
    verdicts = []
    old = encode_1(wanted)
    new = (*damaged(good), *with_notes(good), *with_other_blocks(good), *others(name, good))
    for data in (*new, *damaged(old), *with_notes(old)):
        ours, theirs = (in_store(tmp_path / who, name, data) for who in ("python", "c"))
        verdicts.append(by_python(ours, wanted))
        assert by_c(host, theirs) == verdicts[-1], data[:400]
        assert kept(theirs) == kept(ours)
    sound = [status != PROFILE_REFUSED for status, _ in verdicts]
    assert 30 < sum(sound) < len(sound) - 200  # both are well represented


@pytest.mark.parametrize(("length", "status"), [(80, PROFILE_LOADED), (81, PROFILE_REFUSED)])
def test_longest_note(
    native_folder: Path, profile: tuple[str, bytes], tmp_path: Path, length: int, status: int
) -> None:
    host, (name, good) = Host(native_folder / "AdaptivePLDF.fmu"), profile
    (data,) = (d for d in with_notes(good) if b" " + length * b"n" + b"\n" in d)
    assert by_c(host, in_store(tmp_path / "c", name, data))[0] == status


@pytest.mark.parametrize(
    ("model", "kind", "columns"), [("AdaptivePLDF", "route", 5), ("ScriptedDriver", "script", 6)]
)
def test_prepared_files(
    native_folder: Path, model: str, kind: str, columns: int, tmp_path: Path
) -> None:
    """Python only writes them; its verdict is the description's."""
    host = Host(native_folder / f"{model}.fmu")
    good = (host.folder / "resources" / kind / "0.prepared").read_bytes()
    compare(host, kind, columns, [*damaged(good), good], tmp_path)


def test_prepared_routes_with_marks(native_folder: Path, tmp_path: Path) -> None:
    """Names of roads and signs stand in the header."""
    marks = (Mark(0.0, "road", "12 Hauptstra\N{LATIN SMALL LETTER SHARP S}e"),)
    marks += (Mark(40.5, "sign", "50 km/h sign"), Mark(90.0, "road", "7", against=True))
    good = prepared_route(replace(packed_route(0), marks=marks))
    assert good.startswith(b"PLDF-PREPARED 2\n")
    host = Host(native_folder / "AdaptivePLDF.fmu")
    compare(host, "route", 5, [*damaged(good), *with_marks(good), good], tmp_path)
    older = prepared_route(replace(packed_route(0), marks=()))
    assert older.startswith(b"PLDF-PREPARED 1\n")
    assert is_prepared(older, "route", 5)
    assert older[-100_000:-15] == good[-100_000:-15]


def compare(host: Host, kind: str, columns: int, files: list[bytes], tmp_path: Path) -> None:
    """Compare the verdict of the C reader with that of the description; the last one is sound."""
    path = tmp_path / "file.prepared"
    verdicts = []
    for data in files:
        path.write_bytes(data)
        slave = host.instantiate()
        slave.set(**{f"{kind}_file": str(path)}, **({"kind": 1} if kind == "script" else {}))
        slave.fmu.setupExperiment(startTime=0.0)
        slave.fmu.enterInitializationMode()
        verdicts.append(is_prepared(data, kind, columns))
        assert (slave.status("exitInitializationMode") == 0) == verdicts[-1], data[:200]
        slave.free()
    assert verdicts[-1]
    assert 30 < np.count_nonzero(verdicts) < len(verdicts) - 100
