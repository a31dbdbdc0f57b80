"""Values as C source has them."""

from __future__ import annotations

from math import inf


def number(value: float) -> str:
    """Return ``value`` to the bit."""
    if abs(value) == inf:
        return "INFINITY" if value > 0 else "-INFINITY"
    return float(value).hex()


def literal(words: str) -> str:
    """Return ``words`` as a literal."""
    escaped = words.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'
