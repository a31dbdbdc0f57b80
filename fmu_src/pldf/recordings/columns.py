"""The columns of a recording."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final

from ..files.tables import Column, Format
from ..kernel.codes import EVENT, MODE, REASON

# Beyond is no measurement: -99 and -999 stand for a missing one in many logs.
_MEASURED: Final[dict[str, Any]] = {"low": -90.0, "high": 1000.0}


def _flags(*names: str) -> tuple[Column, ...]:
    return tuple(Column(name, "flag", needed=False) for name in names)


def _counts(*names: str) -> tuple[Column, ...]:
    return tuple(Column(name, "whole", low=0.0, needed=False) for name in names)


# What any function in any car may have recorded.
LABORATORY: Final = Format(
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
# What this function records besides: its other inputs, for a replay, and what it told the driver.
RECORDING: Final = replace(
    LABORATORY,
    columns=(
        *LABORATORY.columns,
        Column("vehicle_x_m", unit="m", needed=False),
        Column("vehicle_y_m", unit="m", needed=False),
        *_flags("lever_resume", "lever_cancel", "lever_up", "lever_down"),
        *_flags("lever_up_long", "lever_down_long"),
        *_flags("teach_pause", "teach_forget_here", "teach_undo", "lead_present"),
        Column("lead_gap_m", unit="m", needed=False),
        Column("lead_speed_mps", unit="m/s", needed=False),
        Column("limit_override_mps", unit="m/s", needed=False),
        Column("acceleration_request_mps2", unit="m/s2", needed=False, **_MEASURED),
        Column("hmi_reason", "word", words=REASON.items, coded=True, needed=False),
        Column("hmi_event", "word", words=EVENT.items, coded=True, needed=False),
        *_counts("hmi_learned_in_drives"),
        Column("hmi_confidence", unit="1", needed=False),
        *_flags("hmi_take_over", "following_limits"),
        Column("following_time_gap_s", unit="s", needed=False),
        *_counts("hmi_sentence", "hmi_sentence_speed", "hmi_sentence_base"),
        *_counts("hmi_sentence_limit", "hmi_sentence_drive"),
    ),
)
COLUMNS: Final = RECORDING.names
KINDS: Final = {column.name: column for column in RECORDING.columns}

# Column -> input and output of the driving function, for who records or replays a drive. What is
# shown of a profile is the sum of two outputs.
INPUTS: Final = {
    "s_m": "vehicle.s_m",
    "speed_mps": "vehicle.speed_mps",
    "acceleration_mps2": "vehicle.acceleration_mps2",
    "gas_pedal": "driver.gas_pedal",
    "brake_pedal": "driver.brake_pedal",
    "eligible": "eligible",
    "vehicle_x_m": "vehicle.x_m",
    "vehicle_y_m": "vehicle.y_m",
    "lever_resume": "lever.resume",
    "lever_cancel": "lever.cancel",
    "lever_up": "lever.up",
    "lever_down": "lever.down",
    "lever_up_long": "lever.up_long",
    "lever_down_long": "lever.down_long",
    "teach_pause": "teach.pause",
    "teach_forget_here": "teach.forget_here",
    "teach_undo": "teach.undo",
    "lead_present": "lead.present",
    "lead_gap_m": "lead.gap_m",
    "lead_speed_mps": "lead.speed_mps",
    "limit_override_mps": "limit.override_mps",
}
OUTPUTS: Final = {
    "mode": "mode",
    "set_speed_mps": "set_speed_mps",
    "set_speed_offset_mps": "set_speed_offset_mps",
    "base_mps": "base_speed_mps",
    "limit_mps": "limit_mps",
    "acceleration_request_mps2": "acceleration_request_mps2",
    "hmi_reason": "hmi.reason_code",
    "hmi_event": "hmi.event",
    "hmi_learned_in_drives": "hmi.learned_in_drives",
    "hmi_confidence": "hmi.confidence",
    "hmi_take_over": "hmi.take_over",
    "following_limits": "following.limits",
    "following_time_gap_s": "following.time_gap_s",
    "hmi_sentence": "hmi.sentence",
    "hmi_sentence_speed": "hmi.sentence_speed",
    "hmi_sentence_base": "hmi.sentence_base",
    "hmi_sentence_limit": "hmi.sentence_limit",
    "hmi_sentence_drive": "hmi.sentence_drive",
}
LEARNED_DELTA: Final = "hmi.learned_delta_mps"  # added to base_mps it is profile_mps
