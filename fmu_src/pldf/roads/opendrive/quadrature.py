"""Gauss-Legendre quadrature with five nodes: exact far beyond 1e-9 m over 1 m of any road."""

from __future__ import annotations

from typing import Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from ...kernel.arrays import FloatArray

Number = TypeVar("Number", np.float64, np.complex128)

_GAUSS: Final = np.polynomial.legendre.leggauss(5)
# On [0, 1].
NODES: Final[FloatArray] = 0.5 * (_GAUSS[0] + 1.0)
_WEIGHTS: Final[FloatArray] = 0.5 * _GAUSS[1]
# For larger products OpenBLAS wakes its threads, which takes several times as long.
_AT_ONCE: Final = 512


def means(values: NDArray[Number]) -> NDArray[Number]:
    """Return the mean of each row, [n], of values at the nodes, [n, 5]."""
    found = np.empty(len(values), dtype=values.dtype)
    for first in range(0, len(values), _AT_ONCE):
        some = values[first : first + _AT_ONCE]
        # A single row is rounded otherwise: what is found must not depend on how many there are.
        many = some if len(some) > 1 else np.repeat(some, 2, axis=0)
        found[first : first + len(some)] = (many @ _WEIGHTS)[: len(some)]
    return found
