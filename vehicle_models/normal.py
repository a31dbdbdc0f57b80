"""Logarithm, exponential and normal quantile by arithmetic alone: the same bits everywhere.

A C library's ``log`` and ``exp`` differ in the last bit from platform to platform. In the numba
subset (see ``pldf.kernel``).
"""

from __future__ import annotations

from math import floor, sqrt

LN_2 = 0.6931471805599453
SQRT_2 = 1.4142135623730951
# Wichura's polynomials, the highest power first.
CENTRAL_ABOVE = (
    2.5090809287301226727e3, 3.3430575583588128105e4, 6.7265770927008700853e4,
    4.5921953931549871457e4, 1.3731693765509461125e4, 1.9715909503065514427e3,
    1.3314166789178437745e2, 3.3871328727963666080e0,
)  # fmt: skip
CENTRAL_BELOW = (
    5.2264952788528545610e3, 2.8729085735721942674e4, 3.9307895800092710610e4,
    2.1213794301586595867e4, 5.3941960214247511077e3, 6.8718700749205790830e2,
    4.2313330701600911252e1, 1.0,
)  # fmt: skip
NEAR_TAIL_ABOVE = (
    7.74545014278341407640e-4, 2.27238449892691845833e-2, 2.41780725177450611770e-1,
    1.27045825245236838258e0, 3.64784832476320460504e0, 5.76949722146069140550e0,
    4.63033784615654529590e0, 1.42343711074968357734e0,
)  # fmt: skip
NEAR_TAIL_BELOW = (
    1.05075007164441684324e-9, 5.47593808499534494600e-4, 1.51986665636164571966e-2,
    1.48103976427480074590e-1, 6.89767334985100004550e-1, 1.67638483018380384940e0,
    2.05319162663775882187e0, 1.0,
)  # fmt: skip
FAR_TAIL_ABOVE = (
    2.01033439929228813265e-7, 2.71155556874348757815e-5, 1.24266094738807843860e-3,
    2.65321895265761230930e-2, 2.96560571828504891230e-1, 1.78482653991729133580e0,
    5.46378491116411436990e0, 6.65790464350110377720e0,
)  # fmt: skip
FAR_TAIL_BELOW = (
    2.04426310338993978564e-15, 1.42151175831644588870e-7, 1.84631831751005468180e-5,
    7.86869131145613259100e-4, 1.48753612908506148525e-2, 1.36929880922735805310e-1,
    5.99832206555887937690e-1, 1.0,
)  # fmt: skip


def natural_log(x: float) -> float:
    """Logarithm of ``x`` > 0; error below 1e-15, relative or absolute, whichever is larger.

    The series of 2 artanh((m - 1) / (m + 1)) with ``x`` = m 2^k and m next to 1.
    """
    halvings = 0
    while x >= SQRT_2:
        x *= 0.5
        halvings += 1
    while x < 0.5 * SQRT_2:
        x *= 2.0
        halvings -= 1
    t = (x - 1.0) / (x + 1.0)
    square = t * t
    series = 0.0
    for odd in range(23, 0, -2):
        series = series * square + 1.0 / odd
    return halvings * LN_2 + 2.0 * t * series


def exponential(x: float) -> float:
    """Exponential of ``x``, which is between -600 and 600; relative error below 2e-15 + 2e-16 |x|.

    Pade's quotient of degree 6 near 0, times a power of two.
    """
    doublings = floor(x / LN_2 + 0.5)
    r = x - doublings * LN_2
    square = r * r
    even = 1.0 + square * (5.0 / 44.0 + square * (1.0 / 792.0 + square / 665280.0))
    odd = r * (0.5 + square * (1.0 / 66.0 + square / 15840.0))
    value = (even + odd) / (even - odd)
    factor = 2.0 if doublings > 0 else 0.5
    for _ in range(abs(doublings)):
        value *= factor
    return value


def normal_quantile(u: float) -> float:
    """Value below which a standard normal number lies with probability ``u``, 0 < u < 1.

    Wichura (1988), algorithm AS 241 (PPND16); relative error below 1e-15.
    """
    q = u - 0.5
    if abs(q) <= 0.425:
        return q * _quotient(0.180625 - q * q, CENTRAL_ABOVE, CENTRAL_BELOW)
    tail = sqrt(-natural_log(u if q < 0.0 else 1.0 - u))
    if tail <= 5.0:
        z = _quotient(tail - 1.6, NEAR_TAIL_ABOVE, NEAR_TAIL_BELOW)
    else:
        z = _quotient(tail - 5.0, FAR_TAIL_ABOVE, FAR_TAIL_BELOW)
    return -z if q < 0.0 else z


def _quotient(r: float, above: tuple[float, ...], below: tuple[float, ...]) -> float:
    numerator, denominator = 0.0, 0.0
    for i in range(8):
        numerator = numerator * r + above[i]
        denominator = denominator * r + below[i]
    return numerator / denominator
