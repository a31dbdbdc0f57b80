"""The writer of tables: bytes, and files that are written whole or not at all."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from pldf.errors import ModelError
from pldf.files.tables import table_csv, write_table


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
