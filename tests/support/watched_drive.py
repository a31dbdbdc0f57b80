"""What a drive on the study road tells other windows."""

from __future__ import annotations

import base64
import json
from typing import Any

from pldf.cockpit.road_view import road_view
from pldf.hmi_texts import as_json
from pldf.kernel.codes import ACTIVE, REASON_CURVE
from pldf.roads import open_road


def road() -> dict[str, Any]:
    """Return the study road as the page gets it."""
    view = road_view(open_road("0"))
    return view | {"prepared": base64.b64encode(view["prepared"]).decode()}


def bundle(language: str = "en") -> bytes:
    """Return what windows beside the drive need of a bundle."""
    content = {"models": {}, "texts": json.loads(as_json()), "road": road(), "language": language}
    return json.dumps(content).encode()


def values(s_m: float = 1000.0, **others: Any) -> dict[str, Any]:
    """Return outputs of the function in a curve at 61 km/h; `_` of others is a point."""
    return {
        "vehicle.s_m": s_m,
        "vehicle.speed_mps": 61.0 / 3.6,
        "mode": ACTIVE,
        "driver.brake_pedal": 0.0,
        "limit_mps": 70.0 / 3.6,
        "set_speed_mps": 75.0 / 3.6,
        "set_speed_offset_mps": 0.0,
        "base_speed_mps": 58.0 / 3.6,
        "target_speed_mps": 66.0 / 3.6,
        "hmi.take_over": False,
        "hmi.sentence": REASON_CURVE,
        "hmi.sentence_speed": 66,
        "hmi.sentence_base": 58,
        "hmi.sentence_limit": 70,
        "hmi.sentence_drive": 0,
        "hmi.learned_delta_mps": 8.0 / 3.6,
        "hmi.learned_in_drives": 2,
        "hmi.confidence": 0.75,
        "hmi.next_speed_mps": 50.0 / 3.6,
        "hmi.next_distance_m": 244.0,
    } | {name.replace("_", ".", 1): value for name, value in others.items()}


def frame(time_s: float, participant: str = "P07", phase: str = "A2", **of: Any) -> dict[str, Any]:
    """Return the message of a moment."""
    told = {"kind": "frame", "participant": participant, "phase": phase, "time_s": time_s}
    return told | {"values": values(**of)}


def status(participant: str = "P07", **others: Any) -> dict[str, Any]:
    """Return the message of where a person is."""
    return {
        "kind": "status", "participant": participant, "phase": "A2", "place": "Drive A2",
        "position": 4, "of": 14, "state": "driving", "reason": "",
        "order": "BA", "explanation": "text", "unit": "KMH", "language": "en",
        "learned_places": 11, "end_m": 4500.0,
    } | others  # fmt: skip
