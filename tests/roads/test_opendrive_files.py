"""OpenDRIVE: what is said about files as a whole."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from opendrive_text import SHAPES, geometry, road, straight
from pldf.errors import ModelError
from pldf.roads import Route, read_route
from pldf.roads.opendrive import xml_parser
from pldf.roads.opendrive.xml_tree import Element

Reader = Callable[..., Route]


@pytest.mark.parametrize(
    "before", ["\ufeff", "<!-- <OpenDRIVE> by hand -->\n", "exported\n\n", "\n"]
)
def test_text_before_the_xml_is_skipped_and_lines_still_count(read: Reader, before: str) -> None:
    assert read(straight("1"), before=before).length_m == 100.0
    with pytest.raises(ModelError, match=f"line {3 + before.count(chr(10))}, road 1: no planView"):
        read(road("1", ""), before=before)


def test_the_name_comes_from_the_header_else_from_the_file(read: Reader) -> None:
    assert read('<header name=" B 85 "/>', straight("1")).name == "B 85"
    assert read(straight("1")).name == "town"


def test_a_prefix_or_default_namespace_does_not_matter(tmp_path: Path) -> None:
    path = tmp_path / "ns.xodr"
    path.write_text(f'<OpenDRIVE xmlns="http://code.asam.net/x">{straight("1")}</OpenDRIVE>')
    assert read_route(path).length_m == 100.0


@pytest.mark.parametrize(
    ("encoding", "declared"),
    [
        ("utf-8", "UTF-8"), ("utf-16", "UTF-16"), ("utf-16-le", "UTF-16"),
        ("utf-16-be", "UTF-16BE"), ("utf-32", "UTF-32"), ("latin-1", "ISO-8859-1"),
        ("gb2312", "GB2312"), ("gb18030", "GB18030"),
        ("shift_jis", "Shift_JIS"), ("utf-8-sig", "GB2312"),
    ],
)  # fmt: skip
def test_a_road_may_be_in_every_encoding_that_it_declares(
    tmp_path: Path, encoding: str, declared: str
) -> None:
    name = {"gb2312": "\u9053\u8def", "gb18030": "\u9053\u8def", "shift_jis": "\u9053\u8def"}
    named = name.get(encoding, "Stra\u00dfe")
    path = tmp_path / "road.xodr"
    text = f'<OpenDRIVE>\n<header name="{named}"/>\n{straight("1")}</OpenDRIVE>'
    path.write_bytes(f'<?xml version="1.0" encoding="{declared}"?>\n{text}'.encode(encoding))
    route = read_route(path)
    assert (route.name, route.length_m) == (named, 100.0)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b'<?xml version="1.0" encoding="u2f-8"?>', "line 1: unknown encoding 'u2f-8'; save the"),
        (b'x\n<?xml version="1.0" encoding="UTF-8"?>\n<!--\xfc', "line 3: not UTF-8, which the"),
        (b'<?xml version="1.0" encoding="GB2312"?>\n<!--\xfc', "line 2: not GB2312, which the"),
        (b"\xff\xfe<\0O\0p\0e", "line 1: not UTF-16-LE, which the file"),
    ],
)
def test_a_road_that_cannot_be_decoded_is_refused_with_its_line(
    tmp_path: Path, data: bytes, message: str
) -> None:
    path = tmp_path / "road.xodr"
    path.write_bytes(data)
    with pytest.raises(ModelError, match=message):
        read_route(path)


@pytest.mark.parametrize(
    ("roads", "message"),
    [
        ("", "line 2: no <road> in this file"),
        ("<road", "not well-formed XML"),
        (road("1", geometry(0, 100), length=0), "line 3, road 1: length 0 m"),
        (road("1", geometry(0, 1e18), length=1e18), "line 3, road 1: length 1e.18 m is beyond"),
        (road("1", ""), "road 1: no planView/geometry"),
        (road("1", geometry(0, 100, "<circle/>")), "road 1: no line, arc, spiral"),
        (
            road("1", geometry(0, 100, '<arc curvature="nan"/>')),
            "line 7, road 1: <arc> attribute curvature = 'nan' is not a finite number",
        ),
        (road("1", geometry(0, 100, "<arc/>")), "<arc> attribute curvature is missing"),
        (road("1", geometry(0, 100, '<arc curvature="3"/>')), "tighter than 1 m"),
        (road("1", geometry(0, 1), length=1), "the route is 1 m long"),
        (
            road("1", geometry(0, 100, SHAPES["normalized"].replace("normalized", "arcLength"))),
            "line 7, road 1: the polynomial is .* check length and pRange",
        ),
        (
            road("1", geometry(0, 100, SHAPES["normalized"].replace("normalized", "per cent"))),
            "line 7, road 1: <paramPoly3> attribute pRange is neither arcLength nor normalized",
        ),
        (
            straight("1", inside='<type s="0"><speed max="0"/></type>'),
            r"line 5, road 1: speed limit 0 m/s \(no unit given\) must lie above 0",
        ),
        (straight("1", inside='<type s="0"><speed max="-50" unit="mph"/></type>'), "limit -50 mph"),
        (straight("1", inside='<type s="0"><speed max="100"/></type>'), "limit 100 m/s .no unit"),
        (straight("1", inside='<type s="0"><speed max="9" unit="knots"/></type>'), "unit 'knots'"),
        (straight("1", inside='<type s="0"><speed max="fast"/></type>'), "max = 'fast' is not"),
        (straight("1", inside='<type s="0"><speed max="1_0"/></type>'), "max = '1_0' is not"),
        (straight("1", inside='<type s="0"><speed max="\u0661"/></type>'), "max = '\u0661' is not"),
        (road("1", geometry(0, 100, '<arc curvature="0.0_1"/>')), "curvature = '0.0_1' is not"),
        (straight("1", inside='<type s="0"><speed unit="mph"/></type>'), "max is missing"),
    ],
)
def test_an_unusable_file_is_refused_with_its_line(read: Reader, roads: str, message: str) -> None:
    with pytest.raises(ModelError, match=message) as caught:
        read(roads)
    assert "town.xodr" in str(caught.value)
    assert str(caught.value).count("\n") <= 1


def test_elements_that_are_never_closed_are_told_where_they_pile_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At once: 9 MB of them took 26 s and 1.2 GB; elements of its own tools a file may have."""
    made = []
    monkeypatch.setattr(xml_parser, "Element", lambda *a: made.append(a) or Element(*a))
    path = tmp_path / "open.xodr"
    path.write_bytes(b"<OpenDRIVE>\n" + b"<road>\n" * 1_300_000)
    with pytest.raises(
        ModelError, match=r"open\.xodr, line 65: .* <road> of line 64 is not closed"
    ):
        read_route(path)
    assert len(made) == 65  # with the document
    own = "<userData>" * 50 + "</userData>" * 50
    path.write_text(f"<OpenDRIVE>{straight('1')}{own}</OpenDRIVE>")
    assert read_route(path).length_m == 100.0


def test_another_xml_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "map.xodr"
    path.write_text("<osm/>")
    with pytest.raises(ModelError, match="line 1: <osm> where <OpenDRIVE> should be"):
        read_route(path)


PLACE = '<?xml version="1.0" encoding="{0}"?>\n<OpenDRIVE><header name="{1}"/>{2}</OpenDRIVE>'


@pytest.mark.parametrize(
    ("declared", "written", "name"),
    [
        ("GB2312", "gb2312", "测试路"),
        ("GBK", "gbk", "朱镕基路"),
        ("Shift_JIS", "cp932", "田中通り"),
        ("EUC-JP", "euc_jp", "道路"),
        ("windows-1252", "cp1252", "Straße"),
        ("UTF-16", "utf-16", "Straße"),
        ("utf-16", "utf-16-le", "Straße"),
    ],
)
def test_roads_are_read_in_the_encoding_that_they_declare(
    tmp_path: Path, declared: str, written: str, name: str
) -> None:
    path = tmp_path / "town.xodr"
    path.write_bytes(PLACE.format(declared, name, straight("1")).encode(written))
    route = read_route(path)
    assert (route.name, route.length_m, route.notes) == (name, 100.0, ())


@pytest.mark.parametrize(
    ("declared", "written"),
    [("UTF-16", "utf-8"), ("utf-32", "utf-8"), ("GB2312", "utf-8-sig"), ("UTF16", "utf-8-sig")],
)
def test_a_declaration_that_is_not_true_is_told(
    tmp_path: Path, declared: str, written: str
) -> None:
    path = tmp_path / "town.xodr"
    path.write_bytes(PLACE.format(declared, "Straße", straight("1")).encode(written))
    route = read_route(path)
    (note,) = route.notes
    assert route.name == "Straße"
    assert str(note).endswith(f"line 1: declares {declared} and is in UTF-8, as which it was read")


@pytest.mark.parametrize(
    ("declared", "written", "name", "larger"),
    [("gb2312", "gbk", "朱镕基路", "GB18030"), ("Shift_JIS", "cp932", "髙橋通り", "CP932")],
)
def test_letters_beyond_the_declared_set_are_read_and_told(
    tmp_path: Path, declared: str, written: str, name: str, larger: str
) -> None:
    path = tmp_path / "town.xodr"
    path.write_bytes(PLACE.format(declared, name, straight("1")).encode(written))
    route = read_route(path)
    assert route.name == name
    assert f"has letters that only {larger} has" in str(route.notes[0])


@pytest.mark.parametrize(
    ("declared", "message"),
    [
        ("undefined", "line 1: not UNDEFINED, which the file seems to be; save it as UTF-8"),
        ("u2f-8", "line 1: unknown encoding 'u2f-8'; save the file as UTF-8"),
        ("rot13", "line 1: unknown encoding 'rot13'"),
        ("Shift_JIS", "line 2: not SHIFT_JIS, which the file seems to be"),
    ],
)
def test_a_declaration_that_cannot_be_followed_is_refused(
    tmp_path: Path, declared: str, message: str
) -> None:
    path = tmp_path / "town.xodr"
    path.write_bytes(PLACE.format(declared, "Stra\xdfe\x81\xff", straight("1")).encode("latin-1"))
    with pytest.raises(ModelError, match=message):
        read_route(path)
