"""Field specifiers: one annotated class is a model's single table of signals.

A model's record is a dataclass whose fields are made with the functions below. Its metadata is the
single source of the Python field, the FMI variable, the recording column and the documentation::

    @dataclass
    class Inputs:
        vehicle_speed_mps: float = real_input("Ego speed", "m/s", start=0.0, low=0.0, high=100.0)

    @dataclass(slots=True)
    class State(Memory, Outputs, Inputs):  # a dataclass takes the fields of its LAST base first
        ...

The public name of a field that starts with one of ``GROUPS`` has a dot behind the group:
``vehicle_speed_mps`` is ``vehicle.speed_mps``. Every other field keeps its name; a field that only
looks grouped (``driver_id``) states its ``name``.

A field that 0.2 did not have names the release that brings it, ``since("0.3", real_input(...))``:
all variables of older releases keep their value references, wherever in the record it stands.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import Field, dataclass, field, fields
from math import inf
from typing import Any, Final, Literal, cast

Causality = Literal["parameter", "input", "output", "local"]
Kind = Literal["Real", "Integer", "Boolean", "Enumeration", "String"]

GROUPS: Final = (
    "vehicle", "driver", "lever", "teach", "lead", "rate", "drive", "profile", "hmi",
    "planner", "control", "learning", "following", "wish", "script", "body", "scene", "traffic",
)  # fmt: skip

_KEY: Final = "signal"


@dataclass(frozen=True)
class Enumeration:
    """A named set of integer codes, 0, 1, 2 ... in the order of ``items``."""

    name: str
    items: tuple[str, ...]

    def code(self, item: str) -> int:
        """Return the code of ``item``; ValueError when it is not one of the items."""
        return self.items.index(item)

    @property
    def legend(self) -> str:
        """All codes with their items, for the description of an Integer that holds one."""
        return ", ".join(f"{code} {item}" for code, item in enumerate(self.items))


@dataclass(frozen=True)
class Signal:
    """One variable of a model. ``field`` is the Python attribute, ``name`` the public name.

    ``follows``: fields of the inputs that an output follows between the steps and in initialization
    mode; empty for an output that only initialization and steps set. Masters sort by it, and what
    is named too much makes algebraic loops that are not there.
    ``tunable``: a parameter that may be set between steps, too.
    ``since``: the release that brought it; empty: 0.2 had it.
    """

    field: str
    name: str
    causality: Causality
    kind: Kind
    start: float | int | bool | str
    description: str
    unit: str = ""
    low: float | None = None
    high: float | None = None
    enumeration: Enumeration | None = None
    follows: tuple[str, ...] = ()
    tunable: bool = False
    since: str = ""

    @property
    def release(self) -> tuple[int, ...]:
        """The numbers of ``since``; of 0.2 and before none."""
        return tuple(map(int, self.since.split("."))) if self.since else ()

    @property
    def range(self) -> tuple[float, float]:
        """Lowest and highest value allowed, both inclusive; infinite where none is declared.

        A Boolean has 0 and 1, an enumeration the codes of its first and last item.
        """
        if self.kind == "Boolean":
            return 0, 1
        if self.enumeration is not None:
            return 0, len(self.enumeration.items) - 1
        return (
            -inf if self.low is None else self.low,
            inf if self.high is None else self.high,
        )


def signals_of(record: type[Any] | Any) -> tuple[Signal, ...]:
    """Return the signals of a record class (or instance) in order of definition."""
    return tuple(_signal(f) for f in fields(record) if _KEY in f.metadata)


def by_reference(signals: Iterable[Signal]) -> dict[int, Signal]:
    """Return the variables of a model by value reference, which no later release changes.

    The older release first, within one the order given; behind 0.2's stands FMI 3.0's ``time``.
    """
    ordered = sorted(signals, key=lambda signal: signal.release)
    time = time_reference(ordered)
    return {i + (i >= time): signal for i, signal in enumerate(ordered)}


def time_reference(signals: Iterable[Signal]) -> int:
    """Return the value reference of FMI 3.0's independent variable ``time``."""
    return sum(not signal.since for signal in signals)


def variables_of(record: type[Any] | Any, texts: type[Any] | Any) -> tuple[Signal, ...]:
    """Return the variables of a model in the order of their value references.

    Args:
        record: class (or instance) of the numbers.
        texts: class (or instance) of the Strings.
    """
    return tuple(by_reference((*signals_of(record), *signals_of(texts))).values())


def _signal(spec: Field[Any]) -> Signal:
    details = dict(spec.metadata[_KEY])
    details["name"] = details["name"] or _public_name(spec.name)
    return Signal(field=spec.name, start=cast(float, spec.default), **details)


def _public_name(field_name: str) -> str:
    group, _, rest = field_name.partition("_")
    return f"{group}.{rest}" if group in GROUPS and rest else field_name


def _spec(causality: Causality, kind: Kind, start: object, description: str, **more: object) -> Any:
    details: dict[str, object] = {"name": "", **more}
    details.update(causality=causality, kind=kind, description=description)
    return field(default=start, metadata={_KEY: details})


def real_parameter(
    description: str, unit: str, *, start: float, low: float, high: float, name: str = ""
) -> Any:
    """Real parameter, fixed during a drive. ``unit`` is ``""`` for a pure number."""
    return _spec("parameter", "Real", start, description, unit=unit, low=low, high=high, name=name)


def real_input(
    description: str, unit: str, *, start: float, low: float, high: float, name: str = ""
) -> Any:
    """Real input, sampled once per communication step."""
    return _spec("input", "Real", start, description, unit=unit, low=low, high=high, name=name)


def real_output(
    description: str,
    unit: str,
    *,
    low: float | None = None,
    high: float | None = None,
    follows: tuple[str, ...] = (),
) -> Any:
    """Real output."""
    details = {"unit": unit, "low": low, "high": high, "follows": follows}
    return _spec("output", "Real", 0.0, description, **details)


def flag_parameter(description: str, *, start: bool, name: str = "") -> Any:
    """Boolean parameter, held as int 0 or 1 so that the record stays flat."""
    return _spec("parameter", "Boolean", int(start), description, name=name)


def flag_input(description: str, *, start: bool, name: str = "") -> Any:
    """Boolean input, held as int 0 or 1."""
    return _spec("input", "Boolean", int(start), description, name=name)


def flag_output(description: str, *, follows: tuple[str, ...] = ()) -> Any:
    """Boolean output, held as int 0 or 1."""
    return _spec("output", "Boolean", 0, description, follows=follows)


def count_parameter(description: str, *, start: int, low: int, high: int, name: str = "") -> Any:
    """Integer parameter, fixed during a drive."""
    return _spec("parameter", "Integer", start, description, low=low, high=high, name=name)


def count_input(description: str, *, start: int, low: int, high: int, name: str = "") -> Any:
    """Integer input, sampled once per communication step."""
    return _spec("input", "Integer", start, description, low=low, high=high, name=name)


def count_output(description: str, *, follows: tuple[str, ...] = ()) -> Any:
    """Integer output."""
    return _spec("output", "Integer", 0, description, follows=follows)


def choice_parameter(description: str, choices: Enumeration, *, start: int, name: str = "") -> Any:
    """Enumeration parameter; the field holds the item's code."""
    return _spec("parameter", "Enumeration", start, description, enumeration=choices, name=name)


def choice_input(description: str, choices: Enumeration, *, start: int, name: str = "") -> Any:
    """Enumeration input; the field holds the item's code."""
    return _spec("input", "Enumeration", start, description, enumeration=choices, name=name)


def choice_output(description: str, choices: Enumeration, *, follows: tuple[str, ...] = ()) -> Any:
    """Enumeration output; the field holds the item's code."""
    return _spec("output", "Enumeration", 0, description, enumeration=choices, follows=follows)


def text_parameter(description: str, *, name: str = "") -> Any:
    """String parameter, empty by default: everything works with none of them set."""
    return _spec("parameter", "String", "", description, name=name)


def tunable(specifier: Any) -> Any:
    """Say that the parameter may be set between steps, too, and counts from the next one on.

    Nothing that is prepared once per drive (profiles, what a file is read with) may depend on it.
    """
    return _with(specifier, tunable=True)


def text_output(description: str) -> Any:
    """String output, put together when it is read; the kernel holds what it is made of."""
    return _spec("output", "String", "", description)


def parameters_of(texts: type[Any] | Any) -> tuple[str, ...]:
    """Return the fields of a record of Strings that are parameters, in order of definition."""
    return tuple(s.field for s in signals_of(texts) if s.causality == "parameter")


def since(release: str, specifier: Any) -> Any:
    """Say that ``release`` brought the variable that one of the functions above specifies."""
    return _with(specifier, since=release)


def _with(specifier: Any, **more: object) -> Any:
    details = {**specifier.metadata[_KEY], **more}
    return field(default=specifier.default, metadata={**specifier.metadata, _KEY: details})
