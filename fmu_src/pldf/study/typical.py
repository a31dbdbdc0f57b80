"""Who of a study's people is the most usual one: the example to look at, chosen by a rule.

It is who lies nearest to the medians of all laws, in standard deviations of the laws (Euclidean; of
lognormal laws in the logarithm). What the driver model itself draws from the person's seed counts
like two more laws: how far the lasting wish differs from the usual one, as root mean square over
the metres of the road for the wished offset, and over those in curves for lateral acceleration.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

import numpy as np

from vehicle_models.driver_state import DriverState
from vehicle_models.variation_kernel import fill_lateral_accels, fill_offsets

from ..kernel.arrays import FloatArray
from ..roads import Route, route_arrays
from .participants import Participant
from .population import Distribution


def typical(people: Sequence[Participant], distribution: Distribution, route: Route) -> Participant:
    """Return who of ``people``, drawn from ``distribution``, is nearest to its medians."""
    return min(people, key=lambda one: distance(one, distribution, route))


def distance(person: Participant, distribution: Distribution, route: Route) -> float:
    """Return how far ``person`` lies from the medians, in standard deviations."""
    of_laws = (law.deviation(person.values[name]) for name, law in distribution.laws.items())
    return hypot(*of_laws, *_of_lasting_wish(person, route))


def _of_lasting_wish(person: Participant, route: Route) -> tuple[float, float]:
    """Return the deviations of wished offset and lateral acceleration; 0 for what is not drawn."""
    st = DriverState(person_seed=person.seed)
    for name in person.values:
        setattr(st, name, person.value(name))
    st.wish_offset_occasion_sd_mps = st.wish_lateral_occasion_sigma = 0.0  # of a drive
    roads = route_arrays(route)
    curvature = np.asarray(roads.curvature_per_m)
    offset, lateral = np.zeros(len(curvature)), np.zeros(len(curvature))
    fill_offsets(st, roads.limit_mps, offset)
    fill_lateral_accels(st, roads.curvature_per_m, lateral)
    in_curves = np.abs(curvature) > st.driver_lever_curvature_per_m
    return (
        _deviation(
            offset - st.wish_offset_mps, st.wish_offset_person_sd_mps, st.wish_offset_place_sd_mps
        ),
        _deviation(
            np.log(lateral[in_curves] / st.wish_lateral_accel_max_mps2),
            st.wish_lateral_person_sigma,
            st.wish_lateral_place_sigma,
        ),
    )


def _deviation(differences: FloatArray, *parts: float) -> float:
    """Return the root mean square of differences, in standard deviations of their parts' sum."""
    if not any(parts) or not len(differences):
        return 0.0
    return float(np.sqrt(np.mean(differences**2))) / hypot(*parts)
