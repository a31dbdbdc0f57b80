"""``versions.json`` as the report reads it, and what it says if somebody spoilt it."""

from __future__ import annotations

from pathlib import Path

import pytest
from pldf.errors import ModelError
from pldf.kernel.state import PldfState
from pldf.report.own_versions import driven_otherwise, read_parameters, read_text
from pldf.report.page import _table_of


@pytest.mark.parametrize(
    "text",
    [
        "[]",
        "no JSON",
        '{"parameters": 5}',
        '{"parameters": {"pldf": 5}}',
        '{"parameters": {"pldf": {"planner.accel_max_mps2": null}}}',
        '{"parameters": {"pldf": {"planner.accel_max_mps2": "1.2"}}}',
        "",
    ],
)
def test_a_spoilt_file_is_told_with_the_way_out(text: str) -> None:
    with pytest.raises(ModelError, match=r"versions\.json: not what 'pldf study' wrote .* restore"):
        read_parameters(Path("versions.json"), text)


def test_what_is_no_text_is_told(tmp_path: Path) -> None:
    path = tmp_path / "versions.json"
    path.write_bytes(b"\xff{}")
    with pytest.raises(ModelError, match="cannot be read"):
        read_text(path)


def test_a_parameter_that_the_run_did_not_know_is_marked() -> None:
    table = _table_of("pldf", PldfState, {"planner.accel_max_mps2": 1.5})
    shown = {signal.name: values[0] for signal, values in table.rows}
    assert shown["planner.accel_max_mps2"] == "1.5"
    assert shown["learning.offset_series_s"] == "not known to the run (5 here)"


def test_a_long_run_of_another_release_is_told(tmp_path: Path) -> None:
    variant = tmp_path / "long_run" / "gain 1"
    variant.mkdir(parents=True)
    own, other = tmp_path / "versions.json", variant / "versions.json"
    assert driven_otherwise(tmp_path, variant.parent) == ()  # a laboratory's folder
    own.write_text('{"source": "new"}')
    other.write_text('{"source": "new"}')
    assert driven_otherwise(tmp_path, variant.parent) == ()
    other.write_text('{"source": "old"}')
    (told,) = driven_otherwise(tmp_path, variant.parent)
    assert (told.severity, told.place) == ("warning", "gain 1")
    assert "--restart" in told.way_out
