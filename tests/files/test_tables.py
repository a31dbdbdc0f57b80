"""Tables: what is written reads back, and every single thing that is wrong is found where it is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as hs
from pldf.errors import ModelError
from pldf.files.tables import (
    Column,
    Format,
    Table,
    TableError,
    parse_table,
    read_table,
    table_csv,
)

PATH = Path("t.csv")
MIXED = Format(
    "mixture",
    "thing",
    (
        Column("who", "text"),
        Column("x_m", unit="m", low=-1e300, high=1e300),
        Column("count", "whole", low=0.0, high=9.0),
        Column("on", "flag"),
        Column("mode", "word", words=("OFF", "ON")),
        Column("maybe", needed=False, blank=True),
    ),
    key=("who",),
)
NUMBERS = Format("matrix", "row", (Column("a"), Column("b", "whole"), Column("c", "flag")))
GOOD = "who,x_m,count,on,mode,maybe\nann,1.5,2,0,ON,\nben,-3,0,1,OFF,7\ncleo,0,9,1,ON,\n"


def parse(text: str | bytes, form: Format = MIXED) -> Table:
    return parse_table(text if isinstance(text, bytes) else text.encode(), PATH, form)


def refusal(text: str | bytes, form: Format = MIXED) -> TableError:
    with pytest.raises(TableError) as caught:
        parse(text, form)
    assert str(caught.value).count("\n") <= 1
    return caught.value


def same(one: Table, other: Table) -> None:
    assert one.texts == other.texts
    assert list(one.numbers) == list(other.numbers)
    for name, values in one.numbers.items():
        assert values.tobytes() == other.numbers[name].tobytes()


def test_a_table_is_read_by_its_declaration() -> None:
    table = parse("# first\n\n#second \n" + GOOD + "# last\n")
    assert (len(table), table.header_line, table.lines) == (3, 4, [5, 6, 7])
    assert table.comments == ("first", "second")
    assert table.texts == {"who": ["ann", "ben", "cleo"]}
    assert {name: values.tolist() for name, values in table.numbers.items() if name != "maybe"} == {
        "x_m": [1.5, -3.0, 0.0],
        "count": [2.0, 0.0, 9.0],
        "on": [0.0, 1.0, 1.0],
        "mode": [1.0, 0.0, 1.0],
    }
    np.testing.assert_array_equal(table.numbers["maybe"], [np.nan, 7.0, np.nan])
    assert "maybe" in table
    assert "other" not in table


@pytest.mark.parametrize(
    "change",
    [
        lambda text: "\ufeff" + text,
        lambda text: text.replace("\n", "\r\n"),
        lambda text: text.replace("\n", "\r"),
        lambda text: text.removesuffix("\n"),
        lambda text: text.replace("\n", "\n\n  \n"),
        lambda text: text.replace("\n", "\n # no row\n"),
        lambda text: text.replace(",", " ,\t"),
        lambda text: text.replace("ON", '"ON"').replace("1.5", '"1.5"'),
        lambda text: text.replace("who", '"who"').replace("ann", ' "ann"'),
        lambda text: "\n".join(",".join(reversed(r.split(","))) for r in text.splitlines()),
        lambda text: "\n".join(f"{row},further" for row in text.splitlines()),
        lambda text: "\n".join(f'"{k}\n#",{r}' for k, r in enumerate(text.splitlines())),
        lambda text: text.replace("1.5", "+1.50e0").replace("cleo,0", "cleo,0.0"),
        lambda text: text.replace(",2,", ",2.0,"),
    ],
)
def test_what_makes_no_difference(change: Callable[[str], str]) -> None:
    assert change(GOOD) != GOOD
    same(parse(GOOD), parse(change(GOOD)))


def test_a_cell_may_hold_commas_quotes_hashes_and_line_breaks() -> None:
    names = ['a,"b"', "#c", 'd\n# e\n\n"f', "g"]
    data = table_csv({"who": names, "x_m": np.arange(4.0)})
    table = parse(data, Format("list", "name", (Column("who", "text"), Column("x_m"))))
    assert table.texts["who"] == names
    assert table.lines == [2, 3, 4, 8]


def test_rows_can_be_left_out_whatever_else_they_hold() -> None:
    text = GOOD.replace("-3", "minus three").replace("cleo,0,9,1,ON,", "cleo")
    table = parse_table(text.encode(), PATH, MIXED, lambda row: row["who"] in ("ben", "cleo"))
    assert table.texts["who"] == ["ann"]


@pytest.mark.parametrize(
    ("form", "text", "told"),
    [
        (MIXED, "", "t.csv: no header; a mixture has the columns who,x_m,count,on,mode[,maybe]"),
        (MIXED, "# c\n\n", "t.csv: no header"),
        (MIXED, "who,x_m\n", "t.csv, line 1: missing column count, on, mode; a mixture has"),
        (
            MIXED,
            "\nwho;x_m\n",
            "line 2: missing column count, on, mode; a mixture has",
        ),
        (NUMBERS, "a,b,c,a,b\n", "line 1: repeated column a, b; a matrix has the columns a,b,c"),
        (NUMBERS, "#\n#\na,b,c\n\n", "t.csv: no rows below the header (line 3)"),
        (NUMBERS, "a,b,c\n1,2,0,4\n5,6,0,8\n", "line 2: 4 values for 3 columns\n  also line 3"),
        (NUMBERS, "a,b,c\n1,2,0\n\n5,6\n", "t.csv, line 4: 2 values for 3 columns"),
        (NUMBERS, "a,b,c\n1,2,0 # why\n", "line 2, c: '0 # why' is not 0 or 1"),
        (NUMBERS, "a,b,c\n1_000,2,0\n", "line 2, a: '1_000' is not a number"),
        (NUMBERS, "a,b,c\n\u0661,2,0\n", "line 2, a: '\u0661' is not a number"),
        (NUMBERS, "a,b,c\n1,2.5,0\n", "line 2, b: '2.5' is not a whole number"),
        (NUMBERS, "a,b,c\n1,2,0.5\n", "line 2, c: '0.5' is not 0 or 1"),
        (NUMBERS, "a,b,c\n1;5,2,0\n", "line 2, a: '1;5' is not a number"),
        (NUMBERS, 'a,b,c\n1,"2,0\n3,4,1\n', "line 2: quotes that do not fit"),
        (NUMBERS, 'a,b,c\n1,2,0\n1,"2"2,0\n', "line 3: quotes that do not fit"),
        (MIXED, "who x_m\n", "no comma, semicolon or tab in the header 'who x_m'; a mixture has"),
        (MIXED, GOOD.replace("ON", "Onn", 1), "line 2, who ann, mode: 'Onn' is not one of OFF, ON"),
        (MIXED, GOOD.replace("ON", "1", 1), "line 2, who ann, mode: '1' is not one of OFF, ON"),
        (MIXED, GOOD.replace("1.5", "9e300"), "who ann, x_m: '9e300' is not a number from -1e+300"),
        (MIXED, GOOD.replace("1.5", "x" * 99), f"x_m: '{'x' * 40}' is not a number"),
        (MIXED, GOOD.replace(",9,", ",10,"), "count: '10' is not a whole number from 0 to 9"),
        (MIXED, GOOD.replace("ben", " "), "line 3, who: '' is not a text"),
        (MIXED, GOOD.replace("7", "seven"), "line 3, who ben, maybe: 'seven' is not a number"),
    ],
)
def test_what_is_wrong_is_told(form: Format, text: str, told: str) -> None:
    assert told in str(refusal(text, form))


def test_a_closed_format_refuses_other_columns() -> None:
    form = Format("matrix", "row", NUMBERS.columns, closed=True)
    assert "unknown column d; a matrix has" in str(refusal("a,b,c,d\n1,2,0,4\n", form))
    assert "missing column c; unknown column d, e; a" in str(refusal("a,b,d,e\n1,2,0,1\n", form))


def test_too_few_rows_are_refused() -> None:
    form = Format("drive", "sample", (Column("a"),), rows_min=2)
    told = "no samples below the header (line 1); at least 2 are needed"
    assert str(refusal("a\n", form)).endswith(told)
    assert "1 sample below" in str(refusal("a\n1\n", form))
    assert len(parse("a\n1\n2\n", form)) == 2


NAMES = "who,x_m,count,on,mode\n# {0}\n{0},1.5,2,0,ON\n"


@pytest.mark.parametrize(
    ("name", "encoding", "told"),
    [
        ("M\u00fcller", "utf-16", "read as UTF-16"),
        ("M\u00fcller", "utf-16-le", "read as UTF-16"),
        ("M\u00fcller", "utf-16-be", "read as UTF-16"),
        ("M\u00fcller", "utf-32", "read as UTF-32"),
        ("M\u00fcller", "utf-32-be", "read as UTF-32"),
        ("M\u00fcller", "utf-8-sig", ""),
        ("M\u00fcller", "latin-1", "t.csv, line 2: not UTF-8: read as Windows-1252 (Latin-1)"),
        ("M\u00fcller", "cp1252", "save the file as UTF-8"),
        ("\u674e\u56db", "gb2312", "read as GB 18030 (GB 2312), which gives '\u674e\u56db'"),
        ("\u4f50\u85e4", "shift_jis", "read as Shift JIS, which gives '\u4f50\u85e4'"),
    ],
)
def test_every_encoding_is_read_and_guesses_are_told(name: str, encoding: str, told: str) -> None:
    table = parse(NAMES.format(name).encode(encoding))
    assert table.texts["who"] == [name]
    assert table.numbers["x_m"].tolist() == [1.5]
    assert told in "".join(map(str, table.notes))
    assert bool(told) == bool(table.notes)


def test_letters_of_utf_7_are_told() -> None:
    table = parse(NAMES.format("M\u00fcller").encode("utf-7"))
    (note,) = table.notes
    assert "line 2: not UTF-8: read as UTF-7, which gives 'M\u00fcller'; in ASCII it is" in str(
        note
    )
    assert table.texts["who"] == ["M\u00fcller"]


def test_what_is_no_text_is_refused_with_its_line() -> None:
    assert "line 3: a zero byte, which is no text" in str(refusal(GOOD.replace("ben", "b\0n")))
    cut = GOOD.encode("utf-16")[:-1]
    assert "line 4: not UTF-16 text, as it began" in str(refusal(cut))


SIZES = Format(
    "list",
    "size",
    (
        Column("who", "text"),
        Column("x_m"),
        Column("y_m", needed=False),
        Column("maybe_s", low=0.0, needed=False, blank=True),
        Column("mode", "word", words=("OFF", "ON"), needed=False, coded=True),
        Column("on", "flag", needed=False),
    ),
)


@pytest.mark.parametrize(
    ("text", "x_m", "y_m"),
    [
        ("who;x_m;y_m\na;1,5;-0,25\nb;12,125;1e-3\n", [1.5, 12.125], [-0.25, 0.001]),
        ("who\tx_m\ty_m\na\t1.5\t2\nb\t3\t4\n", [1.5, 3.0], [2.0, 4.0]),
        ("who|x_m|y_m\na|1.5|2\nb|3|4\n", [1.5, 3.0], [2.0, 4.0]),
        ('who,x_m,y_m\na,"1,5",2\nb,3,"4,25"\n', [1.5, 3.0], [2.0, 4.25]),
        ("who,x_m,y_m\na,\u22121.5,2\nb,3,4\n", [-1.5, 3.0], [2.0, 4.0]),
    ],
)
def test_numbers_of_all_countries(text: str, x_m: list[float], y_m: list[float]) -> None:
    table = parse(text, SIZES)
    assert table.numbers["x_m"].tolist() == x_m
    assert table.numbers["y_m"].tolist() == y_m
    assert ("is read as" in "".join(map(str, table.notes))) == ("," in text.split("\n", 1)[1] and (
        ";" in text or '"' in text
    ))  # fmt: skip


@pytest.mark.parametrize(
    "text",
    [
        'who,x_m\na,"1,5"\nb,2.5\n',
        'who,x_m\na,"1,234"\nb,2\n',
        "who;x_m\na;1,234.5\nb;2,5\n",
        'who,x_m\na,"1,23,4"\nb,2\n',
        'who,x_m\na,"1,234.5"\nb,3\n',
        "who;x_m\na;1.234,5\nb;3\n",
        "who;x_m\na;1.234.567\nb;0,5\n",
        "who,x_m\na,1'234.5\nb,3\n",
        "who,x_m\na,12\u202f345\nb,3\n",
        "who;x_m\na;1,234\nb;2\n",
    ],
)
def test_what_may_separate_thousands_is_refused(text: str) -> None:
    assert "line 2, x_m" in str(refusal(text, SIZES)) or "line 3, x_m" in str(refusal(text, SIZES))


@pytest.mark.parametrize("cell", ["", "NA", "n/a", "NaN", "null", "-99", "-999.0"])
def test_what_stands_for_a_missing_number(cell: str) -> None:
    table = parse(f"who,x_m,maybe_s\na,1,{cell}\nb,2,3\n", SIZES)
    np.testing.assert_array_equal(table.numbers["maybe_s"], [np.nan, 3.0])
    assert [str(note) for note in table.notes] == (
        [f"t.csv, maybe_s: {cell} (1): read as missing"] if cell else []
    )
    if "9" not in cell:
        assert "line 2, who a, x_m" in str(
            refusal(f"who,x_m\na,{cell}\n", replace(SIZES, key=("who",)))
        )


def test_codes_in_place_of_words_and_words_in_place_of_flags() -> None:
    table = parse("who,x_m,mode,on\na,1,1,TRUE\nb,2,0.0,False\nc,3,ON,1\n", SIZES)
    assert table.numbers["mode"].tolist() == [1.0, 0.0, 1.0]
    assert table.numbers["on"].tolist() == [1.0, 0.0, 1.0]
    assert "nor a code from 0 to 1" in str(refusal("who,x_m,mode\na,1,2\n", SIZES))


def test_a_name_that_is_almost_known_is_read_or_told() -> None:
    table = parse("Who,X m,y-m\na,1,2\n", SIZES)
    assert table.numbers["y_m"].tolist() == [2.0]
    assert "the column 'y-m' is read as y_m" in str(table.notes[-1])
    table = parse("who,x_m,maybes_s\na,1,2\n", SIZES)
    assert "maybe_s" not in table
    assert "'maybes_s' is not known and passed over; is maybe_s meant?" in str(table.notes[0])


def test_a_row_that_is_taken_for_a_comment_is_told() -> None:
    table = parse("# made, by us\nwho,x_m\n#7,1\nb,2\n# the end\n", SIZES)
    (note,) = table.notes
    assert "t.csv, line 3: begins with # and is passed over, though it has 2 cells" in str(note)


def test_a_range_open_to_one_side_is_told() -> None:
    wanted = Column("a", low=0.0, unit="s").description, Column("a", high=9.0).description
    assert wanted == ("a number of at least 0 in s", "a number of at most 9")


def test_all_faults_are_found_at_once() -> None:
    error = refusal("a,b,c\nx,2,0\n1,2\n1,y,2\n1,2,3\n" + "z,1,1\n" * 9, NUMBERS)
    assert [fault.where for fault in error.faults[:5]] == [
        "line 2, a", "line 3", "line 4, b", "line 4, c", "line 5, c",
    ]  # fmt: skip
    assert len(error.faults) == 14
    assert str(error).splitlines() == [
        "t.csv, line 2, a: 'x' is not a number",
        "  also line 3; line 4, b; line 4, c; line 5, c; line 6, a; and 8 more",
    ]


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"none\.csv: cannot be read .No such .*check the path"):
        read_table(tmp_path / "none.csv", NUMBERS)
    with pytest.raises(ModelError, match="cannot be read"):
        read_table(tmp_path, NUMBERS)


texts = (
    hs.text(hs.characters(exclude_categories=["Cs"], exclude_characters="\r\0"), min_size=1)
    .map(str.strip)
    .filter(bool)
)
# What stands for a missing value is refused where none may be missing.
no_code = {-99.0, -999.0, -9999.0}.isdisjoint
cells = {
    "who": texts,
    "x_m": hs.floats(-1e300, 1e300).filter(lambda x: no_code({x})),
    "count": hs.integers(0, 9),
    "on": hs.booleans(),
    "mode": hs.sampled_from(["OFF", "ON"]),
}


@settings(deadline=None)
@given(hs.lists(hs.tuples(*cells.values()), min_size=1, max_size=6))
def test_what_is_written_reads_back_to_the_same_bits(rows: list[tuple]) -> None:
    columns = dict(zip(cells, map(list, zip(*rows, strict=True)), strict=True))
    data = table_csv(columns, ["made", "for a test"])
    table = parse(data)
    assert table.comments == ("made", "for a test")
    assert table.texts["who"] == columns["who"]
    codes = [float(word == "ON") for word in columns["mode"]]
    for name, values in (columns | {"mode": codes}).items():
        if name != "who":
            assert table.numbers[name].tobytes() == np.array(values, dtype=np.float64).tobytes()
    again = columns | table.numbers | {"mode": columns["mode"]}
    same(parse(table_csv(again)), table)


@settings(deadline=None)
@given(
    hs.lists(
        hs.tuples(
            hs.floats(allow_nan=False, allow_infinity=False).filter(lambda x: no_code({x})),
            hs.integers(-(2**53), 2**53).filter(lambda x: no_code({x})),
            hs.booleans(),
        ),
        min_size=1,
    )
)
def test_numbers_alone_take_a_faster_way_to_the_same_bits(rows: list[tuple]) -> None:
    a, b, c = (np.array(column, dtype=np.float64) for column in zip(*rows, strict=True))
    data = table_csv({"a": a, "b": b, "c": c})
    fast, slow = parse(data, NUMBERS), parse(data + b"# no row\n", NUMBERS)
    same(fast, slow)
    assert fast.lines == slow.lines
    assert fast.numbers["a"].tobytes() == a.tobytes()


@pytest.mark.parametrize(
    ("form", "text"), [(MIXED, GOOD), (NUMBERS, "a,b,c\n1,2,0\n3,4,1\n.5,6,1\n")]
)
@settings(deadline=None)
@given(data=hs.data())
def test_every_corruption_of_a_single_cell_is_found_where_it_is(
    form: Format, text: str, data: hs.DataObject
) -> None:
    lines = [line.split(",") for line in text.splitlines()]
    row = data.draw(hs.integers(1, len(lines) - 1))
    at = data.draw(hs.integers(0, len(lines[0]) - 1))
    column = form.columns[at]
    bad = [""] if column.kind == "text" else ["x", "1 2", "0x1", "1'5", "-inf", "1_0"]
    bad += [] if column.blank else ["", " "] + ["nan", "NA"] * (column.kind != "text")
    bad += ["2.5", "-0.5", "1e-9"] if column.kind in ("whole", "flag", "word") else []
    lines[row][at] = data.draw(hs.sampled_from(bad))
    lead = data.draw(hs.sampled_from(["", "# comment\n", "\n\n"]))
    (fault,) = refusal(lead + "\n".join(map(",".join, lines)), form).faults
    assert fault.line == row + 1 + lead.count("\n")
    assert fault.place.split(", ")[-1] == column.name
    cell = lines[row][at].strip()
    why = "; it stands for a missing value: fill it in, or leave the row out"
    named = cell in ("nan", "NA")
    assert fault.text == f"{cell!r} is not {column.description}" + why * named


@pytest.mark.parametrize("head", [b"", b"a,b,c\n", b"who,x_m,count,on,mode\n"])
@settings(deadline=None)
@given(data=hs.binary(max_size=60))
def test_any_bytes_are_read_or_refused(head: bytes, data: bytes) -> None:
    for form in (MIXED, NUMBERS):
        try:
            table = parse(head + data, form)
        except TableError as error:
            assert error.faults
        else:
            assert all(len(values) == len(table) > 0 for values in table.numbers.values())
