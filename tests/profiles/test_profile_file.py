"""The byte format of a stored profile."""

from __future__ import annotations

import struct
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pldf.errors import ModelError
from pldf.profiles.profile_file import decode, encode
from pldf.profiles.store import Iteration, ProfileRefused, StoredProfile
from profile_examples import drive_result, learned_profile, new_profile, sealed


def hand_built_file() -> bytes:
    """Two iterations over three nodes, written down without the code under test."""
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
    assert (first.number, first.interventions, first.note) == (1, 4, "B1, 4.5 km")
    assert first.learned_mps.tolist() == [20.0, 22.25, 21.0]
    assert first.offset_mps.tobytes() == struct.pack("<3d", 0.0, -1.5, -0.0)
    assert first.drive.tolist() == [0.0, 1.0, 0.0]
    assert first.intervention.tolist() == [0.0, 4.0, 0.0]
    assert (second.number, second.interventions, second.note) == (2, 0, "")
    assert second.learned_mps.tolist() == [20.0, 0.1, 21.0]
    assert second.drive.tolist() == [0.0, 2.0, 999999999.0]
    assert encode(profile) == data


def speeds(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high) | st.sampled_from((0.0, -0.0, 5e-324, high))


@st.composite
def profiles(draw: st.DrawFn) -> StoredProfile:
    nodes = draw(st.integers(3, 20))

    def column(low: float, high: float) -> np.ndarray:
        return np.array(draw(st.lists(speeds(low, high), min_size=nodes, max_size=nodes)))

    def whole() -> np.ndarray:
        counts = st.integers(0, 999_999_999)
        return np.array(draw(st.lists(counts, min_size=nodes, max_size=nodes)), float)

    note = st.text(st.characters(min_codepoint=32, max_codepoint=126), max_size=80).map(str.strip)
    iterations = tuple(
        Iteration(
            number,
            draw(note),
            draw(st.integers(0, 999_999_999)),
            column(0.0, 200.0),
            column(-200.0, 200.0),
            whole(),
            whole(),
        )
        for number in range(1, draw(st.integers(0, 3)) + 1)
    )
    driver_id = draw(st.integers(0, 999_999_999))
    route = draw(st.from_regex(r"\A[0-9a-f]{16}\Z"))
    return StoredProfile(driver_id, route, column(0.0, 200.0), iterations)


@given(profiles())
def test_round_trip_to_the_bit(profile: StoredProfile) -> None:
    data = encode(profile)
    again = decode(data, "x")
    assert again.base_mps.tobytes() == profile.base_mps.tobytes()
    for old, new in zip(profile.iterations, again.iterations, strict=True):
        assert (new.number, new.note, new.interventions) == (
            old.number,
            old.note,
            old.interventions,
        )
        for name in ("learned_mps", "offset_mps", "drive", "intervention"):
            assert getattr(new, name).tobytes() == getattr(old, name).tobytes()
    assert encode(again) == data


@pytest.mark.parametrize("nodes", [3, 7, 8, 9, 4501])
@pytest.mark.parametrize("iterations", [0, 1, 12])
def test_blocks_are_aligned_to_64_bytes(nodes: int, iterations: int) -> None:
    profile = learned_profile(iterations, nodes)
    data = encode(profile)
    header = data.index(b"\n", data.index(b"\nend") + 1) + 1
    stride = -(-8 * nodes // 64) * 64
    assert header % 64 == 0
    assert len(data) == header + (1 + 4 * iterations) * stride + 15
    if iterations:
        start = header + (4 * iterations - 3) * stride
        newest = profile.iterations[-1].learned_mps
        assert data[start : start + 8 * nodes] == newest.tobytes()


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
        "found 'iteration 1 -1": profile.with_iteration(replace(result, interventions=-1)),
        "only ASCII": profile.with_iteration(replace(result, note="größer")),
        "expected 'end'": profile.with_iteration(replace(result, note="a\nb")),
        "expected 'iteration 1 ": profile.with_iteration(replace(result, note="open end ")),
        "found 'driver -1'": replace(profile, driver_id=-1),
        "expected 'route ": replace(profile, route="../../etc/passwd"),
        "2 nodes; possible are 3": replace(profile, base_mps=profile.base_mps[:2]),
    }


@pytest.mark.parametrize("reason", unsound())
def test_nothing_is_written_that_could_not_be_read(reason: str) -> None:
    with pytest.raises(ProfileRefused, match=reason):
        encode(unsound()[reason])
