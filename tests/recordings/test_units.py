"""Units of laboratories: there and back, against published conversions, out of headers."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pldf.recordings.units import UNITS, header_of, to_ours, unit_named, units_of

ALL = [(ours, unit) for ours, units in UNITS.items() for unit in units]


@given(st.sampled_from(ALL), st.floats(-1e6, 1e6, allow_subnormal=False))
def test_there_and_back(pair: tuple[str, str], value: float) -> None:
    ours, unit = pair
    there = to_ours(np.array([value]), unit, ours)
    back = there / to_ours(np.array([1.0]), unit, ours)
    np.testing.assert_allclose(back, value, rtol=1e-14, atol=1e-300)  # denormals have fewer bits


@pytest.mark.parametrize(
    ("value", "unit", "ours", "expected"),
    [  # NIST Special Publication 811, appendix B.8, and ISO 80000-3
        (36.0, "km/h", "m/s", 10.0),
        (1.0, "mph", "m/s", 0.44704),
        (1.0, "kn", "m/s", 1852.0 / 3600.0),
        (1.0, "ft", "m", 0.3048),
        (1.0, "mi", "m", 1609.344),
        (1.0, "g", "m/s2", 9.80665),
        (250.0, "ms", "s", 0.25),
        (1.5, "h", "s", 5400.0),
        (50.0, "%", "1", 0.5),
        (1.25, "epoch s", "s", 1.25),
        (1250.0, "epoch ms", "s", 1.25),
    ],
)
def test_published_conversions(value: float, unit: str, ours: str, expected: float) -> None:
    assert unit in units_of(ours)
    (found,) = to_ours(np.array([value]), unit, ours)
    assert found == pytest.approx(expected, rel=1e-15)


@given(st.integers(0, 10**9))
def test_whole_milliseconds_are_the_decimals_that_one_writes(ms: int) -> None:
    assert to_ours(np.array([float(ms)]), "ms", "s")[0] == float(f"{ms // 1000}.{ms % 1000:03}")


@pytest.mark.parametrize(
    ("text", "name", "unit"),
    [
        ("Speed [km/h]", "Speed", "km/h"),
        ("Speed (KM/H)", "Speed", "km/h"),
        ("Ego speed in mph", "Ego speed", "mph"),
        ("Speed / km/h", "Speed", "km/h"),
        ("speed_kmh", "speed", "km/h"),
        ("Throttle %", "Throttle", "%"),
        ("a_x [m/s²]", "a_x", "m/s2"),
        ("a [m s^-2]", "a", "m/s2"),
        ("time [µs]", "time", "us"),
        ("time_ms", "time", "ms"),
        ("acceleration_mps2", "acceleration", "m/s2"),
        ("Time", "Time", ""),
        ("Speed [furlongs]", "Speed [furlongs]", ""),
        ("pldf::mode[INT]", "pldf::mode[INT]", ""),
        ("", "", ""),
    ],
)
def test_units_in_headers(text: str, name: str, unit: str) -> None:
    assert header_of(text) == (name, unit)


def test_the_docs_list_every_unit() -> None:
    page = (Path(__file__).parents[2] / "docs" / "recordings.md").read_text(encoding="utf-8")
    rows = dict(re.findall(r"^\| (time|length|speed|acceleration|pedals) \| (.*) \|$", page, re.M))
    for name, ours in zip(rows, ("s", "m", "m/s", "m/s2", "1"), strict=True):
        listed = re.sub(r"\(.*\)|since 1970:", "", rows[name]).replace(";", ",")
        assert [unit.strip() for unit in listed.split(",")] == list(units_of(ours))


def test_what_is_no_unit_is_none() -> None:
    assert [unit_named(text) for text in ("", "parsec", "?", "m/h", "km/")] == [""] * 5
