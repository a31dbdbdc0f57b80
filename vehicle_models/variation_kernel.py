"""How the preference driver's wish varies: from person to person, place to place, drive to drive.

Each part is a standard normal number that follows from a seed, from what it is for and from the
metre at which its place begins: no state, no order, and a limit that is changed elsewhere changes
nothing here. In the numba subset (see ``pldf.kernel``).
"""

from __future__ import annotations

from pldf.kernel.arrays import Floats

from .driver_state import DriverState
from .normal import exponential, normal_quantile

# What a draw is for: what lasts, everywhere and at a place. The occasion's is so much behind.
OFFSET_OF_PERSON = 1
OFFSET_OF_PLACE = 2
LATERAL_OF_PERSON = 5
LATERAL_OF_PLACE = 6
OF_OCCASION = 2
# The occasion's variance is shared by halves between the drive and each place in it.
HALF_OF_VARIANCE = 0.7071067811865476
# What varies stays within what its parameter allows.
OFFSET_MIN_MPS = -20.0
OFFSET_MAX_MPS = 30.0
LATERAL_MIN_MPS2 = 0.1
LATERAL_MAX_MPS2 = 10.0

_32_BITS = 0xFFFFFFFF


def fill_offsets(st: DriverState, limit: Floats, offset: Floats) -> None:
    """Fill ``offset`` (m/s, per cell) with the wished offset; a place is a limit's segment."""
    person, place = st.wish_offset_person_sd_mps, st.wish_offset_place_sd_mps
    occasion = st.wish_offset_occasion_sd_mps
    everywhere = _with_parts(st.wish_offset_mps, st, person, occasion, OFFSET_OF_PERSON, 0)
    here = everywhere
    for i in range(len(limit)):
        if i == 0 or limit[i] != limit[i - 1]:
            here = everywhere + _with_parts(0.0, st, place, occasion, OFFSET_OF_PLACE, i)
            here = max(OFFSET_MIN_MPS, min(here, OFFSET_MAX_MPS))
        offset[i] = here


def fill_lateral_accels(st: DriverState, curvature: Floats, lateral: Floats) -> None:
    """Fill ``lateral`` (m/s2, per cell) with what is accepted there; a place is a curve.

    A curve goes on while the road does not count as straight; ``curvature`` is that of each cell.
    """
    person, place = st.wish_lateral_person_sigma, st.wish_lateral_place_sigma
    occasion = st.wish_lateral_occasion_sigma
    everywhere = _with_parts(0.0, st, person, occasion, LATERAL_OF_PERSON, 0)
    straight = _accepted(st, everywhere)
    here = straight
    was_curve = False
    for i in range(len(curvature)):
        is_curve = abs(curvature[i]) > st.driver_lever_curvature_per_m
        if is_curve and not was_curve:
            of_place = _with_parts(0.0, st, place, occasion, LATERAL_OF_PLACE, i)
            here = _accepted(st, everywhere + of_place)
        lateral[i] = here if is_curve else straight
        was_curve = is_curve


def _with_parts(
    usual: float, st: DriverState, lasting_sd: float, occasion_sd: float, purpose: int, metre: int
) -> float:
    """Add to ``usual`` what lasts, from the person's seed, and half the occasion's variance."""
    lasting = usual + _spread(lasting_sd, st.person_seed, purpose, metre)
    return lasting + _spread(HALF_OF_VARIANCE * occasion_sd, st.seed, purpose + OF_OCCASION, metre)


def _accepted(st: DriverState, logarithm: float) -> float:
    """Lateral acceleration that differs from the usual one by ``logarithm``."""
    if logarithm == 0.0:
        return st.wish_lateral_accel_max_mps2
    accepted = st.wish_lateral_accel_max_mps2 * exponential(logarithm)
    return max(LATERAL_MIN_MPS2, min(accepted, LATERAL_MAX_MPS2))


def _spread(sd: float, seed: int, purpose: int, metre: int) -> float:
    """Normal number with standard deviation ``sd``, always the same for the other three."""
    return 0.0 if sd == 0.0 else sd * normal_quantile(keyed_uniform(seed, purpose, metre))


def keyed_uniform(seed: int, purpose: int, metre: int) -> float:
    """Number above 0 and below 1, one of 2^32, by a hash of whole numbers >= 0."""
    return (_mixed(_mixed(_mixed(seed) ^ purpose) ^ metre) + 0.5) / 4294967296.0


def _mixed(key: int) -> int:
    """Whole number of 32 bits in which each bit of ``key`` has moved about half of the others.

    Multiplicative xor-shift hash; its factors are below 2^31, so that no product leaves 63 bits.
    """
    key = (key + 0x9E3779B9) & _32_BITS  # 0 would stay 0
    key ^= key >> 15
    key = (key * 0x2C1B3C6D) & _32_BITS
    key ^= key >> 12
    key = (key * 0x297A2D39) & _32_BITS
    return key ^ (key >> 15)
