"""Stored profiles that are damaged, foreign or made up: refused with their place."""

from __future__ import annotations

import re
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pldf.profiles.profile_file import decode, encode, require_match
from pldf.profiles.store import ProfileRefused, StoredProfile
from profile_examples import DRIVER, ROUTE, learned_profile, sealed


def body_of(profile: StoredProfile) -> bytes:
    return encode(profile)[:-15]


def refusal(data: bytes) -> ProfileRefused:
    with pytest.raises(ProfileRefused) as caught:
        decode(data, "x.pldf")
    assert str(caught.value).startswith("x.pldf, ")
    assert "\n" not in str(caught.value)
    return caught.value


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
