r"""The byte format of a stored profile: bytes <-> ``StoredProfile``, pure, no disk access.

A file is a text header, float64 blocks and a checksum line. ``n`` is the number of nodes (node
``i`` lies at ``i`` metres), ``k`` the number of iterations. Text is ASCII, lines end with LF,
fields are separated by one space, numbers are decimal without sign or leading zeros.

Header::

    PLDF-PROFILE 1                   magic and format version
    driver 17                        0 .. 999999999
    route 0123456789abcdef           fingerprint of the route, 16 lower-case hexadecimal digits
    nodes 4501                       n, 3 .. 10000000
    step_m 1                         distance of the nodes, always 1
    iterations 2                     k, 0 .. 999999
    iteration 1 3 learned            k lines: number (1 .. k in order), interventions, note
    iteration 2 0 rollback of 0
    end                              and 0 .. 63 spaces before LF: the header's length H is the
                                     next multiple of 64

A note has 0 .. 80 printable characters (0x20 .. 0x7e), none of the outer ones a space; an empty
note leaves no space behind the interventions.

Blocks: IEEE 754 float64, little-endian, n values, filled with zero bytes to the stride
``S = 64 * ceil(8 * n / 64)``, so that every block starts at a multiple of 64. Block ``b`` starts at
``H + b * S``; there are ``1 + 4 * k`` of them::

    b = 0              base_mps      node: planned from the legal limits alone, 0 .. 200
    b = 4 * j - 3      learned_mps   node: what the drive after iteration j follows, 0 .. 200
    b = 4 * j - 2      offset_mps    cell: learned offset of the set speed, -200 .. 200
    b = 4 * j - 1      drive         node: number of the drive that changed it last, 0 = never
    b = 4 * j          intervention  node: number of the intervention in that drive, 0 = set speed

``drive`` and ``intervention`` hold whole numbers 0 .. 999999999; nothing is NaN or infinite.

Last line, at ``H + (1 + 4 * k) * S``, 15 bytes: ``crc32 1a2b3c4d`` and LF, eight lower-case
hexadecimal digits: the CRC-32 of zlib, PNG and gzip over all bytes before this line. The file ends
there, at 4 GiB at most. Equal profiles have equal bytes, and a file that can be read is written
again byte by byte.
"""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterator
from typing import Final, NamedTuple, NoReturn

import numpy as np

from ..kernel.arrays import FloatArray
from .stored_profile import Iteration, ProfileRefused, StoredProfile

VERSION: Final = 1
ALIGNMENT: Final = 64
NODES_MAX: Final = 10_000_000
SPEED_MAX_MPS: Final = 200.0
COUNT_MAX: Final = 999_999_999
FILE_MAX: Final = 1 << 32
CHECKSUM_SIZE: Final = len(b"crc32 00000000\n")

_MAGIC: Final = b"PLDF-PROFILE "
_LINE_MAX: Final = 128
_NUMBER: Final = rb"(0|[1-9][0-9]{0,8})"
_DRIVER: Final = re.compile(rb"driver " + _NUMBER)
_ROUTE: Final = re.compile(rb"route ([0-9a-f]{16})")
_NODES: Final = re.compile(rb"nodes " + _NUMBER)
_STEP: Final = re.compile(rb"step_m (1)")
_ITERATIONS: Final = re.compile(rb"iterations (0|[1-9][0-9]{0,5})")
_ITERATION: Final = re.compile(
    rb"iteration " + _NUMBER + rb" " + _NUMBER + rb"(?: ([!-~](?:[ -~]{0,78}[!-~])?))?"
)
_END: Final = re.compile(rb"end( {0,63})")


def encode(profile: StoredProfile) -> bytes:
    """Return the bytes of the file.

    Raises:
        ProfileRefused: something in ``profile`` is out of the ranges above, e.g. a NaN speed.
    """
    file = f"profile of driver {profile.driver_id}"
    parts = [_header(profile, file)]
    for name, values in _blocks(profile):
        if np.shape(values) != (profile.nodes,):
            _refuse(file, "", f"{name} has shape {np.shape(values)}, base_mps {profile.nodes}")
        block = np.asarray(values, "<f8").tobytes()
        parts += [block, bytes(-len(block) % ALIGNMENT)]
    body = b"".join(parts)
    data = body + _checksum_line(zlib.crc32(body))
    decode(data, file)  # nothing is ever written that cannot be read back
    return data


def decode(data: bytes, file: str) -> StoredProfile:
    """Return the profile in ``data``; its arrays are read-only views of ``data``.

    Args:
        data: the whole content of a file, from any source: nothing in it is trusted.
        file: the name to be shown in errors.

    Raises:
        ProfileRefused: ``data`` is not exactly what ``encode`` writes.
    """
    if len(data) > FILE_MAX:
        _refuse(file, f"byte {FILE_MAX}", f"{len(data)} bytes; possible are {FILE_MAX}")
    head = _parse_header(data, file)
    _check_size(data, head, file)
    _check_sum(data, file)
    columns = [_column(data, head, block, file) for block in range(1 + 4 * len(head.iterations))]
    iterations = tuple(
        Iteration(number, note, interventions, *columns[4 * number - 3 : 4 * number + 1])
        for number, interventions, note in head.iterations
    )
    return StoredProfile(head.driver_id, head.route, columns[0], iterations)


def require_match(profile: StoredProfile, wanted: tuple[int, str, int], file: str) -> None:
    """Refuse ``profile`` unless it is of the ``wanted`` driver, route and number of nodes.

    Raises:
        ProfileRefused: it belongs to another driver or route.
    """
    driver_id, route, nodes = wanted
    if profile.driver_id != driver_id:
        _refuse(file, "line 2", f"profile of driver {profile.driver_id}, not of driver {driver_id}")
    if profile.route != route:
        _refuse(file, "line 3", f"learned on another route ({profile.route}, this one is {route})")
    if profile.nodes != nodes:
        _refuse(file, "line 4", f"{profile.nodes} nodes, but the route has {nodes}")


class Column(NamedTuple):
    """What may stand in a block: values from ``low`` to ``high``, ``whole`` numbers only or any."""

    name: str
    low: float
    high: float
    whole: bool


# In the order of the blocks: the base profile, then those of an iteration.
COLUMNS: Final = (
    Column("base_mps", 0.0, SPEED_MAX_MPS, whole=False),
    Column("learned_mps", 0.0, SPEED_MAX_MPS, whole=False),
    Column("offset_mps", -SPEED_MAX_MPS, SPEED_MAX_MPS, whole=False),
    Column("drive", 0.0, COUNT_MAX, whole=True),
    Column("intervention", 0.0, COUNT_MAX, whole=True),
)


class _Header(NamedTuple):
    driver_id: int
    route: str
    nodes: int
    iterations: list[tuple[int, int, str]]  # number, interventions, note
    size: int

    @property
    def stride(self) -> int:
        return 8 * self.nodes + -8 * self.nodes % ALIGNMENT


class _Lines:
    """Walks through the header line by line and knows where it is."""

    def __init__(self, data: bytes, file: str) -> None:
        self.data = data
        self.file = file
        self.at = 0
        self.number = 0

    def take(self, pattern: re.Pattern[bytes], example: str) -> tuple[str, ...]:
        """Return the groups of ``pattern`` in the next line."""
        end = self.data.find(b"\n", self.at, self.at + _LINE_MAX)
        self.number += 1
        if end < 0 and len(self.data) - self.at < _LINE_MAX:
            self.refuse("truncated: the file ends within the header")
        match = pattern.fullmatch(self.data, self.at, end) if end >= 0 else None
        if match is None:
            shown = self.data[self.at : end if end >= 0 else self.at + 20][:40]
            self.refuse(f"expected '{example}', found {shown.decode('latin-1')!a}")
        self.at = end + 1
        return tuple((group or b"").decode("ascii") for group in match.groups())

    def refuse(self, reason: str) -> NoReturn:
        _refuse(self.file, f"line {self.number}", reason)


def _parse_header(data: bytes, file: str) -> _Header:
    lines = _Lines(data, file)
    _take_version(lines)
    driver_id = int(lines.take(_DRIVER, "driver NUMBER")[0])
    route = lines.take(_ROUTE, "route 16_HEX_DIGITS")[0]
    nodes = int(lines.take(_NODES, "nodes NUMBER")[0])
    if not 3 <= nodes <= NODES_MAX:
        lines.refuse(f"{nodes} nodes; possible are 3 to {NODES_MAX}")
    lines.take(_STEP, "step_m 1")
    count = int(lines.take(_ITERATIONS, "iterations NUMBER")[0])
    iterations = []
    for expected in range(1, count + 1):
        number, interventions, note = lines.take(
            _ITERATION, f"iteration {expected} INTERVENTIONS NOTE"
        )
        if int(number) != expected:
            lines.refuse(f"iteration {number} where {expected} should be")
        iterations.append((expected, int(interventions), note))
    (spaces,) = lines.take(_END, "end")
    if len(spaces) != -(lines.at - len(spaces)) % ALIGNMENT:
        lines.refuse(f"the header is not filled up to the next multiple of {ALIGNMENT} bytes")
    return _Header(driver_id, route, nodes, iterations, lines.at)


def _take_version(lines: _Lines) -> None:
    magic = lines.data[: len(_MAGIC)]
    if len(magic) < len(_MAGIC) and _MAGIC.startswith(magic):
        lines.number = 1
        lines.refuse("truncated: the file is empty" if not magic else "truncated within the header")
    if magic != _MAGIC:
        lines.number = 1
        lines.refuse("not a profile file (it does not begin with PLDF-PROFILE)")
    version = int(lines.take(re.compile(_MAGIC + _NUMBER), f"PLDF-PROFILE {VERSION}")[0])
    if version > VERSION:
        lines.refuse(
            f"format {version} of a newer version; this one reads format {VERSION}, update it"
        )
    if version < VERSION:
        lines.refuse(f"format {version} does not exist")


def _check_size(data: bytes, head: _Header, file: str) -> None:
    size = head.size + (1 + 4 * len(head.iterations)) * head.stride + CHECKSUM_SIZE
    if len(data) < size:
        _refuse(file, f"byte {len(data)}", f"truncated: {size} bytes follow from the header")
    if len(data) > size:
        _refuse(file, f"byte {size}", f"{len(data) - size} bytes behind the end of the profile")


def _check_sum(data: bytes, file: str) -> None:
    end = len(data) - CHECKSUM_SIZE
    line = _checksum_line(zlib.crc32(memoryview(data)[:end]))
    if data[end:] != line:
        stated = ascii(data[end:].decode("latin-1").rstrip("\n"))
        _refuse(
            file, f"byte {end}", f"damaged: checksum line is {stated}, not '{line[:-1].decode()}'"
        )


def _column(data: bytes, head: _Header, block: int, file: str) -> FloatArray:
    name, low, high, whole = COLUMNS[0 if block == 0 else 1 + (block - 1) % 4]
    start = head.size + block * head.stride
    values = np.frombuffer(data, "<f8", head.nodes, start)
    with np.errstate(invalid="ignore"):  # a signalling NaN is as wrong as any other
        good = (values >= low) & (values <= high)
        if whole:
            good &= np.floor(values) == values
    if not good.all():
        node = int(np.argmin(good))
        iteration = f" of iteration {(block + 3) // 4}" if block else ""
        reason = f"{name}{iteration} is {float(values[node])!r} at {node} m"
        _refuse(file, f"byte {start + 8 * node}", reason)
    end = start + 8 * head.nodes
    if any(data[end : start + head.stride]):
        _refuse(file, f"byte {end}", "fill bytes are not zero")
    return values.astype(np.float64, copy=False)


def _blocks(profile: StoredProfile) -> Iterator[tuple[str, FloatArray]]:
    yield "base_mps", profile.base_mps
    for iteration in profile.iterations:
        for name, *_ in COLUMNS[1:]:
            yield name, getattr(iteration, name)


def _header(profile: StoredProfile, file: str) -> bytes:
    lines = [
        f"PLDF-PROFILE {VERSION}",
        f"driver {profile.driver_id}",
        f"route {profile.route}",
        f"nodes {profile.nodes}",
        "step_m 1",
        f"iterations {len(profile.iterations)}",
        *(
            f"iteration {i.number} {i.interventions}" + (f" {i.note}" if i.note else "")
            for i in profile.iterations
        ),
        "end",
    ]
    text = "\n".join(lines)
    if not text.isascii():
        _refuse(file, "", "only ASCII characters are possible in a note")
    return (text + " " * (-(len(text) + 1) % ALIGNMENT) + "\n").encode("ascii")


def _checksum_line(checksum: int) -> bytes:
    return b"crc32 %08x\n" % checksum


def _refuse(file: str, where: str, reason: str) -> NoReturn:
    raise ProfileRefused(file, where, reason)
