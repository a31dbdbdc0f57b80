"""Runtime and C host under gcc's sanitizers: no wrong access, no undefined behaviour, no leak."""

from __future__ import annotations

import importlib
import os
import shutil
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest
from hostile_files import damaged, with_marks, with_other_blocks
from native_drives import CASES, by_source
from native_hosts import HEADERS, MODELS, PLATFORMS, WARNINGS, Hosts, Value, host_sources, missing
from pldf.build import fmus as fmu_build
from pldf.profiles.profile_file import decode
from pldf.profiles.profile_format_1 import encode_1
from pldf.roads import packed_route

pytest.importorskip("ziglang", reason="needs the extra: pip install -e .[native]")
if sys.platform != "linux":
    pytest.skip("the sanitizers of gcc on Linux", allow_module_level=True)

from pldf.build.native.objects import compile_objects
from pldf.build.native.table import source
from pldf.build.native.table_header import header
from pldf.cosim.prepared import write_prepared_route

HERE = PLATFORMS["linux64"]
RUNTIME = fmu_build.RUNTIME
STEPS = "1000000"
GCC = (
    "gcc", "-g", "-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=undefined",
    "-fno-omit-frame-pointer", *WARNINGS, f"-I{HEADERS}",
)  # fmt: skip


class Sanitized:
    """The C host and the libraries of all models, compiled by gcc with its sanitizers."""

    def __init__(self, hosts: Hosts, folder: Path) -> None:
        if not shutil.which("gcc"):
            missing("gcc is missing: apt-get install gcc libc6-dev")
        self.hosts, self.folder = hosts, folder
        self.program = folder / "host"
        libraries = ["-ldl", "-lm", "-lpthread"]
        command = [*GCC, "-std=gnu11", *host_sources(), "-o", str(self.program), *libraries]
        subprocess.run(command, check=True)
        for model in MODELS:
            self.compile(model)

    def compile(self, model: str) -> None:
        """Compile the runtime, and link it with the model's table and kernel."""
        module, _, name = fmu_build.NATIVE[model].partition(":")
        made_of = getattr(importlib.import_module(module), name)
        tokens = [self.hosts.fmu("linux64", v, model).description.guid for v in (2, 3)]
        place = self.folder / model
        place.mkdir()
        (place / "table.h").write_text(header(made_of), encoding="utf-8")
        (place / "table.c").write_text(source(made_of, *tokens), encoding="utf-8")
        kernel = compile_objects(fmu_build.NATIVE[model], [HERE.target])[HERE.target]
        (place / "kernel.o").write_bytes(kernel)
        inputs = [*sorted(RUNTIME.glob("*.c")), place / "table.c", place / "kernel.o"]
        command = [*GCC, "-std=c11", "-shared", "-fPIC", f"-I{RUNTIME}", f"-I{place}"]
        library = ["-o", str(place / f"{model}.so"), *map(str, inputs), "-lm"]
        subprocess.run([*command, *library], check=True)

    def described(
        self, version: int, model: str, path: Path, settings: Mapping[str, Value] | None = None
    ) -> Path:
        """Write what the host has to know to ``path``, and return it."""
        fmu = self.hosts.fmu("linux64", version, model)
        library = self.folder / model / f"{model}.so"
        return fmu.described(HERE, path, settings, library)

    def run(self, job: str, *arguments: str | Path, cwd: Path) -> str:
        """Run a job, which sanitizers end with another status than 0; return what was logged."""
        kept = {k: v for k, v in os.environ.items() if not k.startswith("PLDF_")}
        done = subprocess.run(
            [self.program, job, *arguments],
            env={**kept, "ASAN_OPTIONS": "detect_leaks=1"},
            cwd=cwd, capture_output=True, check=False,
        )  # fmt: skip
        told = done.stderr.decode(errors="replace")
        assert done.returncode == 0, (done.returncode, told[-4000:])
        return told


@pytest.fixture(scope="module")
def sanitized(hosts: Hosts, tmp_path_factory: pytest.TempPathFactory) -> Sanitized:
    return Sanitized(hosts, tmp_path_factory.mktemp("sanitized"))


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("version", [2, 3])
def test_a_million_steps_that_make_no_sense(
    sanitized: Sanitized, version: int, model: str, tmp_path: Path
) -> None:
    file = sanitized.described(version, model, tmp_path / "fmu.txt")
    sanitized.run("hostile", file, STEPS, cwd=tmp_path)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("version", [2, 3])
def test_life_cycle_order_of_calls_instances_and_states(
    sanitized: Sanitized, version: int, model: str, tmp_path: Path
) -> None:
    other = "ScriptedDriver" if model == "AdaptivePLDF" else "AdaptivePLDF"
    files = [sanitized.described(version, m, tmp_path / m) for m in (model, other)]
    sanitized.run("check", *files, cwd=tmp_path)


FORGED: dict[str, dict[str, Value]] = {
    "AdaptivePLDF": {"learn": 1},
    "AdaptivePLDF by coordinates": {"localization": 1, "apply_learned": 0},
    "LeadVehicle": {},
    "LeadVehicle with a script": {"kind": 1},
    "LongitudinalVehicle": {},
    "ScriptedDriver": {},
    "ScriptedDriver with a script": {"kind": 1},
}


@pytest.mark.parametrize("what", FORGED)
@pytest.mark.parametrize("version", [2, 3])
def test_every_word_of_a_state_forged(
    sanitized: Sanitized, version: int, what: str, tmp_path: Path
) -> None:
    """It is refused and nothing changes, or drives on: no crash, no NaN (a road of 40 m)."""
    road = packed_route(0)
    write_prepared_route(
        replace(road, **{name: knots[:40] for name, knots in road.knots.items()}),
        tmp_path / "road.prepared",
    )
    settings = {"route_file": str(tmp_path / "road.prepared"), **FORGED[what]}
    file = sanitized.described(version, what.split(maxsplit=1)[0], tmp_path / "fmu.txt", settings)
    sanitized.run("forge", file, cwd=tmp_path)


# Files


def test_damaged_profiles(sanitized: Sanitized, tmp_path: Path) -> None:
    case = CASES["learn"]
    files = []
    store = tmp_path / "good"
    by_source(case, case.script()[:500], store)
    (profile,) = store.iterdir()
    good = profile.read_bytes()
    old = encode_1(decode(good, profile.name))
    for number, data in enumerate((*damaged(good), *with_other_blocks(good), *damaged(old))):
        place = tmp_path / str(number)
        place.mkdir()
        (place / profile.name).write_bytes(data)
        settings = case.stored(str(place))
        files.append(sanitized.described(2, case.model, tmp_path / f"{number}.txt", settings))
    sanitized.run("attempt", *files, cwd=tmp_path)
    kept = [path for path in tmp_path.glob("*/*") if "refused" in path.name]
    assert len(files) / 2 < len(kept) < len(files)  # changed values can be as good as others


@pytest.mark.parametrize(
    ("model", "kind"), [("AdaptivePLDF", "route"), ("ScriptedDriver", "script")]
)
def test_damaged_routes_and_scripts(
    sanitized: Sanitized, model: str, kind: str, tmp_path: Path
) -> None:
    good = sanitized.hosts.fmu("linux64", 2, model).folder / "resources" / kind / "0.prepared"
    files = []
    others = with_marks(good.read_bytes()) if kind == "route" else ()
    for number, data in enumerate((*damaged(good.read_bytes()), *others)):
        path = tmp_path / f"{number}.prepared"
        path.write_bytes(data)
        settings = {f"{kind}_file": str(path), **({"kind": 1} if kind == "script" else {})}
        files.append(sanitized.described(2, model, path.with_suffix(".txt"), settings))
    refused = sanitized.run("attempt", *files, cwd=tmp_path).count(".prepared: ")
    assert len(files) / 2 < refused < len(files)
