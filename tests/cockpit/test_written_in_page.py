"""What the page writes of a drive is what Python writes, to the byte."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from node import node
from pldf.kernel.arrays import FloatArray
from pldf.recordings.columns import INPUTS, OUTPUTS, RECORDING
from pldf.recordings.recording import Recording, recording_csv

WRITER = "tests/cockpit/javascript/engine_written.mjs"
EDGES = [0.0, -0.0, 1e16, 1e-4, 9.999e-5, 1e21, 1e-7, 5e-324, 1.7976931348623157e308, 123456789.0]
ROWS = 200


def written(**task: Any) -> str:
    result = node(WRITER, given=json.dumps(task))
    assert result.returncode == 0, result.stderr
    return result.stdout


def bits_of(values: FloatArray) -> str:
    return values.astype("<f8").tobytes().hex()


@settings(max_examples=6, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_numbers_are_written_as_python_writes_them(seed: int) -> None:
    random = np.random.default_rng(seed)
    anything = random.integers(0, 2**64, 20_000, dtype=np.uint64).view(np.float64)
    usual = np.round(random.normal(0.0, 50.0, 20_000), random.integers(0, 12))
    numbers = np.concatenate(
        (anything, usual, usual * 1e-6, usual * 1e14, EDGES, np.negative(EDGES))
    )
    assert written(kind="numbers", hex=bits_of(numbers)).split("\n") == [
        repr(number) for number in numbers.tolist()
    ]


def test_the_columns_are_those_of_python() -> None:
    assert json.loads(written(kind="columns")) == [
        {
            "name": column.name,
            "kind": column.kind,
            "source": INPUTS.get(column.name, OUTPUTS.get(column.name, "")),
            "words": list(column.words),
        }
        for column in RECORDING.columns
    ]


@given(seed=st.integers(0, 2**32 - 1), count=st.integers(0, ROWS))
@settings(max_examples=6, deadline=None)
def test_a_recording_is_the_same_file(seed: int, count: int) -> None:
    random = np.random.default_rng(seed)
    columns = {}
    for column in RECORDING.columns:
        if column.name != "time_s" and random.random() < 0.3:
            continue
        most = {"flag": 2, "whole": 10_000, "word": len(column.words)}.get(column.kind, 0)
        values = random.integers(0, most, count) if most else random.normal(0.0, 30.0, count)
        columns[column.name] = values.astype(np.float64)
    comments = ("device: pad (Vendor: 046d)", "a comment\nof two lines")
    made = written(
        kind="recording",
        columns={name: bits_of(values) for name, values in columns.items()},
        comments=comments,
    )
    assert made.encode() == recording_csv(Recording(columns, comments))
