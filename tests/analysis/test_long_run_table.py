"""``long_run.csv``: made of drives, read by variant, refused with line and column."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
import scipy.stats
from pldf.analysis.long_run import MEASURES, long_run_of, read_long_run, write_long_run
from pldf.errors import ModelError
from pldf.files.tables import write_table
from pldf.study.drive_row import COLUMNS, DriveRow

HEADER = "variant,phase," + ",".join(MEASURES)
# Of four drivers: pedal rate, set-speed rate, combined rate, errors in m/s.
SECOND = np.array(
    [[0.1, 0.2, 0.25, 1.0, 2.0], [0.0, 0.0, 0.0, 3.0, 1.0], [0.3, 0.0, 0.3, 2.0, 2.5],
     [0.02, 0.4, 0.41, 0.5, 0.75]]
)  # fmt: skip


def write_drives(folder: Path, second: np.ndarray) -> Path:
    """Write two drives of everybody: the first with twice as much of everything."""
    rows = [
        DriveRow(f"P{k + 1:03d}", f"B{n}", *values[:3], n, 200.0, k, *values[3:])
        for k, own in enumerate(second)
        for n, values in ((1, 2.0 * own), (2, own))
    ]
    path = folder / f"{len(second)}.csv"
    write_table(
        path, dict(zip(COLUMNS, zip(*(row.cells for row in rows), strict=True), strict=True))
    )
    return path


def test_means_and_intervals_are_those_of_scipy(tmp_path: Path) -> None:
    table = tmp_path / "long_run.csv"
    write_long_run(table, {"gain 1": write_drives(tmp_path, SECOND)})
    with table.open(encoding="utf-8", newline="") as file:
        (first, last) = csv.DictReader(file)
    assert (first["variant"], first["phase"], first["participants"]) == ("gain 1", "B1", "4")
    values = SECOND * [100.0, 100.0, 100.0, 3.6, 3.6]
    names = ("pedal_percent", "set_speed_percent", "combined_percent", "wish_error_kmh",
             "drive_wish_error_kmh")  # fmt: skip
    for name, column in zip(names, values.T, strict=True):
        low, high = scipy.stats.t.interval(0.95, 3, column.mean(), scipy.stats.sem(column))
        found = [float(last[f"{name}{end}"]) for end in ("", "_low", "_high")]
        assert found == pytest.approx([column.mean(), max(low, 0.0), high], rel=1e-5)
        assert float(first[name]) == pytest.approx(2.0 * column.mean(), rel=1e-5)
    # Wilson (1927), one of four, by its closed form.
    z, n, share = scipy.stats.norm.ppf(0.975), 4, 0.25
    middle = (share + z**2 / (2 * n)) / (1 + z**2 / n)
    half = z / (1 + z**2 / n) * np.sqrt(share * (1 - share) / n + z**2 / (4 * n**2))
    found = [float(last[f"content_percent{end}"]) for end in ("", "_low", "_high")]
    assert found == pytest.approx([25.0, 100 * (middle - half), 100 * (middle + half)], rel=1e-5)


def test_one_driver_says_nothing_of_others(tmp_path: Path) -> None:
    table = tmp_path / "long_run.csv"
    write_long_run(table, {"alone": write_drives(tmp_path, SECOND[:1])})
    with table.open(encoding="utf-8", newline="") as file:
        _, last = csv.DictReader(file)
    assert [last[f"pedal_percent{end}"] for end in ("_low", "", "_high")] == ["0", "10", "100"]
    assert [last[f"wish_error_kmh{end}"] for end in ("_low", "_high")] == ["0", "inf"]


def test_what_was_written_is_read_by_variant(tmp_path: Path) -> None:
    drives = {"one": write_drives(tmp_path, SECOND), "half": write_drives(tmp_path, SECOND[:3])}
    inside = tmp_path / "long_run"
    inside.mkdir()
    write_long_run(inside / "long_run.csv", drives)
    path = long_run_of(tmp_path)
    assert path == long_run_of(inside) == inside / "long_run.csv"
    found = read_long_run(path)
    assert list(found) == ["one", "half"]
    assert found["one"]["drive"] == [1.0, 2.0]
    assert found["half"]["content_percent"] == pytest.approx([100 / 3, 100 / 3], rel=1e-5)


def test_without_a_long_run_there_is_none(tmp_path: Path) -> None:
    assert long_run_of(tmp_path) is None


def test_of_two_systems_the_one_that_learns_counts(tmp_path: Path) -> None:
    path = tmp_path / "long_run.csv"
    path.write_text(f"{HEADER}\nx,A1,9,9,9,9,9,9\nx,B1,1,2,3,4,5,6\nx,B2,2,3,4,5,6,7\n")
    assert read_long_run(path)["x"] == {
        "drive": [1.0, 2.0],
        **{name: [1.0 + k, 2.0 + k] for k, name in enumerate(MEASURES)},
    }


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            "stretch_factor,drive,pedal_percent\n0.5,1,20\n",
            "long_run.csv: a long run by stretch factor, as releases before 0.3 wrote it; move it",
        ),
        (HEADER.replace("pedal_", "gas_"), "long_run.csv, line 1: missing column pedal_percent"),
        (
            f"{HEADER}\nx,B1,y,1,1,1,1,1",
            "line 2, variant x, phase B1, pedal_percent: 'y' is not a number in %",
        ),
        (
            f"{HEADER}\nx,7,1,1,1,1,1,1",
            "line 2, variant x, phase: '7' is not A or B and the number",
        ),
    ],
)
def test_what_cannot_be_used_is_named(tmp_path: Path, text: str, told: str) -> None:
    (tmp_path / "long_run.csv").write_text(text)
    with pytest.raises(ModelError) as caught:
        read_long_run(tmp_path / "long_run.csv")
    assert told in str(caught.value)
