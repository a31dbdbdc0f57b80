"""The command line as a whole: what a call imports, and what it says of all commands."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest
from pldf import cli
from pldf.commands import COMMANDS

FOLDER = Path(cli.__file__).parent / "commands"
HEAVY = {"fmpy", "matplotlib", "numba", "plotly", "pythonfmu", "rich", "scipy"}


def imported(*arguments: str) -> set[str]:
    """Return the names of all modules that a process has imported at the end of a call."""
    code = (
        "import json, sys\n"
        "from pldf import cli\n"
        "try:\n"
        "    status = cli.main(sys.argv[1:])\n"
        "except SystemExit as stop:\n"
        "    status = stop.code\n"
        "print(json.dumps([status, sorted(sys.modules)]))"
    )
    result = subprocess.run(
        [sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=True
    )
    status, names = json.loads(result.stdout.splitlines()[-1])
    assert status == 0, result.stderr
    return set(names)


def test_help_imports_neither_a_command_nor_numpy() -> None:
    names = imported("--help")
    assert {name for name in names if name.startswith("pldf.")} == {
        "pldf.cli",
        "pldf.commands",
        "pldf.errors",
    }
    assert not names & (HEAVY | {"numpy"})


def test_the_help_of_a_command_imports_that_command_alone() -> None:
    commands = {
        name
        for name in imported("route", "--help")
        if name.startswith("pldf.commands.") and not name.startswith("pldf.commands.shared")
    }
    assert commands == {"pldf.commands.route"}


def test_a_route_is_shown_without_what_drives_draws_or_tests() -> None:
    names = imported("route", "study")
    assert not names & HEAVY
    rooms = {"analysis", "build", "profiles", "recordings", "report", "study"}
    assert not {name for name in names if name.startswith("pldf.") and name.split(".")[1] in rooms}


def test_help_lists_every_command_with_its_summary(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        cli.main(["--help"])
    text = " ".join(capsys.readouterr().out.split())
    assert stop.value.code == 0
    for name, summary in COMMANDS.items():
        assert f"{name} {summary}" in text


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_explains_itself_with_an_example(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as stop:
        cli.main([name, "--help"])
    text = capsys.readouterr().out
    assert stop.value.code == 0
    assert f"usage: pldf {name} " in text
    assert COMMANDS[name] in " ".join(text.split())
    assert f"example:\n  {import_module(f'pldf.commands.{name}').EXAMPLE}" in text


def test_every_module_with_a_command_is_listed() -> None:
    runs = {path.stem for path in FOLDER.glob("*.py") if "\ndef run(" in path.read_text("utf-8")}
    assert runs == set(COMMANDS)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["rout"], "invalid choice: 'rout'"),
        ([], "the following arguments are required: COMMAND"),
        (["drive", "--set", "learning.weight"], "write learning.weight=VALUE"),
        (["study", "--set", "wish.offset_mps"], "write wish.offset_mps=VALUE"),
        (["learn", "--set", "learning.weight"], "write learning.weight=VALUE"),
        (["--verbose", "route", "study"], "unrecognized arguments: --verbose"),
    ],
)
def test_wrong_usage_is_told_apart_from_bad_input(
    arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as stop:
        cli.main(arguments)
    assert stop.value.code == 2
    assert said in capsys.readouterr().err
    assert cli.main(["route", "nowhere.xodr"]) == 1
    assert "nowhere.xodr" in capsys.readouterr().err


def test_what_the_system_refuses_is_told_with_the_file_and_a_way_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("no folder")
    out = tmp_path / "file" / "dist"
    assert cli.main(["build", "--only", "AdaptivePLDF", "--out", str(out)]) == 1
    shown = capsys.readouterr()
    assert shown.out.endswith("failed\n")
    (line,) = shown.err.splitlines()
    assert line.startswith(f"pldf: {out}: cannot be read or written (")
    assert line.endswith("); check path and permissions")
