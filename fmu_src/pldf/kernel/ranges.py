"""What a restored state may hold: the range of every field of a record and of every array.

Anybody can write a state, and an index or a code from one must not lead out of an array. So every
field of a model's memory has a range, in which the kernel neither leaves an array nor computes
anything but numbers. Python checks it (``pldf.snapshot``) and, generated from here, C does, too
(``runtime/state.c``). An integer states its range where it is declared::

    phase: int = whole(0, 3)
    mode: int = holds(code(MODE), count_output("Mode"))

Numbers without a declaration lie within ``VALUE_MAX``; inputs and parameters may hold anything, for
an importer may set them to it: the kernel judges inputs, initialization parameters.
"""

from __future__ import annotations

from dataclasses import Field, dataclass, field, fields
from math import inf
from typing import Any, Final, get_type_hints

from .signals import Enumeration, Signal, signals_of

# Far beyond every position, speed, force or count, and its square is still exact enough.
VALUE_MAX: Final = 1e9
# 36 years; sums and differences of a few such times fit into 64 bits.
TIME_MAX_NS: Final = 1 << 60

# Of one metre (section 6), in a profile file, too: other scales are other gains and losses.
EVIDENCE_MAX: Final = 2.2

# In place of the name of a field: how many nodes the route has, and the number of the last one.
NODES: Final = "NODES"
LAST_NODE: Final = "LAST_NODE"

_KEY: Final = "range"


@dataclass(frozen=True)
class Range:
    """Lowest and highest value, both inclusive.

    Attributes:
        low: lowest value.
        high: highest value.
        at_most: field, NODES or LAST_NODE whose value bounds it as well; empty: none does.
        plus: field whose value is added to this one's before that.
    """

    low: float = -VALUE_MAX
    high: float = VALUE_MAX
    at_most: str = ""
    plus: str = ""


NODE: Final = Range(0, VALUE_MAX, LAST_NODE)
COUNT: Final = Range(0, VALUE_MAX)
EVIDENCE: Final = Range(0, EVIDENCE_MAX)


def whole(low: int, high: int, *, start: int = 0, at_most: str = "", plus: str = "") -> Any:
    """Integer of the memory with its range; the last two as in ``Range``."""
    return field(default=start, metadata={_KEY: Range(low, high, at_most, plus)})


def code(items: Enumeration) -> Any:
    """Integer of the memory that holds one of these codes."""
    return whole(0, len(items.items) - 1)


def flag() -> Any:
    """Integer of the memory that is 0 or 1."""
    return whole(0, 1)


def nanoseconds(*, low: int = 0, start: int = 0, at_most: str = "") -> Any:
    """Integer of the memory that is a time."""
    return whole(low, TIME_MAX_NS, start=start, at_most=at_most)


def number(low: float, high: float, *, start: float = 0.0) -> Any:
    """Real of the memory with another range than ``VALUE_MAX``."""
    return field(default=start, metadata={_KEY: Range(low, high)})


def anything() -> Any:
    """Real of the memory that may be any bit pattern: nothing but compared."""
    return field(default=0.0, metadata={_KEY: None})


def holds(range_of: Any, specifier: Any) -> Any:
    """Give the output that ``specifier`` makes the range of the memory field ``range_of``."""
    metadata = {**specifier.metadata, _KEY: range_of.metadata[_KEY]}
    return field(default=specifier.default, metadata=metadata)


def ranges_of(record: type[Any]) -> dict[str, Range | None]:
    """Return the range of every field of a record by name; None: it may hold anything.

    Raises:
        ValueError: an integer of the memory, or an Integer output, declares none.
    """
    signals = {signal.field: signal for signal in signals_of(record)}
    return {spec.name: _range(spec, signals.get(spec.name)) for spec in fields(record)}


def _range(spec: Field[Any], signal: Signal | None) -> Range | None:
    if _KEY in spec.metadata:
        declared: Range | None = spec.metadata[_KEY]
        return declared
    if signal is not None and signal.kind == "Boolean":
        return Range(0, 1)
    if signal is not None and signal.causality in ("parameter", "input") and not signal.tunable:
        return None  # a fixed parameter is checked when a drive starts
    low, high = signal.range if signal is not None else (-inf, inf)
    if isinstance(spec.default, int) and high == inf:
        raise ValueError(f"{spec.name}: an integer of the memory has to declare its range")
    return Range(max(low, -VALUE_MAX), min(high, VALUE_MAX))


def columns_of(arrays: type[Any]) -> tuple[Range, ...]:
    """Return the range of the values of each array of a named tuple.

    An array that declares another one than ``VALUE_MAX`` is ``Annotated[Floats, Range(...)]``.
    """
    hints = get_type_hints(arrays, include_extras=True)
    return tuple(_annotated(hints[name]) for name in arrays._fields)


def _annotated(hint: Any) -> Range:
    declared = [item for item in getattr(hint, "__metadata__", ()) if isinstance(item, Range)]
    return declared[0] if declared else Range()
