"""What the project's reader says of a way, compared with what the judge reads of it.

The judge is told which roads were driven and asks: are they linked, are their limits those that the
file states, does the line run where the file says, and does the car turn where the line turns,
judged over a car's length and a bit more? A difference is a violation unless it is told.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
from pldf.roads.options import RoadOptions
from pldf.roads.route import Route
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from .judged_roads_line import STEP_M, Array, wrapped
from .judged_roads_reader import Town, Way

# Windows over which the turning of a line is judged: a car's length, and what a repair may spread.
_CAR_M: Final = 5.0
_WIDE_M: Final = 50.0
_LANE_M: Final = 3.0  # so far beside the line a car is still in its lane
# Where the curvature is noise, nobody knows where the line runs: so far beside it, so much sharper.
_NOISE_M: Final = 6.0
_NOISE_SHARPER: Final = 2.0
_LATERAL_MPS2: Final = 2.5
_FASTER_MPS: Final = 50.0 / 3.6  # nobody drives so much faster than every limit
_LINK_WORDS: Final = (
    "link", "predecessor", "successor", "junction", "contactPoint", "the way ends",
    "no lane for cars",
)  # fmt: skip
_CURVE_WORDS: Final = ("turns", "noise", "no curve of a road", "smoothed")


class Difference(NamedTuple):
    """Something that is otherwise than the file says."""

    what: str  # way, length, limit, line, missed curve, invented curve
    at_m: float
    text: str
    told: bool


def driven(route: Route, town: Town) -> list[Way]:
    """Return the ways of the route's marks."""
    return [
        Way(_road_id(mark.name, town), mark.against) for mark in route.marks if mark.kind == "road"
    ]


def _road_id(name: str, town: Town) -> str:
    ids = (name, *(name[:at] for at in range(len(name) - 1, -1, -1) if name[at] == " "))
    return next((each for each in ids if each in town.roads), name)


def differences(route: Route, town: Town, options: RoadOptions) -> Iterator[Difference]:
    """Yield what is otherwise.

    Raises:
        Unclear: the file does not say plainly what is right.
    """
    ways = driven(route, town)
    notes = [str(note) for note in route.notes]
    yield from _links(ways, town, options, notes)
    lengths = [town.length_m(way.road) for way in ways]
    starts = np.concatenate(([0.0], np.cumsum(lengths)))
    marks = [mark.s_m for mark in route.marks if mark.kind == "road"]
    for at, (mark, start) in enumerate(zip([*marks, route.length_m], starts, strict=True)):
        if abs(mark - start) > 1e-6 * (1.0 + start):
            text = f"road {ways[min(at, len(ways) - 1)].road} at {mark:.9g}, not {start:.9g} m"
            yield Difference("length", mark, text, told=False)
            return
    yield from _limits(route, ways, starts, town, options, notes)
    yield from _lines(route, ways, starts, town, notes)


def _links(
    ways: Sequence[Way], town: Town, options: RoadOptions, notes: Sequence[str]
) -> Iterator[Difference]:
    for before, behind in pairwise(ways):
        if behind not in town.onward(before):
            told = any(_of_link(note, before, behind) for note in notes)
            yield Difference("way", 0.0, f"{before} does not lead to {behind}", told)
    yield from _end(ways, town, options, notes)
    ids = iter([way.road for way in ways])
    named = [*options.via, *([options.to] if options.to else [])]
    if options.via and ways[0].road == options.via[0]:
        named = named[1:]
    next(ids)
    if options.start_road and ways[0].road != options.start_road:
        yield Difference("way", 0.0, f"starts at {ways[0]}", told=False)
    if options.to and ways[-1].road != options.to:
        yield Difference("way", 0.0, f"ends at {ways[-1]}", told=False)
    if len(ways) > 1 and not all(name in ids for name in named if name != options.to):
        yield Difference("way", 0.0, f"does not pass {named}: {ways}", told=False)


def _of_link(note: str, *ways: Way) -> bool:
    about_links = any(word in note for word in _LINK_WORDS)
    return about_links and any(re.search(rf"road '?{re.escape(w.road)}\b", note) for w in ways)


def _end(
    ways: Sequence[Way], town: Town, options: RoadOptions, notes: Sequence[str]
) -> Iterator[Difference]:
    """Yield that a way which nobody ended ends though it goes on, or at a link to nowhere."""
    if options.to is not None:
        return
    onward = [way for way in town.onward(ways[-1]) if way.road not in {w.road for w in ways}]
    nowhere = town.is_linked(ways[-1]) and not town.onward(ways[-1])
    if onward or nowhere:
        text = f"ends behind {ways[-1]}; on to {onward}"
        yield Difference("way", 0.0, text, told=any(_of_link(note, ways[-1]) for note in notes))


def _limits(
    route: Route,
    ways: Sequence[Way],
    starts: Array,
    town: Town,
    options: RoadOptions,
    notes: Sequence[str],
) -> Iterator[Difference]:
    steps: list[tuple[float, float | None]] = []
    for way, start, stop in zip(ways, starts, starts[1:], strict=False):
        stated = town.stated(way, options.limit_unit or "m/s")
        length = stop - start
        stops = [*(min(s, length) for s, _ in stated[1:]), length]
        for (s, limit), after in zip(stated, stops, strict=True):
            if s < length and after > s:
                steps.append((stop - after if way.against else start + s, limit))
    steps.sort(key=lambda step: step[0])
    edges = np.array([s for s, _ in steps])
    gaps_told = any("limit" in note or "sign" in note for note in notes)
    probes = np.arange(0.25, route.length_m, 0.5)
    near = np.abs(edges[np.clip(np.searchsorted(edges, probes), 0, len(edges) - 1)] - probes) < 0.3
    near |= np.abs(edges[np.searchsorted(edges, probes, side="right") - 1] - probes) < 0.3
    probes = probes[~near]
    which = np.searchsorted(edges, probes, side="right") - 1
    got = route.speed_limit_mps[np.searchsorted(route.s_m, probes, side="right") - 1]
    wanted = np.array([np.nan if limit is None else limit for _, limit in steps])[which]
    wrong = np.flatnonzero(~np.isnan(wanted) & (np.abs(got - wanted) > 1e-6))
    if len(wrong):
        at = wrong[0]
        text = f"{3.6 * got[at]:.5g} km/h where the file says {3.6 * wanted[at]:.5g}"
        yield Difference("limit", float(probes[at]), f"{text}, {len(wrong) / 2:g} m", told=False)
    gaps = np.flatnonzero(np.isnan(wanted))
    if len(gaps) and (len(gaps) < len(probes) or options.default_limit_mps is None):
        text = f"nothing is stated, {3.6 * got[gaps[0]]:.5g} km/h is read"
        yield Difference("limit", float(probes[gaps[0]]), text, gaps_told)
    filled = _filled(wanted)
    plain = options.default_limit_mps is None and not town.has_signs()
    other = np.flatnonzero(np.isnan(wanted) & (np.abs(got - filled) > 1e-6))
    if plain and len(other):
        text = f"a gap has {3.6 * got[other[0]]:.5g}, its neighbour {3.6 * filled[other[0]]:.5g}"
        yield Difference("limit", float(probes[other[0]]), text, told=False)


def _filled(limits: Array) -> Array:
    """Return the limits with that before in gaps, at the start that behind."""
    known = np.flatnonzero(~np.isnan(limits))
    if not len(known):
        return limits
    at = np.searchsorted(known, np.arange(len(limits)), side="right") - 1
    return limits[known[np.maximum(at, 0)]]


def _lines(
    route: Route, ways: Sequence[Way], starts: Array, town: Town, notes: Sequence[str]
) -> Iterator[Difference]:
    s_m, turned, x_m, y_m, moved = _whole(ways, starts, town)
    grid = np.arange(0.0, route.length_m, STEP_M)
    yield from _curves(route, grid, s_m, turned, notes)
    got_x, got_y = (np.interp(grid, route.s_m, values) for values in (route.x_m, route.y_m))
    away = np.hypot(np.interp(grid, s_m, x_m) - got_x, np.interp(grid, s_m, y_m) - got_y)
    for at, gap in moved:  # x and y move over there
        away[np.abs(grid - at) <= 5.0 * gap + 1.0] = 0.0
        if gap > 1.05 and not any("sideways" in note for note in notes):
            yield Difference("line", at, f"the line jumps by {gap:.3g} m", told=False)
    far = int(np.argmax(away))
    if away[far] > 0.5:
        yield Difference("line", float(grid[far]), f"{away[far]:.3g} m beside the line", told=False)


def _whole(
    ways: Sequence[Way], starts: Array, town: Town
) -> tuple[Array, Array, Array, Array, list[tuple[float, float]]]:
    """Return s, turned heading, x and y of the whole way, and where it jumps by how much."""
    parts: list[Array] = []
    moved = []
    turned, heading = 0.0, 0.0
    for way, start in zip(ways, starts, strict=False):
        line = town.line(way.road)
        s, turn, x, y = line.s_m, line.turned_rad, line.x_m, line.y_m
        first = line.heading_rad
        if way.against:
            first = line.heading_rad + turn[-1] + np.pi
            s, turn, x, y = (
                town.length_m(way.road) - s[::-1],
                (turn - turn[-1])[::-1],
                x[::-1],
                y[::-1],
            )
        if parts:
            turned += wrapped(first - heading)
            gap = np.hypot(x[0] - parts[-1][2, -1], y[0] - parts[-1][3, -1])
            if gap > 0.01:
                moved.append((float(start), float(gap)))
        parts.append(np.stack((start + s, turned + turn, x, y)))
        turned += turn[-1]
        heading = first + turn[-1]
        jumps = np.hypot(np.diff(x), np.diff(y)) - np.diff(s)
        moved += [(float(start + s[at]), float(jumps[at])) for at in np.flatnonzero(jumps > 0.02)]
    return (*np.concatenate(parts, axis=1), moved)


def _curves(
    route: Route, grid: Array, s_m: Array, turned: Array, notes: Sequence[str]
) -> Iterator[Difference]:
    """Yield curves that are missed or invented, the worst of each.

    Where nothing is told the route turns as the line does, over a car's length. Where curves were
    repaired, whoever turns as the route does stays in the lane, and turns nowhere more sharply
    than the line does within ``_WIDE_M``.
    """
    own = np.interp(grid, s_m, turned)
    driven_rad = np.interp(grid, route.s_m, _integral(route.s_m, route.curvature_per_m))
    felt = _LATERAL_MPS2 / (float(np.max(route.speed_limit_mps)) + _FASTER_MPS) ** 2
    is_, line = _mean(driven_rad, _CAR_M), _mean(own, _CAR_M)
    told = any(word in note for note in notes for word in _CURVE_WORDS)
    if not told:
        # A small corner is rounded over up to 50 m, within the play of a lane.
        lost = _mean(own - driven_rad, _WIDE_M) > 1.1 * felt
        lasting = np.where(lost, line, 0.0)
        yield from _excess("missed curve", grid, lasting, _near(is_, _CAR_M), felt)
        yield from _excess("invented curve", grid, is_, _near(line, 3.0 * _CAR_M), felt)
        return
    noisy = any("noise" in note for note in notes)
    sharpest = _near(line, _WIDE_M + 2.0 * _CAR_M) * (_NOISE_SHARPER if noisy else 1.0)
    yield from _excess("invented curve", grid, is_, sharpest, felt)
    beside = np.cumsum(driven_rad - own) * STEP_M
    beside -= uniform_filter1d(beside, int(2.0 * _WIDE_M / STEP_M), mode="nearest")
    at = int(np.argmax(np.abs(beside)))
    if abs(beside[at]) > (_NOISE_M if noisy else _LANE_M):
        text = f"who turns as the route does is {abs(beside[at]):.2g} m beside the line"
        yield Difference("missed curve", float(grid[at]), text, told=False)


def _excess(what: str, grid: Array, high: Array, low: Array, felt: float) -> Iterator[Difference]:
    excess = high - 1.15 * np.maximum(low, felt)
    at = int(np.argmax(excess))
    if excess[at] > 0.0:
        radii = (1.0 / max(values[at], 1e-9) for values in (high, low))
        text = "R {:.3g} m against R {:.3g} m".format(*radii)
        yield Difference(what, float(grid[at]), text, told=False)


def _integral(s_m: Array, values: Array) -> Array:
    return np.concatenate(([0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(s_m))))


def _mean(angle: Array, window_m: float) -> Array:
    """Return the mean curvature, without sign, over windows around each place of the grid."""
    half = max(int(0.5 * window_m / STEP_M), 1)
    n = len(angle)
    at = np.arange(n)
    a, b = np.maximum(at - half, 0), np.minimum(at + half, n - 1)
    return np.abs(angle[b] - angle[a]) / np.maximum((b - a) * STEP_M, window_m)


def _near(values: Array, window_m: float) -> Array:
    """Return the largest within half a window of each place."""
    largest: Array = maximum_filter1d(values, int(window_m / STEP_M) | 1, mode="nearest")
    return largest
