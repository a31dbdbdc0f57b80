"""Was a profile learned on an older reading of a road? A guess, for a fingerprint says no more.

A road whose reading changes (a repair, a limit carried on, a sign, a newer map) has another
fingerprint, and what was learned on it would be lost without a word. Its base profile tells: most
of it is as before. ``build/runtime/older.c`` guesses in the same way.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import combinations
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from ..errors import ModelError
from ..kernel.arrays import FloatArray
from .saving import read
from .stored_profile import StoredProfile

# A repair moves the end of a road by some metres, another road has another length.
LENGTH_SHARE: Final = 0.01
# Of the nodes that both have, metre by metre, so many have the same base speed: a curve that is
# found on a road of 100 km/h changes half a kilometre of it. Of 7,260 pairs of 121 roads of public
# maps 1.4 % are equally long, 0.5 % look like one road. With 0.8 it would be 0.4 %, most of them
# straight roads with one limit, which no base profile can tell apart.
ALIKE_SHARE: Final = 0.5
ALIKE_MPS: Final = 0.1  # less than 0.4 km/h, which other roundings of a limit make


class OlderReading(NamedTuple):
    """A profile that was probably learned on an older reading of a road."""

    path: Path
    alike: int  # nodes with the same base speed
    nodes: int  # that both have

    @property
    def percent(self) -> int:
        """How much of the base profile is the same, whole percents, rounded down."""
        return 100 * self.alike // self.nodes


def nodes_alike(older_mps: FloatArray, base_mps: FloatArray) -> int:
    """Return at how many nodes two base profiles agree, metre by metre from the start."""
    nodes = min(len(older_mps), len(base_mps))
    return int(np.count_nonzero(np.abs(older_mps[:nodes] - base_mps[:nodes]) <= ALIKE_MPS))


def is_older_reading(older_mps: FloatArray, base_mps: FloatArray) -> bool:
    """Tell whether two base profiles (m/s, one value per metre) are probably of one road."""
    nodes, others = len(base_mps), len(older_mps)
    if abs(nodes - others) > LENGTH_SHARE * nodes:
        return False
    return nodes_alike(older_mps, base_mps) >= ALIKE_SHARE * min(nodes, others)


def find_older_reading(
    files: Iterable[Path], driver_id: int, route: str, base_mps: FloatArray
) -> OlderReading | None:
    """Return the likeliest of ``files``, None if there is none; nothing on the disk is changed.

    Args:
        files: profiles; what cannot be read, or is of another driver, is passed over.
        driver_id: whose profile is looked for.
        route: fingerprint of the road as it is read now, which no older reading has.
        base_mps: its base profile, m/s per node.
    """
    best = None
    for path in sorted(files):
        profile = _sound(path)
        if profile is None or profile.driver_id != driver_id or profile.route == route:
            continue
        older_mps = profile.iteration().base_mps
        if not profile.iterations or not is_older_reading(older_mps, base_mps):
            continue
        alike = nodes_alike(older_mps, base_mps)
        if best is None or alike > best.alike:
            best = OlderReading(path, alike, min(len(older_mps), len(base_mps)))
    return best


def pairs_of_one_road(files: Iterable[Path]) -> list[tuple[Path, Path]]:
    """Return those of ``files`` that two readings of one road probably left for one driver."""
    sound = [(path, profile) for path in sorted(files) if (profile := _sound(path)) is not None]
    return [
        (path, other_path)
        for (path, profile), (other_path, other) in combinations(sound, 2)
        if profile.driver_id == other.driver_id
        and profile.route != other.route
        and is_older_reading(profile.iteration().base_mps, other.iteration().base_mps)
    ]


def _sound(path: Path) -> StoredProfile | None:
    try:
        return read(path)
    except ModelError:  # its own drive tells of it
        return None
