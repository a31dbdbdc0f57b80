"""Durations as people read them."""

from __future__ import annotations


def minutes(time_s: float, places: int = 0) -> str:
    """Return minutes and seconds, e.g. ``3:05`` or, with one of the ``places``, ``3:04.7``."""
    parts = 10**places
    whole, rest = divmod(round(time_s * parts), 60 * parts)  # rounded first: never 2:60
    return f"{whole}:{rest / parts:0{places + 3 if places else 2}.{places}f}"
