"""A population of preference drivers: how their parameters are distributed, and samples of it.

The starting values are those of the study's description; what it leaves open is decided here and
marked as decision. All laws are independent. A person is drawn by inverse transform from the
person's own stream of uniform numbers, one number per parameter in the fixed order of ``FIELDS``:
person k is the same person in a study of 43 and of 10,000, and moving the median of one parameter
moves every person's value of it and nothing else (common random numbers: a smooth fit).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from difflib import get_close_matches
from math import exp, inf, log, sqrt
from statistics import NormalDist
from typing import Any, Final, Protocol

import numpy as np

from ..errors import ModelError
from ..kernel.signals import Signal
from ..kernel.units import MPS_PER_KMH
from ..toml_file import shown
from .participants import DRIVER_SIGNALS, Participant

STANDARD: Final = NormalDist()
# Each drive takes the next seed: room for many drives below the driver model's last one.
OWN_SEED_MAX: Final = 999_900_000


class Law(Protocol):
    """Distribution of one parameter."""

    def at(self, u: float) -> float:
        """Return the quantile of ``u``, which is above 0 and below 1."""

    def deviation(self, value: float) -> float:
        """Return how far ``value`` lies above the median, in standard deviations."""


SIGMA_MAX: Final = 10.0  # one sigma off is 22,000 times the median then: nobody is like that


@dataclass(frozen=True)
class Normal:
    """Normal distribution; values outside ``low``..``high`` become the nearer end."""

    mean: float
    sd: float
    low: float = -np.inf
    high: float = np.inf

    def at(self, u: float) -> float:
        """Return the quantile of ``u``."""
        return min(max(self.mean + self.sd * STANDARD.inv_cdf(u), self.low), self.high)

    def deviation(self, value: float) -> float:
        """Return the deviation of ``value`` from the median."""
        return (value - self.mean) / self.sd if self.sd > 0.0 else 0.0


@dataclass(frozen=True)
class Lognormal:
    """Lognormal distribution; ``median`` may be negative (a deceleration). Ends as in Normal."""

    median: float
    sigma: float
    low: float = -np.inf
    high: float = np.inf

    def __post_init__(self) -> None:
        if not 0.0 <= self.sigma <= SIGMA_MAX:
            raise ValueError(f"sigma = {self.sigma:g} must lie between 0 and {SIGMA_MAX:g}")

    def at(self, u: float) -> float:
        """Return the quantile of ``u``."""
        return min(max(self.median * exp(self.sigma * STANDARD.inv_cdf(u)), self.low), self.high)

    def deviation(self, value: float) -> float:
        """Return the deviation of the logarithm of ``value`` from that of the median."""
        if self.sigma == 0.0 or value == self.median:
            return 0.0
        ratio = value / self.median if self.median else inf
        return log(ratio) / self.sigma if ratio > 0.0 else -inf  # an end at or beyond 0


@dataclass(frozen=True)
class Uniform:
    """Uniform distribution from ``low`` to ``high``."""

    low: float
    high: float

    def at(self, u: float) -> float:
        """Return the quantile of ``u``."""
        return self.low + (self.high - self.low) * u

    def deviation(self, value: float) -> float:
        """Return the deviation of ``value`` from the middle."""
        width = self.high - self.low
        return (value - 0.5 * (self.low + self.high)) / (width / sqrt(12.0)) if width else 0.0


@dataclass(frozen=True)
class Share:
    """Yes (1) for a ``share`` of the people, else no (0)."""

    share: float

    def at(self, u: float) -> float:
        """Return 1 or 0 for ``u``."""
        return float(u < self.share)

    def deviation(self, value: float) -> float:
        """Return the deviation of ``value`` from what most people have."""
        median = float(self.share >= 0.5)
        variance = self.share * (1.0 - self.share)
        return (value - median) / sqrt(variance) if variance > 0.0 else 0.0


LAWS: Final = {"normal": Normal, "lognormal": Lognormal, "uniform": Uniform, "share": Share}
# Order of the uniform numbers: append only, else every person becomes another one.
FIELDS: Final = (
    "wish_offset_mps",
    "wish_lateral_accel_max_mps2",
    "wish_accel_max_mps2",
    "wish_accel_min_mps2",
    "wish_anticipation_s",
    "driver_threshold_mps",
    "driver_reaction_s",
    "driver_overshoot",
    "driver_reactivation_s",
    "driver_uses_lever",
    "driver_lever_settled_s",
)


@dataclass(frozen=True)
class Distribution:
    """Laws of the parameters that differ from person to person, by field of ``DriverState``.

    ``numbers`` are parameters that are the same for everybody, in place of a law or of the driver
    model's default.

    Given by the study's description are the laws without a comment. Decisions: the sigmas of
    threshold, reaction and reactivation; the strengths, whose medians are the driver model's; that
    the wait before the lever differs too; and all ends that are not named in the description, which
    only keep rare draws plausible.
    """

    wish_offset_mps: Law = Normal(7.0 * MPS_PER_KMH, 5.0 * MPS_PER_KMH)
    wish_lateral_accel_max_mps2: Law = Lognormal(2.9, 0.25)
    wish_accel_max_mps2: Law = Lognormal(1.5, 0.2, low=0.5, high=3.0)  # decision
    wish_accel_min_mps2: Law = Lognormal(-1.3, 0.2, low=-3.0, high=-0.5)  # decision
    wish_anticipation_s: Law = Normal(2.0, 1.5, low=0.0, high=20.0)
    driver_threshold_mps: Law = Lognormal(
        5.0 * MPS_PER_KMH, 0.3, low=0.5 * MPS_PER_KMH
    )  # sigma: decision
    driver_reaction_s: Law = Lognormal(1.0, 0.3, low=0.5, high=2.0)  # sigma: decision
    driver_overshoot: Law = Uniform(0.0, 1.2)
    driver_reactivation_s: Law = Lognormal(2.0, 0.4, low=0.3, high=20.0)  # sigma: decision
    driver_uses_lever: Law = Share(0.95)
    driver_lever_settled_s: Law = Lognormal(3.0, 0.3, low=0.3, high=20.0)  # decision
    numbers: Mapping[str, float] = field(default_factory=dict)

    def with_laws(self, laws: Mapping[str, Law]) -> Distribution:
        """Return the same distribution with other laws for some fields."""
        return replace(self, **dict[str, Any](laws))

    def with_numbers(self, numbers: Mapping[str, float]) -> Distribution:
        """Return the same distribution with some parameters, by field, the same for everybody."""
        return replace(self, numbers={**self.numbers, **numbers})

    @property
    def laws(self) -> dict[str, Law]:
        """The laws by field, without the parameters that are the same for everybody."""
        return {name: getattr(self, name) for name in FIELDS if name not in self.numbers}

    def as_table(self) -> dict[str, dict[str, str | float] | float]:
        """Return {public parameter name: law as table, or number}, the form of a study file."""
        laws: dict[str, dict[str, str | float] | float] = {
            name: _law_table(law) for name, law in self.laws.items()
        }
        return {
            DRIVER_SIGNALS[name].name: entry for name, entry in {**laws, **self.numbers}.items()
        }


def read_distribution(table: Mapping[str, Any]) -> Distribution:
    """Return the starting values with what ``table`` says, which has the form of ``as_table``.

    Raises:
        ModelError: unknown parameter or law, numbers that are missing or too many, or a number out
            of the parameter's range.
    """
    signals = {signal.name: signal for signal in DRIVER_SIGNALS.values()}
    laws, numbers = {}, {}
    for name, entry in table.items():
        if name not in signals:
            near = ", ".join(get_close_matches(name, signals, cutoff=0.3)) or next(iter(signals))
            raise ModelError(
                f'distribution: "{name}" is not a driver parameter; there are e.g. {near}'
            )
        signal = signals[name]
        if isinstance(entry, Mapping):
            laws[signal.field] = _read_law(signal, entry)
        else:
            numbers[signal.field] = _read_number(signal, entry)
    return Distribution().with_laws(laws).with_numbers(numbers)


def sample_participants(
    count: int, seed: int, distribution: Distribution | None = None, first: int = 1
) -> list[Participant]:
    """Return ``count`` people from number ``first`` on; the same ``seed`` gives the same people."""
    laws = distribution or Distribution()
    return [draw_participant(first - 1 + k, seed, laws) for k in range(count)]


def draw_participant(index: int, seed: int, distribution: Distribution) -> Participant:
    """Return the person with this index, from 0, whatever the size of the study."""
    rng = np.random.default_rng([seed, index])
    own_seed = int(rng.integers(1, OWN_SEED_MAX, endpoint=True))
    # The open interval: a normal law has no value at 0.
    quantiles = [max(float(rng.random()), 1e-12) for _ in FIELDS]
    return Participant(f"P{index + 1:03d}", own_seed, values_at(quantiles, distribution))


def values_at(quantiles: Sequence[float], distribution: Distribution) -> dict[str, float]:
    """Return the parameters of the person at ``quantiles`` (above 0, below 1; as ``FIELDS``)."""
    drawn = {
        name: getattr(distribution, name).at(u) for name, u in zip(FIELDS, quantiles, strict=True)
    }
    return {**drawn, **distribution.numbers}


def _law_table(law: Law) -> dict[str, str | float]:
    kind = next(kind for kind, cls in LAWS.items() if isinstance(law, cls))
    numbers = {k: v for k, v in asdict(law).items() if np.isfinite(v)}  # type: ignore[call-overload]
    return {"law": kind, **numbers}


def _read_law(signal: Signal, table: Mapping[str, Any]) -> Law:
    name = signal.name
    if signal.field not in FIELDS:
        raise ModelError(
            f'distribution: "{name}" has no law, since it does not differ from person to person; '
            f"write a number, the same for everybody: {_allowed(signal)}"
        )
    if table.get("law") not in LAWS:
        raise ModelError(f'distribution: "{name}" needs law = one of {", ".join(LAWS)}')
    numbers = {key: value for key, value in table.items() if key != "law"}
    try:
        law: Law = LAWS[table["law"]](**{key: float(value) for key, value in numbers.items()})
    except (TypeError, ValueError) as error:
        raise ModelError(f'distribution: "{name}": {error}') from error
    return law


def _read_number(signal: Signal, entry: Any) -> float:
    """Return a parameter that is the same for everybody."""
    low, high = signal.range
    if signal.kind == "Boolean":
        usable = entry in (False, True)
    else:
        usable = isinstance(entry, int | float) and not isinstance(entry, bool)
    if usable and low <= entry <= high:
        return float(entry)
    law = "; or a law, in braces" if signal.field in FIELDS else ""
    raise ModelError(
        f'distribution: "{signal.name}" = {shown(entry)} must be {_allowed(signal)}{law}'
    )


def _allowed(signal: Signal) -> str:
    """Return what a number that is the same for everybody may be."""
    if signal.kind == "Boolean":
        return "true or false"
    low, high = signal.range
    return f"a number from {low:g} to {high:g}{f' {signal.unit}' if signal.unit else ''}"
