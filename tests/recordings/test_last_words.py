"""The driver's last word in a recording: a pause teaches nothing, a press is told."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import road, within
from pldf.kernel.codes import ACTIVE, GAS_OVERRIDE
from pldf.recordings.offline import learn_from
from pldf.recordings.recording import Recording

ROAD = road(2000.0, ((0.0, 20.0),))


def with_gas(**columns: np.ndarray) -> Recording:
    """100 s at 20 m/s, with 24 m/s while gas is pressed from 700 to 900 m."""
    time_s = 0.1 * np.arange(1000)
    s_m = 20.0 * time_s
    gas = within(s_m, [(700.0, 900.0)])
    made = {"time_s": time_s, "s_m": s_m, "speed_mps": np.where(gas, 24.0, 20.0)}
    return Recording(made | {"mode": np.where(gas, GAS_OVERRIDE, ACTIVE).astype(float)} | columns)


@pytest.mark.parametrize("paused", [False, True])
def test_what_is_done_in_a_pause_is_not_learned(paused: bool) -> None:
    columns = {"teach_pause": within(with_gas()["s_m"], [(600.0, 1000.0)]).astype(float)}
    learned = learn_from(with_gas(**(columns if paused else {})), ROAD)
    assert np.any(learned.iteration.learned_mps > 20.5) != paused


@pytest.mark.parametrize(
    ("column", "command"), [("teach_forget_here", "forget"), ("teach_undo", "undo")]
)
def test_a_press_that_is_not_repeated_is_told(column: str, command: str) -> None:
    pressed = within(with_gas()["s_m"], [(1200.0, 1210.0)]).astype(float)
    (note,) = [
        n for n in learn_from(with_gas(**{column: pressed}), ROAD).notes if n.place == column
    ]
    assert note.severity == "warning"
    assert note.text == "pressed at 1200 m, which is not repeated"
    assert f"pldf profiles {command}" in note.way_out
