"""Files as nobody wrote them: a sound one after a few changes, most with the right checksum.

For the formats with a text header, blocks of float64 and a CRC-32 behind them: profiles and
prepared files. Half of the changes hit the header, which is the smaller part by far.
"""

from __future__ import annotations

import re
import zlib
from collections.abc import Callable
from typing import Final

import numpy as np
from hostile_files import filled

_CHECKSUM_SIZE: Final = len(b"crc32 00000000\n")
_WORDS: Final = (
    b"0", b"1", b"2", b"3", b"-1", b"07", b"999999", b"10000000", b"99999999", b"999999999",
    b"4294967296", b"9" * 19, b"9" * 40, b"+3", b"", b" ", b"m/s", b"1 1", b"drive", b"rollback",
    b"learned_mps", b"base_mps", b"offset_mps", b"bound", b"n" * 90, b"\xc3\xa9", b"\0", b"\r",
)  # fmt: skip
_VALUES: Final = (
    np.nan, np.inf, -np.inf, -0.0, 0.0, 0.5, 1.0, 2.2, 2.3, 5.0, 6.0, 200.0, 200.5, -200.0, -1e-9,
    1e9, 999999999.0, 1e300, -1e300, 5e-324,
)  # fmt: skip


def mutated(good: bytes, rng: np.random.Generator) -> bytes:
    """Return ``good`` after one to three changes."""
    body = good[:-_CHECKSUM_SIZE]
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        change: Callable[[bytes, np.random.Generator], bytes] = _CHANGES[rng.choice(len(_CHANGES))]
        body = change(body, rng)
    if rng.random() < 0.8:
        body = filled(body)
    if rng.random() < 0.9:
        return body + b"crc32 %08x\n" % zlib.crc32(body)
    return (body + good[-_CHECKSUM_SIZE:])[: rng.integers(0, len(good) + 9)]


def _header_size(body: bytes) -> int:
    match = re.search(rb"\nend *\n", body)
    return match.end() if match else min(len(body), 200)


def _place(body: bytes, rng: np.random.Generator) -> int:
    return int(rng.integers(0, (_header_size(body) if rng.random() < 0.5 else len(body)) + 1))


def _byte(body: bytes, rng: np.random.Generator) -> bytes:
    at = _place(body, rng)
    new = body[at] ^ (1 << int(rng.integers(0, 8))) if at < len(body) else 0
    return body[:at] + bytes([new]) + body[at + 1 :]


def _piece(body: bytes, rng: np.random.Generator) -> bytes:
    """Overwrite, insert or cut out a few bytes, which come from elsewhere in the file."""
    at, other, size = _place(body, rng), _place(body, rng), int(rng.integers(0, 80))
    new = body[other : other + size] if rng.random() < 0.6 else b""
    cut = size if rng.random() < 0.6 else 0
    return body[:at] + new + body[at + cut :]


def _word(body: bytes, rng: np.random.Generator) -> bytes:
    """Replace a word of the header."""
    words = list(re.finditer(rb"[^ \n]+", body[: _header_size(body)]))
    if not words:
        return body
    word = words[rng.choice(len(words))]
    other = words[rng.choice(len(words))].group()
    new = other if rng.random() < 0.3 else _WORDS[rng.choice(len(_WORDS))]
    return body[: word.start()] + new + body[word.end() :]


def _line(body: bytes, rng: np.random.Generator) -> bytes:
    """Leave out, repeat or move a line of the header."""
    size = _header_size(body)
    lines = body[:size].split(b"\n")
    at, to = (int(rng.integers(0, len(lines))) for _ in range(2))
    taken = lines[at] if rng.random() < 0.5 else lines.pop(at)
    if rng.random() < 0.7:
        lines.insert(to, taken)
    return b"\n".join(lines) + body[size:]


def _value(body: bytes, rng: np.random.Generator) -> bytes:
    start = _header_size(body)
    count = (len(body) - start) // 8
    if count == 0:
        return body
    at = start + 8 * int(rng.integers(0, count))
    return body[:at] + np.float64(_VALUES[rng.choice(len(_VALUES))]).tobytes() + body[at + 8 :]


def _block(body: bytes, rng: np.random.Generator) -> bytes:
    """Copy a block or several over others, insert them or cut them out."""
    start, size = _header_size(body), _stride(body)
    count = (len(body) - start) // size
    if count < 2:
        return body
    some = size * int(rng.integers(1, count))
    at, other = (start + size * int(rng.integers(0, count)) for _ in range(2))
    new = body[other : other + some] if rng.random() < 0.7 else b""
    return body[:at] + new + body[at + (some if rng.random() < 0.7 else 0) :]


def _named_block(body: bytes, rng: np.random.Generator) -> bytes:
    """Insert a copy of a block of a profile with a line that names it, and count it."""
    start, size = _header_size(body), _stride(body)
    lines = body[:start].split(b"\n")
    named = [number for number, line in enumerate(lines) if line.startswith(b"block ")]
    if not named:
        return body
    block, other = (int(rng.integers(0, len(named))) for _ in range(2))
    at, source = start + size * (block + 1), start + size * other
    name = lines[named[other if rng.random() < 0.5 else int(rng.integers(0, len(named)))]]
    lines.insert(named[block] + 1, name)
    head = b"\n".join(lines).replace(b"blocks %d" % len(named), b"blocks %d" % (len(named) + 1), 1)
    return head + body[start:at] + body[source : source + size] + body[at:]


def _same_block(body: bytes, rng: np.random.Generator) -> bytes:
    """Give a block of a profile the bytes of the one before with its name, or only zeros."""
    start, size = _header_size(body), _stride(body)
    names = re.findall(rb"\nblock ([^ \n]*)", body[:start])
    pairs = [(i, j) for j in range(len(names)) for i in range(j) if names[i] == names[j]]
    if not pairs:
        return body
    before, block = (start + size * index for index in pairs[rng.choice(len(pairs))])
    new = body[before : before + size] if rng.random() < 0.7 else bytes(size)
    return body[:block] + new + body[block + size :]


def _stride(body: bytes) -> int:
    """Return the distance of a profile's blocks in bytes; of other files, something possible."""
    nodes = re.search(rb"\nnodes (\d{1,6})\n", body)
    return max(-(-8 * int(nodes[1]) // 64) * 64, 64) if nodes else 64


_CHANGES: Final = (
    _byte, _piece, _word, _line, _value, _value, _block, _named_block, _same_block,
)  # fmt: skip
