"""What README and docs name is there: files, modules, commands and options, parameters, links."""

from __future__ import annotations

import argparse
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from itertools import takewhile
from pathlib import Path

import pldf
import pytest
from pldf.commands import COMMANDS
from pldf.cosim.fmu import Fmu
from readme_commands import blocks

ROOT = Path(__file__).parent.parent
PAGES = [
    *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")),
    ROOT / "examples" / "README.md",
    *sorted((ROOT / "docs").glob("*.md")),
]
ALL = pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())

# Where a path in the docs may begin.
BASES = (ROOT, ROOT / "fmu_src", ROOT / "fmu_src" / "pldf")
FOLDERS = {path.name for path in ROOT.iterdir() if path.is_dir()}
SOURCE = re.compile(r"[\w./-]+\.(?:py|[ch]|yml|yaml)")
WRITTEN = {"dist", "out", "site"}  # by commands
GENERATED = {"table.c", "table.h"}  # by the native build
VARIABLE = re.compile(r"[a-z]+(?:_[a-z]+)*\.[a-z_0-9]+(?:\.[a-z_0-9]+)*")
FILE_ENDINGS = (".csv", ".pldf", ".png", ".ssv", ".py", ".c", ".h", ".js", ".mjs", ".toml")
NAME_TABLES = ("input", "parameter", "Parameter")


def text_of(page: Path) -> str:
    return page.read_text(encoding="utf-8")


def without_blocks(text: str) -> str:
    return re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)


def spans(text: str) -> list[str]:
    """Everything written as code in running text."""
    return [" ".join(code.split()) for code in re.findall(r"`([^`]+)`", without_blocks(text))]


def code_lines(text: str) -> Iterator[str]:
    """Code in running text, and the lines of blocks; lines that end with a backslash are joined."""
    yield from spans(text)
    for language in ("sh", "powershell", ""):
        for block in blocks(text, language):
            yield from "\n".join(block).replace("\\\n", " ").splitlines()


def slug(heading: str) -> str:
    """The anchor of a heading, as GitHub and MkDocs make it."""
    plain = re.sub(r"[^\w\s-]", "", heading.replace("`", "")).strip().lower()
    return re.sub(r"\s", "-", plain)


@ALL
def test_every_link_leads_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)\s]+)\)", without_blocks(text_of(page))):
        if target.startswith(("http://", "https://")):
            continue
        name, _, anchor = target.partition("#")
        linked = (page.parent / name).resolve() if name else page
        assert linked.exists(), target
        assert linked.is_relative_to(ROOT / "docs") or page.parent != ROOT / "docs", (
            f"{target}: the site holds docs/ alone; write the path as code"
        )
        if anchor:
            headings = re.findall(r"^#+ (.+)$", without_blocks(text_of(linked)), re.MULTILINE)
            assert anchor in map(slug, headings), target


@ALL
def test_every_file_named_is_there(page: Path) -> None:
    for code in spans(text_of(page)):
        for word in code.split():
            name = word.strip("(),;:")
            if set("*$<>…") & set(name) or name.split("/")[0] in WRITTEN:
                continue
            rooted = name.split("/")[0] in FOLDERS or SOURCE.fullmatch(name)
            if "/" in name and rooted:
                assert any((base / name).exists() for base in BASES), name
            elif SOURCE.fullmatch(name) and name not in GENERATED:
                assert repository_files(name), f"{name}: no file of this name"


@cache
def repository_files(name: str) -> tuple[Path, ...]:
    folders = ("fmu_src", "vehicle_models", "tests", "studies", "examples", "benchmarks", ".github")
    found = [path for folder in folders for path in (ROOT / folder).rglob(name)]
    return (*found, *ROOT.glob(name))


@ALL
def test_every_module_named_is_there(page: Path, fmus: dict[str, Fmu]) -> None:
    text = text_of(page)
    named = [w for code in code_lines(text) for w in re.findall(r"(?<![\w.-])pldf\.[\w.]+", code)]
    named += re.findall(r"^::: (\S+)$", text, re.MULTILINE)
    for name in named:  # "pldf.NAME" is also a variable of the part "pldf" of a coupled drive
        if not name.endswith(FILE_ENDINGS) and name[5:] not in fmus["pldf"].signals:
            assert exists(name), name


def exists(name: str) -> bool:
    """Whether the dotted name is a module or something in one."""
    first, *parts = name.split(".")
    found = import_module(first)
    for part in parts:
        if hasattr(found, part):
            found = getattr(found, part)
        elif find_spec(f"{found.__name__}.{part}") is not None:
            found = import_module(f"{found.__name__}.{part}")
        else:
            return False
    return True


def test_the_whole_front_door_is_documented() -> None:
    shown = re.findall(r"^::: (\S+)$", text_of(ROOT / "docs" / "api.md"), re.MULTILINE)
    assert sorted(name.split(".")[-1] for name in shown) == sorted(pldf.__all__)


@cache
def options_of(command: str) -> frozenset[str]:
    """All option strings of ``pldf COMMAND``, those of its actions included."""
    parser = argparse.ArgumentParser(prog=command)
    import_module(f"pldf.commands.{command}").configure(parser)
    found: set[str] = set()
    parsers = [parser]
    while parsers:
        for action in parsers.pop()._actions:
            found.update(action.option_strings)
            if isinstance(action, argparse._SubParsersAction):
                found.update(action.choices)
                parsers.extend(action.choices.values())
    return frozenset(found)


def commands_in(line: str) -> Iterator[list[str]]:
    """The calls of ``pldf`` in a line of a shell, split into words."""
    plain = line.replace(".venv\\Scripts\\", "").replace(".venv/bin/", "").replace("\\", "/")
    try:
        words = shlex.split(plain, comments=True)
    except ValueError:  # an apostrophe in running text
        return
    while "pldf" in words:
        words = words[words.index("pldf") + 1 :]
        yield list(takewhile(lambda word: word not in {"&&", "|", ";"}, words))


@ALL
def test_every_command_and_option_is_there(page: Path) -> None:
    for line in code_lines(text_of(page)):
        for command, *words in filter(None, commands_in(line)):
            if command in {"COMMAND", "...", "X"} or command.startswith("-"):
                continue
            assert command in COMMANDS, line
            for word in words:
                if word.startswith("--") and word != "--help":
                    assert word in options_of(command), f"{line}: no option {word}"
                if command == "profiles" and word == words[0] and "/" not in word:
                    assert word.split("|")[0] in options_of(command), line


@ALL
def test_every_target_of_make_is_there(page: Path) -> None:
    targets = re.findall(r"^([\w-]+):", text_of(ROOT / "Makefile"), re.MULTILINE)
    for line in code_lines(text_of(page)):
        for target in re.findall(r"^make ([a-z][\w-]*)", line):
            assert target in targets, line


def test_every_variable_named_is_one_of_an_fmu(traffic_fmus: dict[str, Fmu]) -> None:
    fmus = traffic_fmus
    names = {name for fmu in fmus.values() for name in fmu.signals}
    vehicle = {f"vehicle.{name}" for name in fmus["vehicle"].signals}
    parted = {f"{part}.{name}" for part, fmu in fmus.items() for name in fmu.signals}
    known = names | vehicle | parted
    groups = {name.split(".")[0] for name in names if "." in name}
    checked = 0
    for page in PAGES:
        for code in spans(text_of(page)):
            name = code.split("=")[0].strip()
            if name.endswith(FILE_ENDINGS) or not VARIABLE.fullmatch(name):
                continue
            if name.split(".")[0] in groups:
                assert name in known, f"{page.name}: {name}"
                checked += 1
    assert checked > 20


@pytest.mark.parametrize("page", [ROOT / "docs" / "simulator.md", ROOT / "docs" / "vehicle.md"])
def test_first_columns_of_tables_are_variables(page: Path, fmus: dict[str, Fmu]) -> None:
    known = {name for fmu in fmus.values() for name in fmu.signals}
    rows = [line.split("|")[1:-1] for line in text_of(page).splitlines() if line.startswith("|")]
    checked = 0
    inside = False
    for at, row in enumerate(rows):
        if at + 1 < len(rows) and set(rows[at + 1][0]) == {"-"}:
            inside = row[0].strip() in NAME_TABLES
        elif inside:
            for name in re.findall(r"`([^`]+)`", row[0]):
                assert name in known, name
                checked += 1
    assert checked > 10


def test_what_make_docs_writes_beside_the_pages_is_linked() -> None:
    linked = {
        address
        for page in (ROOT / "docs").glob("*.md")
        for address in re.findall(r'<a href="([^"]+)">', text_of(page))
    }
    assert linked == set(re.findall(r"--export site/(\S+)", text_of(ROOT / "Makefile")))


def test_the_site_builds_without_warnings_and_fetches_nothing(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(tmp_path)]
    result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
    pages = list(tmp_path.rglob("*.html"))
    assert len(pages) > len(list((ROOT / "docs").glob("*.md")))  # and 404.html
    for page in pages:
        fetched = re.findall(r"<(?:script|img|iframe)[^>]*\bsrc=[\"']?([^\"' >]+)", text_of(page))
        fetched += re.findall(r"<link[^>]*\bhref=[\"']?([^\"' >]+)", text_of(page))
        assert fetched
        assert not [address for address in fetched if re.match(r"(?:https?:)?//", address)]
    for style in tmp_path.rglob("*.css"):
        assert not re.findall(r"(?:url\(|@import)\s*[\"']?(?:https?:)?//", text_of(style))


def test_ci_runs_what_readme_says_for_windows() -> None:
    (lines,) = blocks(text_of(ROOT / "README.md"), "powershell")
    assert any("pytest" in line for line in lines)
    workflow = text_of(ROOT / ".github" / "workflows" / "ci.yml")
    assert "python tests/support/readme_commands.py" in workflow


def test_every_section_of_the_algorithm_that_is_cited_is_there() -> None:
    text = text_of(ROOT / "docs" / "algorithm.md")
    sections = {*re.findall(r"^## (\d)", text, re.MULTILINE)}
    third = text[text.index("## 3") : text.index("## 4")]
    sections |= {f"3.{number}" for number in re.findall(r"^(\d+)\. ", third, re.MULTILINE)}
    folders = ("fmu_src", "vehicle_models", "tests/kernel", "tests/study")
    cited = {
        number
        for folder in folders
        for path in (ROOT / folder).rglob("*.py")
        for line in text_of(path).splitlines()
        for number in re.findall(r"(?i)\bsections? (\d(?:\.\d)?)", line)
        if "FMI" not in line and "standard" not in line
    }
    assert {"1", "3.7", "5"} <= cited
    assert cited <= sections, cited - sections


def test_the_version_is_the_same_everywhere() -> None:
    version = pldf.__version__
    assert f"adaptive_pldf-{version}-py3-none-any.whl" in text_of(ROOT / "README.md")
    assert f"\nversion: {version}\n" in text_of(ROOT / "CITATION.cff")
    assert re.search(rf"^## \[{version}\] - ", text_of(ROOT / "CHANGELOG.md"), re.MULTILINE)
    assert f"Adaptive PLDF {version}" in text_of(ROOT / "ssp" / "SystemStructure.ssd")
