"""Values as the page reads them: JSON, with bytes as base64."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterable, Mapping
from typing import Any


def as_json(made: Any) -> bytes:
    """Return a JSON text that may stand in a page: there is no ``<`` in it."""
    text = json.dumps(made, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").encode()


def plain(value: Any) -> Any:
    """Return a value as JSON knows it; bytes become base64 texts."""
    if isinstance(value, bytes):
        return base64.b64encode(value).decode()
    if isinstance(value, Mapping):
        return {key: plain(inner) for key, inner in value.items()}
    if isinstance(value, Iterable) and not isinstance(value, str):
        return [plain(inner) for inner in value]
    return value


def beside_data(told: Mapping[str, Any]) -> dict[str, bytes]:
    """Return the files that a bundle wants to lie beside the data, by name."""
    return {name: base64.b64decode(text) for name, text in told.get("beside", {}).items()}
