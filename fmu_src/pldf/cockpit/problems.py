"""What is wrong with files that people wrote, collected, so that all of it is told at once."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from ..errors import ModelError
from ..toml_file import Key, TomlFile

T = TypeVar("T")


class Problems:
    """What was found wrong so far."""

    def __init__(self) -> None:
        self._texts: list[str] = []

    def wrong(self, file: TomlFile, key: Key, text: str) -> None:
        """Note that something is wrong with a key of a file."""
        self.tried(lambda: file.fail(key, text))

    def note(self, text: str) -> None:
        """Note a problem, or several, one in a line."""
        self._texts += text.splitlines()

    def tried(self, call: Callable[[], T]) -> T | None:
        """Return what ``call`` returns; None if it finds something wrong."""
        try:
            return call()
        except ModelError as problem:
            self.note(str(problem))
            return None

    def finish(self) -> None:
        """Raise ModelError if something is wrong."""
        if self._texts:
            raise ModelError("\n".join(dict.fromkeys(self._texts)))
