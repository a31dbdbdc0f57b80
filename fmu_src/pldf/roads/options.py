"""What a person says about how the file of a road is to be read: the same in every command."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any, Literal

from ..errors import ModelError
from ..kernel.units import KMH_PER_MPS

LimitUnit = Literal["km/h", "mph", "m/s"]


@dataclass(frozen=True, slots=True)
class RoadOptions:
    """How to read a road; without any of it, the file says all. CSV roads need none.

    Attributes:
        start_road: id of the OpenDRIVE road to start with; None: the only possible one.
        via: ids of the roads to pass, in this order; the same may be named twice.
        to: id of the road that the way ends with; None: it goes on while there is one way.
        reverse: the start road is driven against the direction in which it is drawn.
        default_limit_mps: limit where the file states none and no neighbour does.
        limit_unit: unit of limits that the file states without one; None: m/s, as OpenDRIVE says.
        signs: speed signs count where no speed is stated.
        smoothing_m: the curvature is its mean over so many metres; None: it is smoothed only where
            it is noise, 0: nowhere.
    """

    start_road: str | None = None
    via: tuple[str, ...] = ()
    to: str | None = None
    reverse: bool = False
    default_limit_mps: float | None = None
    limit_unit: LimitUnit | None = None
    signs: bool = True
    smoothing_m: float | None = None


AS_WRITTEN = RoadOptions()


class OptionNeededError(ModelError):
    """A file that can only be read when a person says more about it.

    What has to be said is kept apart from what is the matter: each place where roads are named has
    its own way to say it.
    """

    def __init__(
        self,
        matter: str,
        suggested: RoadOptions,
        others: str = "",
        ending: RoadOptions | None = None,
    ) -> None:
        """Keep what can be said.

        Args:
            matter: what is the matter, with file, line and road.
            suggested: all options that would do.
            others: what could be said in place of the last of them.
            ending: the options that end the way here instead.
        """
        self.matter, self.suggested = matter, suggested
        self._others, self._ending = others, ending
        super().__init__(self.told(arguments))

    def told(self, say: Callable[[RoadOptions], str]) -> str:
        """Return the whole as a person reads it where options are written as ``say`` does."""
        others = f" (or {self._others})" if self._others else ""
        ending = "" if self._ending is None else f"; {say(self._ending)} ends the way here"
        return f"{self.matter}: {say(self.suggested)}{others}{ending}"


def said(options: RoadOptions) -> dict[str, Any]:
    """Return those of the options that say something, by name."""
    both = (
        (f.name, getattr(options, f.name), getattr(AS_WRITTEN, f.name)) for f in fields(options)
    )
    return {name: value for name, value, usual in both if value != usual}


def keywords(options: RoadOptions) -> str:
    """Return the options as they are written in a call from Python."""
    return ", ".join(f"{name}={value!r}" for name, value in said(options).items())


def arguments(options: RoadOptions) -> str:
    """Return the options as they are typed behind a command."""
    words = {
        "--start-road": options.start_road,
        "--via": ",".join(options.via) or None,
        "--to": options.to,
    }
    typed = [f"{name} {shlex.quote(word)}" for name, word in words.items() if word is not None]
    if options.reverse:
        typed.append("--reverse")
    if options.default_limit_mps is not None:
        typed.append(f"--default-limit {options.default_limit_mps * KMH_PER_MPS:g}")
    if options.limit_unit is not None:
        typed.append(f"--limit-unit {options.limit_unit}")
    if not options.signs:
        typed.append("--no-signs")
    if options.smoothing_m is not None:
        typed.append(f"--smoothing {options.smoothing_m:g}")
    return " ".join(typed)
