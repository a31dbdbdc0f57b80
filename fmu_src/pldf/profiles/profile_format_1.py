r"""Format 1 of a profile file, which release 0.2.0 and older ones write: read, and exported to.

It knows no kinds, no base profile per iteration, no lessons, bounds, evidence or demonstrations::

    PLDF-PROFILE 1
    driver 17
    route 0123456789abcdef
    nodes 4501
    step_m 1
    iterations 2
    iteration 1 3 learned            number, interventions, note
    iteration 2 0 rollback of 0
    end                              filled up as in format 2

Behind the header every block stands, ``1 + 4 * k`` of them: ``base_mps``, then for each iteration
``learned_mps``, ``offset_mps``, ``drive`` and ``intervention``.
"""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Final

from .file_parts import (
    CHECKSUM_SIZE,
    COLUMNS,
    FILE_MAX,
    NOTE,
    NUMBER,
    Lines,
    Start,
    header,
    read_block,
    refuse,
    sealed,
)
from .stored_profile import StoredProfile

VERSION: Final = 1
COLUMNS_1: Final = COLUMNS[1:5]

_ITERATION: Final = re.compile(rb"iteration " + NUMBER + rb" " + NUMBER + NOTE)
_ROLLBACK: Final = re.compile(r"rollback of [0-9]+")


def encode_1(profile: StoredProfile) -> bytes:
    """Return the bytes of a sound ``profile`` in format 1; what that does not know is left out.

    Its base profile is that of the newest iteration.

    Raises:
        ProfileRefused: they are more than a file may have.
    """
    file = f"profile of driver {profile.driver_id}"
    start = Start(profile.driver_id, profile.route, profile.nodes, len(profile.iterations))
    lines = [
        f"iteration {i.number} {i.interventions}" + (f" {i.note}" if i.note else "")
        for i in profile.iterations
    ]
    blocks = [profile.iteration().base_mps]
    blocks += [getattr(i, column.name) for i in profile.iterations for column in COLUMNS_1]
    data = sealed(header([*start.text(VERSION), *lines], file), blocks)
    if len(data) > FILE_MAX:
        refuse(file, "", f"{len(data)} bytes in format 1; possible are {FILE_MAX}")
    return data


def decode_1(lines: Lines) -> StoredProfile:
    """Return the profile in the file of ``lines``, the first of which is taken.

    All its iterations have its one base profile. What format 1 does not know is 0; the kind is
    ``rollback`` where the note says so, else ``drive``.

    Raises:
        ProfileRefused: the file is not exactly what ``encode_1`` writes.
    """
    start = lines.take_start()
    heads = [_take_iteration(lines, number + 1) for number in range(start.iterations)]
    lines.take_end()
    at = lines.at
    size = at + (1 + len(COLUMNS_1) * len(heads)) * start.stride + CHECKSUM_SIZE
    lines.check_whole(size)
    base = read_block(lines, at, start.nodes, COLUMNS[0], 0)
    profile = StoredProfile(start.driver_id, start.route, base)
    iterations = [profile.iteration(0)]
    for number, (interventions, note) in enumerate(heads, 1):
        columns = {}
        for column in COLUMNS_1:
            at += start.stride
            columns[column.name] = read_block(lines, at, start.nodes, column, number)
        kind = "rollback" if _ROLLBACK.fullmatch(note) else "drive"
        iterations.append(
            replace(
                iterations[0],
                number=number,
                kind=kind,
                note=note,
                interventions=interventions,
                **columns,
            )
        )
    return replace(profile, iterations=tuple(iterations[1:]))


def _take_iteration(lines: Lines, expected: int) -> tuple[int, str]:
    number, interventions, note = lines.take(_ITERATION, f"iteration {expected} INTERVENTIONS NOTE")
    if int(number) != expected:
        lines.refuse(f"iteration {number} where {expected} should be")
    return int(interventions), note
