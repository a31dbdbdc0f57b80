"""The native build: all platforms, the same bytes anywhere, and what it refuses."""

from __future__ import annotations

import os
import shutil
import struct
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from pldf import cli

pytest.importorskip("lief", reason="needs the extra: pip install -e .[native]")

import lief
from pldf.build.native.linking import universal
from pldf.cosim.platforms import PLATFORMS, TARGETS

SMALLEST = "LongitudinalVehicle"
ROOT = Path(__file__).parents[2]
SOURCES = ("fmu_src", "vehicle_models", "build_fmu.py")


def built(out: Path, *targets: str) -> tuple[Path, Path]:
    """Build the smallest FMU in this process; return where its two archives should be."""
    chosen = [part for target in targets for part in ("--target", target)]
    arguments = ["--native", "--only", SMALLEST, *chosen, "--out", str(out)]
    assert cli.main(["build", *arguments]) == 0
    return out / "native" / f"{SMALLEST}.fmu", out / "native" / "fmi3" / f"{SMALLEST}.fmu"


def binaries(archive: Path) -> dict[str, bytes]:
    """Return the libraries by their folder."""
    with zipfile.ZipFile(archive) as opened:
        places = [name for name in opened.namelist() if name.startswith("binaries/")]
        return {name.split("/")[1]: opened.read(name) for name in places}


# All platforms


@pytest.fixture(scope="module")
def everywhere(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Return the archives of one model for all platforms."""
    return built(tmp_path_factory.mktemp("everywhere"))


def test_every_platform_has_its_folder(everywhere: tuple[Path, Path]) -> None:
    assert binaries(everywhere[0]).keys() == {"linux64", "win64", "darwin64"}
    assert binaries(everywhere[1]).keys() == TARGETS.keys()


def test_both_archives_hold_the_same_libraries(everywhere: tuple[Path, Path]) -> None:
    two, three = map(binaries, everywhere)
    assert two["linux64"] == three["x86_64-linux"]
    assert two["win64"] == three["x86_64-windows"]
    assert two["darwin64"] == universal([three["x86_64-darwin"], three["aarch64-darwin"]])


def test_darwin64_is_universal_and_signed(everywhere: tuple[Path, Path]) -> None:
    """ARM processors of Apple run signed code only; pages there have 16 KiB."""
    two, three = map(binaries, everywhere)
    data = two["darwin64"]
    assert struct.unpack_from(">II", data) == (0xCAFEBABE, 2)
    for number, target in enumerate(("x86_64-darwin", "aarch64-darwin")):
        _, _, offset, size, power = struct.unpack_from(">IIIII", data, 8 + 20 * number)
        assert (offset % 2**14, power) == (0, 14)
        assert data[offset : offset + size] == three[target]
    whole = lief.MachO.parse(list(data))  # owns its parts
    intel, arm = whole
    assert intel.header.cpu_type == lief.MachO.Header.CPU_TYPE.X86_64
    assert arm.header.cpu_type == lief.MachO.Header.CPU_TYPE.ARM64
    assert arm.has_code_signature
    for part in (intel, arm):
        assert part.build_version.minos == [11, 0, 0]
        assert [lib.name for lib in part.libraries] == [
            f"@rpath/{SMALLEST}.dylib",
            "/usr/lib/libSystem.B.dylib",
        ]


def test_libraries_are_for_their_processors(everywhere: tuple[Path, Path]) -> None:
    found = binaries(everywhere[1])
    machines = {
        "x86_64-linux": lief.ELF.ARCH.X86_64,
        "aarch64-linux": lief.ELF.ARCH.AARCH64,
        "x86_64-windows": lief.PE.Header.MACHINE_TYPES.AMD64,
    }
    for target, machine in machines.items():
        head = lief.parse(found[target]).header
        assert getattr(head, "machine_type", getattr(head, "machine", None)) == machine


def test_linux_libraries_need_no_newer_c_library(everywhere: tuple[Path, Path]) -> None:
    found = binaries(everywhere[1])
    for target in ("x86_64-linux", "aarch64-linux"):
        needed = lief.parse(found[target]).symbols_version_requirement
        versions = [v.name for one in needed for v in one.get_auxiliary_symbols()]
        assert versions
        for version in versions:
            prefix, _, number = version.partition("_")
            assert prefix == "GLIBC"
            assert tuple(map(int, number.split("."))) <= (2, 17)


def test_a_platform_that_fmi_2_does_not_know_has_no_archive_there(tmp_path: Path) -> None:
    two, three = built(tmp_path, "aarch64-linux")
    assert not two.exists()
    assert binaries(three).keys() == {"aarch64-linux"}


def test_every_target_can_be_asked_for() -> None:
    assert [target for group in PLATFORMS.values() for target in group] == list(TARGETS)


# The same bytes


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a copy of the sources, to be built from or broken."""
    folder = tmp_path_factory.mktemp("a copy")
    for name in SOURCES:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(source, folder)
    return folder


def build_from(copy: Path, out: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run build_fmu.py of the copied sources for one model and one platform."""
    chosen = ["--native", "--target", "linux64", "--only", SMALLEST, "--out", str(out)]
    path = os.pathsep.join([str(copy / "fmu_src"), str(copy)])
    return subprocess.run(
        [sys.executable, "build_fmu.py", *chosen],
        cwd=copy,
        env={**os.environ, "PYTHONPATH": path, **environment},
        capture_output=True,
        text=True,
        check=False,
    )


def test_the_same_bytes_from_elsewhere_with_empty_caches(
    native_folder: Path, copy: Path, tmp_path: Path
) -> None:
    fresh = {name: str(tmp_path / name) for name in ("PLDF_CACHE", "ZIG_GLOBAL_CACHE_DIR")}
    done = build_from(copy, tmp_path, **fresh, ZIG_LOCAL_CACHE_DIR=fresh["ZIG_GLOBAL_CACHE_DIR"])
    assert done.returncode == 0, done.stderr
    for place in (Path(f"{SMALLEST}.fmu"), Path("fmi3", f"{SMALLEST}.fmu")):
        assert (tmp_path / "native" / place).read_bytes() == (native_folder / place).read_bytes()


def test_progress_names_platforms_and_archives(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    paths = built(tmp_path, "linux64")
    said = capsys.readouterr().out
    for work in ("compile the kernel", "link x86_64-linux", "validate"):
        assert f"[1/1] {SMALLEST}: {work} ... " in said
    assert all(str(path) in said for path in paths)


# What it refuses


def broken(copy: Path, tmp_path: Path, old: str, new: str) -> subprocess.CompletedProcess[str]:
    """Build with a changed kernel of the vehicle."""
    path = copy / "vehicle_models" / "vehicle_kernel.py"
    text = path.read_text()
    assert text.count(old) == 1
    path.write_text(text.replace(old, new))
    try:
        return build_from(copy, tmp_path)
    finally:
        path.write_text(text)


def line_of(text: str) -> int:
    """Return the line of the vehicle's kernel that holds ``text``."""
    path = ROOT / "vehicle_models" / "vehicle_kernel.py"
    return next(n for n, line in enumerate(path.read_text().splitlines(), 1) if text in line)


ADVANCED = "after = before + step_s * acceleration_mps2"


@pytest.mark.parametrize(
    ("new", "reason"),
    [
        (f"{ADVANCED} ** 2", "no ** in a kernel"),
        ("after = before + (step_s, 1.0)", "No implementation of function"),  # numba's own words
    ],
)
def test_the_build_says_which_line_is_refused(
    copy: Path, tmp_path: Path, new: str, reason: str
) -> None:
    done = broken(copy, tmp_path, ADVANCED, new)
    assert done.returncode == 1
    where = copy / "vehicle_models" / "vehicle_kernel.py"
    assert f"{where}:{line_of(ADVANCED)}: {reason}" in done.stderr
    assert "Traceback" not in done.stderr
    assert done.stderr.startswith(f"pldf: {SMALLEST}: the kernel cannot be compiled:\n")
    assert not (tmp_path / "native").exists()


def test_targets_are_those_of_native_fmus(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        cli.main(["build", "--target", "linux64"])
    assert ended.value.code == 2
    assert "--target goes with --native" in capsys.readouterr().err


def test_without_the_extra_the_build_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "ziglang", None)
    assert cli.main(["build", "--native", "--only", SMALLEST, "--out", str(tmp_path)]) == 1
    said = capsys.readouterr().err
    assert "native FMUs need ziglang; run: pip install 'adaptive-pldf[native]'" in said
