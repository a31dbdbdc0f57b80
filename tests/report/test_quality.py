"""The report's part on data quality."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest
from pldf.analysis.checks import CheckedFile, Checks
from pldf.findings import Finding
from pldf.recordings.quality import Hole, Quality
from pldf.report.contents import Contents
from pldf.report.figures import quality
from pldf.report.page import report_of
from pldf.report.scene import Boxes

SOUND = Quality(190.0, 20.0, 0.0, 4500.0, 1.0, ())
HOLED = Quality(190.0, 20.0, 0.0, 2250.0, 0.5, (Hole(10.0, 3.0, 100.0, 175.0),))


def drive(participant: str, phase: str, *findings: Finding, sound: bool = True) -> CheckedFile:
    path = Path(f"study/recordings/{participant}_{phase}.csv")
    return CheckedFile(path, "recording", findings, SOUND if sound else HOLED, participant, phase)


@pytest.fixture
def checks() -> Checks:
    half = Finding("warning", "study/recordings/P02_A1.csv", 0, "s_m", "covers <half>", "so", "out")
    note = Finding("note", "study/recordings/P01_A2.csv", 0, "", "read with a map")
    return Checks(
        (drive("P01", "A1"), drive("P01", "A2", note), drive("P02", "A1", half, sound=False))
    )


def test_each_recording_is_a_cell_of_the_gravest_that_was_found(checks: Checks) -> None:
    (panel,) = quality(checks).panels
    kinds = [element for element in panel.elements if isinstance(element, Boxes)]
    cells = {kind.label: [(box.start, box.low) for box in kind.boxes] for kind in kinds}
    assert [len(cells[label]) for label in ("With a warning", "Nothing found")] == [1, 2]
    assert cells["With a warning"][0] == pytest.approx((-0.46, -0.46))  # first drive, last row
    assert [tick.text for tick in panel.x.ticks] == ["A1", "A2"]
    assert [tick.text for tick in panel.y.ticks] == ["P01", "P02"]
    (warning,) = next(kind.boxes for kind in kinds if kind.label == "With a warning")
    assert warning.hover.splitlines() == [
        "P02 A1", "190 s, 20 Hz, 50 % of the road", "1 drop-outs, 75 m lost",
        "warning: covers <half>",
    ]  # fmt: skip


def test_the_page_lists_warnings_and_every_recording(contents: Contents, checks: Checks) -> None:
    page = report_of(replace(contents, checks=checks))
    part = page[page.index('<section id="quality">') :]
    part = part[: part.index("</section>")]
    text = re.sub(r"<script>.*?</script>", "", part, flags=re.DOTALL)
    assert "P02_A1.csv, s_m" in text and "covers &lt;half&gt;" in text
    assert "covers <half>" not in text
    rows = re.findall(r"<tr><th>(\w+)</th><td>(\w+)</td>", text)
    assert rows == [("P01", "A1"), ("P01", "A2"), ("P02", "A1")]
    assert "<td>50 %</td><td>1</td><td>75</td><td>1</td>" in text


def test_without_recordings_the_part_is_left_out(html: str) -> None:
    assert '<section id="quality">' not in html
