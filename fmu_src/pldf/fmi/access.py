"""Value references turned into reads and writes of a model's record.

Value references are unique over all types (``kernel.signals.by_reference``).
An importer asks for the same group of variables again and again: each group is looked up once.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from operator import attrgetter
from typing import Any, NamedTuple

from ..errors import ModelError
from ..kernel.signals import Kind, Signal, by_reference

_GROUPS_MAX = 256  # an importer that never repeats a group must not fill the memory


class Group(NamedTuple):
    """What one call of fmi2Get... or fmi2Set... is about."""

    fields: tuple[str, ...]
    read: Callable[[Any], list[Any]]
    outputs: bool  # contains an output
    fixed: bool  # contains a parameter that only the initialization takes
    tunable: tuple[tuple[int, Signal], ...]  # the other parameters, with their places in the group


class Access:
    """Groups of the variables that travel as one FMI type."""

    def __init__(self, signals: Sequence[Signal], kinds: frozenset[Kind]) -> None:
        self._known = {i: s for i, s in by_reference(signals).items() if s.kind in kinds}
        self._type = "/".join(sorted(kinds))
        self._groups: dict[tuple[int, ...], Group] = {}
        self._writable: dict[tuple[int, ...], Group] = {}

    def group(self, references: Sequence[int]) -> Group:
        """Return the group of these value references; ModelError if one is unknown."""
        key = tuple(references)
        group = self._groups.get(key)
        if group is None:
            group = _group([self._signal(reference) for reference in key])
            _remember(self._groups, key, group)
        return group

    def writable(self, references: Sequence[int]) -> Group:
        """Return the group, ModelError if one of its variables is an output."""
        key = tuple(references)
        group = self._writable.get(key)
        if group is None:
            group = self.group(key)
            if group.outputs:
                name = next(s.name for s in map(self._signal, key) if s.causality == "output")
                raise ModelError(f"{name} is an output, it cannot be set")
            _remember(self._writable, key, group)
        return group

    def _signal(self, reference: int) -> Signal:
        signal = self._known.get(reference)
        if signal is None:
            raise ModelError(f"there is no {self._type} variable with value reference {reference}")
        return signal


def _remember(groups: dict[tuple[int, ...], Group], key: tuple[int, ...], group: Group) -> None:
    if len(groups) >= _GROUPS_MAX:
        groups.clear()
    groups[key] = group


def _group(signals: Sequence[Signal]) -> Group:
    names = tuple(s.field for s in signals)
    return Group(
        fields=names,
        read=_reader(names),
        outputs=any(s.causality == "output" for s in signals),
        fixed=any(s.causality == "parameter" and not s.tunable for s in signals),
        tunable=tuple((at, s) for at, s in enumerate(signals) if s.tunable),
    )


def _reader(names: tuple[str, ...]) -> Callable[[Any], list[Any]]:
    if not names:
        return lambda _: []
    get = attrgetter(*names)
    if len(names) == 1:
        return lambda record: [get(record)]
    return lambda record: list(get(record))
