"""What may know what: the import contracts of pyproject.toml, and that they can fail."""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
KERNEL = ROOT / "fmu_src" / "pldf" / "kernel"
KERNELS = sorted((*KERNEL.glob("*.py"), *(ROOT / "vehicle_models").glob("*_kernel.py")))

# What a kernel may import from outside: types and mathematics.
PURE = {
    "__future__",
    "collections.abc",
    "dataclasses",
    "math",
    "numpy",
    "numpy.typing",
    "typing",
}
IMPURE_CALLS = {"open", "print", "input", "eval", "exec", "compile", "id", "hash", "__import__"}
RUN = "from importlinter.cli import lint_imports_command; lint_imports_command()"


def lint(root: Path) -> subprocess.CompletedProcess[str]:
    path = os.pathsep.join((str(root / "fmu_src"), str(root)))
    return subprocess.run(
        [sys.executable, "-c", RUN, "--config", str(root / "pyproject.toml"), "--no-cache"],
        cwd=root,
        env={**os.environ, "PYTHONPATH": path, "PYTHONUTF8": "1"},
        capture_output=True,
        encoding="utf-8",
        check=False,
    )


def test_the_import_contracts_hold() -> None:
    result = lint(ROOT)
    assert result.returncode == 0, result.stdout + result.stderr
    assert " 0 broken" in result.stdout


@pytest.mark.parametrize(
    ("module", "line", "contract"),
    [
        ("fmu_src/pldf/kernel/drive.py", "import time", "Kernels know no FMI"),
        ("fmu_src/pldf/kernel/planner.py", "from . import learning", "Within the kernel"),
        ("fmu_src/pldf/fmi/access.py", "from ..kernel import codes", "The FMI binding"),
        ("fmu_src/pldf/profiles/store.py", "from ..cosim import master", "What is packed"),
        ("fmu_src/pldf/roads/route.py", "from ..function import Files", "flow one way"),
        ("vehicle_models/driver.py", "from pldf.function import Files", "by its signals only"),
    ],
)
def test_a_forbidden_import_breaks_its_contract(
    tmp_path: Path, module: str, line: str, contract: str
) -> None:
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    ignored = shutil.ignore_patterns("__pycache__", "data", "*.egg-info")
    for folder in ("fmu_src/pldf", "vehicle_models"):
        shutil.copytree(ROOT / folder, tmp_path / folder, ignore=ignored)
    target = tmp_path / module
    target.write_text(f"{target.read_text(encoding='utf-8')}\n{line}\n", encoding="utf-8")
    result = lint(tmp_path)
    assert result.returncode == 1
    broken = [text for text in result.stdout.splitlines() if " BROKEN" in text]
    assert any(contract in text for text in broken), result.stdout


@pytest.mark.parametrize("path", KERNELS, ids=lambda path: path.stem)
def test_kernels_import_types_and_mathematics_only(path: Path) -> None:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            assert {alias.name for alias in node.names} <= PURE
        if isinstance(node, ast.ImportFrom) and node.level == 0:
            outside = not (node.module or "").startswith(("pldf.kernel", "vehicle_models."))
            assert not outside or node.module in PURE, node.module
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            assert node.func.id not in IMPURE_CALLS, node.func.id
        # numpy for tables and types; its functions on files, time and chance stay out.
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            assert node.value.id != "np" or node.attr in {"array", "zeros", "float64", "int64"}


def test_importing_the_kernel_leaves_nothing_behind() -> None:
    code = (
        "import os, threading; before = dict(os.environ);"
        "import pldf.kernel.learning, pldf.kernel.drive;"
        "assert dict(os.environ) == before and threading.active_count() == 1;"
        "import sys; assert not {'pythonfmu', 'numba', 'fmpy', 'logging'} & set(sys.modules)"
    )
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stderr


def test_pytest_looks_into_every_room() -> None:
    """Its own list of folders to leave out has had the name of a room on it."""
    result = subprocess.run(
        [sys.executable, "-m", "pytest", "--collect-only", "-q", "-p", "no:cacheprovider"],
        cwd=ROOT,
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    collected = {line.partition("::")[0] for line in result.stdout.splitlines() if "::" in line}
    there = {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "tests").rglob("test_*.py")
        if path.parent.name != "wheel"  # those are run where the sources are out of reach
    }
    assert there <= collected
