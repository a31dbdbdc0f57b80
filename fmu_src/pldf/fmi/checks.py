"""Parameters against the ranges that their signals declare."""

from __future__ import annotations

from math import inf
from typing import Any

from ..instance import Instance, ModelError
from ..kernel.signals import Signal


def check_parameters(signals: tuple[Signal, ...], model: Instance[Any]) -> None:
    """Raise ModelError for a parameter that is not finite or outside its declared range."""
    for signal in signals:
        if signal.causality == "parameter" and signal.kind in ("Real", "Integer", "Enumeration"):
            _check(signal, getattr(model.record, signal.field))


def _check(signal: Signal, value: float) -> None:
    low, high = bounds(signal)
    if not low <= value <= high or abs(value) == inf:
        unit = f" {signal.unit}" if signal.unit else ""
        raise ModelError(f"parameter {signal.name} = {value}{unit} is not in {low:g} .. {high:g}")


def bounds(signal: Signal) -> tuple[float, float]:
    """Return the declared range of a signal, infinite where none is declared."""
    if signal.enumeration is not None:
        return 0, len(signal.enumeration.items) - 1
    low = -inf if signal.low is None else signal.low
    high = inf if signal.high is None else signal.high
    return low, high
