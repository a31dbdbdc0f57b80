"""What a WebAssembly module or object needs and offers, read from its bytes (WebAssembly 1.0)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

_MAGIC: Final = b"\0asm\1\0\0\0"
_IMPORTS, _EXPORTS = 2, 7  # numbers of sections
_TABLE_OR_MEMORY: Final = (1, 2)


def is_module(data: bytes) -> bool:
    """Tell whether these are the bytes of WebAssembly, linked or not."""
    return data.startswith(_MAGIC)


def imports(data: bytes) -> set[str]:
    """Return the names of what has to be given to it."""
    names = set()
    for section in _sections(data, _IMPORTS):
        for _ in range(section.number()):
            section.name()  # of the module that would have it
            names.add(section.name())
            section.skip_description()
    return names


def exports(data: bytes) -> set[str]:
    """Return the names of what it offers."""
    names = set()
    for section in _sections(data, _EXPORTS):
        for _ in range(section.number()):
            names.add(section.name())
            section.byte()
            section.number()
    return names


class _Reader:
    def __init__(self, data: bytes) -> None:
        self._data = data
        self._at = 0

    @property
    def rest(self) -> bool:
        return self._at < len(self._data)

    def byte(self) -> int:
        self._at += 1
        return self._data[self._at - 1]

    def number(self) -> int:
        """Return a whole number of 7 bits per byte, the lowest first."""
        value, shift = 0, 0
        while True:
            byte = self.byte()
            value |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                return value

    def part(self) -> bytes:
        length = self.number()
        self._at += length
        return self._data[self._at - length : self._at]

    def name(self) -> str:
        return self.part().decode()

    def skip_description(self) -> None:
        """Pass over what an import is: function, table, memory, global or tag."""
        kind = self.byte()
        if kind == 1:
            self.byte()
        if kind in _TABLE_OR_MEMORY:
            flags = self.number()
            for _ in range(1 + (flags & 1)):  # at least, and at most if that is given
                self.number()
        elif kind == 3:
            self.byte()
            self.byte()
        elif kind == 4:
            self.byte()
            self.number()
        else:
            self.number()


def _sections(data: bytes, wanted: int) -> Iterator[_Reader]:
    whole = _Reader(data[len(_MAGIC) :])
    while whole.rest:
        number, content = whole.byte(), whole.part()
        if number == wanted:
            yield _Reader(content)
