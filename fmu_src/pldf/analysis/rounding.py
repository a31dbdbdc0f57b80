"""What of a number is rounding: values as they were written, and differences that are the same."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from ..kernel.arrays import FloatArray

# Differences that are the same on paper are at most this many times the largest value apart: some
# thousand roundings of a double, for what is summed over a drive and averaged over drives.
DOUBLE: Final = 1e-12
# Half a unit in the last place of single precision, as a share of the value, and what printing it
# with nine digits adds.
SINGLE: Final = 2.0**-24
_NINE_DIGITS: Final = 1e-9
# Decimals up to which a value is a number that somebody rounded, in double and single precision.
# With more, chance would take unrounded values for rounded ones.
DECIMALS_DOUBLE_MAX: Final = 9
DECIMALS_SINGLE_MAX: Final = 5


def decimals_of(values: ArrayLike) -> int | None:
    """Return with how many decimals ``values`` were written; None if they were not rounded.

    That is the fewest with which rounding changes none of them by more than the error of the
    floating-point numbers that they are: of single precision if all are such (a table written from
    float32 has 0.300000012 for 0.3), else of a double. NaN are passed over.
    """
    x = np.asarray(values, float)
    x = x[np.isfinite(x)]
    if not x.size:
        return None
    single = _is_single(x)
    error = (SINGLE if single else DOUBLE) * max(1.0, float(np.abs(x).max()))
    for decimals in range((DECIMALS_SINGLE_MAX if single else DECIMALS_DOUBLE_MAX) + 1):
        if (np.abs(x - np.round(x, decimals)) <= error).all():
            return decimals
    return None


def as_written(values: ArrayLike) -> FloatArray:
    """Return ``values`` as decimal numbers if they are ones but for rounding; else as they are."""
    x = np.asarray(values, float)
    decimals = decimals_of(x)
    written: FloatArray = x if decimals is None else np.round(x, decimals)
    return written


def equal(differences: FloatArray, largest: float) -> FloatArray:
    """Return ``differences`` with those made the same that but rounding tells apart.

    Args:
        differences: of values that are at most ``largest``; finite.
        largest: largest absolute value of those.

    Returns:
        The same numbers; sizes closer together than ``DOUBLE * largest`` are all the smallest of
        them, and 0 if that is a rounding away from 0.
    """
    sizes = np.abs(differences)
    order = np.argsort(sizes, kind="stable")
    steps = np.diff(sizes[order], prepend=0.0)
    # A difference begins a group of its own if it is more than rounding above the one before.
    group = np.cumsum(steps > DOUBLE * largest)
    smallest = np.concatenate(([0.0], sizes[order][steps > DOUBLE * largest]))
    found = np.empty_like(sizes)
    found[order] = smallest[group]
    result: FloatArray = np.copysign(found, differences)
    return result


def _is_single(x: FloatArray) -> bool:
    """Tell whether all are numbers of single precision, as such or printed with nine digits."""
    nearest = x.astype(np.float32).astype(np.float64)
    return bool((np.abs(x - nearest) <= _NINE_DIGITS * np.abs(x)).all())
