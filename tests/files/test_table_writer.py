"""The writer of tables: bytes, and files that are written whole or not at all."""

from __future__ import annotations

import csv
import io
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pldf.errors import ModelError
from pldf.files.tables import Column, Format, parse_table, table_csv, write_table


def test_numbers_of_numpy_and_of_python_are_written_alike() -> None:
    columns = {"a": [np.float64(0.1), 1, np.int64(2)], "b": [True, np.True_, False]}
    assert table_csv(columns) == b"a,b\n0.1,1\n1,1\n2,0\n"


def test_comments_stay_in_their_lines_and_an_empty_cell_is_a_row() -> None:
    assert table_csv({"a": [""]}, ["x\r\ny"]) == b'# x y\na\n""\n'


def test_a_file_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    write_table(path, {"a": [1.5]})
    assert path.read_bytes() == b"a\n1.5\n"
    with pytest.raises(ValueError, match="argument 2 is shorter"):
        write_table(path, {"a": [1.0, 2.0], "b": [1.0]})
    assert path.read_bytes() == b"a\n1.5\n"
    assert list(tmp_path.iterdir()) == [path]
    with pytest.raises(ModelError, match=r"t\.csv: cannot be written .No such file"):
        write_table(tmp_path / "nowhere" / "t.csv", {"a": [1.5]})


@pytest.mark.skipif(sys.platform == "win32", reason="has no /dev")
def test_a_device_is_written_to_and_not_replaced() -> None:
    write_table("/dev/null", {"a": [1.5]})
    assert Path("/dev/null").is_char_device()


TEXTS = Format("list", "row", (Column("name", "text", pattern="(?s:.*)"), Column("end", "number")))
# What spreadsheets calculate with, as OWASP lists it; the last four are the wide forms.
STARTS = "=+-@\t\r\n\uff1d\uff0b\uff0d\uff20"


def cells_of(data: bytes) -> list[str]:
    """The first column as Python's own reader sees it, which is what a spreadsheet would see."""
    return [row[0] for row in csv.reader(io.StringIO(data.decode(), newline=""))][1:]


def _lines_alike(text: str) -> str:
    """Blanks around a cell are nobody's, and the reader takes all line ends for the same."""
    return text.strip().replace("\r\n", "\n").replace("\r", "\n")


@given(st.lists(st.text(st.sampled_from([*STARTS, *"'\"a1.,; "]), max_size=8), min_size=1))
def test_no_text_becomes_a_formula_and_all_are_read_back(names: list[str]) -> None:
    data = table_csv({"name": names, "end": [1.0] * len(names)})
    for cell in cells_of(data):
        # A number calculates nothing: -1.5 written as text stays what it is.
        assert not cell.startswith(tuple(STARTS)) or float(cell) == float(cell)
    read = parse_table(data, Path("t.csv"), TEXTS).texts["name"]
    assert [_lines_alike(text) for text in read] == [_lines_alike(name) for name in names]


def test_formulas_stand_behind_an_apostrophe_and_numbers_do_not() -> None:
    names = ["=1+1", "-1.5", "-x", "+49 30", "@a", "'=1", "a=1", '=A1&","']
    assert table_csv({"n": names}).decode().splitlines()[1:] == [
        "'=1+1", "-1.5", "'-x", "'+49 30", "'@a", "''=1", "a=1", '"\'=A1&"","""',
    ]  # fmt: skip
    assert table_csv({"n": np.array([-1.5])}) == b"n\n-1.5\n"
