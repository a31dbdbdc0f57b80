"""Fixtures that several test modules share: what is built is built once per test run."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from built_once import once
from fmi_host import Host, Slave
from native_hosts import Hosts, native_archives
from pldf import cli
from pldf.build.builder import build
from pldf.cosim.fmu import Fmu
from pldf.cosim.kinds import PARTS_IN_TRAFFIC
from pldf.cosim.master import unpacked
from pushed_cart import cart_recipe
from wasm_host import wasm_modules

# Run by test_wheel.py where the sources are out of reach.
collect_ignore = ["wheel"]


@pytest.fixture(scope="session")
def fmu_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with all FMUs, validated by fmpy, and the study's SSP packages."""

    def build(folder: Path) -> None:
        assert cli.main(["build", "--out", str(folder)]) == 0

    return once(tmp_path_factory, "dist", build)


@pytest.fixture(scope="session")
def fmus(fmu_folder: Path) -> Iterator[dict[str, Fmu]]:
    """Return the three FMUs, unpacked."""
    with unpacked(fmu_folder) as found:
        yield found


@pytest.fixture(scope="session")
def traffic_fmus(fmu_folder: Path) -> Iterator[dict[str, Fmu]]:
    """Return the three FMUs and the car ahead, unpacked."""
    with unpacked(fmu_folder, PARTS_IN_TRAFFIC) as found:
        yield found


@pytest.fixture(scope="session")
def native_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the native FMUs of this platform; those for FMI 3.0 in ``fmi3``."""
    return native_archives(tmp_path_factory, "linux64")


@pytest.fixture(scope="session")
def native_fmus(native_folder: Path) -> Iterator[dict[str, Fmu]]:
    """Return the three native FMUs, unpacked."""
    with unpacked(native_folder) as found:
        yield found


@pytest.fixture(scope="session")
def native_traffic_fmus(native_folder: Path) -> Iterator[dict[str, Fmu]]:
    """Return the three native FMUs and the car ahead, unpacked."""
    with unpacked(native_folder, PARTS_IN_TRAFFIC) as found:
        yield found


@pytest.fixture(scope="session")
def wasm_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with all FMUs as WebAssembly and their model descriptions."""
    return wasm_modules(tmp_path_factory)


@pytest.fixture(scope="session")
def hosts(tmp_path_factory: pytest.TempPathFactory) -> Hosts:
    """Return the C host and the native FMUs for every platform."""
    return Hosts(tmp_path_factory)


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
