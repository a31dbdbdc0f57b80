"""``pldf profiles move``: what was learned, carried over to a new reading of its road."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Final

import numpy as np

from ...errors import ModelError
from ...function import DrivingFunction
from ...kernel.codes import BOUND
from ...kernel.units import KMH_PER_MPS
from ...moved_profile import Moved, move_profile
from ...outcome_words import BOUND_WORDS
from ...profiles.store import ProfileStore, StoredProfile, read_profile, write_profile
from ...recordings.interventions import runs
from ...roads import Route, fingerprint
from .road import add_road
from .settings import add_settings, apply_settings

_TOLD_MAX: Final = 20
_SHOWN_MPS: Final = 0.1 / KMH_PER_MPS


def add_move(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the action."""
    add_road(parser, "the road as it is read now", required=True)
    parser.add_argument(
        "--out",
        metavar="FILE",
        type=Path,
        help="profile file to write (default: beside the old one, where the function looks for it)",
    )
    parser.add_argument(
        "--force",
        action="store_true",
        help="move even if it does not look like the same road, and replace what is there "
        "already; that is kept as OUT.replaced-N",
    )
    add_settings(parser)


def chosen_older(store: ProfileStore, driver_id: int, route: Route) -> Path:
    """Return the profile of a driver that was probably learned on an older reading of ``route``.

    Raises:
        ModelError: there is none.
    """
    function = DrivingFunction()
    function.prepare(route)
    base = np.array(function.profile.base_mps)
    older = store.older_reading(driver_id, fingerprint(route), base)
    if older is None:
        names = ", ".join(path.name for path in store.files_of(driver_id)) or "none"
        raise ModelError(
            f"{store.folder}: no profile of driver {driver_id} looks as if it was learned on an "
            f"older reading of {route.name}; name the file (there is: {names})"
        )
    return older.path


def move(path: Path, route: Route, options: argparse.Namespace) -> None:
    """Carry the profile in ``path`` over to ``route``, and say what became of it."""
    function = DrivingFunction()
    apply_settings(function.record, options.settings)
    stored = read_profile(path)
    try:
        moved = move_profile(stored, route, function, force=options.force)
    except ModelError as problem:
        raise ModelError(f"{path}: {problem}") from None
    profile = moved.profile
    out = options.out or ProfileStore(path.parent).path(profile.driver_id, profile.route)
    kept = write_profile(out, profile, force=options.force)
    if kept is not None:
        print(f"pldf: {out}: what was there is kept as {kept}", file=sys.stderr)
    _tell(stored, moved)
    print(f"written    {out}; {path} is left as it is")


def _tell(stored: StoredProfile, moved: Moved) -> None:
    profile = moved.profile
    same = int(np.count_nonzero(~moved.changed))
    print(f"driver     {profile.driver_id}, {len(profile.iterations)} iterations carried over")
    print(f"from       route {stored.route}, {stored.nodes - 1} m")
    print(f"to         route {profile.route}, {profile.nodes - 1} m")
    print(f"as before  {same} of {profile.nodes} m, to the bit")
    if profile.nodes > stored.nodes:
        print(f"new        {profile.nodes - stored.nodes} m at the end, with the base profile")
    elif profile.nodes < stored.nodes:
        print(f"left out   {stored.nodes - profile.nodes} m at the end, which the road has no more")
    _tell_changed(moved, min(stored.nodes, profile.nodes))
    _tell_cut(moved)


def _tell_changed(moved: Moved, both: int) -> None:
    """Say where the base profile changed, of the nodes that both readings have."""
    newest = moved.profile.iteration()
    changed = moved.changed[:both] & (
        np.abs(newest.base_mps - moved.older_base_mps)[:both] > _SHOWN_MPS
    )
    places = runs(changed)
    for first, behind in places[:_TOLD_MAX]:
        before = KMH_PER_MPS * moved.older_base_mps[first:behind].mean()
        now = KMH_PER_MPS * newest.base_mps[first:behind].mean()
        learned = KMH_PER_MPS * newest.learned_mps[first:behind].mean()
        print(
            f"changed    {first} to {behind - 1} m: base profile {before:.1f} to {now:.1f} km/h on "
            f"average, learned speed {learned:.1f} km/h"
        )
    if len(places) > _TOLD_MAX:
        print(f"changed    {len(places) - _TOLD_MAX} more places")


def _tell_cut(moved: Moved) -> None:
    newest = moved.profile.iteration()
    places = runs(moved.cut_mps > _SHOWN_MPS)
    for first, behind in places[:_TOLD_MAX]:
        codes = np.unique(newest.bound[first:behind]).astype(int)
        words = ", ".join(BOUND_WORDS[code] for code in codes if BOUND.items[code] != "NONE")
        most = KMH_PER_MPS * moved.cut_mps[first:behind].max()
        print(f"cut        {first} to {behind - 1} m, by up to {most:.1f} km/h: {words}")
    if len(places) > _TOLD_MAX:
        print(f"cut        {len(places) - _TOLD_MAX} more places")
