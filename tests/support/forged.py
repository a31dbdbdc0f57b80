"""States of a Python session of which somebody has changed one value."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import fields
from math import inf, nan
from typing import Any, Final

from pldf.fmi.session import Session

WHOLE: Final = (-1, 2, 9, 1000, 2**31, 2**60, 2**63 - 1, -(2**63))
REAL: Final = (nan, inf, -inf, 1e300, -1e300, 1e18, -1.0, 0.5)
SESSION_HEAD: Final = 19  # magic, phase, ready, stale, time
MODEL_HEAD: Final = SESSION_HEAD + 32  # with the digest of the record's fields


def forgeries(session: Session) -> Iterator[tuple[str, bytes]]:
    """Yield what was changed, and the state with it, for every place of the session's state."""
    state = session.state()
    for name, at, value in _changes(session, state):
        yield f"{name} = {value!r}", state[:at] + value + state[at + len(value) :]


def _changes(session: Session, state: bytes) -> Iterator[tuple[str, int, bytes]]:
    for value in (1, 3, 4, 255):
        for name, at in (("phase", 8), ("ready", 9), ("stale", 10)):
            yield name, at, bytes([value])
    yield from _values("time", 11)
    record = MODEL_HEAD + 16 + 8 * len(session.model.arrays)
    for at in range(MODEL_HEAD, record, 8):
        yield from _values(f"size at {at}", at)
    yield from _changed_model(session, state, record)


def _changed_model(session: Session, state: bytes, record: int) -> Iterator[tuple[str, int, bytes]]:
    texts = record + 8 * len(fields(session.model.record))
    for at, spec in zip(range(record, texts, 8), fields(session.model.record), strict=True):
        yield from _values(spec.name, at)
    for at in range(texts, texts + struct.unpack_from("<q", state, MODEL_HEAD)[0]):
        for text in (b"\0", b"\xff", b'"', b"\\"):
            yield f"text at {at - texts}", at, text
    for k, array in enumerate(session.model.arrays):
        end = len(state) - 8 * sum(map(len, session.model.arrays[k:]))
        for index in {0, len(array) // 2, len(array) - 1} if len(array) else ():
            yield from _values(f"array {k}[{index}]", end + 8 * index)


def _values(name: str, at: int) -> Iterator[tuple[str, int, bytes]]:
    values: tuple[Any, ...] = (*WHOLE, *REAL)
    for value in values:
        yield name, at, struct.pack("<q" if isinstance(value, int) else "<d", value)
