"""The byte format of a stored profile."""

from __future__ import annotations

import re
import struct
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pldf.errors import ModelError
from pldf.profiles.profile_file import decode, encode
from pldf.profiles.store import ProfileRefused, StoredProfile
from pldf.profiles.stored_profile import COLUMN_NAMES, KINDS
from profile_examples import drive_result, learned_profile, new_profile, sealed


def blocks_of(*columns: tuple[float, float, float]) -> bytes:
    """Return the blocks of a file with three nodes."""
    return b"".join(struct.pack("<3d", *column) + bytes(40) for column in columns)


def hand_built_file() -> bytes:
    """Three iterations over three nodes, written down without the code under test."""
    head = (
        b"PLDF-PROFILE 2\n"
        b"driver 17\n"
        b"route 0123456789abcdef\n"
        b"nodes 3\n"
        b"step_m 1\n"
        b"iterations 3\n"
        b"blocks 12\n"
        b"block base_mps m/s\n"
        b"iteration 1 drive 4 B1, 4.5 km\n"
        b"block learned_mps m/s\n"
        b"block offset_mps m/s\n"
        b"block drive 1\n"
        b"block intervention 1\n"
        b"block lessons 1\n"
        b"block evidence_slower 1\n"
        b"iteration 2 learn 0\n"
        b"block base_mps m/s\n"
        b"block drive 1\n"
        b"block offset_pending_slower_mps m/s\n"
        b"iteration 3 rollback 0 rollback of 0\n"
        b"block learned_mps m/s\n"
        b"block drive 1\n"
        b"end"
    )
    assert len(head) == 421
    head += b" " * 26 + b"\n"
    assert len(head) == 448
    blocks = blocks_of(
        (20.0, 20.5, 21.0),
        (20.0, 22.25, 21.0),
        (0.0, -1.5, -0.0),
        (0.0, 1.0, 0.0),
        (0.0, 4.0, 0.0),
        (0.0, 1.0, 999999999.0),
        (1.25, 2.2, 0.0),
        (20.0, 20.5, 200.0),
        (0.0, 1.0, 2.0),
        (-200.0, 0.1, 0.0),
        (20.0, 20.5, 200.0),
        (0.0, 0.0, 0.0),
    )
    return sealed(head + blocks)


def test_file_built_by_hand_is_read_and_written_to_the_byte() -> None:
    data = hand_built_file()
    profile = decode(data, "by hand")
    assert (profile.driver_id, profile.route, profile.nodes) == (17, "0123456789abcdef", 3)
    assert profile.base_mps.tolist() == [20.0, 20.5, 21.0]
    heads = [(i.number, i.kind, i.interventions, i.note) for i in profile.iterations]
    assert heads == [
        (1, "drive", 4, "B1, 4.5 km"), (2, "learn", 0, ""), (3, "rollback", 0, "rollback of 0"),
    ]  # fmt: skip
    first, second, third = profile.iterations
    assert first.base_mps.tolist() == [20.0, 20.5, 21.0]
    assert first.learned_mps.tolist() == [20.0, 22.25, 21.0]
    assert first.offset_mps.tobytes() == struct.pack("<3d", 0.0, -1.5, -0.0)
    assert first.drive.tolist() == [0.0, 1.0, 0.0]
    assert first.intervention.tolist() == [0.0, 4.0, 0.0]
    assert first.lessons.tolist() == [0.0, 1.0, 999999999.0]
    assert first.evidence_slower.tolist() == [1.25, 2.2, 0.0]
    assert not first.bound.any()
    assert second.base_mps.tolist() == [20.0, 20.5, 200.0]
    assert second.learned_mps.tolist() == [20.0, 22.25, 21.0]
    assert second.drive.tolist() == [0.0, 1.0, 2.0]
    assert second.offset_pending_slower_mps.tolist() == [-200.0, 0.1, 0.0]
    assert third.base_mps.tolist() == third.learned_mps.tolist() == [20.0, 20.5, 200.0]
    assert not third.drive.any()
    assert third.intervention.tolist() == [0.0, 4.0, 0.0]
    assert encode(profile) == data


def speeds(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high) | st.sampled_from((0.0, -0.0, 5e-324, high))


@st.composite
def profiles(draw: st.DrawFn) -> StoredProfile:
    nodes = draw(st.integers(3, 20))

    def column(low: float, high: float) -> np.ndarray:
        return np.array(draw(st.lists(speeds(low, high), min_size=nodes, max_size=nodes)))

    def whole(high: int | None) -> np.ndarray:
        counts = st.integers(0, high or 999_999_999)
        return np.array(draw(st.lists(counts, min_size=nodes, max_size=nodes)), float)

    def values(name: str) -> np.ndarray:
        if name.endswith("_mps"):
            return column(-200.0 if name.startswith("offset") else 0.0, 200.0)
        return column(0.0, 2.2) if "evidence" in name else whole(5 if name == "bound" else None)

    note = st.text(st.characters(min_codepoint=32, max_codepoint=126), max_size=80).map(str.strip)
    driver_id = draw(st.integers(0, 999_999_999))
    route = draw(st.from_regex(r"\A[0-9a-f]{16}\Z"))
    profile = StoredProfile(driver_id, route, column(0.0, 200.0))
    for _ in range(draw(st.integers(0, 3))):
        changed = draw(st.sets(st.sampled_from(COLUMN_NAMES), max_size=6))
        kind, interventions = draw(st.sampled_from(KINDS)), draw(st.integers(0, 999_999_999))
        columns = {name: values(name) for name in sorted(changed)}
        iteration = profile.next_iteration(kind, draw(note), interventions, columns)
        profile = profile.with_iteration(iteration)
    return profile


@given(profiles())
def test_round_trip_to_the_bit(profile: StoredProfile) -> None:
    data = encode(profile)
    again = decode(data, "x")
    assert again.base_mps.tobytes() == profile.base_mps.tobytes()
    for old, new in zip(profile.iterations, again.iterations, strict=True):
        for name in ("number", "kind", "note", "interventions"):
            assert getattr(new, name) == getattr(old, name)
        for name in COLUMN_NAMES:
            assert getattr(new, name).tobytes() == getattr(old, name).tobytes()
    assert encode(again) == data


@pytest.mark.parametrize("nodes", [3, 7, 8, 9, 4501])
@pytest.mark.parametrize("iterations", [0, 1, 12])
def test_blocks_are_aligned_to_64_bytes(nodes: int, iterations: int) -> None:
    profile = learned_profile(iterations, nodes)
    data = encode(profile)
    header = data.index(b"\n", data.index(b"\nend") + 1) + 1
    named = re.findall(rb"^block (\w+)", data[:header], re.MULTILINE)
    stride = -(-8 * nodes // 64) * 64
    assert header % 64 == 0
    assert len(data) == header + len(named) * stride + 15
    if iterations:
        start = header + (len(named) - 1 - named[::-1].index(b"learned_mps")) * stride
        newest = profile.iterations[-1].learned_mps
        assert data[start : start + 8 * nodes] == newest.tobytes()


def test_only_what_changed_stands_in_the_file() -> None:
    profile = learned_profile(3, 4501)
    size = len(encode(profile))
    same = profile.next_iteration("drive", "nothing learned", 0, {})
    assert len(encode(profile.with_iteration(same))) <= size + 64
    copies = {name: getattr(same, name).copy() for name in COLUMN_NAMES}
    copied = profile.next_iteration("drive", "nothing learned", 0, copies)
    assert encode(profile.with_iteration(copied)) == encode(profile.with_iteration(same))
    for values in copies.values():
        values[:] = 0.0  # back to zero is a change
    cleared = profile.with_iteration(profile.next_iteration("undo", "", 0, copies))
    assert not decode(encode(cleared), "x").iteration().lessons.any()


def test_minus_zero_is_not_zero() -> None:
    profile = new_profile()
    minus = profile.with_iteration(
        profile.next_iteration("drive", "", 0, {"offset_mps": np.full(11, -0.0)})
    )
    assert np.signbit(decode(encode(minus), "x").iteration().offset_mps).all()


def test_arrays_that_were_read_cannot_be_changed() -> None:
    profile = decode(encode(learned_profile()), "x")
    with pytest.raises(ValueError, match="read-only"):
        profile.iterations[0].learned_mps[0] = 1.0


def test_iteration_zero_is_the_base_profile_and_none_the_newest() -> None:
    profile = learned_profile(2)
    base = profile.iteration(0)
    assert base.learned_mps is profile.base_mps
    assert not base.offset_mps.any()
    assert profile.iteration() is profile.iterations[1]
    assert profile.iteration(1) is profile.iterations[0]
    for number in (-1, 3):
        with pytest.raises(ModelError, match=rf"no iteration {number}; .* 0 \(base\) to 2"):
            profile.iteration(number)


def unsound() -> dict[str, StoredProfile]:
    profile = new_profile()
    result = drive_result(profile)
    nan = result.learned_mps.copy()
    nan[3] = np.nan
    return {
        "learned_mps of iteration 1 is nan at 3 m": profile.with_iteration(
            replace(result, learned_mps=nan)
        ),
        r"offset_mps has shape \(10,\), base_mps 11": profile.with_iteration(
            replace(result, offset_mps=result.offset_mps[:-1])
        ),
        "iteration 2 where 1 should be": profile.with_iteration(replace(result, number=2)),
        "found 'iteration 1 drive -1": profile.with_iteration(replace(result, interventions=-1)),
        "only ASCII": profile.with_iteration(replace(result, note="größer")),
        "expected 'end'": profile.with_iteration(replace(result, note="a\nb")),
        "expected 'iteration 1 ": profile.with_iteration(replace(result, note="open end ")),
        "kind 'drift'": profile.with_iteration(replace(result, kind="drift")),
        "bound of iteration 1 is 6.0 at 0 m": profile.with_iteration(
            replace(result, bound=np.full(11, 6.0))
        ),
        "found 'driver -1'": replace(profile, driver_id=-1),
        "expected 'route ": replace(profile, route="../../etc/passwd"),
        "2 nodes; possible are 3": replace(profile, base_mps=profile.base_mps[:2]),
    }


@pytest.mark.parametrize("reason", unsound())
def test_nothing_is_written_that_could_not_be_read(reason: str) -> None:
    with pytest.raises(ProfileRefused, match=reason):
        encode(unsound()[reason])
