"""OpenDRIVE read in blocks: nothing depends on where they end; what nobody reads is left out."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
import pytest
from opendrive_text import RIGHT_100, SHAPES, geometry, road, straight
from pldf.errors import ModelError
from pldf.roads import (
    RoadOptions,
    Route,
    per_metre,
    route_arrays,
)
from pldf.roads.knots import knots
from pldf.roads.load import read_route
from pldf.roads.opendrive import geometry as shapes
from pldf.roads.opendrive import quadrature, xml_parser
from pldf.roads.opendrive.plan_view import PlanView
from pldf.roads.opendrive.xml_tree import Element
from pldf.roads.opendrive_file import parse_opendrive

Reader = Callable[..., Route]


def _parsed(blocks: Iterable[bytes]) -> Route:
    return parse_opendrive(blocks, Path("town.xodr"), RoadOptions())


def _mixed() -> str:
    """Return a road with a geometry of each kind, each at the end of the one before."""
    plan, s_m, x, y = "", 0.0, 0.0, 0.0
    for shape in SHAPES.values():
        alone = f"<OpenDRIVE>{road('1', geometry(0, 80, shape), length=80)}</OpenDRIVE>"
        plan += geometry(s_m, 80, shape, f'x="{x!r}" y="{y!r}" hdg="0"')
        end = _parsed([alone.encode()])
        s_m, x, y = s_m + 80.0, x + float(end.x_m[-1]), y + float(end.y_m[-1])
    return road(
        "1", plan + geometry(s_m, 0.5, pose=f'x="{x!r}" y="{y!r}" hdg="0"'), length=s_m + 0.5
    )


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "gb18030", "shift_jis"])
def test_a_letter_or_a_tag_may_end_in_another_block(encoding: str) -> None:
    text = (
        f'<?xml version="1.0" encoding="{encoding}"?>\n<OpenDRIVE>\n<header name="田中通り"/>\n'
        f"{_mixed()}\n</OpenDRIVE>"
    )
    data = text.encode(encoding)
    whole = _parsed([data])
    head = data.index("header".encode(encoding)[-12:])  # the declaration stands in the first block
    parts = _parsed([data[:head], *(data[k : k + 7] for k in range(head, len(data), 7))])
    assert parts.name == "田中通り"
    assert (parts.name, parts.notes, parts.marks) == (whole.name, whole.notes, whole.marks)
    for name, values in whole.knots.items():
        np.testing.assert_array_equal(parts.knots[name], values)


def test_what_is_not_the_declared_encoding_is_told_with_its_line_in_any_block() -> None:
    data = b'<?xml version="1.0" encoding="UTF-8"?>\n<OpenDRIVE>\n\n\n<header name="\xe4"/>'
    with pytest.raises(ModelError, match="line 5: not UTF-8, which the file seems to be"):
        _parsed([data[:45], data[45:60], data[60:]])


@pytest.mark.parametrize("options", [{}, {"start_road": "1", "reverse": True}])
def test_no_bit_depends_on_how_many_knots_are_computed_together(
    read: Reader, monkeypatch: pytest.MonkeyPatch, options: dict[str, object]
) -> None:
    whole = read(_mixed(), **options)
    arrays = route_arrays(whole)
    for module, count in ((knots, 5), (shapes, 3), (quadrature, 1), (per_metre, 2)):
        monkeypatch.setattr(module, "_AT_ONCE", count)
    parts = read(_mixed(), **options)
    for name, values in whole.knots.items():
        np.testing.assert_array_equal(parts.knots[name], values)
    for found, expected in zip(route_arrays(parts), arrays, strict=True):
        np.testing.assert_array_equal(found, expected)


def test_geometries_and_what_nobody_reads_are_no_elements(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[str] = []

    def counted(tag: str, attributes: dict[str, str], line: int) -> Element:
        made.append(tag)
        return Element(tag, attributes, line)

    monkeypatch.setattr(xml_parser, "Element", counted)
    plan = "".join(geometry(k, 1, "<line/><userData/>") for k in range(100))
    objects = "<objects><object><outline/><objects/></object></objects>" * 100
    path = tmp_path / "town.xodr"
    path.write_text(f"<OpenDRIVE>{road('1', plan, inside=RIGHT_100 + objects)}</OpenDRIVE>")
    assert read_route(path).length_m == 100.0
    assert sorted(made) == ["", "OpenDRIVE", "link", "road", "speed", "type"]
    assert PlanView.__slots__ == ("first", "stop", "table")


def test_prefixes_order_and_further_shapes_do_not_matter(read: Reader) -> None:
    plan = (
        '<x:geometry hdg="0" length="50" y="0" x="0" s="0" more="1"><x:userData><arc/></x:userData>'
        '<x:arc curvature="0.01"/><x:line/></x:geometry><other><geometry s="9"/></other>'
        + geometry(50, 50, pose='x="47.94255386" y="12.2417438" hdg="0.5"')
    )
    route = read(road("1", plan).replace("<planView>", '<planView xmlns:x="y">'))
    np.testing.assert_array_equal(route.curvature_per_m[route.s_m < 50.0], 0.01)
    np.testing.assert_array_equal(route.curvature_per_m[route.s_m > 50.0], 0.0)


def test_all_faults_of_a_road_are_told_at_once_and_those_of_others_are_none(read: Reader) -> None:
    bad = (
        geometry(0, 50, pose='x="1e999" hdg="zero"')
        + "\n" + geometry(50, 25, '<arc curvature="--1"/>')
        + "\n" + geometry(75, 25, "<spiral/>")
    )  # fmt: skip
    with pytest.raises(ModelError) as caught:
        read(road("1", bad))
    first, others = str(caught.value).split("\n")
    assert first.endswith(
        "line 7, road 1: <geometry> attribute hdg = 'zero' is not a finite number"
    )
    assert others == (
        "  also line 7: <geometry> attribute x = '1e999' is not a finite number;"
        " line 7: <geometry> attribute y is missing;"
        " line 8: <arc> attribute curvature = '--1' is not a finite number; and 2 more"
    )
    assert read(straight("1"), road("2", bad), start_road="1").length_m == 100.0


# Each of eight entities is thirty times the one before: a name of 10 GB.
BOMB = "".join(
    f'<!ENTITY {new} "{f"&{old};" * 30}">' for old, new in zip("abcdefg", "bcdefgh", strict=True)
)
BOMB = (
    f'<?xml version="1.0"?><!DOCTYPE o [<!ENTITY a "ha">{BOMB}]>\n<OpenDRIVE><header name="&h;"/>'
)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (f"<OpenDRIVE>{straight('1')}", r"line 7: .*no element found\); is the file whole\?"),
        (f"<OpenDRIVE>{straight('1')[:90]}", r"line 3: .*unclosed token\); is the file whole\?"),
        (BOMB, "line 2: not well-formed XML .*amplification"),
    ],
)
def test_a_file_that_is_cut_off_or_blows_itself_up_is_refused(
    tmp_path: Path, text: str, message: str
) -> None:
    path = tmp_path / "town.xodr"
    path.write_text(text)
    with pytest.raises(ModelError, match=message) as caught:
        read_route(path)
    assert len(str(caught.value)) < 300


def test_a_number_of_megabytes_is_shown_by_its_beginning(read: Reader) -> None:
    with pytest.raises(ModelError, match=r"curvature = '1{40}' is not a finite number") as caught:
        read(road("1", geometry(0, 100, f'<arc curvature="{"1" * 6_000_000}"/>')))
    assert len(str(caught.value)) < 300
