"""Names of participants: who is spelled in two ways is one person, and that is told."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator

from ..findings import Finding


def key_of(name: str) -> str:
    """Return what two spellings of one name share: all but case, blanks and Unicode form."""
    return "".join(unicodedata.normalize("NFKC", name).casefold().split())


class Names:
    """The participants of a study; of several spellings the first one counts."""

    def __init__(self) -> None:
        self._spellings: dict[str, dict[str, str]] = {}

    def __contains__(self, name: str) -> bool:
        return key_of(name) in self._spellings

    def take(self, name: str, file: str) -> str:
        """Return the spelling that counts; ``name``, met in ``file``, if it is the first."""
        spellings = self._spellings.setdefault(key_of(name), {})
        spellings.setdefault(name, file)
        return next(iter(spellings))

    def notes(self) -> Iterator[Finding]:
        """Yield who was brought together."""
        for spellings in self._spellings.values():
            first, *others = spellings
            for name in others:
                yield Finding(
                    "warning", spellings[name], 0, f"participant {name}",
                    f"{name!r} and {first!r} ({spellings[first]}) differ in case or blanks only",
                    f"they count as one participant, {first}",
                    "if they are two people, rename one",
                )  # fmt: skip
