"""The byte format of a stored profile."""

from __future__ import annotations

import re
import struct
import zlib
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pldf.instance import ModelError
from pldf.profiles.profile_file import decode, encode, require_match
from pldf.profiles.store import Iteration, ProfileRefused, StoredProfile
from profile_examples import DRIVER, ROUTE, drive_result, learned_profile, new_profile


def sealed(body: bytes) -> bytes:
    return body + f"crc32 {zlib.crc32(body):08x}\n".encode()


def body_of(profile: StoredProfile) -> bytes:
    return encode(profile)[:-15]


def refusal(data: bytes) -> ProfileRefused:
    with pytest.raises(ProfileRefused) as caught:
        decode(data, "x.pldf")
    assert str(caught.value).startswith("x.pldf, ")
    assert "\n" not in str(caught.value)
    return caught.value


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


EXAMPLE = encode(learned_profile(2))
HEAD = 128  # bytes of its header
BLOCK = 128  # bytes of its blocks: 11 nodes and 40 fill bytes

HEADER_FAULTS = [
    (b"", b"<xml>", 1, "not a profile file"),
    (b"PLDF-PROFILE 1", b"PLDF-PROFILE 2", 1, "format 2 of a newer version.*update"),
    (b"PLDF-PROFILE 1", b"PLDF-PROFILE 999999999", 1, "newer version"),
    (b"PLDF-PROFILE 1", b"PLDF-PROFILE 0", 1, "format 0 does not exist"),
    (b"PLDF-PROFILE 1", b"PLDF-PROFILE 1\r", 1, "expected 'PLDF-PROFILE 1', found"),
    (b"driver 17", b"driver -17", 2, "expected 'driver NUMBER', found 'driver -17'"),
    (b"driver 17", b"driver 017", 2, "found 'driver 017'"),
    (b"driver 17", b"driver 1000000000", 2, "found"),
    (b"route 0123456789abcdef", b"route 0123456789ABCDEF", 3, "expected 'route 16_HEX"),
    (b"nodes 11", b"nodes 2", 4, "2 nodes; possible are 3 to"),
    (b"nodes 11", b"nodes 999999999", 4, "999999999 nodes"),
    (b"nodes 11", b"nodes 99999999999999999999", 4, "expected 'nodes NUMBER'"),
    (b"step_m 1", b"step_m 2", 5, "expected 'step_m 1'"),
    (b"iterations 2", b"iterations -1", 6, "expected 'iterations NUMBER'"),
    (b"iterations 2", b"iterations 999999", 9, "expected 'iteration 3 "),
    (b"iterations 2", b"iterations 1", 8, "expected 'end'"),
    (b"iteration 2 2", b"iteration 2 -2", 8, "expected 'iteration 2 INTERVENTIONS NOTE'"),
    (b"iteration 2 2", b"iteration 3 2", 8, "iteration 3 where 2 should be"),
    (b"drive 2", b"drive \xe9", 8, r"drive \\xe9"),
    (b"drive 2", b"x" * 81, 8, "expected 'iteration 2"),
    (b"drive 2", b"x" * 500, 8, "expected 'iteration 2"),
    (b"drive 2", b"drive 2 and more", 9, "not filled up"),
]


@pytest.mark.parametrize(("old", "new", "line", "reason"), HEADER_FAULTS)
def test_header_faults_name_the_line(old: bytes, new: bytes, line: int, reason: str) -> None:
    error = refusal(sealed(EXAMPLE[:-15].replace(old, new, 1)))
    assert error.where == f"line {line}"
    assert re.search(reason, error.reason)


def test_an_empty_file_says_so() -> None:
    assert "empty" in refusal(b"").reason


def test_every_truncation_is_called_truncated() -> None:
    for end in range(len(EXAMPLE)):
        assert "truncated" in refusal(EXAMPLE[:end]).reason


def test_bytes_behind_the_end() -> None:
    error = refusal(EXAMPLE + b"!!")
    assert error.where == f"byte {len(EXAMPLE)}"
    assert error.reason == "2 bytes behind the end of the profile"


def test_damage_is_found_by_the_checksum() -> None:
    data = bytearray(EXAMPLE)
    data[300] ^= 1
    error = refusal(bytes(data))
    assert error.where == f"byte {len(EXAMPLE) - 15}"
    assert "damaged: checksum" in error.reason


@pytest.mark.parametrize("block", range(9))
@pytest.mark.parametrize(
    "value", [float("nan"), float("inf"), -float("inf"), -200.5, 1e9, 5e300], ids=repr
)
def test_impossible_numbers_name_byte_and_place(block: int, value: float) -> None:
    body = bytearray(EXAMPLE[:-15])
    at = HEAD + BLOCK * block + 8 * 5
    body[at : at + 8] = struct.pack("<d", value)
    error = refusal(sealed(bytes(body)))
    assert error.where == f"byte {at}"
    name = ("base_mps", "learned_mps", "offset_mps", "drive", "intervention")[
        block and (block - 1) % 4 + 1
    ]
    of = "" if block == 0 else f" of iteration {(block - 1) // 4 + 1}"
    assert error.reason == f"{name}{of} is {value!r} at 5 m"


@pytest.mark.parametrize("block", [3, 4, 7, 8])
@pytest.mark.parametrize("value", [0.5, -1.0])
def test_counts_are_whole_and_not_negative(block: int, value: float) -> None:
    body = bytearray(EXAMPLE[:-15])
    body[HEAD + BLOCK * block : HEAD + 8 + BLOCK * block] = struct.pack("<d", value)
    assert refusal(sealed(bytes(body))).where == f"byte {HEAD + BLOCK * block}"


def test_fill_bytes_must_be_zero() -> None:
    body = bytearray(EXAMPLE[:-15])
    body[HEAD + 100] = 1
    error = refusal(sealed(bytes(body)))
    assert (error.where, error.reason) == (f"byte {HEAD + 88}", "fill bytes are not zero")


@st.composite
def mutations(draw: st.DrawFn) -> bytes:
    """Return the example after a few cuts, insertions, copies and overwritten pieces."""
    data = EXAMPLE
    for _ in range(draw(st.integers(1, 4))):
        start = draw(st.integers(0, len(data)) | st.integers(0, min(HEAD, len(data))))
        end = draw(st.integers(start, min(len(data), start + 24)))
        piece = draw(
            st.binary(max_size=24)
            | st.just(data[start:end])
            | st.sampled_from((b"9" * 9, b"0", b"-1", b"\n", b" ", b"end\n", b"\x00"))
        )
        data = data[:start] + piece + data[end:]
    return data


def reads_back_or_is_refused(data: bytes) -> None:
    try:
        profile = decode(data, "x")
    except ProfileRefused:
        return
    assert encode(profile) == data


@given(mutations())
def test_any_mutation_is_refused_or_changes_nothing(data: bytes) -> None:
    if data == EXAMPLE:
        assert encode(decode(data, "x")) == EXAMPLE
    else:
        refusal(data)


@given(mutations())
def test_mutations_with_a_right_checksum_never_surprise(data: bytes) -> None:
    reads_back_or_is_refused(sealed(data[:-15]))


@given(st.binary(max_size=300))
def test_any_bytes_behind_the_magic_never_surprise(data: bytes) -> None:
    reads_back_or_is_refused(data)
    reads_back_or_is_refused(sealed(b"PLDF-PROFILE 1\n" + data))


@pytest.mark.parametrize(
    ("wanted", "where", "reason"),
    [
        ((18, ROUTE, 11), "line 2", "profile of driver 17, not of driver 18"),
        ((DRIVER, "f" * 16, 11), "line 3", "learned on another route"),
        ((DRIVER, ROUTE, 12), "line 4", "11 nodes, but the route has 12"),
    ],
)
def test_profile_of_somebody_else(wanted: tuple[int, str, int], where: str, reason: str) -> None:
    require_match(learned_profile(), (DRIVER, ROUTE, 11), "x.pldf")
    with pytest.raises(ProfileRefused, match=reason) as caught:
        require_match(learned_profile(), wanted, "x.pldf")
    assert caught.value.where == where


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
