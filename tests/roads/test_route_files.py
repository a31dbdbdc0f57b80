"""Route CSV files: what is read, and what is said about files that cannot be."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from pldf.errors import ModelError
from pldf.roads import Route, read_route, write_route_csv

HEADER = "s_m,curvature_per_m,speed_limit_mps"


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "road.csv"


def test_the_shortest_useful_file(path: Path) -> None:
    path.write_text(f"{HEADER}\n0,0,20\n50,0.01,10\n100,0,10\n")
    route = read_route(path)
    assert (route.name, route.length_m, route.has_line) == ("road", 100.0, False)
    assert list(route.speed_limit_mps) == [20.0, 10.0, 10.0]
    assert list(route.grade) == [0.0, 0.0, 0.0]


def test_columns_may_come_in_any_order(path: Path) -> None:
    path.write_text(
        "y_m,x_m,speed_limit_mps,curvature_per_m,s_m,grade\n1,2,20,0,0,.01\n1,9,20,0,7,0\n"
    )
    route = read_route(path)
    assert route.has_line
    assert list(route.x_m) == [2.0, 9.0]
    assert list(route.grade) == [0.01, 0.0]


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_comments_byte_order_mark_and_line_ends_do_not_matter(path: Path, newline: str) -> None:
    lines = ["# from a survey", "", "# in May", HEADER, "0,0,20", "", "9,0,20", ""]
    path.write_bytes(b"\xef\xbb\xbf" + newline.join(lines).encode())
    assert read_route(path).length_m == 9.0


def test_a_route_without_a_line_is_written_without_one(path: Path) -> None:
    s = np.array([0.0, 9.0])
    write_route_csv(Route("bare", s, 0 * s, 0 * s + 9, 0 * s, 0 * s, 0 * s, has_line=False), path)
    assert "x_m" not in path.read_text()
    assert not read_route(path).has_line


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the file is empty"),
        ("# only\n# comments\n", "no header"),
        (f"{HEADER}\n", "no knots below the header .line 1"),
        (f"{HEADER}\n# nothing\n", "no knots below the header"),
        ("s_m,speed_limit_mps\n0,1\n", "line 1: missing column curvature_per_m"),
        ("# c\ns_m,kappa\n0,1\n", "line 2: missing column curvature_per_m, speed_limit_mps"),
        ("s;curvature\n0;1\n", "missing column s_m, curvature_per_m, speed_limit_mps"),
        (f"{HEADER},x_m\n0,0,9,1\n", "missing column y_m"),
        (f"{HEADER},grad\n0,0,9,1\n", "unknown column grad"),
        (f"{HEADER},s_m\n0,0,9,1\n", "repeated column s_m"),
        (f"{HEADER}\n0,0,9\n5,0\n9,0,9\n", "line 3: 2 values for 3 columns"),
        (f"{HEADER}\n0,0,9,4\n5,0,9,4\n", "line 2: 4 values for 3 columns"),
        (f"# c\n{HEADER}\n0,0,9\n\n5,zero,9\n", "line 5, curvature_per_m: 'zero' is not a number"),
        (f"{HEADER}\n0,0,9\n5,,9\n", "line 3, curvature_per_m: '' is not a number"),
        (f"{HEADER}\n0,0,9\n5,nan,9\n", "line 3, curvature_per_m: 'nan' is not a number"),
        (f"{HEADER}\n0,0,9\n# c\n5,0,inf\n", "line 4, speed_limit_mps: 'inf' is not a number"),
        (
            f"{HEADER},grade\n0,0,9,0\n5,0,9,5\n",
            "line 3, grade: '5' is not rise over run, such as 0.05",
        ),
        (f"{HEADER}\n0,0,9\n5,0,0\n", "line 3: speed_limit_mps = 0; a limit must be above 0"),
        (f"{HEADER}\n0,0,9\n5,0,-4\n", "line 3: speed_limit_mps = -4"),
        (f"{HEADER}\n0,0,100\n5,0,100\n", "line 2: .* above 300 km/h; is the unit right"),
        (f"{HEADER}\n0,0,9\n5,0,9\n4,0,9\n", "line 4: s_m = 4 lies before the previous one"),
        (f"{HEADER}\n0,0,9\n5,0,9\n5,0,9\n5,0,9\n", "line 5: s_m = 5 for the third time"),
        (f"{HEADER}\n2,0,9\n5,0,9\n", "line 2: s_m starts at 2; it must start at 0"),
        (f"{HEADER}\n0,0,9\n0,0,9\n", "line 3: the route is 0 m long"),
        (f"{HEADER}\n0,0,9\n", "line 2: the route is 0 m long"),
    ],
)
def test_a_bad_file_is_refused_with_its_line(path: Path, text: str, message: str) -> None:
    path.write_text(text)
    with pytest.raises(ModelError, match=message) as caught:
        read_route(path)
    assert str(caught.value).startswith(str(path))
    assert str(caught.value).count("\n") <= 1


def test_a_file_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"nowhere\.csv: cannot be read .No such file"):
        read_route(tmp_path / "nowhere.csv")
    with pytest.raises(ModelError, match="cannot be read"):
        read_route(tmp_path)


def test_a_binary_file_is_refused(path: Path) -> None:
    path.write_bytes(f"{HEADER}\n0,0,9\n".encode() + b"\x80\x04\x95")
    with pytest.raises(ModelError, match="line 3: not UTF-8 text; save the file as UTF-8"):
        read_route(path)
    path.write_bytes(b"\x80\x04\x95\0\0\0" * 9)
    with pytest.raises(ModelError, match="line 1: a zero byte, which is no text"):
        read_route(path)


def test_how_a_route_was_read_is_told(tmp_path: Path) -> None:
    path = tmp_path / "road.csv"
    path.write_text('"s_m";"curvature_per_m";"speed_limit_mps"\n0;0,0;13,8889\n900;0;13,8889\n')
    route = read_route(path)
    assert (route.length_m, route.speed_limit_mps.tolist()) == (900.0, [13.8889, 13.8889])
    assert [note.text for note in route.notes] == [
        "semicolons separate the columns",
        "decimal commas: 0,0 is read as 0",
    ]
