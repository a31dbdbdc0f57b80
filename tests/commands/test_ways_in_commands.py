"""Every command that takes a road takes the same options, and so does a study file."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

import pytest
from networks import crossing
from pldf import cli
from pldf.cli import COMMANDS
from pldf.cosim.road_values import road_values
from pldf.errors import ModelError
from pldf.roads import Road, RoadOptions, open_road, read_route
from pldf.study.study_file import read_study

OPTIONS = {
    "--start-road", "--via", "--to", "--reverse",
    "--default-limit", "--limit-unit", "--no-signs", "--smoothing",
}  # fmt: skip


def _parsers(parser: argparse.ArgumentParser) -> Iterator[argparse.ArgumentParser]:
    yield parser
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for each in action.choices.values():
                yield from _parsers(each)


def test_every_command_that_takes_a_road_takes_all_its_options() -> None:
    with_road = 0
    for command in COMMANDS:
        for parser in _parsers(cli.build_parser(command)):
            options = {name for action in parser._actions for name in action.option_strings}
            takes_road = any(action.dest == "road" for action in parser._actions)
            assert not takes_road or options >= OPTIONS, parser.prog
            assert takes_road or "--route" not in options, parser.prog
            with_road += takes_road
    assert with_road >= 7


@pytest.fixture
def town(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "town.xodr"
    path.write_text(crossing().text, encoding="utf-8")
    return path


def _way(road: Road) -> list[str]:
    """Return the roads of a way, those driven against with a minus."""
    marks = [mark for mark in road.route.marks if mark.kind == "road"]
    return [f"{'-' if mark.against else ''}{mark.name}" for mark in marks]


def _study(town: Path, keys: str) -> Path:
    path = town.with_name("my.toml")
    path.write_text(f'[participants]\ncount = 1\n[road]\nroute = "town.xodr"\n{keys}\n')
    return path


@pytest.mark.parametrize(
    "keys",
    ['start_road = "w"\nvia = ["we"]\nto = "e"', 'start_road = "w"\nvia = ["we,e"]\nto = "e"'],
)
def test_a_study_file_names_a_way(town: Path, keys: str) -> None:
    road = read_study(_study(town, keys)).settings.road
    assert _way(road) == ["w", "we", "e"]
    reverse = read_study(_study(town, 'start_road = "e"\nreverse = true\nto = "n"')).settings.road
    assert _way(reverse) == ["-e", "en", "n"]


def test_ids_in_a_study_file_may_be_numbers(town: Path) -> None:
    town.write_text(crossing().text.replace('"w"', '"12"'), encoding="utf-8")
    road = read_study(_study(town, 'start_road = 12\nvia = ["we"]\nto = "e"')).settings.road
    assert _way(road) == ["12", "we", "e"]
    with pytest.raises(ModelError, match=r"road.via: \[1.5\] must be a list of the ids of roads"):
        read_study(_study(town, "via = [1.5]"))


def test_a_study_file_is_told_which_keys_it_needs(town: Path) -> None:
    with pytest.raises(ModelError, match=r"my.toml, line 4, road.route: .*junction J leads") as no:
        read_study(_study(town, 'start_road = "w"'))
    assert str(no.value).endswith(
        'say where to go: start_road = "w", via = ["s"] (or e, n); start_road = "w", to = "w" '
        "ends the way here"
    )


def test_fmus_are_handed_the_way_that_was_named(town: Path, tmp_path: Path) -> None:
    road = open_road(str(town), RoadOptions(start_road="w", to="e"))
    told = road_values(road, tmp_path)
    again = read_route(str(told["route_file"]))
    assert again.length_m == road.route.length_m == pytest.approx(220.0)
