"""Roads that were drawn by chance and then spoilt: right, told or refused, never a traceback."""

from __future__ import annotations

import random
import re
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final

from pldf.roads import read_route
from pldf.roads.options import RoadOptions
from pldf.roads.route import Route

from .experiment import Counts, Experiment, Progress
from .judged_roads import differences
from .judged_roads_changes import BYTE_CHANGES, TREE_CHANGES, changed
from .judged_roads_maps import DRAWINGS, drawn
from .judged_roads_reader import Town, Way, parse
from .sheets import Unclear
from .verdicts import Verdict, Word, asked, counted

_STEPS_MAX: Final = 8
# Where a refusal is: a line of the file, a road, or what has to be said of the roads.
_PLACE: Final = re.compile(r"line \d+|road|--|XML|encod|empty|OpenDRIVE")


@dataclass(frozen=True)
class Kind:
    """A drawing, spoilt in one way, or in none."""

    name: str


def way_through(town: Town, chance: random.Random) -> list[Way]:
    """Return some roads in a row that are linked, each once."""
    ways = [Way(name, against) for name in town.roads for against in (False, True)]
    way = [chance.choice([each for each in ways if town.has_lane(each)])]
    for _ in range(chance.randrange(_STEPS_MAX)):
        passed = {each.road for each in way}
        onward = [each for each in town.onward(way[-1]) if each.road not in passed]
        if not onward:
            break
        way.append(chance.choice(onward))
    return way


def options_for(way: list[Way], chance: random.Random) -> RoadOptions:
    """Return what a person says to drive there, or only where to start."""
    default = chance.choice((None, 50.0 / 3.6))
    first = RoadOptions(start_road=way[0].road, reverse=way[0].against, default_limit_mps=default)
    if chance.random() < 0.3:
        return first
    via = tuple(each.road for each in way[1:])
    return RoadOptions(way[0].road, via, way[-1].road, way[0].against, default)


def verdict(
    path: Path, text: str | None, options: RoadOptions, known: set[str]
) -> tuple[Word, str]:
    """Return what the reader's answer to a file is, and what speaks for it.

    Args:
        path: the file.
        text: what anybody reads in it; None: nobody knows.
        options: how it is read.
        known: what was told of the sound file.
    """
    route = asked(partial(read_route, options=options), path)
    if not isinstance(route, Route):
        word, why = route
        if word == "refused" and not _PLACE.search(why.replace(str(path), "")):
            return "violation", f"refused without a place: {why}"
        return route
    told = {note.text for note in route.notes} - known
    try:
        if text is None:
            raise Unclear("characters")
        found = list(differences(route, parse(text), options))
    except Unclear as unclear:
        if told:
            return "told", "; ".join(sorted(told))
        return "violation", f"taken without a word, though unclear: {unclear}"
    for each in found:
        if not each.told:
            return "violation", f"{each.what} at {each.at_m:.1f} m: {each.text}"
    return ("told" if told or found else "right"), ""


def trials(kind: Kind, count: int, seed: int) -> Iterator[Verdict]:
    """Draw so many maps, spoil them in this way, yield what came of each."""
    chance = random.Random(f"{kind.name} {seed}")
    with tempfile.TemporaryDirectory(prefix="faults_") as folder:
        path = Path(folder, "road.xodr")
        for _ in range(count):
            drawing = chance.choice(list(DRAWINGS))
            text = drawn(drawing, chance)
            options = options_for(way_through(parse(text), chance), chance)
            path.write_text(text)
            sound = asked(partial(read_route, options=options), path)
            known = {note.text for note in sound.notes} if isinstance(sound, Route) else set()
            if kind.name == "sound":
                yield Verdict(drawing, *verdict(path, text, options, set()))
                continue
            done, data, meant = changed(text, kind.name, chance)
            path.write_bytes(data)
            yield Verdict(f"{drawing}, {done}", *verdict(path, meant, options, known))


KINDS: Final = tuple(map(Kind, ("sound", *TREE_CHANGES, *BYTE_CHANGES)))


def roads(count: int, seed: int, progress: Progress) -> Counts:
    """Draw and spoil so many roads; count the verdicts."""
    return counted(KINDS, trials, count, seed, progress)


EXPERIMENTS: Final = (
    Experiment(
        "judged_roads",
        "A way through a map of OpenDRIVE roads, sound or spoilt, runs, turns and is limited as an "
        "independent reader reads it, or it is told, or refused.",
        roads,
        count=300 * len(KINDS),
        short=12 * len(KINDS),
    ),
)
