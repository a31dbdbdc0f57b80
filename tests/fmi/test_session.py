"""The Python session: a restored drive goes on with the model that its parameters ask for."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from pldf.fmi.access import Access
from pldf.fmi.session import Session
from pldf.function import DrivingFunction
from pldf.kernel.signals import by_reference


class Driven:
    """A session of the driving function, by names of variables."""

    def __init__(self) -> None:
        self.session = Session(DrivingFunction)
        self.references = {s.name: i for i, s in by_reference(self.session.signals).items()}
        self.texts = Access(self.session.signals, frozenset({"String"}))
        self.numbers = Access(
            self.session.signals, frozenset({"Real", "Integer", "Boolean", "Enumeration"})
        )

    def set(self, **values: Any) -> Driven:
        """Set values (a dot in a name is written as two underscores)."""
        for name, value in values.items():
            reference = [self.references[name.replace("__", ".")]]
            if isinstance(value, str):
                self.session.write_texts(self.texts.writable(reference), [value])
            else:
                self.session.write(self.numbers.writable(reference), [value])
        return self

    def get(self, name: str) -> Any:
        """Return a number."""
        return self.session.read(self.numbers.group([self.references[name]]))[0]

    def start(self) -> Driven:
        """Initialize."""
        self.session.enter()
        self.session.exit()
        return self

    def drive(self, first: int, steps: int) -> Driven:
        """Drive with 20 m/s from step ``first`` on."""
        for k in range(first, first + steps):
            self.set(vehicle__s_m=100.0 + k, vehicle__speed_mps=20.0)
            self.session.step(0.05 * k, 0.05)
        return self


@pytest.fixture
def stores(tmp_path: Path) -> tuple[Path, Path]:
    return tmp_path / "first", tmp_path / "second"


def learned_in(driven: Driven, stores: tuple[Path, Path]) -> list[int]:
    """Drive on to the end and return how many profiles each store has then."""
    driven.drive(10, 30).session.terminate()
    return [len(list(store.glob("*.pldf"))) for store in stores]


def test_a_parameter_set_after_outputs_were_read_counts(stores: tuple[Path, Path]) -> None:
    first, second = stores
    other = Driven().set(learn=1, profile_store=str(second)).start().drive(0, 10)
    driven = Driven().set(learn=1, profile_store=str(first))
    driven.session.enter()
    driven.get("target_speed_mps")
    driven.set(profile_store=str(second))
    driven.session.restore(other.session.state())
    assert learned_in(driven, stores) == [0, 1]


@pytest.mark.parametrize("when", ["before", "afterwards"])
def test_a_state_without_a_drive_brings_its_own_store(stores: tuple[Path, Path], when: str) -> None:
    first, second = stores
    other = Driven().set(learn=1, profile_store=str(second))
    state = other.session.state()
    driving = other.start().drive(0, 10).session.state()
    if when == "afterwards":
        other.session.terminate()
        state = other.session.state()
        for path in second.glob("*.pldf"):
            path.unlink()
    driven = Driven().set(learn=1, profile_store=str(first)).start().drive(0, 5)
    driven.session.restore(state)
    driven.session.restore(driving)
    assert learned_in(driven, stores) == [0, 1]
