"""Columns that a recording lacks, derived from the route and the profile that was driven."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..kernel.arrays import ProfileArrays, RouteArrays
from ..kernel.codes import GAS_OVERRIDE, STANDBY
from .columns import COLUMNS
from .recording import Recording


def completed(recording: Recording, route: RouteArrays, profile: ProfileArrays) -> Recording:
    """Return ``recording`` with every column, absent ones derived from route and profile driven.

    Pedals come from the mode (standby after driving counts as braked), acceleration from the
    speed, set speed and offset from each other and the limit.
    """
    columns = dict(recording.columns)
    cell = np.clip(np.floor(columns["s_m"]), 0, len(route.limit_mps) - 1).astype(np.intp)
    node = np.arange(float(len(route.limit_mps)))
    automatic = (np.asarray(route.limit_mps) + np.asarray(profile.offset_mps))[cell]
    columns.setdefault("limit_mps", np.asarray(route.limit_mps)[cell])
    columns.setdefault("base_mps", np.interp(columns["s_m"], node, np.asarray(profile.base_mps)))
    columns.setdefault(
        "profile_mps", np.interp(columns["s_m"], node, np.asarray(profile.learned_mps))
    )
    columns.setdefault("gas_pedal", (columns["mode"] == GAS_OVERRIDE).astype(np.float64))
    columns.setdefault("brake_pedal", (columns["mode"] == STANDBY).astype(np.float64))
    columns.setdefault("eligible", np.ones(len(recording)))
    columns.setdefault("acceleration_mps2", np.gradient(columns["speed_mps"], columns["time_s"]))
    if "set_speed_mps" not in columns:
        columns["set_speed_mps"] = automatic + columns.get("set_speed_offset_mps", 0.0)
    columns.setdefault("set_speed_offset_mps", columns["set_speed_mps"] - automatic)
    return replace(recording, columns={name: columns[name] for name in COLUMNS})
