"""What came of something spoilt: right, told, refused, or a promise broken; counted."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from math import isnan
from pathlib import Path
from typing import Any, Literal, NamedTuple, Protocol, TypeVar

from pldf.errors import ModelError

from .experiment import Counts, Progress

Word = Literal["right", "told", "refused", "violation"]


class Verdict(NamedTuple):
    """What was done, how it was answered, and what speaks for that."""

    done: str
    word: Word
    why: str = ""


class Kind(Protocol):
    """A kind of file, or a command, by its name."""

    @property
    def name(self) -> str:
        """The name."""


KindT = TypeVar("KindT", bound=Kind)
AnswerT = TypeVar("AnswerT")
# Spoils so many of a kind with this seed.
Trials = Callable[[KindT, int, int], Iterable[Verdict]]


def counted(
    kinds: Sequence[KindT], trials: Trials[KindT], count: int, seed: int, progress: Progress
) -> Counts:
    """Try ``count`` in all, alike of each kind; name what breaks the promise beside the counts."""
    found: Counter[str] = Counter(right=0, told=0, refused=0, violations=0)
    for at, kind in enumerate(kinds, start=1):
        for verdict in trials(kind, count // len(kinds), seed):
            if verdict.word == "violation":
                found["violations"] += 1
                found[f"{kind.name}: {verdict.done}: {verdict.why}"] += 1
            else:
                found[verdict.word] += 1
        progress(at * count // len(kinds))
    return dict(found)


def asked(read: Callable[[Path], AnswerT], path: Path) -> AnswerT | tuple[Word, str]:
    """Return what a reader answers to the file ``path``; if it raises, the verdict on that."""
    try:
        return read(path)
    except ModelError as error:  # a refusal has to name the file
        return ("refused" if path.name in str(error) else "violation"), str(error)
    except Exception as error:
        return "violation", f"{type(error).__name__}: {error}"


def same(got: Any, meant: Any) -> bool:
    """Tell whether two values, or lists or tables of them, are the same; a missing one is NaN."""
    if isinstance(got, dict) and isinstance(meant, dict):
        return got.keys() == meant.keys() and all(same(got[name], meant[name]) for name in meant)
    if isinstance(got, list | tuple) and isinstance(meant, list | tuple):
        return len(got) == len(meant) and all(map(same, got, meant))
    if isinstance(got, float) and isinstance(meant, float) and isnan(meant):
        return isnan(got)
    return bool(got == meant)
