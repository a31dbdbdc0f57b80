"""The columns of a recording."""

from __future__ import annotations

from typing import Final

from ..files.tables import Column, Format
from ..kernel.codes import MODE

RECORDING: Final = Format(
    "recording",
    "sample",
    (
        Column("time_s", unit="s"),
        Column("s_m", unit="m"),
        Column("speed_mps", unit="m/s"),
        Column("acceleration_mps2", unit="m/s2", needed=False),
        Column("mode", "word", words=MODE.items),
        Column("gas_pedal", unit="1", needed=False),
        Column("brake_pedal", unit="1", needed=False),
        Column("set_speed_mps", unit="m/s", needed=False),
        Column("set_speed_offset_mps", unit="m/s", needed=False),
        Column("profile_mps", unit="m/s", needed=False),
        Column("base_mps", unit="m/s", needed=False),
        Column("limit_mps", unit="m/s", needed=False),
        Column("eligible", "flag", needed=False),
    ),
    rows_min=2,
)
COLUMNS: Final = RECORDING.names
