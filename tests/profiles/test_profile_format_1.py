"""Format 1, which release 0.2.0 writes: read, upgraded on the next write, exported to."""

from __future__ import annotations

import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pldf.profiles.profile_file import decode, encode, same_history
from pldf.profiles.profile_format_1 import encode_1
from pldf.profiles.store import ProfileRefused, read_profile
from pldf.profiles.stored_profile import COLUMN_NAMES
from profile_examples import DRIVER, ROUTE, drive_result, learned_profile, new_profile, sealed
from stored import NAME, saved_store

KNOWN = ("learned_mps", "offset_mps", "drive", "intervention")


def hand_built_file() -> bytes:
    """Two iterations over three nodes, as release 0.2.0 writes them."""
    head = (
        b"PLDF-PROFILE 1\n"
        b"driver 17\n"
        b"route 0123456789abcdef\n"
        b"nodes 3\n"
        b"step_m 1\n"
        b"iterations 2\n"
        b"iteration 1 4 B1, 4.5 km\n"
        b"iteration 2 0\n"
        b"end"
    )
    assert len(head) == 120
    head += b" " * 7 + b"\n"
    columns = (
        (20.0, 20.5, 21.0),
        (20.0, 22.25, 21.0),
        (0.0, -1.5, -0.0),
        (0.0, 1.0, 0.0),
        (0.0, 4.0, 0.0),
        (20.0, 0.1, 21.0),
        (0.0, 0.0, 200.0),
        (0.0, 2.0, 999999999.0),
        (0.0, 1.0, 0.0),
    )
    blocks = b"".join(struct.pack("<3d", *column) + bytes(40) for column in columns)
    assert len(head) == 128
    assert len(blocks) == 9 * 64
    return sealed(head + blocks)


def test_file_built_by_hand_is_read_and_written_to_the_byte() -> None:
    data = hand_built_file()
    profile = decode(data, "by hand")
    assert (profile.driver_id, profile.route, profile.nodes) == (17, "0123456789abcdef", 3)
    assert profile.base_mps.tolist() == [20.0, 20.5, 21.0]
    first, second = profile.iterations
    assert (first.number, first.kind, first.interventions, first.note) == (
        1, "drive", 4, "B1, 4.5 km",
    )  # fmt: skip
    assert first.base_mps.tolist() == [20.0, 20.5, 21.0]
    assert first.learned_mps.tolist() == [20.0, 22.25, 21.0]
    assert first.offset_mps.tobytes() == struct.pack("<3d", 0.0, -1.5, -0.0)
    assert first.drive.tolist() == [0.0, 1.0, 0.0]
    assert first.intervention.tolist() == [0.0, 4.0, 0.0]
    assert (second.number, second.interventions, second.note) == (2, 0, "")
    assert second.learned_mps.tolist() == [20.0, 0.1, 21.0]
    assert second.drive.tolist() == [0.0, 2.0, 999999999.0]
    for name in set(COLUMN_NAMES) - {*KNOWN, "base_mps"}:
        assert not getattr(second, name).any()
    assert encode_1(profile) == data


def test_upgraded_and_exported_again_it_is_the_same_file() -> None:
    old = hand_built_file()
    new = encode(decode(old, "old"))
    assert new.startswith(b"PLDF-PROFILE 2\n")
    assert same_history(decode(new, "new"), decode(old, "old"))
    assert encode_1(decode(new, "new")) == old


@pytest.mark.parametrize(
    ("note", "kind"),
    [
        (b"rollback of 0", "rollback"), (b"rollback of 12", "rollback"), (b"rollback of", "drive"),
        (b"rollback of x", "drive"), (b"a rollback of 1", "drive"), (b"rollback of 1b", "drive"),
    ],
)  # fmt: skip
def test_a_rollback_is_known_by_its_note(note: bytes, kind: str) -> None:
    profile = learned_profile(1)
    named = replace(profile.iterations[0], note=note.decode())
    data = encode_1(replace(profile, iterations=(named,)))
    assert decode(data, "x").iteration().kind == kind


def test_the_next_write_upgrades(tmp_path: Path) -> None:
    old = new_profile()
    for seed in range(2):
        old = old.with_iteration(drive_result(old, f"drive {seed}", seed))
    (tmp_path / NAME).write_bytes(encode_1(old))
    store = saved_store(tmp_path, 0)
    loaded = store.load(DRIVER, ROUTE, 11)
    assert loaded is not None
    assert (tmp_path / NAME).read_bytes() == encode_1(old)  # reading changes nothing
    saved = store.append(loaded, drive_result(loaded, "new", 2))
    assert not saved.warning
    assert (tmp_path / NAME).read_bytes().startswith(b"PLDF-PROFILE 2\n")
    profile = read_profile(tmp_path / NAME)
    assert [i.note for i in profile.iterations] == ["drive 0", "drive 1", "new"]
    for before, after in zip(old.iterations, profile.iterations, strict=False):
        for name in KNOWN:
            assert np.array_equal(getattr(before, name), getattr(after, name))


def test_the_exported_base_profile_is_the_newest() -> None:
    """As a release that knows one base profile would have written it."""
    profile = learned_profile(1)
    planned_anew = profile.base_mps + 0.5
    newest = profile.next_iteration("drive", "slower planner", 0, {"base_mps": planned_anew})
    again = decode(encode_1(profile.with_iteration(newest)), "x")
    assert np.array_equal(again.base_mps, planned_anew)


FAULTS = [
    (b"iterations 2", b"iterations 999999", 9, "expected 'iteration 3 "),
    (b"iterations 2", b"iterations 1", 8, "expected 'end'"),
    (b"iteration 2 2", b"iteration 2 -2", 8, "expected 'iteration 2 INTERVENTIONS NOTE'"),
    (b"iteration 2 2", b"iteration 3 2", 8, "iteration 3 where 2 should be"),
    (b"iteration 2 2", b"iteration 2 drive 2", 8, "expected 'iteration 2 INTERVENTIONS NOTE'"),
    (b"drive 2", b"x" * 81, 8, "expected 'iteration 2"),
    (b"drive 2", b"drive 2 and more", 9, "not filled up"),
]


@pytest.mark.parametrize(("old", "new", "line", "reason"), FAULTS)
def test_header_faults_name_the_line(old: bytes, new: bytes, line: int, reason: str) -> None:
    body = encode_1(learned_profile(2))[:-15].replace(old, new, 1)
    with pytest.raises(ProfileRefused, match=reason) as caught:
        decode(sealed(body), "x")
    assert caught.value.where == f"line {line}"


def test_every_truncation_is_called_truncated() -> None:
    example = encode_1(learned_profile(2))
    for end in range(len(example)):
        with pytest.raises(ProfileRefused, match="truncated"):
            decode(example[:end], "x")
