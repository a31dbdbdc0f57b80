"""Names, places and several FMUs at once."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys

import pytest
from fmi_host import Host
from pldf.build.builder import build
from pushed_cart import DISCARD, EXAMPLE, push, recipe_with


@pytest.mark.parametrize(
    "name", ["a b", "/tmp/x/y.z", "C:\\models\\a b", "%s%n%d", "ü ' \" {}", ""]
)
def test_instance_names(cart_host, name):
    cart = push(cart_host.instantiate(name))
    assert cart.status("doStep", 0.0, -1.0) == DISCARD
    cart.free()


@pytest.mark.skipif(os.name == "nt", reason="spelling of paths on POSIX systems")
@pytest.mark.parametrize(
    "spelling", ["file://{}/resources", "file:///{}/resources", "file://{}/resources/"]
)
def test_resource_locations(cart_fmu, tmp_path, spelling):
    host = Host(cart_fmu, tmp_path / "with space")
    place = str(host.folder).replace(" ", "%20")
    cart = host.instantiate(location=spelling.format(place))
    assert len(push(cart).run(0.0, 3)) == 3
    cart.free()


LOCATION = """
import sys
from pathlib import Path
sys.path.insert(0, {tests!r})
from fmi_host import Host
Host(Path({fmu!r}), Path({folder!r})).instantiate(location={location!r}).start()
"""


@pytest.mark.skipif(os.name == "nt", reason="spelling of paths on POSIX systems")
@pytest.mark.xfail(strict=True, reason="pythonfmu 0.7.0 crashes before any Python of the FMU runs")
@pytest.mark.parametrize("location", ["file:{}/resources", "file://{}%2B/resources"])
def test_resource_locations_that_the_wrapper_cannot_read(cart_fmu, tmp_path, location):
    """When this passes, the wrapper was repaired: docs/fmu.md can lose a limit."""
    folder = tmp_path / ("here+" if "%2B" in location else "here")
    script = LOCATION.format(
        tests=str(EXAMPLE.parent),
        fmu=str(cart_fmu),
        folder=str(folder),
        location=location.format(tmp_path / "here"),
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, check=False)
    assert done.returncode == 0


@pytest.mark.skipif(os.name == "nt", reason="permissions of POSIX systems")
def test_resources_may_be_read_only(cart_fmu, tmp_path):
    host = Host(cart_fmu, tmp_path / "fmu")
    for path in sorted(host.folder.rglob("*")):
        path.chmod(0o555 if path.is_dir() else 0o444)
    try:
        cart = push(host.instantiate())
        assert len(cart.run(0.0, 3)) == 3
        cart.free()
    finally:
        for path in sorted(host.folder.rglob("*")):
            path.chmod(0o755)


# Several at once, one after the other


def test_two_instances_do_not_share_anything(cart_host):
    alone = push(cart_host.instantiate())
    expected = alone.run(0.0, 20)
    one, two = cart_host.instantiate("one"), cart_host.instantiate("two")
    push(one)
    two.start(force_n=-9.0, memory_size=5)
    found = []
    for step in range(20):
        found += one.run(step * 0.01, 1)
        two.run(step * 0.01, 1)
    for slave in (alone, one, two):
        slave.free()
    assert found == expected


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("example/cart/model.py", "0.125 * step_s", "0.250 * step_s"),
        ("pldf/instance.py", "def report(", "def report_(self) -> None: ...\n\n    def report("),
        ("example/cart_slave.py", "A cart pushed", "A cart shoved"),
    ],
)
def test_two_builds_in_one_process_run_their_own_code(cart_fmu, tmp_path, file, old, new):
    other_fmu = build(recipe_with(tmp_path, file, old, new), tmp_path / "out")
    hosts = [Host(cart_fmu), Host(other_fmu)]
    assert hosts[0].description.guid != hosts[1].description.guid
    slaves = [push(host.instantiate()) for host in hosts]
    ends = [slave.run(0.0, 10)[-1]["position_m"] for slave in slaves]
    assert (ends[0] == ends[1]) == ("model" not in file)
    loaded = {name for name in sys.modules if name.startswith("cart_slave_")}
    for slave, host in zip(slaves, hosts, strict=True):
        slave.free()
        names = {p.name.removesuffix(".py") for p in host.folder.glob("resources/cart_slave_*")}
        assert names <= loaded
        shutil.rmtree(host.folder)


def test_load_unload_load_while_the_first_folder_vanishes(cart_fmu, tmp_path):
    expected = None
    for turn in range(3):
        host = Host(cart_fmu, tmp_path / str(turn))
        cart = push(host.instantiate())
        found = cart.run(0.0, 10)
        expected = expected or found
        assert found == expected
        cart.free()
        shutil.rmtree(host.folder)


def test_host_keeps_its_import_path(cart_host):
    before = list(sys.path)
    for _ in range(3):
        cart_host.instantiate().free()
    assert sys.path == before


def test_many_instances_one_after_the_other(cart_host):
    for number in range(60):
        cart = push(cart_host.instantiate(f"number {number}"))
        cart.status("getReal", [99])
        cart.fmu.doStep(0.0, 0.01)
        cart.fmu.reset()
        cart.free()


CLEAN_PROCESS = """
import sys
from pathlib import Path
sys.path.insert(0, {tests!r})
from fmi_host import Host
assert "pythonfmu" not in sys.modules
host = Host(Path({fmu!r}))
cart = host.instantiate()
cart.start(force_n=4.0)
print(cart.run(0.0, 100)[-1]["position_m"])
cart.status("getReal", [99])
cart.status("getReal", [99])
assert sys.modules["pythonfmu"].__file__.startswith(str(host.folder)), sys.modules["pythonfmu"]
if {free}:
    cart.free()
"""


@pytest.mark.parametrize("free", [True, False])
def test_clean_process_without_the_project(cart_fmu, cart, tmp_path, free):
    """The FMU brings its own pythonfmu, and the process ends well with or without a release."""
    script = CLEAN_PROCESS.format(tests=str(EXAMPLE.parent), fmu=str(cart_fmu), free=free)
    done = subprocess.run(
        [sys.executable, "-c", script],
        cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) == push(cart).run(0.0, 100)[-1]["position_m"]
