"""The columns of a recording."""

from __future__ import annotations

from typing import Any, Final

from ..files.tables import Column, Format
from ..kernel.codes import MODE

# Beyond is no measurement: -99 and -999 stand for a missing one in many logs.
_MEASURED: Final[dict[str, Any]] = {"low": -90.0, "high": 1000.0}
RECORDING: Final = Format(
    "recording",
    "sample",
    (
        Column("time_s", unit="s"),
        Column("s_m", unit="m"),
        Column("speed_mps", unit="m/s", **_MEASURED),
        Column("acceleration_mps2", unit="m/s2", needed=False, **_MEASURED),
        Column("mode", "word", words=MODE.items, coded=True),
        Column("gas_pedal", unit="1", needed=False, **_MEASURED),
        Column("brake_pedal", unit="1", needed=False, **_MEASURED),
        Column("set_speed_mps", unit="m/s", needed=False, **_MEASURED),
        Column("set_speed_offset_mps", unit="m/s", needed=False, **_MEASURED),
        Column("profile_mps", unit="m/s", needed=False, **_MEASURED),
        Column("base_mps", unit="m/s", needed=False, **_MEASURED),
        Column("limit_mps", unit="m/s", needed=False, **_MEASURED),
        Column("eligible", "flag", needed=False),
    ),
    rows_min=2,
)
COLUMNS: Final = RECORDING.names
