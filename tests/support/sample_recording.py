"""A recording of which one knows where the driver intervened."""

from __future__ import annotations

import numpy as np
from pldf.recordings.recording import Recording


def sample_recording(shift: float = 0.0) -> Recording:
    """Return 100 s with gas from 20 s, brake from 50 s, and an offset from 60 s."""
    time = np.arange(0.0, 100.0, 0.1)
    mode = np.full(len(time), 2.0)
    mode[200:300] = 3.0
    mode[500:600] = 1.0
    brake = np.zeros(len(time))
    brake[500:550] = 0.4
    gas = np.where(mode == 3.0, 0.5, 0.0)
    limit = np.full(len(time), 25.0)
    offset = np.where(time >= 60.0, 2.0, 0.0)
    columns = {
        "time_s": time,
        "s_m": 20.0 * time,
        "speed_mps": 20.0 + shift + np.sin(time / 5.0),
        "acceleration_mps2": np.cos(time / 5.0) / 5.0,
        "mode": mode,
        "gas_pedal": gas,
        "brake_pedal": brake,
        "set_speed_mps": limit + offset,
        "set_speed_offset_mps": offset,
        "profile_mps": np.full(len(time), 22.0 + shift),
        "base_mps": np.full(len(time), 22.0),
        "limit_mps": limit,
        "eligible": np.ones(len(time)),
    }
    return Recording(columns)
