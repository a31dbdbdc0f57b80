"""Fixtures that several test modules share: what is built is built once per test run."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from filelock import FileLock
from fmi_host import Host, Slave
from pldf.fmi.packing.builder import build
from pldf.study.fmu import Fmu
from pldf.study.master import unpacked
from pushed_cart import cart_recipe

import build_fmu

TESTS = Path(__file__).parent


def once(factory: pytest.TempPathFactory, name: str, build: Callable[[Path], None]) -> Path:
    """Return a folder that one of all xdist workers lets ``build`` fill; the others wait for it."""
    base = factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / name
    stamp = folder.with_suffix(".built")
    with FileLock(folder.with_suffix(".lock")):
        if not stamp.is_file():
            folder.mkdir(exist_ok=True)  # another worker may have failed here
            build(folder)
            stamp.touch()
    return folder


@pytest.fixture(scope="session")
def fmu_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the three FMUs, validated by fmpy, and the study's SSP packages."""

    def build(folder: Path) -> None:
        assert build_fmu.main(["--out", str(folder)]) == 0

    return once(tmp_path_factory, "dist", build)


@pytest.fixture(scope="session")
def fmus(fmu_folder: Path) -> Iterator[dict[str, Fmu]]:
    """Return the three FMUs, unpacked."""
    with unpacked(fmu_folder) as found:
        yield found


@pytest.fixture(scope="session")
def native_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the native FMUs of this platform, validated by fmpy."""
    pytest.importorskip("ziglang", reason="needs the extra: pip install -e .[native]")
    if sys.platform != "linux":
        pytest.skip("builds and loads the linux64 FMUs")

    def build(folder: Path) -> None:
        assert build_fmu.main(["--native", "--target", "linux64", "--out", str(folder)]) == 0

    return once(tmp_path_factory, "dist_native", build) / "native"


@pytest.fixture(scope="session")
def native_fmus(native_folder: Path) -> Iterator[dict[str, Fmu]]:
    """Return the three native FMUs, unpacked."""
    with unpacked(native_folder) as found:
        yield found


@pytest.fixture(scope="session")
def c_host(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a simulator without Python."""
    headers = pytest.importorskip("pldf.native.build").HEADERS

    def build(folder: Path) -> None:
        zig = [sys.executable, "-m", "ziglang", "cc", "-std=gnu11", "-O1", f"-I{headers}"]
        source, program = str(TESTS / "native_host.c"), str(folder / "native_host")
        subprocess.run([*zig, source, "-o", program, "-ldl", "-lm"], check=True)

    return once(tmp_path_factory, "host", build) / "native_host"


@pytest.fixture(scope="session")
def cart_fmu(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the FMU of a small model with every kind of variable."""
    return build(cart_recipe(), tmp_path_factory.mktemp("cart"))


@pytest.fixture(scope="session")
def cart_host(cart_fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> Host:
    """Return that FMU, unpacked."""
    return Host(cart_fmu, tmp_path_factory.mktemp("unpacked"))


@pytest.fixture
def cart(cart_host: Host) -> Iterator[Slave]:
    """Return an instance of it."""
    slave = cart_host.instantiate()
    yield slave
    slave.free()
