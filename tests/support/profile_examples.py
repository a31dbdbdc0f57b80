"""Profiles for the tests of file format, store and command."""

from __future__ import annotations

import zlib
from dataclasses import replace

import numpy as np
from pldf.profiles.store import Iteration, StoredProfile

ROUTE = "0123456789abcdef"
DRIVER = 17


def new_profile(nodes: int = 11, driver_id: int = DRIVER, route: str = ROUTE) -> StoredProfile:
    """Return a profile before the first drive."""
    return StoredProfile(driver_id, route, np.linspace(20.0, 25.0, nodes))


def drive_result(profile: StoredProfile, note: str = "learned", seed: int = 0) -> Iteration:
    """Return what one more drive has learned: arbitrary, but the same for the same seed."""
    random = np.random.default_rng(seed)
    number = len(profile.iterations) + 1
    n = profile.nodes
    return profile.next_iteration(
        "drive",
        note,
        number % 4,
        {
            "learned_mps": profile.base_mps + random.uniform(-3.0, 3.0, n),
            "offset_mps": random.choice((-5.0 / 3.6, 0.0, 0.1), n),
            "drive": random.integers(0, number + 1, n).astype(float),
            "intervention": random.integers(0, 9, n).astype(float),
            "lessons": random.integers(0, number + 1, n).astype(float),
            "bound": random.integers(0, 6, n).astype(float),
            "evidence_faster": random.choice((0.0, 1.25, 2.2), n),
            "pending_faster": random.integers(0, 3, n).astype(float),
            "pending_faster_mps": random.uniform(0.0, 50.0, n),
        },
    )


def learned_profile(iterations: int = 2, nodes: int = 11) -> StoredProfile:
    """Return a profile after some drives."""
    profile = new_profile(nodes)
    for seed in range(iterations):
        profile = profile.with_iteration(drive_result(profile, f"drive {seed + 1}", seed))
    return profile


def sealed(body: bytes) -> bytes:
    """Return a file's ``body`` with its checksum."""
    return body + f"crc32 {zlib.crc32(body):08x}\n".encode()


def two_bases() -> tuple[StoredProfile, StoredProfile]:
    """Return two large profiles without iterations, so that either may replace the other."""
    slow = new_profile(nodes=200_000)
    return slow, replace(slow, base_mps=slow.base_mps + 0.5)
