"""Stored profiles that are damaged, foreign or made up: refused with their place."""

from __future__ import annotations

import re
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pldf.profiles.profile_file import decode, encode, require_match
from pldf.profiles.profile_format_1 import encode_1
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
HEAD = EXAMPLE.index(b"\n", EXAMPLE.index(b"\nend") + 1) + 1  # bytes of its header
BLOCK = 128  # bytes of its blocks: 11 nodes and 40 fill bytes
NAMES = [name.decode() for name in re.findall(rb"^block (\w+)", EXAMPLE[:HEAD], re.MULTILINE)]
SECOND = NAMES.index("learned_mps", 2)  # the first block of iteration 2

HEADER_FAULTS = [
    (b"", b"<xml>", 1, "not a profile file"),
    (b"PLDF-PROFILE 2", b"PLDF-PROFILE 3", 1, "format 3 of a newer version.*1 and 2, update"),
    (b"PLDF-PROFILE 2", b"PLDF-PROFILE 999999999", 1, "newer version"),
    (b"PLDF-PROFILE 2", b"PLDF-PROFILE 0", 1, "format 0 does not exist"),
    (b"PLDF-PROFILE 2", b"PLDF-PROFILE 1", 7, "expected 'iteration 1 INTERVENTIONS NOTE'"),
    (b"PLDF-PROFILE 2", b"PLDF-PROFILE 2\r", 1, "expected 'PLDF-PROFILE 2', found"),
    (b"driver 17", b"driver -17", 2, "expected 'driver NUMBER', found 'driver -17'"),
    (b"driver 17", b"driver 017", 2, "found 'driver 017'"),
    (b"driver 17", b"driver 1000000000", 2, "found"),
    (b"route 0123456789abcdef", b"route 0123456789ABCDEF", 3, "expected 'route 16_HEX"),
    (b"nodes 11", b"nodes 2", 4, "2 nodes; possible are 3 to"),
    (b"nodes 11", b"nodes 999999999", 4, "999999999 nodes"),
    (b"nodes 11", b"nodes 99999999999999999999", 4, "expected 'nodes NUMBER'"),
    (b"step_m 1", b"step_m 2", 5, "expected 'step_m 1'"),
    (b"iterations 2", b"iterations -1", 6, "expected 'iterations NUMBER'"),
    (b"iterations 2", b"iterations 999999", 29, "expected 'iteration 3 "),
    (b"iterations 2", b"iterations 1", 19, "expected 'end'"),
    (b"blocks 19", b"blocks 18", 7, "18 blocks, but 19 are named"),
    (b"blocks 19", b"blocks 0", 7, "expected 'blocks NUMBER'"),
    (b"block base_mps m/s\n", b"", 8, "expected 'block base_mps m/s'"),
    (b"block base_mps m/s", b"block base_mps km/h", 8, "expected 'block base_mps m/s'"),
    (
        b"block drive 1",
        b"block drives 1",
        12,
        "block 'drives', which a newer version wrote",
    ),
    (b"block drive 1", b"block drive m/s", 12, "block drive is in 1, not in m/s"),
    (b"block drive 1", b"block learned_mps m/s", 12, "block learned_mps where it should not be"),
    (b"block drive 1", b"block offset_mps m/s", 12, "block offset_mps where it should not be"),
    (b"block drive 1", b"block drive", 12, "expected 'block NAME UNIT'"),
    (b"iteration 2 drive 2", b"iteration 2 drive -2", 19, "expected 'iteration 2 KIND INTERV"),
    (b"iteration 2 drive 2", b"iteration 3 drive 2", 19, "iteration 3 where 2 should be"),
    (b"iteration 2 drive 2", b"iteration 2 dream 2", 19, "kind 'dream', which a newer version"),
    (b"drive 2\n", b"drive \xe9\n", 19, r"drive \\xe9"),
    (b" drive 2\n", b" " + b"x" * 81 + b"\n", 19, "expected 'iteration 2"),
    (b" drive 2\n", b" " + b"x" * 500 + b"\n", 19, "expected 'iteration 2"),
    (b"iteration 2 drive 2 drive 2", b"iteration 2 drive 2 drive", 29, "not filled up"),
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
    data[HEAD + 44] ^= 1
    error = refusal(bytes(data))
    assert error.where == f"byte {len(EXAMPLE) - 15}"
    assert "damaged: checksum" in error.reason


@pytest.mark.parametrize("block", range(len(NAMES)))
@pytest.mark.parametrize(
    "value", [float("nan"), float("inf"), -float("inf"), -200.5, 1e9, 5e300], ids=repr
)
def test_impossible_numbers_name_byte_and_place(block: int, value: float) -> None:
    body = bytearray(EXAMPLE[:-15])
    at = HEAD + BLOCK * block + 8 * 5
    body[at : at + 8] = struct.pack("<d", value)
    error = refusal(sealed(bytes(body)))
    assert error.where == f"byte {at}"
    of = "" if block == 0 else f" of iteration {1 if block < SECOND else 2}"
    assert error.reason == f"{NAMES[block]}{of} is {value!r} at 5 m"


@pytest.mark.parametrize(
    "block", [b for b, name in enumerate(NAMES) if not re.search("_mps|evidence", name)]
)
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


@pytest.mark.parametrize("block", [1, SECOND])
def test_a_block_that_is_as_before_must_not_stand_there(block: int) -> None:
    """So that equal profiles are equal files."""
    body = bytearray(EXAMPLE[:-15])
    start, before = HEAD + BLOCK * block, HEAD + BLOCK * (0 if block == 1 else 1)
    body[start : start + 88] = body[before : before + 88]
    error = refusal(sealed(bytes(body)))
    assert error.where == f"byte {start}"
    number = 1 if block == 1 else 2
    assert error.reason == f"learned_mps of iteration {number} is as before and must not stand here"


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
    assert (encode_1 if data.startswith(b"PLDF-PROFILE 1") else encode)(profile) == data


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
    for version in (b"1", b"2"):
        reads_back_or_is_refused(sealed(b"PLDF-PROFILE " + version + b"\n" + data))


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
