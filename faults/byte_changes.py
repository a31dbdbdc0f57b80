"""What happens to the bytes of a file on its way, whatever it holds."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Final

# Changes a written file.
Damage = Callable[[bytes, random.Random], bytes]


def _cut(data: bytes, chance: random.Random) -> bytes:
    return data[: chance.randrange(len(data))]


def _nul(data: bytes, chance: random.Random) -> bytes:
    at = chance.randrange(len(data))
    return data[:at] + b"\0" * chance.choice((1, 4, 512)) + data[at + chance.choice((0, 1)) :]


def _bit(data: bytes, chance: random.Random) -> bytes:
    at = chance.randrange(len(data))
    return data[:at] + bytes((data[at] ^ 1 << chance.randrange(8),)) + data[at + 1 :]


def _byte(data: bytes, chance: random.Random) -> bytes:
    at = chance.randrange(len(data))
    return data[:at] + bytes((chance.randrange(256),)) + data[at + 1 :]


def _twice(data: bytes, chance: random.Random) -> bytes:
    return data + data


DAMAGES: Final[dict[str, Damage]] = {
    "cut": _cut,
    "nul": _nul,
    "bit": _bit,
    "byte": _byte,
    "file_twice": _twice,
}
