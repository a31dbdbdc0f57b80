"""The state of an instance as bytes, and back: nothing in bytes is trusted.

Layout: digest of the record's fields, size of the texts, number and lengths of the arrays, record
(int64 and float64 in its order), texts as JSON, arrays. What a number may be stands in
``kernel.ranges``.
"""

from __future__ import annotations

import hashlib
import json
import struct
from collections.abc import Mapping, Sequence
from dataclasses import fields
from functools import cache
from math import inf
from typing import Any, Final, NamedTuple, Protocol

import numpy as np

from .errors import ModelError
from .kernel.arrays import FloatArray
from .kernel.ranges import LAST_NODE, NODES, columns_of, ranges_of
from .kernel.signals import parameters_of

_HEAD: Final = struct.Struct("<32sqq")
_TEXT_MAX: Final = 4096  # as PATH_SIZE of the C runtime
_ranges = cache(ranges_of)
_columns = cache(columns_of)


class Stateful(Protocol):
    """What a state is taken of and given to: the attributes of ``Instance``."""

    record: Any
    texts: Any
    arrays: tuple[FloatArray, ...]

    @property
    def groups(self) -> tuple[Any, ...]:
        """Named tuples of ``arrays``."""


class Snapshot(NamedTuple):
    """A state whose every value is within its range.

    Attributes:
        numbers: of the record, by field.
        texts: the String parameters, by field.
        arrays: in the order of the model's groups; none before initialization.
    """

    numbers: dict[str, Any]
    texts: dict[str, str]
    arrays: tuple[FloatArray, ...]


def encode(model: Stateful) -> bytes:
    """Return the whole state of ``model``."""
    given = {name: getattr(model.texts, name) for name in parameters_of(model.texts)}
    texts = json.dumps(given).encode()
    lengths = [len(array) for array in model.arrays]
    head = _HEAD.pack(_layout(model), len(texts), len(lengths))
    sizes = struct.pack(f"<{len(lengths)}q", *lengths)
    numbers = struct.pack(_format(model), *(getattr(model.record, n) for n in _names(model)))
    return b"".join((head, sizes, numbers, texts, *(array.tobytes() for array in model.arrays)))


def decode(model: Stateful, state: bytes) -> Snapshot:
    """Return what ``state`` holds for a model of this class.

    Raises:
        ModelError: ``encode`` cannot have written it in this build, or a value is out of range.
    """
    if len(state) < _HEAD.size or state[:32] != _layout(model):
        raise ModelError("this FMU state belongs to another model or build; not restored")
    lengths, at, text_size = _sizes(model, state)
    numbers = dict(zip(_names(model), struct.unpack_from(_format(model), state, at), strict=True))
    at += struct.calcsize(_format(model))
    texts = _texts(model, state[at : at + text_size])
    arrays = _arrays(state, at + text_size, lengths)
    _check(model, numbers, arrays)
    return Snapshot(numbers, texts, arrays)


def _sizes(model: Stateful, state: bytes) -> tuple[tuple[int, ...], int, int]:
    """Return the arrays' lengths, where the record begins and the size of the texts."""
    _, text_size, count = _HEAD.unpack_from(state)
    columns = [len(_columns(group)) for group in model.groups]
    if count in (0, sum(columns)) and len(state) >= _HEAD.size + 8 * count:
        lengths = struct.unpack_from(f"<{count}q", state, _HEAD.size)
        at = _HEAD.size + 8 * count
        end = at + struct.calcsize(_format(model)) + text_size + 8 * sum(lengths)
        if min(text_size, *lengths, 0) == 0 and len(state) == end and _even(lengths, columns):
            return lengths, at, text_size
    raise ModelError("this FMU state is truncated or of another model; not restored")


def _even(lengths: Sequence[int], columns: Sequence[int]) -> bool:
    """Tell whether all arrays of a group are equally long."""
    ends = np.cumsum(columns).tolist() if lengths else []
    parts = zip([0, *ends], ends, strict=False)
    return all(len(set(lengths[first:end])) == 1 for first, end in parts)


def _texts(model: Stateful, data: bytes) -> dict[str, str]:
    try:
        texts = json.loads(data)
    except (ValueError, RecursionError):
        texts = None
    names = parameters_of(model.texts)
    if (
        isinstance(texts, dict)
        and texts.keys() == set(names)
        and all(map(_is_text, texts.values()))
    ):
        return texts
    raise ModelError("the texts of this FMU state cannot be used; not restored")


def _is_text(value: object) -> bool:
    """Tell whether an importer could have set this: no NUL, nothing that UTF-8 does not know."""
    try:
        return isinstance(value, str) and "\0" not in value and len(value.encode()) < _TEXT_MAX
    except UnicodeEncodeError:
        return False


def _arrays(state: bytes, at: int, lengths: Sequence[int]) -> tuple[FloatArray, ...]:
    found = []
    for length in lengths:
        found.append(np.frombuffer(state, np.float64, length, at).copy())
        at += 8 * length
    return tuple(found)


def _check(model: Stateful, numbers: Mapping[str, Any], arrays: Sequence[FloatArray]) -> None:
    """Raise ModelError for the first value out of its range."""
    nodes = len(arrays[0]) if arrays else 0
    bounds = {**numbers, NODES: nodes, LAST_NODE: nodes - 1}
    for name, allowed in _ranges(model.record.__class__).items():
        if allowed is not None:
            # What depends on the route is meaningless without one, and computed anew with it.
            limit = bounds.get(allowed.at_most, inf) if arrays else inf
            high = min(allowed.high, limit - numbers.get(allowed.plus, 0))
            _require(name, numbers[name], allowed.low, high)
    ranges = [allowed for group in model.groups for allowed in _columns(group)]
    names = [name for group in model.groups for name in group._fields]
    for name, allowed, array in zip(names, ranges, arrays, strict=False):
        high = min(allowed.high, bounds.get(allowed.at_most, inf))
        _require(name, array.min(initial=allowed.low), allowed.low, high)
        _require(name, array.max(initial=allowed.low), allowed.low, high)


def _require(name: str, value: float, low: float, high: float) -> None:
    if not low <= value <= high:  # NaN is not
        raise ModelError(
            f"this FMU state was changed: {name} = {value}, possible are {low:g} to {high:g}; "
            "not restored"
        )


def _names(model: Stateful) -> tuple[str, ...]:
    return tuple(field.name for field in fields(model.record))


def _format(model: Stateful) -> str:
    kinds = ("q" if isinstance(field.default, int) else "d" for field in fields(model.record))
    return "<" + "".join(kinds)


def _layout(model: Stateful) -> bytes:
    text = f"{type(model).__qualname__} {_format(model)} {_names(model)}"
    return hashlib.sha256(text.encode()).digest()
