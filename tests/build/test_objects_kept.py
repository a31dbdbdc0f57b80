"""Object files are made once: of what is kept, whatever the target, however many ask at a time."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Event

import pytest
from pldf.build.native import objects

MODEL = "vehicle_models.native:VEHICLE"
TARGETS = ("x86_64-linux", "wasm32")


class Compiler:
    """Stands in for numba and LLVM: writes what it was asked for, and notes it."""

    def __init__(self) -> None:
        self.asked: list[tuple[str, ...]] = []
        self.frontends = 0
        self.let_go = Event()
        self.let_go.set()

    def compile(self, model: str, folder: Path, targets: Sequence[str]) -> None:
        """Do as ``objects._compile``, once it may."""
        self.let_go.wait(60.0)
        self.asked.append(tuple(targets))
        if not (folder / "llvm.gz").exists():
            self.frontends += 1
            (folder / "llvm.gz").write_bytes(b"made once")
        for target in targets:
            (folder / f"{target}.o").write_bytes(f"{model} for {target}".encode())


@pytest.fixture
def compiler(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Compiler:
    made = Compiler()
    monkeypatch.setenv("PLDF_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(objects, "_compile", made.compile)
    return made


def test_a_further_target_is_made_of_what_is_kept(compiler: Compiler) -> None:
    first = objects.compile_objects(MODEL, ["x86_64-linux"])
    both = objects.compile_objects(MODEL, TARGETS)
    assert both == {**first, "wasm32": b"vehicle_models.native:VEHICLE for wasm32"}
    assert objects.compile_objects(MODEL, TARGETS) == both
    assert compiler.asked == [("x86_64-linux",), ("wasm32",)]
    assert compiler.frontends == 1


def test_web_assembly_has_a_process_of_its_own(compiler: Compiler) -> None:
    objects.compile_objects(MODEL, ("x86_64-linux", "wasm32", "aarch64-linux"))
    assert compiler.asked == [("x86_64-linux", "aarch64-linux"), ("wasm32",)]
    assert compiler.frontends == 1


def test_who_asks_meanwhile_waits_and_finds_it_done(compiler: Compiler) -> None:
    compiler.let_go.clear()
    with ThreadPoolExecutor(2) as pool:
        asked = [pool.submit(objects.compile_objects, MODEL, TARGETS) for _ in range(2)]
        compiler.let_go.set()
    assert asked[0].result() == asked[1].result()
    assert compiler.asked == [("x86_64-linux",), ("wasm32",)]


def test_a_cache_that_cannot_be_written_costs_time_alone(
    compiler: Compiler, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("no folder")
    monkeypatch.setenv("PLDF_CACHE", str(tmp_path / "file"))
    made = [objects.compile_objects(MODEL, TARGETS) for _ in range(2)]
    assert made[0] == made[1]
    assert compiler.frontends == 2
