"""Tables as spreadsheets, statistics programs and simulators of many countries write them."""

from __future__ import annotations

import codecs
import csv
import io
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as hs
from pldf.files.tables import Column, Format, Table, TableError, parse_table, read_header

PATH = Path("t.csv")
FORM = Format(
    "mixture",
    "thing",
    (
        Column("who", "text"),
        Column("x_m", unit="m"),
        Column("count", "whole", low=0.0),
        Column("on", "flag"),
        Column("mode", "word", words=("OFF", "ON"), coded=True),
        Column("maybe", needed=False, blank=True),
    ),
    key=("who",),
)
PAIR = Format("pair", "row", (Column("x"), Column("y")))


def parse(text: str | bytes, form: Format = FORM) -> Table:
    return parse_table(text if isinstance(text, bytes) else text.encode(), PATH, form)


def refusal(text: str | bytes, form: Format = PAIR) -> str:
    with pytest.raises(TableError) as caught:
        parse(text, form)
    return str(caught.value)


def told(table: Table) -> str:
    return "\n".join(map(str, table.notes))


def test_what_is_written_as_wanted_needs_no_words() -> None:
    assert parse("who,x_m,count,on,mode,maybe\nMüller,1.5,2,0,ON,\n").notes == []


@pytest.mark.parametrize("mark", [";", "\t"])
def test_other_separators_and_decimal_commas(mark: str) -> None:
    rows = ["x,y", "0|1,5", "-2,25|1e3", ",5|1,5E-3"]
    table = parse("\n".join([f"x{mark}y", *rows[1:]]).replace("|", mark), PAIR)
    assert table.numbers["x"].tolist() == [0.0, -2.25, 0.5]
    assert table.numbers["y"].tolist() == [1.5, 1000.0, 0.0015]
    name = {";": "semicolons", "\t": "tabs"}[mark]
    assert f"{name} separate the columns" in told(table)
    assert "decimal commas: -2,25 is read as -2.25" in told(table)
    assert {note.severity for note in table.notes} == {"note"}


def test_a_separator_in_quotes_or_in_data_separates_nothing() -> None:
    table = parse('"x";"a, b, c";"y"\n1;",,,";2\n', PAIR)
    assert (table.numbers["x"].tolist(), table.numbers["y"].tolist()) == ([1.0], [2.0])
    table = parse("x;y;speed (m/s, mean, of 3)\n1;2;3\n", PAIR)
    assert table.numbers["y"].tolist() == [2.0]
    table = parse("sep=;\nx;y\n1;2\n", PAIR)
    assert (table.numbers["y"].tolist(), table.header_line, table.lines) == ([2.0], 2, [3])


def test_quoted_headers_with_line_breaks() -> None:
    table = parse('"x","a\nlong ""name""\n","y"\n1,t,2\n"3","u\n\nv","4"\n5,w,6\n', PAIR)
    assert table.numbers["y"].tolist() == [2.0, 4.0, 6.0]
    assert (table.header_line, table.lines) == (1, [4, 5, 8])


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("x;y\n1,234;2\n", "line 2, x: '1,234' may be 1.234 or 1234; write decimal points"),
        ('x,y\n"1,234",2\n', "line 2, x: '1,234' may be 1.234 or 1234"),
        ("x;y\n0;0\n1,5;2.5\n", "line 3, x: '1,5' has a comma and '2.5' a point"),
        (
            "x;y\n1.234,5;2\n",
            "'1.234,5' is not a number; write it with a decimal point and nothing",
        ),
        ("x;y\n1'234;2\n", '"1\'234" is not a number; write it with a decimal point'),
        ("x;y\n1 234,5;2\n", "'1 234,5' is not a number; write it with a decimal point"),
        ('x,y\n"1,234,567",2\n', "'1,234,567' is not a number; write it with a decimal point"),
        ("x,y\n1,5,2,5\n", "4 values for 2 columns; with decimal commas, separate columns by semi"),
        ("x;y\n1,5;2;3\n", "line 2: 3 values for 2 columns"),
        ("x,y\n1,NA\n", "line 2, y: 'NA' is not a number; it stands for a missing value: fill"),
        ("x,y\n1,-99\n1,2\n", "line 2, y: '-99' is not a number; it stands for a missing value"),
    ],
)
def test_what_may_mean_two_things_is_refused(text: str, wanted: str) -> None:
    assert wanted in refusal(text)


def test_one_comma_that_groups_nothing_decides_for_all() -> None:
    table = parse("x;y\n1,234;2\n0,500;3\n", PAIR)
    assert table.numbers["x"].tolist() == [1.234, 0.5]


def test_missing_values_where_they_may_be() -> None:
    cells = ["", "NA", "nan", "-99", "-999.0", "N/A", "null", "7", "-3"]
    rows = "".join(f"p{k},1,2.0,0,OFF,{cell}\n" for k, cell in enumerate(cells))
    table = parse("who,x_m,count,on,mode,maybe\n" + rows)
    np.testing.assert_array_equal(table.numbers["maybe"], [np.nan] * 7 + [7.0, -3.0])
    for cell in cells[1:7]:
        assert f"{cell} (1)" in told(table)


def test_a_coordinate_that_passes_99_below_zero_is_a_coordinate() -> None:
    table = parse("x,y\n-100,-120\n-99,-99\n-98,0\n", PAIR)
    assert table.numbers["x"].tolist() == [-100.0, -99.0, -98.0]
    assert table.numbers["y"].tolist() == [-120.0, -99.0, 0.0]


def test_numbers_for_words_and_words_in_other_capitals() -> None:
    rows = "a,1,2,true,1.0,\nb,1,2.0,FALSE,0,\nc,1,2,1,on,\nd,1,2,0,Off,\n"
    table = parse("who,x_m,count,on,mode,maybe\n" + rows)
    assert table.numbers["mode"].tolist() == [1.0, 0.0, 1.0, 0.0]
    assert table.numbers["on"].tolist() == [1.0, 0.0, 1.0, 0.0]
    assert "on: true is read as 1" in told(table)
    assert "mode: numbers for words: 1.0 is ON, 0 is OFF" in told(table)
    assert "mode: read without regard to capitals: on, Off" in told(table)
    for strange in ("2", "1.5", "-1", "nan"):
        text = f"who,x_m,count,on,mode\na,1,2,0,{strange}\n"
        assert f"mode: {strange!r} is not one of OFF, ON, nor a code from 0 to 1" in (
            refusal(text, FORM)
        )


def test_rows_and_columns_of_nothing() -> None:
    table = parse(",x,y,\nr1,1,2,\n,,,\nr2,3,4,,\n \n", PAIR)
    assert table.numbers["x"].tolist() == [1.0, 3.0]
    assert table.lines == [2, 4]
    assert "1 rows without any value passed over" in told(table)
    assert "1 rows have more cells than the header; these are empty" in told(table)
    closed = Format("pair", "row", PAIR.columns, closed=True)
    assert parse('"","x","y"\n"1",1,2\n"2",3,4\n', closed).numbers["y"].tolist() == [2.0, 4.0]


NAMES = {
    "cp1252": ["Müller", "Größe", "Éric", "ANDRÉ", "naïve", "20 °C"],
    "gb18030": ["王小明", "测试路", "B组", "李"],
    "cp932": ["田中", "さくら", "テスト", "鈴木一郎"],
    "utf-7": ["Müller", "José", "Łukasz"],
}


@pytest.mark.parametrize(
    ("encoding", "name"), [(code, name) for code, names in NAMES.items() for name in names]
)
def test_encodings_that_do_not_say_what_they_are(encoding: str, name: str) -> None:
    table = parse(f"who,x_m,count,on,mode\n{name},1,2,0,ON\n".encode(encoding))
    assert table.texts["who"] == [name]
    (note,) = table.notes
    assert note.severity == "warning"
    assert repr(name) in note.text
    assert note.consequence == "names depend on that"


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be", "utf-32", "utf-8-sig"])
def test_encodings_that_say_what_they_are(encoding: str) -> None:
    table = parse("who,x_m,count,on,mode\nMüller 王,1,2,0,ON\n".encode(encoding))
    assert table.texts["who"] == ["Müller 王"]
    assert [note.severity for note in table.notes] == ["note"] * (encoding != "utf-8-sig")


def test_marks_of_rare_encodings() -> None:
    text = "who,x_m,count,on,mode\nMüller,1,2,0,ON\n"
    for data in (b"\x84\x31\x95\x33" + text.encode("gb18030"), ("\ufeff" + text).encode("utf-7")):
        assert parse(data).texts["who"] == ["Müller"]
    for mark in (codecs.BOM_UTF32_BE, codecs.BOM_UTF16_BE):
        name = "utf-32-be" if len(mark) == 4 else "utf-16-be"
        assert parse(mark + text.encode(name)).texts["who"] == ["Müller"]


def test_what_is_not_asked_for_needs_no_warning() -> None:
    table = parse("# Prüfstand 7\nx,y,Fahrer\n1,2,Müller\n".encode("cp1252"), PAIR)
    (note,) = table.notes
    assert (note.severity, "Windows-1252" in note.text) == ("note", True)


@pytest.mark.parametrize(
    "data",
    [
        "x,y\n1,2\n# Иван\n".encode("cp1251"),
        b"x,y\n1,2\n# " + bytes(range(0x84, 0x9F)),
        "x,y\n1,2\n# Müller ".encode() + b"\xfcber\xff\xfe\xfd",
    ],
)
def test_what_makes_no_sense_in_any_encoding_is_refused(data: bytes) -> None:
    assert "line 3: not UTF-8 text; save the file as UTF-8" in refusal(data)


def test_a_binary_file_is_refused() -> None:
    assert "a zero byte, which is no text" in refusal(b"PK\x03\x04\xff\x00\x00\x12\xfa")


def test_ascii_that_may_be_utf7_is_read_as_it_stands_and_told() -> None:
    table = parse("x,y,speed+acc\n1,2,3\n", PAIR)
    assert "'x,y,speed+acc' is" in told(table)
    assert "in UTF-7; read as it stands" in told(table)
    assert parse("x,y\n1e+100,2e+050\n", PAIR).notes == []


def test_garbled_letters_are_told() -> None:
    garbled = "Müller".encode().decode("cp1252")
    table = parse(f"who,x_m,count,on,mode\n{garbled},1,2,0,ON\n")
    assert f"letters were lost before: {garbled!r}" in told(table)


def test_columns_that_are_not_asked_for_are_not_converted(tmp_path: Path) -> None:
    path = tmp_path / "wide.csv"
    wide = ",".join(f"c{k}" for k in range(3000))
    path.write_text(f"x,{wide},y\n" + f"1,{',' * 2999},2\n" * 3)
    assert len(read_header(path)) == 3002
    table = parse(path.read_bytes(), PAIR)
    assert table.numbers["y"].tolist() == [2.0, 2.0, 2.0]
    assert "line 5: 3001 values" in refusal(path.read_text() + f"1{',' * 3000}\n")


# Names in letters that the encoding has; each encoding as spreadsheets name it.
alphabets = {
    "utf-8": "aé王ü ",
    "utf-8-sig": "aé王ü;,",
    "utf-16": "aé王\n\"';",
    "utf-32": "aé王,\t",
    "ascii": "ab,;\t\n\"' ",
}


@settings(deadline=None)
@given(data=hs.data())
def test_any_table_in_any_dialect_reads_back(data: hs.DataObject) -> None:
    encoding = data.draw(hs.sampled_from(list(alphabets)))
    mark = data.draw(hs.sampled_from([",", ";", "\t"]))
    comma = data.draw(hs.booleans())
    end = data.draw(hs.sampled_from(["\n", "\r\n", "\r"]))
    letters = hs.text(alphabets[encoding], max_size=5).map(lambda t: f"n{t}n")
    finite = hs.floats(-90.0, 1e9)
    rows = data.draw(hs.lists(hs.tuples(letters, finite, hs.integers(0, 99)), min_size=1))
    # Python's writer leaves LF in a cell without quotes where lines end with CR.
    quoting = csv.QUOTE_ALL if end == "\r" else data.draw(hs.sampled_from([0, csv.QUOTE_ALL]))
    written = io.StringIO()
    writer = csv.writer(written, delimiter=mark, lineterminator=end, quoting=quoting)
    writer.writerow(["who", "x_m", "further", "count"])
    for who, x, count in rows:
        cell = repr(x).replace(".", ",") if comma else repr(x)
        writer.writerow([who, cell, "1,5;\t", f"{count}.0".replace(".", "," if comma else ".")])
    form = Format("list", "row", (Column("who", "text"), Column("x_m"), Column("count", "whole")))
    content = written.getvalue().encode(encoding)
    table = parse(content, form)
    assert table.texts["who"] == [who for who, _, _ in rows]
    assert table.numbers["x_m"].tolist() == [x for _, x, _ in rows]
    assert table.numbers["count"].tolist() == [count for _, _, count in rows]


@settings(deadline=None)
@given(data=hs.binary(max_size=40), head=hs.sampled_from([b"x,y\n1,2\n", b"x;y\n", b""]))
def test_any_bytes_are_read_or_refused(data: bytes, head: bytes) -> None:
    for mark in (b"", codecs.BOM_UTF16_LE, codecs.BOM_UTF32_LE, b"+/v8-", b"\x84\x31\x95\x33"):
        try:
            table = parse(mark + head + data, PAIR)
        except TableError as error:
            assert error.faults
        else:
            assert np.isfinite(table.numbers["x"]).all()
