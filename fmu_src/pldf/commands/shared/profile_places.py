"""``pldf profiles show``: what is learned where, as a table and as a picture."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from ...errors import ModelError
from ...kernel.arrays import FloatArray
from ...kernel.codes import BOUND
from ...kernel.units import KMH_PER_MPS
from ...outcome_words import told_holds
from ...outcomes import held_places
from ...profiles.store import StoredProfile
from ...profiles.stored_profile import Iteration
from ...recordings.interventions import runs
from ...roads import Route, fingerprint, packed_route, route_arrays
from .road import chosen_road

SHOWN_MPS: Final = 0.1 / KMH_PER_MPS  # smaller differences round to nothing in the tables
NO_LIMIT: Final = "the file does not hold the legal limit; name the road with --route to see it"


class Place(NamedTuple):
    """A run of nodes or cells where something is learned, or waits.

    Attributes:
        first, last: its ends, both included, in m.
        mean_kmh, peak_kmh: how much, on average and at most.
        lessons: how many drives shaped it at most, or how many demonstrations wait.
        drives: numbers of the iterations that shaped it last.
        evidence: largest evidence there.
        bounds: which cut it.
    """

    first: int
    last: int
    mean_kmh: float
    peak_kmh: float
    lessons: int
    drives: tuple[int, ...]
    evidence: float
    bounds: str


def learned_places(iteration: Iteration) -> list[Place]:
    """Return where pedals and lever hold the profile off its base."""
    return [*_places(iteration, iteration.learned_mps - iteration.base_mps, "")]


def offset_places(iteration: Iteration) -> list[Place]:
    """Return where an offset of the set speed is learned."""
    return [*_places(iteration, iteration.offset_mps, "offset_")]


def waiting_places(iteration: Iteration) -> list[tuple[str, Place]]:
    """Return what waits for more evidence, with the way it was shown."""
    found = []
    for sign in ("faster", "slower"):
        for prefix, way in (("", "pedals"), ("offset_", "lever")):
            pending = getattr(iteration, f"{prefix}pending_{sign}")
            wish = getattr(iteration, f"{prefix}pending_{sign}_mps")
            difference = np.where(pending > 0.0, wish if prefix else wish - iteration.base_mps, 0.0)
            for first, behind in runs(pending > 0.0):
                place = _place(iteration, difference, prefix, first, behind)
                lessons = int(pending[first:behind].max())
                found.append((f"{sign} by {way}", place._replace(lessons=lessons)))
    return found


def _places(iteration: Iteration, difference: FloatArray, prefix: str) -> Iterator[Place]:
    for first, behind in runs(np.abs(difference) > SHOWN_MPS):
        yield _place(iteration, difference, prefix, first, behind)


def _place(
    iteration: Iteration, difference: FloatArray, prefix: str, first: int, behind: int
) -> Place:
    kmh = difference[first:behind] * KMH_PER_MPS
    here = slice(first, behind)
    evidence = (getattr(iteration, f"{prefix}evidence_{sign}") for sign in ("faster", "slower"))
    return Place(
        first=first,
        last=behind - 1,
        mean_kmh=float(kmh.mean()),
        peak_kmh=float(kmh[np.argmax(np.abs(kmh))]),
        lessons=int(iteration.lessons[here].max()),
        drives=tuple(int(k) for k in np.unique(iteration.drive[here]) if k > 0.0),
        evidence=max(float(values[here].max()) for values in evidence),
        bounds=_bounds(iteration.bound[here]),
    )


def _bounds(codes: FloatArray) -> str:
    """Return the bounds that cut a place, by name, or a dash."""
    names = [BOUND.items[int(code)].lower() for code in np.unique(codes) if code > 0.0]
    return ", ".join(names) or "-"


def show(options: argparse.Namespace, profile: StoredProfile) -> None:
    """Print all places of an iteration; draw them if asked to."""
    iteration = profile.iteration(options.iteration)
    route = _road_of(options, profile)
    print(f"driver     {profile.driver_id}")
    print(f"route      {profile.route}, {profile.nodes - 1} m")
    told = f"{iteration.kind}, {iteration.note}" if iteration.note else iteration.kind
    print(f"iteration  {iteration.number} of {len(profile.iterations)}: {told}")
    _print_places("learned minus base speed", learned_places(iteration))
    _print_places("learned offset of the set speed", offset_places(iteration))
    _print_waiting(iteration)
    _print_holds(iteration)
    if options.plot is not None:
        draw(options.plot, profile, iteration, route)
        print(f"plot       {options.plot}" + ("" if route else f" ({NO_LIMIT})"))


def _road_of(options: argparse.Namespace, profile: StoredProfile) -> Route | None:
    """Return the road of the profile: the one named, or the shipped one if it is that.

    Raises:
        ModelError: another road is named.
    """
    named = chosen_road(options)
    if named is not None and fingerprint(named.route) != profile.route:
        raise ModelError(
            f"the profile belongs to route {profile.route}, not to {named.route.name} "
            f"({fingerprint(named.route)}); name its road and options, or leave out --route"
        )
    if named is not None:
        return named.route
    shipped = packed_route(0)
    return shipped if fingerprint(shipped) == profile.route else None


def _print_places(title: str, places: list[Place]) -> None:
    if not places:
        print(f"{title}: none")
        return
    print(
        f"{title}:\n{'from m':>9} {'to m':>9} {'mean km/h':>10} {'peak km/h':>10} lessons  "
        f"{'cut by':24} {'drives':12} evidence"
    )
    for p in places:
        print(
            f"{p.first:9} {p.last:9} {p.mean_kmh:+10.1f} {p.peak_kmh:+10.1f} {p.lessons:7}  "
            f"{p.bounds:24} {', '.join(map(str, p.drives)) or '-':12} {p.evidence:8.2f}"
        )


def _print_waiting(iteration: Iteration) -> None:
    """Say what was shown and is not learned yet (only if something was)."""
    waiting = waiting_places(iteration)
    if waiting:
        print(
            f"waiting for more evidence:\n{'from m':>9} {'to m':>9} {'mean km/h':>10} "
            f"{'shown':>6} {'evidence':>9}  wish"
        )
    for way, p in waiting:
        print(f"{p.first:9} {p.last:9} {p.mean_kmh:+10.1f} {p.lessons:6} {p.evidence:9.2f}  {way}")


def _print_holds(iteration: Iteration) -> None:
    """Say where a bound, not the driver's wish, holds the learned speed."""
    told = told_holds(held_places(iteration.bound, iteration.learned_mps))
    print("bounds: none holds it" if not told else "bounds:")
    for hold in told:
        print(f"  {hold}")


def draw(path: Path, profile: StoredProfile, iteration: Iteration, route: Route | None) -> None:
    """Draw base and learned speed with each place's drives, and the limit if the road is known."""
    from matplotlib.figure import Figure  # noqa: PLC0415 - slow to import, rarely needed

    figure = Figure(figsize=(10, 4.5), layout="constrained")
    axes = figure.subplots()
    kilometres = np.arange(profile.nodes) / 1000.0
    base, learned = (KMH_PER_MPS * speed for speed in (iteration.base_mps, iteration.learned_mps))
    if route is not None:
        limit = KMH_PER_MPS * np.asarray(route_arrays(route).limit_mps)
        axes.step(
            kilometres, limit, where="post", label="legal limit", color="#666666", linewidth=1.6
        )
    axes.plot(kilometres, base, label="base", color="#0072B2", linewidth=1.2, linestyle="--")
    axes.plot(kilometres, learned, label="learned", color="#D55E00", linewidth=1.6)
    axes.fill_between(kilometres, base, learned, color="#56B4E9", alpha=0.35)
    for place in learned_places(iteration):
        _name(axes, place, learned)
    axes.set(
        xlabel="distance in km",
        ylabel="speed in km/h",
        title=f"Driver {profile.driver_id}, route {profile.route}, iteration {iteration.number}",
    )
    axes.margins(y=0.12)
    axes.grid(alpha=0.3)
    axes.legend(loc="best")
    try:
        figure.savefig(path, dpi=120)
    except (OSError, ValueError) as error:  # ValueError: a file type that is unknown
        raise ModelError(f"{path}: cannot be written ({error})") from error


def _name(axes: Any, place: Place, learned_kmh: FloatArray) -> None:
    """Write how much was learned in a place, and in which drives."""
    at = place.first + int(np.argmax(learned_kmh[place.first : place.last + 1]))
    drives = f"\ndrive {', '.join(map(str, place.drives))}" if place.drives else ""
    axes.annotate(
        f"{place.peak_kmh:+.0f}{drives}", (at / 1000.0, learned_kmh[at]),
        xytext=(0, 4), textcoords="offset points", ha="center", va="bottom", fontsize=7,
    )  # fmt: skip
