"""What the page's modules may import, that all are ready for the export, and their sizes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from graphlib import TopologicalSorter
from pathlib import Path, PurePosixPath

import pytest
from node import node

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "fmu_src/pldf/cockpit/page"
MODULES = {
    path.relative_to(PAGE).as_posix(): path.read_text(encoding="utf-8")
    for path in sorted(PAGE.rglob("*.js"))
    if path.parent.name != "vendor"
}
STATIC = re.compile(r'^(?:import|export)\b[^;]*?\bfrom "([^"]+)";$', re.MULTILINE)
BARE = re.compile(r'^import "([^"]+)";$', re.MULTILINE)
# Who may know whom: a room those before it, and itself; view and cluster not each other.
SHARED = ("dom.js", "language.js", "types.js")
KNOWN = {
    "engine": {"vendor", "shared"},
    "view": {"vendor", "shared", "engine"},
    "cluster": {"vendor", "shared", "engine"},
    "session": {"vendor", "shared", "engine", "view", "cluster"},
    "shared": {"shared"},
    "pages": {"vendor", "shared", "engine", "view", "cluster", "session"},
}


def room_of(name: str) -> str:
    if name in SHARED:
        return "shared"
    return name.partition("/")[0] if "/" in name else "pages"


def imports_of(name: str) -> Iterator[str]:
    for address in (*STATIC.findall(MODULES[name]), *BARE.findall(MODULES[name])):
        assert address.startswith(("./", "../")), f"{name}: {address} is not relative"
        parts: list[str] = []
        for part in (PurePosixPath(name).parent / address).parts:
            if part == "..":
                parts.pop()
            else:
                parts.append(part)
        yield "/".join(parts)


@pytest.mark.parametrize("name", MODULES)
def test_a_module_imports_only_what_its_room_may_know(name: str) -> None:
    room = room_of(name)
    for wanted in imports_of(name):
        assert (PAGE / wanted).is_file(), f"{name}: {wanted} is not there"
        assert room_of(wanted) in KNOWN[room] | {room}, f"{name} imports {wanted}"


def test_no_imports_go_in_a_circle() -> None:
    graph = {name: [n for n in imports_of(name) if n in MODULES] for name in MODULES}
    assert set(TopologicalSorter(graph).static_order()) == set(MODULES)


@pytest.mark.parametrize("name", MODULES)
def test_a_module_is_written_for_the_export(name: str) -> None:
    """All imports are found by the pattern that the exporter uses; no others exist."""
    code = re.sub(r"/\*.*?\*/|^\s*//.*$", "", MODULES[name], flags=re.DOTALL | re.MULTILINE)
    assert len(re.findall(r'\bfrom "', code)) == len(STATIC.findall(code))
    assert not re.search(r"\bimport\(", code), "import() cannot be exported"
    assert "export default" not in code
    assert not re.search(r"\b(?:eval|Function)\(", code)


@pytest.mark.parametrize("name", MODULES)
def test_a_module_is_short(name: str) -> None:
    assert len(MODULES[name].splitlines()) <= 300


@pytest.mark.parametrize("path", sorted(PAGE.glob("*.html")), ids=lambda path: path.name)
def test_a_page_has_no_script_and_no_style_of_its_own(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert not re.search(r"<script(?![^>]*\bsrc=)[^>]*>", text)
    assert not re.search(r"\son\w+=|\sstyle=|<style", text)
    addresses = re.findall(r'(?:src|href)="([^"#]+)"', text)
    assert [a for a in addresses if ":" in a or a.startswith("/")] == []


def test_the_vendored_libraries_are_those_of_the_lock(tmp_path: Path) -> None:
    done = node(ROOT / "tests/cockpit/javascript/vendor.mjs", tmp_path)
    assert done.returncode == 0, done.stderr
    made = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    assert {name: (PAGE / "vendor" / name).read_bytes() for name in made} == made
