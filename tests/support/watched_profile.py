"""A profile of which one knows what was learned where, on the study road."""

from __future__ import annotations

import numpy as np
from pldf.profiles.profile_file import encode
from pldf.profiles.stored_profile import StoredProfile
from pldf.roads import fingerprint, packed_route

KMH = 1.0 / 3.6
BASE_KMH = 60.0


def before() -> StoredProfile:
    """Return what was known before: 8 km/h faster at 500 to 700 m."""
    route = packed_route(0)
    nodes = 4501
    first = StoredProfile(1, fingerprint(route), np.full(nodes, BASE_KMH * KMH))
    return _lesson(first, 500, 701, 8.0)


def after() -> bytes:
    """Return the file after a drive that taught 6 km/h slower at 2000 to 2200 m."""
    return encode(_lesson(before(), 2000, 2201, -6.0))


def forgotten() -> bytes:
    """Return the file after that place was forgotten again."""
    profile = _lesson(before(), 2000, 2201, -6.0)
    older = profile.iteration(1)
    changed = {name: getattr(older, name) for name in ("learned_mps", "drive", "intervention")}
    changed["lessons"] = older.lessons
    return encode(profile.with_iteration(profile.next_iteration("forget", "", 0, changed)))


def _lesson(profile: StoredProfile, first: int, behind: int, kmh: float) -> StoredProfile:
    number = len(profile.iterations) + 1
    known = profile.iteration()
    columns = {
        name: getattr(known, name).copy()
        for name in ("learned_mps", "drive", "intervention", "lessons")
    }
    columns["learned_mps"][first:behind] += kmh * KMH
    columns["drive"][first:behind] = number
    columns["intervention"][first:behind] = 1
    columns["lessons"][first:behind] = 1
    return profile.with_iteration(profile.next_iteration("drive", "learned", 1, columns))
