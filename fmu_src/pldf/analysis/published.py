"""What the paper reports (arXiv:2602.13733): the one place that its numbers are kept.

Shares of the driving time; means of 43 drivers over the two drives with interventions per system.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from ..recordings.interventions import Rates

DRIVERS: Final = 43
PUBLISHED: Final = {"A": Rates(0.2232, 0.3976, 0.5468), "B": Rates(0.1204, 0.1242, 0.2297)}
SOURCE: Final = "Schwager et al., arXiv:2602.13733"


class PublishedTest(NamedTuple):
    """A test as printed in the paper."""

    kind: str  # "t" or "wilcoxon"
    statistic: float
    p: float

    @property
    def text(self) -> str:
        """The test as people write it."""
        name = f"t({DRIVERS - 1})" if self.kind == "t" else "W"
        return f"{name} = {self.statistic:g}"


TESTS: Final = {
    "pedal": PublishedTest("t", 6.42, 9.78e-8),
    "set_speed": PublishedTest("wilcoxon", 24.0, 1.38e-7),
    "combined": PublishedTest("wilcoxon", 1.0, 4.55e-13),
}


def published_means(measure: str) -> tuple[float, float]:
    """Return the means with system A and B of one of the rates."""
    return getattr(PUBLISHED["A"], measure), getattr(PUBLISHED["B"], measure)
