"""Names of roads and signs: as lines of prepared routes and CSV files, and in words."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pldf.cosim.prepared import prepared_route
from pldf.roads import Mark, Route, read_route, write_route_csv
from pldf.roads.marks import mark_lines, marks_in, plain_name, road_words
from two_readings import older_reading

MARKS = (
    Mark(0.0, "road", "12 Hauptstra\N{LATIN SMALL LETTER SHARP S}e"),
    Mark(0.1 + 0.2, "sign", "50 km/h sign"),
    Mark(1234.5678, "road", "7", against=True),
    Mark(2999.9996, "road", "3"),
)


def named() -> Route:
    return replace(older_reading(), marks=MARKS)


def test_an_exported_csv_has_the_marks_to_the_bit(tmp_path: Path) -> None:
    path = tmp_path / "road.csv"
    write_route_csv(named(), path)
    again = read_route(path)
    assert again.marks == MARKS
    assert not again.notes
    for name, values in named().knots.items():
        assert np.array_equal(again.knots[name], values)
    write_route_csv(again, tmp_path / "again.csv")
    ours, theirs = (file.read_text().split("\n", 1) for file in (path, tmp_path / "again.csv"))
    assert ours[1] == theirs[1]  # the first line names the route, which is the file's name


def test_who_changes_the_road_loses_its_names(tmp_path: Path) -> None:
    """They would stand at other places."""
    path = tmp_path / "road.csv"
    write_route_csv(named(), path)
    text = path.read_text()
    assert text.count("\n# mark ") == 4
    lines = text.splitlines()
    del lines[-3]
    path.write_text("\n".join([*lines, ""]))
    assert read_route(path).marks == ()


def test_marks_beyond_the_road_and_other_comments_are_passed_over() -> None:
    lines = ["mark 7.5 road 1", "mark 99.0 road 2", "mark nan road 3", "mark x road 4", "marked"]
    lines += ["mark 2.5 sign 50", "mark 3 kind 5", "mark 3 road "]
    assert marks_in(lines, 50.0) == (Mark(2.5, "sign", "50"), Mark(7.5, "road", "1"))


@pytest.mark.parametrize(
    ("name", "plain"),
    [
        ("a\nb\tc", "a b c"),
        ("  ", "?"),
        ("\x7f", "?"),
        ("n" * 200, "n" * 80),
        ("\N{CJK UNIFIED IDEOGRAPH-8ECA}" * 40, "\N{CJK UNIFIED IDEOGRAPH-8ECA}" * 26),
        ("\ud800", "?"),
    ],
)
def test_names_fit_into_a_line(name: str, plain: str) -> None:
    assert plain_name(name) == plain
    (line,) = mark_lines([Mark(1.0, "road", name)], exact=False)
    assert line == f"mark 1000 road {plain}"


def test_a_prepared_route_names_them_in_its_header() -> None:
    lines = prepared_route(named()).split(b"\nend")[0].decode().split("\n")
    assert lines[0] == "PLDF-PREPARED 2"
    assert lines[6:] == [
        "marks 4",
        "mark 0 road 12 Hauptstra\N{LATIN SMALL LETTER SHARP S}e",
        "mark 300 sign 50 km/h sign",
        "mark 1234568 road_against 7",
        "mark 3000000 road 3",
    ]
    assert prepared_route(older_reading()).startswith(b"PLDF-PREPARED 1\n")


def test_words_name_the_roads_of_a_place_where_there_are_several() -> None:
    assert road_words(MARKS, 10.0, 20.0) == " (road 12 Hauptstra\N{LATIN SMALL LETTER SHARP S}e)"
    assert road_words(MARKS, 1234.568, 2000.0) == " (road 7)"
    assert road_words(MARKS, 1234.567, 2000.0).endswith("e to road 7)")
    assert road_words(MARKS[:2], 10.0, 20.0) == ""
    assert road_words((), 10.0, 20.0) == ""
