"""The packages of development and CI are locked, and the lock fits what pyproject.toml allows."""

import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
from packaging.markers import Marker
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parent.parent
LOCK = (ROOT / "requirements-dev.txt").read_text()
PROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text())

# One entry: requirement, hashes, and a comment on who needs it.
ENTRY = re.compile(r"^([a-z0-9][^\\\n]*?) \\\n((?:    --hash=\S+(?: \\)?\n)+)", re.MULTILINE)
SYSTEMS = (
    ("linux", "Linux", "posix", "x86_64"),
    ("linux", "Linux", "posix", "aarch64"),
    ("win32", "Windows", "nt", "AMD64"),
    ("darwin", "Darwin", "posix", "arm64"),
)
MACHINES = [
    {
        "python_version": python,
        "python_full_version": f"{python}.9",
        "sys_platform": system,
        "platform_system": name,
        "os_name": kind,
        "platform_machine": machine,
        "implementation_name": "cpython",
        "platform_python_implementation": "CPython",
    }
    for python in ("3.11", "3.12", "3.13", "3.14")
    for system, name, kind, machine in SYSTEMS
]


def locked() -> list[tuple[Requirement, list[str]]]:
    return [
        (Requirement(entry), re.findall(r"--hash=(\S+)", hashes))
        for entry, hashes in ENTRY.findall(LOCK)
    ]


def wanted() -> list[Requirement]:
    """What is needed on some machine: to run, with every extra, to develop, and to build."""
    groups = PROJECT["dependency-groups"]
    lines = [line for group in groups.values() for line in group if isinstance(line, str)]
    lines += PROJECT["project"]["dependencies"] + PROJECT["build-system"]["requires"]
    for extra in PROJECT["project"]["optional-dependencies"].values():
        lines += extra
    return [Requirement(line) for line in lines]


def _holds(marker: Marker | None, machine: dict[str, str]) -> bool:
    return marker is None or marker.evaluate(machine)


def test_every_line_of_the_lock_is_read() -> None:
    lines = [line for line in LOCK.splitlines() if line and not line.startswith((" ", "#"))]
    assert len(locked()) == len(lines) > 100


def test_every_package_has_one_version_and_hashes() -> None:
    for requirement, hashes in locked():
        assert re.fullmatch(r"==[^,*]+", str(requirement.specifier)), requirement
        assert hashes, requirement
        assert all(re.fullmatch("sha256:[0-9a-f]{64}", value) for value in hashes), requirement


@pytest.mark.parametrize("requirement", wanted(), ids=str)
def test_lock_has_what_the_project_asks_for_on_every_system(requirement: Requirement) -> None:
    name = canonicalize_name(requirement.name)
    for machine in MACHINES:
        there = [
            str(entry.specifier).removeprefix("==")
            for entry, _ in locked()
            if canonicalize_name(entry.name) == name and _holds(entry.marker, machine)
        ]
        if _holds(requirement.marker, machine):
            assert len(there) == 1, f"{machine}; make lock"
            assert requirement.specifier.contains(there[0], prereleases=True), "make lock"
