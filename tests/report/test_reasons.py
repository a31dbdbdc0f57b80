"""The band of reasons under the speed: where which held, and what the cluster said of it."""

from __future__ import annotations

import numpy as np
from pldf.kernel.codes import REASON
from pldf.recordings.recording import Recording
from pldf.report import figures, palette
from pldf.report.scene import Boxes, Panel
from sample_recording import sample_recording

# Reason, from which row (0.1 s, 2 m each) on.
HELD = {"LIMIT": 0, "LEARNED_FASTER": 150, "OVERRIDE": 200, "STANDBY": 500, "FAULT": 600}


def told(sentences: bool = True) -> Recording:
    recording = sample_recording()
    rows = np.arange(len(recording))
    names = list(HELD)
    held = np.searchsorted(list(HELD.values()), rows, side="right") - 1
    recording.columns["hmi_reason"] = np.array([REASON.code(name) for name in names])[held] * 1.0
    if sentences:
        recording.columns["hmi_sentence"] = recording["hmi_reason"]
        for name, value in {"speed": 75.0, "base": 70.0, "limit": 70.0, "drive": 2.0}.items():
            recording.columns[f"hmi_sentence_{name}"] = np.full(len(recording), value)
    return recording


def band(recording: Recording) -> Panel:
    speed, reasons, pedals = figures.one_drive(recording, "title").panels
    assert speed.x == reasons.x == pedals.x
    return reasons


def spans_m(panel: Panel) -> dict[str, list[tuple[int, int]]]:
    return {
        boxes.label: [(round(1000 * box.start), round(1000 * box.end)) for box in boxes.boxes]
        for boxes in panel.elements
        if isinstance(boxes, Boxes)
    }


def test_each_reason_is_shaded_where_it_held() -> None:
    spans = spans_m(band(told()))
    assert spans == {
        "Speed limit": [(0, 300)],
        "Learned: faster": [(300, 400)],
        "The driver, by gas": [(400, 1000)],
        "Standby": [(1000, 1200)],
        "Fault": [(1200, 1998)],
    }


def test_hovering_says_what_the_cluster_said() -> None:
    (faster,) = (b for b in band(told()).elements if getattr(b, "label", "") == "Learned: faster")
    assert isinstance(faster, Boxes)
    assert faster.boxes[0].hover == (
        "75 instead of 70: you drove faster here in drive 2 (300 to 400 m)"
    )
    (limit, *_) = band(told(sentences=False)).elements
    assert isinstance(limit, Boxes)
    assert limit.boxes[0].hover == "Speed limit (0 to 300 m)"


def test_a_reason_that_moved_the_car_nowhere_has_no_width_to_show() -> None:
    recording = told()
    recording.columns["s_m"][500:601] = recording["s_m"][500]
    assert "Standby" not in spans_m(band(recording))


def test_without_reasons_there_is_no_band() -> None:
    assert len(figures.one_drive(sample_recording(), "title").panels) == 2


def test_every_drive_of_a_study_has_its_band() -> None:
    drives = {"A1": told(), "B1": sample_recording()}
    panels = figures.drives(drives, {"A1": "base", "B1": "learned"}, "title").panels
    assert [len(spans_m(panel)) > 3 and panel.height_in < 1.0 for panel in panels] == [
        False, True, False,
    ]  # fmt: skip


def test_every_reason_has_its_own_shade() -> None:
    assert set(palette.REASONS) == set(REASON.items)
    labels = [label for label, _ in palette.REASONS.values()]
    assert len(set(labels)) == len(labels)
    shades = [fill for name, (_, fill) in palette.REASONS.items() if name != "OFF"]
    assert len(set(shades)) == len(shades)
