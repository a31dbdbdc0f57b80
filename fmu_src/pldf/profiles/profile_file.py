r"""The bytes of a stored profile: bytes <-> ``StoredProfile``, pure, no disk access.

What is written is format 2; format 1 (``profile_format_1``) is read as well. A file is a text
header, float64 blocks and a checksum line. ``n`` is the number of nodes (node ``i`` lies at ``i``
metres), ``k`` the number of iterations. Text is ASCII, lines end with LF, fields are separated by
one space, numbers are decimal without sign or leading zeros.

Header::

    PLDF-PROFILE 2                   magic and format version
    driver 17                        0 .. 999999999
    route 0123456789abcdef           fingerprint of the route, 16 lower-case hexadecimal digits
    nodes 4501                       n, 3 .. 10000000
    step_m 1                         distance of the nodes, always 1
    iterations 2                     k, 0 .. 999999
    blocks 6                         how many there are
    block base_mps m/s               before the first iteration; always there
    iteration 1 drive 3 learned      k times: number (1 .. k in order), kind, interventions, note
    block learned_mps m/s            those of this iteration: name and unit
    block drive 1
    block intervention 1
    block lessons 1
    iteration 2 rollback 0 rollback of 0
    block learned_mps m/s
    end                              and 0 .. 63 spaces before LF: the header's length H is the
                                     next multiple of 64

A note has 0 .. 80 printable characters (0x20 .. 0x7e), none of the outer ones a space; an empty
note leaves no space behind the interventions. Kinds are ``KINDS``, names and units ``COLUMNS``.

**A block stands only where its bytes differ from those of the iteration before**, and must stand
there. Before iteration 1 ``learned_mps`` is ``base_mps``, and everything else is zero. The blocks
of an iteration stand in the order of ``COLUMNS``.

Blocks: IEEE 754 float64, little-endian, n values, filled with zero bytes to the stride
``S = 64 * ceil(8 * n / 64)``, so that every block starts at a multiple of 64. The block of the
``b``-th ``block`` line, from 0, starts at ``H + b * S``. Nothing is NaN or infinite.

Last line, behind the last block, 15 bytes: ``crc32 1a2b3c4d`` and LF, eight lower-case hexadecimal
digits: the CRC-32 of zlib, PNG and gzip over all bytes before this line. The file ends there, at
4 GiB at most. Equal profiles have equal bytes, and a file of format 2 that can be read is written
again byte by byte.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from operator import attrgetter
from typing import Final, NamedTuple

import numpy as np

from ..kernel.arrays import FloatArray
from .file_parts import (
    CHECKSUM_SIZE,
    COLUMNS,
    FILE_MAX,
    NOTE,
    NUMBER,
    Column,
    Lines,
    Start,
    header,
    read_block,
    refuse,
    sealed,
)
from .profile_format_1 import VERSION as VERSION_1
from .profile_format_1 import decode_1
from .stored_profile import KINDS, Iteration, StoredProfile

VERSION: Final = 2

_BLOCKS: Final = re.compile(rb"blocks ([1-9][0-9]{0,7})")
_BASE: Final = re.compile(rb"block base_mps m/s()")
_ITERATION: Final = re.compile(rb"iteration " + NUMBER + rb" ([a-z]{1,16}) " + NUMBER + NOTE)
_BLOCK: Final = re.compile(rb"block ([a-z][a-z0-9_]{0,39}) ([!-~]{1,16})")
_NAMES: Final = tuple(column.name for column in COLUMNS)
_arrays: Final = attrgetter(*_NAMES)


def encode(profile: StoredProfile) -> bytes:
    """Return the bytes of the file.

    Raises:
        ProfileRefused: something in ``profile`` is out of the ranges above, e.g. a NaN speed.
    """
    file = f"profile of driver {profile.driver_id}"
    lines, blocks = ["block base_mps m/s"], [profile.base_mps]
    for iteration, changed in _changes(profile):
        lines.append(_head(iteration))
        lines += [f"block {column.name} {column.unit}" for column in changed]
        blocks += [_block(profile, iteration, column, file) for column in changed]
    start = Start(profile.driver_id, profile.route, profile.nodes, len(profile.iterations))
    head = header([*start.text(VERSION), f"blocks {len(blocks)}", *lines], file)
    data = sealed(head, blocks)
    decode(data, file)  # nothing is ever written that cannot be read back
    return data


def decode(data: bytes, file: str) -> StoredProfile:
    """Return the profile in ``data``; its arrays are read-only views of ``data``.

    Args:
        data: the whole content of a file of any known format, from any source: nothing in it is
            trusted.
        file: the name to be shown in errors.

    Raises:
        ProfileRefused: ``data`` is not exactly what a writer of its format writes.
    """
    if len(data) > FILE_MAX:
        refuse(file, f"byte {FILE_MAX}", f"{len(data)} bytes; possible are {FILE_MAX}")
    lines = Lines(data, file)
    if lines.take_version((VERSION_1, VERSION)) == VERSION_1:
        return decode_1(lines)
    start, heads, blocks = _take_header(lines)
    at = lines.at
    lines.check_whole(at + blocks * start.stride + CHECKSUM_SIZE)
    base = read_block(lines, at, start.nodes, COLUMNS[0], 0)
    profile = StoredProfile(start.driver_id, start.route, base)
    iterations = [profile.iteration(0)]
    for number, head in enumerate(heads, 1):
        columns = {}
        for column in head.columns:
            at += start.stride
            values = read_block(lines, at, start.nodes, column, number)
            if _same(values, getattr(iterations[-1], column.name)):
                reason = f"{column.name} of iteration {number} is as before and must not stand here"
                refuse(file, f"byte {at}", reason)
            columns[column.name] = values
        iterations.append(
            replace(
                iterations[-1],
                number=number,
                kind=head.kind,
                note=head.note,
                interventions=head.interventions,
                **columns,
            )
        )
    return replace(profile, iterations=tuple(iterations[1:]))


def require_match(profile: StoredProfile, wanted: tuple[int, str, int], file: str) -> None:
    """Refuse ``profile`` unless it is of the ``wanted`` driver, route and number of nodes.

    Raises:
        ProfileRefused: it belongs to another driver or route.
    """
    driver_id, route, nodes = wanted
    if profile.driver_id != driver_id:
        refuse(file, "line 2", f"profile of driver {profile.driver_id}, not of driver {driver_id}")
    if profile.route != route:
        refuse(file, "line 3", f"learned on another route ({profile.route}, this one is {route})")
    if profile.nodes != nodes:
        refuse(file, "line 4", f"{profile.nodes} nodes, but the route has {nodes}")


def same_history(a: StoredProfile, b: StoredProfile) -> bool:
    """Tell whether both have the same iterations, to the bit."""
    if len(a.iterations) != len(b.iterations):
        return False
    if not a.iterations:
        return True
    return _same(a.base_mps, b.base_mps) and all(
        _head(x) == _head(y)
        and changed == others
        and all(_same(getattr(x, name), getattr(y, name)) for name, *_ in changed)
        for (x, changed), (y, others) in zip(_changes(a), _changes(b), strict=True)
    )


class _Head(NamedTuple):
    kind: str
    interventions: int
    note: str
    columns: list[Column]


def _take_header(lines: Lines) -> tuple[Start, list[_Head], int]:
    """Return what the header says, at last the number of blocks."""
    start = lines.take_start()
    stated = int(lines.take(_BLOCKS, "blocks NUMBER")[0])
    lines.take(_BASE, "block base_mps m/s")
    heads = [_take_iteration(lines, number + 1) for number in range(start.iterations)]
    lines.take_end()
    named = 1 + sum(len(head.columns) for head in heads)
    if named != stated:
        refuse(lines.file, "line 7", f"{stated} blocks, but {named} are named")
    return start, heads, named


def _take_iteration(lines: Lines, expected: int) -> _Head:
    number, kind, interventions, note = lines.take(
        _ITERATION, f"iteration {expected} KIND INTERVENTIONS NOTE"
    )
    if int(number) != expected:
        lines.refuse(f"iteration {number} where {expected} should be")
    if kind not in KINDS:
        lines.refuse(f"iteration of kind '{kind}', which a newer version wrote; update this one")
    head = _Head(kind, int(interventions), note, [])
    while lines.next_is(b"block "):
        head.columns.append(_take_block(lines, head.columns))
    return head


def _take_block(lines: Lines, before: list[Column]) -> Column:
    name, unit = lines.take(_BLOCK, "block NAME UNIT")
    if name not in _NAMES:
        lines.refuse(f"block '{name}', which a newer version wrote; update this one")
    column = COLUMNS[_NAMES.index(name)]
    if unit != column.unit:
        lines.refuse(f"block {name} is in {column.unit}, not in {unit}")
    if before and _NAMES.index(before[-1].name) >= _NAMES.index(name):
        lines.refuse(f"block {name} where it should not be: blocks stand once, in a fixed order")
    return column


def _head(iteration: Iteration) -> str:
    line = f"iteration {iteration.number} {iteration.kind} {iteration.interventions}"
    return f"{line} {iteration.note}" if iteration.note else line


def _block(profile: StoredProfile, iteration: Iteration, column: Column, file: str) -> FloatArray:
    values: FloatArray = getattr(iteration, column.name)
    if np.shape(values) != (profile.nodes,):
        refuse(file, "", f"{column.name} has shape {np.shape(values)}, base_mps {profile.nodes}")
    return values


def _changes(profile: StoredProfile) -> Iterator[tuple[Iteration, list[Column]]]:
    """Yield each iteration with the columns that differ from those of the one before."""
    before = _arrays(profile.iteration(0))
    for iteration in profile.iterations:
        arrays = _arrays(iteration)
        rows = zip(COLUMNS, arrays, before, strict=True)
        yield iteration, [column for column, new, old in rows if not _same(new, old)]
        before = arrays


def _same(a: FloatArray, b: FloatArray) -> bool:
    """Tell whether the bits are the same: 0.0 is not -0.0."""
    return a is b or np.asarray(a, np.float64).tobytes() == np.asarray(b, np.float64).tobytes()
