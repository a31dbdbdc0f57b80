"""What each figure shows, as scenes; ``paper`` and ``screen`` draw them."""

from .driving import compared, drives, one_drive, recorded
from .learning import development, long_run, steps
from .network import network
from .plan import plan
from .quality import quality
from .road import route
from .shares import rate_bars, rates

__all__ = [
    "compared", "development", "drives", "long_run", "network", "one_drive", "plan", "quality",
    "rate_bars", "rates", "recorded", "route", "steps",
]  # fmt: skip
