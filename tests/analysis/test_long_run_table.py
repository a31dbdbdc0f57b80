"""``long_run.csv``: read by stretch factor, refused with line and column."""

from __future__ import annotations

from pathlib import Path

import pytest
from pldf.analysis.long_run import read_long_run
from pldf.errors import ModelError

HEADER = "stretch_factor,drive,people,combined_percent,pedal_percent,content_percent,wish_error_kmh"


def test_drives_are_told_apart_by_their_stretch_factor(tmp_path: Path) -> None:
    path = tmp_path / "long_run.csv"
    path.write_text(f"{HEADER}\n0.5,1,9,30,20,1,4\n0,1,9,31,21,2,5\n0.5,2,9,10,5,50,3.5\n")
    found = read_long_run(path)
    assert list(found) == [0.0, 0.5]
    assert found[0.5]["drive"] == [1.0, 2.0]
    assert found[0.5]["wish_error_kmh"] == [4.0, 3.5]
    assert found[0.0]["combined_percent"] == [31.0]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (HEADER.replace("pedal_", "gas_"), "long_run.csv, line 1: missing column pedal_percent"),
        (f"{HEADER}\n0,1,9,x,1,1,1", "line 2, combined_percent: 'x' is not a number in %"),
        (f"{HEADER}\n0,1.5,9,1,1,1,1", "line 2, drive: '1.5' is not a whole number of at least 1"),
    ],
)
def test_what_cannot_be_used_is_named(tmp_path: Path, text: str, told: str) -> None:
    (tmp_path / "long_run.csv").write_text(text)
    with pytest.raises(ModelError) as caught:
        read_long_run(tmp_path / "long_run.csv")
    assert told in str(caught.value)
