"""What the function had learned before a drive: the iteration of a profile that it followed."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

from ..errors import ModelError
from ..profiles.store import ProfileStore, StoredProfile, read_profile
from ..roads import Route, fingerprint
from ..study.phases import Phase

_TAUGHT: Final = ("drive", "learn")


@dataclass(frozen=True)
class Profiles:
    """The learned profiles of a study's participants, one file each with all iterations.

    Attributes:
        folder: with ``PARTICIPANT.pldf``, or with the files of a profile store, whose driver id is
            the number in the participant's name: ``driver-000007_route-....pldf`` of P07.
        route: the route driven.
        order: the drives of the study in their order.
    """

    folder: Path
    route: Route
    order: Sequence[Phase]
    _read: dict[str, StoredProfile] = field(default_factory=dict, compare=False)

    def followed(self, participant: str, phase: str) -> StoredProfile:
        """Return the profile as it was before a drive: its newest iteration is what it followed.

        The iterations are the lessons of the study's drives, in order: B1 follows what was learned
        before it, B2 what B1 taught besides. Behind the last one nothing more was learned.

        Raises:
            ModelError: there is no profile, it is of another route, or it does not tell.
        """
        path = self.path(participant)
        profile = self._read.get(participant) or self._read_whole(participant, path)
        drives = [one.name for one in self.order]
        lessons = [one.name for one in self.order if one.learn]
        count = len(profile.iterations)
        if count > 1 and (phase not in drives or count > len(lessons)):
            raise ModelError(
                f"{path}: {count} iterations, and the drives learned from are "
                f"{', '.join(lessons)}; which one {phase} followed cannot be told, so record "
                "set_speed_offset_mps"
            )
        if count > 1:
            count = sum(one.learn for one in self.order[: drives.index(phase)])
        return replace(profile, iterations=profile.iterations[:count])

    def path(self, participant: str) -> Path:
        """Return the file with what was learned from ``participant``.

        Raises:
            ModelError: there is none.
        """
        own = self.folder / f"{participant}.pldf"
        if own.is_file():
            return own
        numbers = re.findall(r"\d+", participant)
        if len(numbers) == 1:
            stored = ProfileStore(self.folder).path(int(numbers[0]), fingerprint(self.route))
            if stored.is_file():
                return self.folder / stored.name
            raise ModelError(f"{self.folder}: neither {own.name} nor {stored.name} is there")
        raise ModelError(f"{self.folder}: no {own.name}, which is what {participant} taught")

    def _read_whole(self, participant: str, path: Path) -> StoredProfile:
        if other := next((who for who in self._read if self.path(who) == path), ""):
            raise ModelError(
                f"{path}: meant for both {other} and {participant}; name the profiles "
                f"{other}.pldf and {participant}.pldf"
            )
        profile = read_profile(path)
        if profile.route != fingerprint(self.route) or profile.nodes != self.route.nodes:
            raise ModelError(
                f"{path}: learned on route {profile.route}, not on {self.route.name} "
                f"({fingerprint(self.route)}); if that is an older reading of the same road, "
                "'pldf profiles move' carries it over"
            )
        for one in profile.iterations:
            if one.kind not in _TAUGHT:
                raise ModelError(
                    f"{path}: iteration {one.number} is of kind {one.kind}; which one a drive "
                    "followed cannot be told, so record set_speed_offset_mps"
                )
        self._read[participant] = profile
        return profile
