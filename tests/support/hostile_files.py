"""Profiles and prepared files that are not as they should be, the same ones for every reader."""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterator
from typing import Final

import numpy as np

CHECKSUM_SIZE: Final = len(b"crc32 00000000\n")
_NUMBERS: Final = (
    b"0", b"-1", b"1", b"2", b"07", b"999999", b"10000000", b"999999999", b"1000000000",
    b"9" * 19, b"9" * 99, b"+3", b" 3", b"3 ", b"0x3", b"",
)  # fmt: skip
_NOTES: Final = (
    b"", b" ", b" a", b" a ", b"  a", b" " + b"n" * 79, b" " + b"n" * 80, b" " + b"n" * 81,
    b" " + b"n" * 200, b" a b", b" \x7f", b" \t", b" \xc3\xa9", b" a\0b",
)  # fmt: skip
_KINDS: Final = (
    b" drive ", b" learn ", b" forget ", b" undo ", b" rollback ", b" base ", b" drives ", b" ",
    b" Drive ", b" driv ", b" drive  ", b"  drive ", b" " + b"d" * 17 + b" ",
)  # fmt: skip
_BLOCKS: Final = (
    b"block learned_mps m/s", b"block bound 1", b"block offset_pending_slower_mps m/s",
    b"block evidence_faster 1", b"block base_mps m/s", b"block base_mps", b"block unheard_of 1",
    b"block learned_mps 1", b"block learned_mps m/s ", b"block  learned_mps m/s", b"block ", b"",
    b"block learned m/s", b"block Learned_mps m/s", b"block learned_mpss m/s",
    b"block " + b"n" * 99 + b" 1",
)  # fmt: skip
_VALUES: Final = (
    np.nan, np.inf, -np.inf, -0.0, -1e-9, 0.5, 200.0, np.nextafter(200.0, 201.0), -200.0, -200.5,
    999999999.0, 1e9, 5e-324,
)  # fmt: skip


def damaged(good: bytes, seed: int = 3) -> Iterator[bytes]:
    """Yield variants of a profile or a prepared file: other bytes, lengths and numbers.

    The checksum of most is right, so that what stands behind it is tested.
    """
    rng = np.random.default_rng(seed)
    body = good[:-CHECKSUM_SIZE]
    head = body.index(b"\nend")
    start = body.index(b"\n", head + 1) + 1
    yield from (b"", good[:-1], good[:-9], good[:head], good + good, good[:100], good + b"\0")
    yield good.replace(b"\n", b"\r\n", 1)
    yield good[:-2] + bytes([good[-2] ^ 1]) + good[-1:]
    yield checked(body[:-1] + bytes([body[-1] ^ 1]))  # the last fill byte of a profile
    for number in range(80):
        changed = bytearray(body)
        at = rng.integers(0, len(body) if number % 2 else head)
        changed[at] = rng.choice([0, 10, 32, 48, 57, 127, 255, changed[at] ^ 1])
        yield checked(bytes(changed))
    for line in body[:head].split(b"\n"):
        name = line.split(b" ")[0]
        for number in _NUMBERS:
            yield checked(filled(body.replace(line, name + b" " + number, 1)))
        yield checked(filled(body.replace(line + b"\n", b"", 1)))
        yield checked(filled(body.replace(line + b"\n", 2 * (line + b"\n"), 1)))
    for value in _VALUES:
        for at in rng.integers(0, (len(body) - start) // 8, 6):
            place = start + 8 * int(at)
            yield checked(body[:place] + np.float64(value).tobytes() + body[place + 8 :])


def with_notes(good: bytes) -> Iterator[bytes]:
    """Yield variants of a profile with other notes behind its last iteration."""
    body = good[:-CHECKSUM_SIZE]
    line = re.findall(rb"\niteration [^\n]*", body)[-1]
    short = re.match(rb"\niteration \d+ (?:[a-z]+ )?\d+", line)
    assert short is not None
    for note in _NOTES:
        yield checked(filled(body.replace(line, short.group() + note, 1)))


def with_other_blocks(good: bytes) -> Iterator[bytes]:
    """Yield variants of a profile with other kinds, and blocks that should not stand there."""
    body = good[:-CHECKSUM_SIZE]
    head = body.index(b"\nend")
    start = body.index(b"\n", head + 1) + 1
    lines = body[:head].split(b"\n")
    stride = (len(body) - start) // max(sum(line.startswith(b"block ") for line in lines), 1)
    for kind in _KINDS:
        line = re.findall(rb"\niteration [^\n]*", body)[-1]
        yield checked(filled(body.replace(line, re.sub(rb" [a-z]+ ", kind, line, count=1), 1)))
    blocks = [body[at : at + stride] for at in range(start, len(body), stride)]
    places = [number for number, line in enumerate(lines) if line.startswith(b"block ")]
    for number, place in enumerate(places):
        for name in _BLOCKS:
            yield _with_blocks([*lines[:place], name, *lines[place + 1 :]], blocks)
        for other in blocks[:number]:  # as before, or in the wrong range
            yield _with_blocks(lines, [*blocks[:number], other, *blocks[number + 1 :]])
        yield _with_blocks(lines, [*blocks[:number], bytes(stride), *blocks[number + 1 :]])
        for name in _BLOCKS[:4]:  # one more, one less
            more = [*blocks[: number + 1], blocks[number], *blocks[number + 1 :]]
            yield _with_blocks([*lines[: place + 1], name, *lines[place + 1 :]], more)
        less = [*blocks[:number], *blocks[number + 1 :]]
        yield _with_blocks([*lines[:place], *lines[place + 1 :]], less)


def _with_blocks(lines: list[bytes], blocks: list[bytes]) -> bytes:
    head = b"\n".join(lines) + b"\nend"
    stated = b"blocks %d" % len(blocks)
    body = filled(re.sub(rb"\nblocks \d+", b"\n" + stated, head) + b"\n")
    return checked(body + b"".join(blocks))


def checked(body: bytes) -> bytes:
    """Return the body with its checksum behind it."""
    return body + b"crc32 %08x\n" % zlib.crc32(body)


def is_prepared(data: bytes, kind: str, columns: int) -> bool:
    """Tell whether these bytes are a prepared file as ``docs/native.md`` describes it."""
    head = re.match(
        rb"PLDF-PREPARED ([12])\nkind (route|script)\nkey [0-9a-f]{16}\ncolumns (0|[1-9]\d?)\n"
        rb"rows (0|[1-9]\d{0,8})\nline (\d)\n"
        rb"(marks ([1-9]\d{0,5})\n((?:mark [^\n]*\n)+))?end( *)\n",
        data,
    )
    if head is None or head[2].decode() != kind or int(head[3]) != columns:
        return False
    if (head[1] == b"2") != (head[6] is not None) or (head[6] is not None and kind != "route"):
        return False
    rows, size = int(head[4]), len(head[0])
    if head[6] is not None and not _are_marks(head[8].split(b"\n")[:-1], int(head[7]), rows):
        return False
    if not (3 if kind == "route" else 1) <= rows <= 10_000_001:
        return False
    if size % 64 or len(head[9]) > 63 or len(data) != size + 8 * columns * rows + CHECKSUM_SIZE:
        return False
    values = np.frombuffer(data, "<f8", columns * rows, size)
    return data == checked(data[:-CHECKSUM_SIZE]) and bool(np.isfinite(values).all())


def _are_marks(lines: list[bytes], count: int, rows: int) -> bool:
    if len(lines) != count:
        return False
    before = 0
    for line in lines:
        found = re.fullmatch(rb"mark (0|[1-9]\d{0,10}) (road|road_against|sign) (.{1,80})", line)
        if found is None or not before <= int(found[1]) <= 1000 * rows:
            return False
        before, name = int(found[1]), found[3]
        try:
            letters = name.decode()
        except UnicodeDecodeError:
            return False
        if name != name.strip(b" ") or any(c < " " or c == "\x7f" for c in letters):
            return False
    return True


_MARKS: Final = (
    b"0 road 1", b"12 road 1", b"0 road", b"0 road ", b"0 road  1", b"0 road 1 ", b"0 Road 1",
    b"", b"0 roads 1", b"0 road_against 7", b"0 road_again 7", b"0 sign 50 km/h", b"00 road 1",
    b"-1 road 1", b"1.5 road 1", b"9999999999 road 1", b"99999999999 road 1",
    b"999999999999 road 1", b"0 road " + b"n" * 80, b"0 road " + b"n" * 81,
    b"0 road " + b"n" * 4000, b"0 road a\tb", b"0 road a\x7fb", b"0 road \xc3\xa4",
    b"0 road \xc3", b"0 road \xc0\x80", b"0 road \xed\xa0\x80", b"0 road \xf4\x90\x80\x80",
    b"0 road \xf0\x9f\x9a\x97", b"0 road \xe0\x80\x80", b"0 road %s%n", b"0 road \xf0\x9f",
    b"0 road a\0b",
)  # fmt: skip


def with_marks(good: bytes) -> Iterator[bytes]:
    """Yield variants of a prepared route with marks: others in place of its first."""
    body = good[:-CHECKSUM_SIZE]
    first = re.search(rb"\nmark ([^\n]*)", body)
    assert first is not None
    for mark in _MARKS:
        yield checked(filled(body.replace(first[0], b"\nmark " + mark, 1)))
    yield checked(filled(body.replace(first[0], b"", 1)))
    yield checked(filled(re.sub(rb"\nmarks [^\n]*(\nmark [^\n]*)+", b"\nmarks 0", body, count=1)))
    yield checked(filled(re.sub(rb"\nmarks [^\n]*(\nmark [^\n]*)+", b"", body, count=1)))
    yield checked(body.replace(b"PREPARED 2", b"PREPARED 1", 1))
    yield checked(body.replace(b"PREPARED 2", b"PREPARED 3", 1))


def filled(body: bytes) -> bytes:
    """Return the body with as many spaces behind ``end`` as its header now needs."""
    match = re.search(rb"\nend( *)\n", body)
    if match is None:
        return body
    end = match.start() + len(b"\nend")
    return body[:end] + b" " * (-(end + 1) % 64) + b"\n" + body[match.end() :]
