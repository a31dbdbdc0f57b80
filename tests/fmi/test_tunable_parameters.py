"""Tunable parameters: what is set between the steps counts from the next one on, in its range."""

from __future__ import annotations

from dataclasses import asdict, fields
from math import nan
from typing import Any

import numpy as np
import pytest
from pldf.errors import ModelError
from pldf.fmi.access import Access
from pldf.fmi.session import Session
from pldf.function import DrivingFunction
from pldf.kernel.signals import by_reference, signals_of
from pldf.kernel.state import PldfState

TUNABLE = [s for s in signals_of(PldfState) if s.tunable]
NAMES = {s.name for s in TUNABLE}


class Driven:
    """A session of the driving function, by fields."""

    def __init__(self) -> None:
        self.session = Session(DrivingFunction)
        self.references = {s.field: i for i, s in by_reference(self.session.signals).items()}
        kinds = frozenset({"Real", "Integer", "Boolean", "Enumeration"})
        self.access = Access(self.session.signals, kinds)
        self.steps = 0

    def start(self) -> Driven:
        """Initialize."""
        self.session.enter()
        self.session.exit()
        return self

    def set(self, **values: Any) -> None:
        """Set what belongs to these fields in one call."""
        group = self.access.writable([self.references[name] for name in values])
        self.session.write(group, list(values.values()))

    def get(self, name: str) -> Any:
        """Return a value."""
        return self.session.read(self.access.group([self.references[name]]))[0]

    def tip(self) -> float:
        """Press the lever up, release it, and return by how much the set speed rose."""
        before = self.get("set_speed_mps")
        for pressed in (1, 0, 0, 0):
            self.set(vehicle_s_m=100.0 + self.steps, vehicle_speed_mps=20.0, lever_up=pressed)
            self.session.step(0.05 * self.steps, 0.05)
            self.steps += 1
        return float(self.get("set_speed_mps") - before)

    def memory(self) -> dict[str, Any]:
        """Return the record."""
        return asdict(self.session.model.record)


def test_those_that_are_promised_are_tunable() -> None:
    assert {"control.tip_short_mps", "control.tip_long_mps", "hmi.language", "hmi.unit"} <= NAMES
    following = {s.name for s in signals_of(PldfState) if s.name.startswith("following.")}
    assert {n for n in NAMES if n.startswith("following.")} == {
        n for n in following if n not in ("following.limits", "following.time_gap_s")
    }


def test_a_tip_of_another_size_counts_from_the_next_step_on() -> None:
    driven = Driven().start()
    assert driven.tip() == pytest.approx(1 / 3.6)
    driven.set(control_tip_short_mps=2.5)
    assert driven.tip() == pytest.approx(2.5)


@pytest.mark.parametrize("value", [-0.1, 20.1, nan])
def test_out_of_its_range_it_is_refused_and_nothing_changes(value: float) -> None:
    driven = Driven().start()
    driven.tip()
    before = driven.memory()
    with pytest.raises(ModelError, match=r"control\.tip_short_mps = .* between 0 and 20"):
        driven.set(control_tip_long_mps=3.0, control_tip_short_mps=value)
    assert driven.memory() == before


def test_beside_a_fixed_one_it_is_refused_and_nothing_changes() -> None:
    driven = Driven().start()
    before = driven.memory()
    with pytest.raises(ModelError, match="fixed parameter is not allowed in phase STEPPING"):
        driven.set(control_tip_short_mps=3.0, control_preview_s=0.1)
    assert driven.memory() == before


def test_a_state_brings_its_own_value_and_the_model_is_not_made_anew() -> None:
    driven = Driven().start()
    driven.set(control_tip_short_mps=2.5)
    state = driven.session.state()
    model = driven.session.model
    driven.set(control_tip_short_mps=1.5)
    driven.session.restore(state)
    assert driven.session.model is model
    assert driven.get("control_tip_short_mps") == 2.5


@pytest.mark.parametrize("end", ["low", "high"])
def test_nothing_that_is_prepared_depends_on_one(end: str) -> None:
    """Else it would make a difference whether it is set before the drive or in it."""
    usual, other = DrivingFunction(), DrivingFunction()
    for signal in TUNABLE:
        setattr(other.record, signal.field, type(signal.start)(signal.range[end == "high"]))
    for model in (usual, other):
        model.record.vehicle_speed_mps = 20.0
        model.initialize()
    for first, second in zip(usual.arrays, other.arrays, strict=True):
        np.testing.assert_array_equal(first, second)
    for spec in fields(PldfState):
        if spec.name not in {s.field for s in TUNABLE}:
            assert getattr(usual.record, spec.name) == getattr(other.record, spec.name), spec.name
