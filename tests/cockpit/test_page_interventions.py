"""The page finds the interventions that Python finds in a recording."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from node import node
from pldf.recordings.interventions import (
    OFFSET_TOLERANCE_MPS,
    pedal_interventions,
    set_speed_interventions,
)
from pldf.recordings.recording import Recording

SCRIPT = Path(__file__).parent / "javascript/find_interventions.mjs"
ROWS = 300


def drive(seed: int) -> Recording:
    """Return a recording whose mode, brake and offset change at random."""
    rng = np.random.default_rng(seed)

    def held(choices: list[float], mean: float) -> np.ndarray:
        lengths = rng.geometric(1.0 / mean, ROWS)
        return np.repeat(rng.choice(choices, ROWS), lengths)[:ROWS]

    time = 0.1 * np.arange(ROWS)
    tolerance = OFFSET_TOLERANCE_MPS
    columns = {
        "time_s": time,
        "s_m": 20.0 * time,
        "mode": held([0.0, 1.0, 1.0, 2.0, 2.0, 2.0, 3.0, 4.0], 4.0),
        "brake_pedal": held([0.0, 0.0, 0.02, 0.0201, 0.5], 3.0),
        "set_speed_offset_mps": held([0.0, 0.0, tolerance, 1.01 * tolerance, -2.0], 20.0),
    }
    return Recording(columns)


def by_python(recording: Recording) -> list[tuple[str, int, int]]:
    found = [*pedal_interventions(recording), *set_speed_interventions(recording)]
    return sorted(((i.kind, i.first, i.last) for i in found), key=lambda i: i[1])


def test_the_same_interventions_are_found(tmp_path: Path) -> None:
    drives = [drive(seed) for seed in range(200)]
    path = tmp_path / "drives.json"
    columns = [{name: v.tolist() for name, v in d.columns.items()} for d in drives]
    path.write_text(json.dumps(columns), encoding="utf-8")
    done = node(SCRIPT, path)
    assert done.returncode == 0, done.stderr
    kinds = set()
    for recording, found in zip(drives, json.loads(done.stdout), strict=True):
        assert [(i["kind"], i["first"], i["last"]) for i in found] == by_python(recording)
        assert all(i["from_m"] == recording["s_m"][i["first"]] for i in found)
        assert all(i["to_m"] == recording["s_m"][i["last"]] for i in found)
        kinds |= {i["kind"] for i in found}
    assert kinds == {"gas", "brake", "set_speed"}
