"""What both formats of a profile file are made of: lines of text, float64 blocks, a checksum."""

from __future__ import annotations

import re
import zlib
from typing import Final, NamedTuple, NoReturn

import numpy as np

from ..kernel.arrays import FloatArray
from ..kernel.codes import BOUND
from ..kernel.ranges import EVIDENCE_MAX
from .stored_profile import COLUMN_NAMES, ProfileRefused

ALIGNMENT: Final = 64
NODES_MAX: Final = 10_000_000
SPEED_MAX_MPS: Final = 200.0
COUNT_MAX: Final = 999_999_999
FILE_MAX: Final = 1 << 32
CHECKSUM_SIZE: Final = len(b"crc32 00000000\n")
MAGIC: Final = b"PLDF-PROFILE "
NUMBER: Final = rb"(0|[1-9][0-9]{0,8})"
NOTE: Final = rb"(?: ([!-~](?:[ -~]{0,78}[!-~])?))?"

_LINE_MAX: Final = 128
_DRIVER: Final = re.compile(rb"driver " + NUMBER)
_ROUTE: Final = re.compile(rb"route ([0-9a-f]{16})")
_NODES: Final = re.compile(rb"nodes " + NUMBER)
_STEP: Final = re.compile(rb"step_m (1)")
_ITERATIONS: Final = re.compile(rb"iterations (0|[1-9][0-9]{0,5})")
_END: Final = re.compile(rb"end( {0,63})")


class Column(NamedTuple):
    """What may stand in a block: values from ``low`` to ``high``, ``whole`` numbers only or any."""

    name: str
    unit: str
    low: float
    high: float
    whole: bool


def _column(name: str) -> Column:
    if name.endswith("_mps"):
        low = -SPEED_MAX_MPS if name.startswith("offset_") else 0.0
        return Column(name, "m/s", low, SPEED_MAX_MPS, whole=False)
    if "evidence" in name:
        return Column(name, "1", 0.0, EVIDENCE_MAX, whole=False)
    high = len(BOUND.items) - 1 if name == "bound" else COUNT_MAX
    return Column(name, "1", 0.0, high, whole=True)


# Of an iteration, in the order of its blocks.
COLUMNS: Final = tuple(map(_column, COLUMN_NAMES))


class Start(NamedTuple):
    """The lines with which every format begins, behind its first."""

    driver_id: int
    route: str
    nodes: int
    iterations: int

    @property
    def stride(self) -> int:
        """Bytes from one block to the next."""
        return 8 * self.nodes + -8 * self.nodes % ALIGNMENT

    def text(self, version: int) -> list[str]:
        """Return the lines, the first with the version of the format."""
        return [
            f"{MAGIC.decode()}{version}",
            f"driver {self.driver_id}",
            f"route {self.route}",
            f"nodes {self.nodes}",
            "step_m 1",
            f"iterations {self.iterations}",
        ]


class Lines:
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

    def next_is(self, word: bytes) -> bool:
        """Tell whether the next line begins with ``word``."""
        return self.data.startswith(word, self.at)

    def take_version(self, known: tuple[int, ...]) -> int:
        """Return the version in the first line, one that is ``known``."""
        magic = self.data[: len(MAGIC)]
        self.number = 1
        if len(magic) < len(MAGIC) and MAGIC.startswith(magic):
            self.refuse("truncated within the header" if magic else "truncated: the file is empty")
        if magic != MAGIC:
            self.refuse("not a profile file (it does not begin with PLDF-PROFILE)")
        self.number = 0
        (text,) = self.take(re.compile(MAGIC + NUMBER), f"PLDF-PROFILE {known[-1]}")
        version = int(text)
        if version > known[-1]:
            readable = " and ".join(map(str, known))
            self.refuse(
                f"format {version} of a newer version; this one reads formats {readable}, update it"
            )
        if version not in known:
            self.refuse(f"format {version} does not exist")
        return version

    def take_start(self) -> Start:
        """Return what every format has behind the first line."""
        driver_id = int(self.take(_DRIVER, "driver NUMBER")[0])
        route = self.take(_ROUTE, "route 16_HEX_DIGITS")[0]
        nodes = int(self.take(_NODES, "nodes NUMBER")[0])
        if not 3 <= nodes <= NODES_MAX:
            self.refuse(f"{nodes} nodes; possible are 3 to {NODES_MAX}")
        self.take(_STEP, "step_m 1")
        return Start(driver_id, route, nodes, int(self.take(_ITERATIONS, "iterations NUMBER")[0]))

    def take_end(self) -> None:
        """Take the last line of the header; the blocks begin behind it."""
        (spaces,) = self.take(_END, "end")
        if len(spaces) != -(self.at - len(spaces)) % ALIGNMENT:
            self.refuse(f"the header is not filled up to the next multiple of {ALIGNMENT} bytes")

    def check_whole(self, size: int) -> None:
        """Refuse the file unless it has this size and its checksum is right."""
        data, file = self.data, self.file
        if len(data) < size:
            refuse(file, f"byte {len(data)}", f"truncated: {size} bytes follow from the header")
        if len(data) > size:
            refuse(file, f"byte {size}", f"{len(data) - size} bytes behind the end of the profile")
        end = len(data) - CHECKSUM_SIZE
        line = _checksum_line(zlib.crc32(memoryview(data)[:end]))
        if data[end:] != line:
            stated = ascii(data[end:].decode("latin-1").rstrip("\n"))
            right = line[:-1].decode()
            refuse(file, f"byte {end}", f"damaged: checksum line is {stated}, not '{right}'")

    def refuse(self, reason: str) -> NoReturn:
        """Raise ProfileRefused for the line taken last."""
        refuse(self.file, f"line {self.number}", reason)


def header(lines: list[str], file: str) -> bytes:
    """Return the bytes of the header, ``end`` and the spaces behind it added."""
    text = "\n".join([*lines, "end"])
    if not text.isascii():
        refuse(file, "", "only ASCII characters are possible in a note")
    return (text + " " * (-(len(text) + 1) % ALIGNMENT) + "\n").encode("ascii")


def sealed(head: bytes, blocks: list[FloatArray]) -> bytes:
    """Return a whole file: header, blocks and the checksum over them."""
    parts: list[bytes | memoryview] = [head]
    for values in blocks:
        block = np.ascontiguousarray(values, "<f8")
        parts += [block.data.cast("B"), bytes(-block.nbytes % ALIGNMENT)]
    checksum = 0
    for part in parts:  # none is copied more than once: a history has many megabytes
        checksum = zlib.crc32(part, checksum)
    return b"".join([*parts, _checksum_line(checksum)])


def read_block(lines: Lines, at: int, nodes: int, column: Column, iteration: int) -> FloatArray:
    """Return the block that begins at byte ``at`` of the file, a read-only view of it.

    Args:
        lines: of the file.
        at: place of the block.
        nodes: number of values.
        column: what it must hold.
        iteration: number of its iteration, 0 = none.

    Raises:
        ProfileRefused: a value is not possible.
    """
    data, file = lines.data, lines.file
    values = np.frombuffer(data, "<f8", nodes, at)
    with np.errstate(invalid="ignore"):  # a signalling NaN is as wrong as any other
        good = (values >= column.low) & (values <= column.high)
        if column.whole:
            good &= np.floor(values) == values
    if not good.all():
        node = int(np.argmin(good))
        of = f" of iteration {iteration}" if iteration else ""
        reason = f"{column.name}{of} is {float(values[node])!r} at {node} m"
        refuse(file, f"byte {at + 8 * node}", reason)
    end = at + 8 * nodes
    if any(data[end : end + -end % ALIGNMENT]):
        refuse(file, f"byte {end}", "fill bytes are not zero")
    return values.astype(np.float64, copy=False)


def refuse(file: str, where: str, reason: str) -> NoReturn:
    """Raise ProfileRefused."""
    raise ProfileRefused(file, where, reason)


def _checksum_line(checksum: int) -> bytes:
    return b"crc32 %08x\n" % checksum
