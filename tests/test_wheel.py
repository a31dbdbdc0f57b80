"""The wheel works alone: built from the sources, installed where they are out of reach, tested."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SOURCES = ("pyproject.toml", "README.md", "LICENSE", "CITATION.cff", "fmu_src", "vehicle_models")


def run(*command: object, folder: Path) -> None:
    """Run a command in ``folder`` without what the tests' own process was told about sources."""
    private = {"PYTHONPATH", "PLDF_CACHE", "PLDF_PROFILE_STORE", "PYTEST_ADDOPTS"}
    result = subprocess.run(
        [str(word) for word in command],
        cwd=folder,
        env={name: value for name, value in os.environ.items() if name not in private},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        check=False,
    )
    assert result.returncode == 0, result.stdout


def build_wheel(folder: Path, modules: Path) -> Path:
    """Build as ``make wheel`` does, with these FMUs as WebAssembly.

    From a copy: setuptools takes up what earlier builds left beside the sources.
    """
    tree = folder / "tree"
    tree.mkdir()
    ignored = shutil.ignore_patterns("__pycache__", "*.egg-info")
    for name in SOURCES:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, tree / name, ignore=ignored)
        else:
            shutil.copy(ROOT / name, tree)
    page = tree / "fmu_src" / "pldf" / "cockpit" / "page"
    shutil.copytree(modules, page / "wasm", dirs_exist_ok=True)
    run(sys.executable, "-m", "build", "--wheel", "--no-isolation", ".", folder=tree)
    (wheel,) = tree.glob("dist/*.whl")
    kept = Path(shutil.move(wheel, folder))
    shutil.rmtree(tree)
    return kept


def install(wheel: Path, folder: Path) -> Path:
    """Make an environment with the wheel that borrows the dependencies installed here.

    Their folders are named in a ``.pth`` file: what is editable there stays out of reach, because
    ``.pth`` files in folders named so are not read.
    """
    venv.create(folder, with_pip=False, symlinks=os.name != "nt")
    python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    pip = (sys.executable, "-m", "pip", "--python", python, "--disable-pip-version-check")
    run(*pip, "install", "--quiet", "--no-deps", "--no-index", wheel, folder=folder)
    (own,) = {path.parent for path in folder.rglob("pldf") if path.is_dir()}
    borrowed = [
        entry for entry in sys.path if Path(entry).name in ("site-packages", "dist-packages")
    ]
    (own / "borrowed.pth").write_text("\n".join(borrowed) + "\n", encoding="utf-8")
    return python


@pytest.fixture(scope="module")
def python(tmp_path_factory: pytest.TempPathFactory, wasm_folder: Path) -> Path:
    """Return the interpreter of an environment with the wheel."""
    folder = tmp_path_factory.mktemp("wheel")
    return install(build_wheel(folder, wasm_folder), folder / "venv")


def run_tests(python: Path, name: str, folder: Path) -> None:
    """Run a file of ``tests/wheel`` in a folder of its own."""
    file = shutil.copy(ROOT / "tests" / "wheel" / name, folder)
    options = ("-p", "no:cacheprovider", "-n", 2, "--durations", 5)
    run(python, "-m", "pytest", *options, file, folder=folder)


def test_the_wheel_works_alone(python: Path, tmp_path: Path) -> None:
    run_tests(python, "test_alone.py", tmp_path)


def test_type_checkers_know_the_wheel(python: Path, tmp_path: Path) -> None:
    run_tests(python, "test_types.py", tmp_path)
