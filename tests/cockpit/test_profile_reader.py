"""The page's reader and Python's say the same of every profile, sound or hostile."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from hostile_files import damaged, with_notes, with_other_blocks
from node import node
from pldf.profiles.profile_file import decode, encode
from pldf.profiles.profile_format_1 import encode_1
from pldf.profiles.stored_profile import COLUMN_NAMES, Iteration, ProfileRefused
from profile_examples import learned_profile, new_profile

SCRIPT = Path(__file__).parent / "javascript/read_profiles.mjs"


def files() -> Iterator[bytes]:
    """Yield profiles of both formats, and what must not pass for one."""
    for profile in (new_profile(), learned_profile(3), learned_profile(1, nodes=17)):
        rolled = profile.rolled_back(0)
        for data in (encode(profile), encode(rolled), encode_1(profile), encode_1(rolled)):
            yield data
            yield from damaged(data)
            if profile.iterations:
                yield from with_notes(data)
        yield from with_other_blocks(encode(rolled))


def told(data: bytes) -> dict[str, Any]:
    """Return what Python's reader says of a file."""
    try:
        profile = decode(data, "")
    except ProfileRefused as refused:
        return {"refused": True, "where": refused.where}
    iterations = [profile.iteration(number) for number in range(len(profile.iterations) + 1)]
    return {
        "driver_id": profile.driver_id,
        "route": profile.route,
        "nodes": profile.nodes,
        "iterations": [told_iteration(iteration) for iteration in iterations],
    }


def told_iteration(iteration: Iteration) -> dict[str, Any]:
    columns = [np.asarray(getattr(iteration, name), "<f8") for name in COLUMN_NAMES]
    return {
        "number": iteration.number,
        "kind": iteration.kind,
        "note": iteration.note,
        "interventions": iteration.interventions,
        "sum": hashlib.sha256(b"".join(column.tobytes() for column in columns)).hexdigest(),
    }


def test_both_readers_say_the_same_of_every_file(tmp_path: Path) -> None:
    data = list(files())
    for number, content in enumerate(data):
        (tmp_path / f"{number:05}.pldf").write_bytes(content)
    done = node(SCRIPT, tmp_path)
    assert done.returncode == 0, done.stderr
    by_page = json.loads(done.stdout)
    by_python = [told(content) for content in data]
    assert len(by_page) == len(by_python)
    for number, (page, python) in enumerate(zip(by_page, by_python, strict=True)):
        reason = page.get("refused")
        assert page | {"refused": reason and True} == {"refused": None} | python, (
            number, reason, data[number][:300],
        )  # fmt: skip
    assert sum("route" in page for page in by_page) > 50
    assert {page.get("refused") for page in by_page} == {
        None, "foreign", "newer", "truncated", "longer", "damaged", "line", "value",
    }  # fmt: skip
