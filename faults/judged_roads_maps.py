"""Small OpenDRIVE maps of many kinds, drawn by chance: what people's roads look like."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from math import cos, pi, radians, sin
from typing import Final

from .judged_roads_pen import Piece, Road, Sketch


def _pieces(chance: random.Random, pose: tuple[float, float, float], count: int) -> Iterator[Piece]:
    last = 0.0
    for _ in range(count):
        length = round(chance.uniform(15.0, 120.0), 2)
        bend = chance.choice((-1, 1)) / chance.uniform(25.0, 400.0)
        kind = chance.randrange(4)
        if kind == 0 or last != 0.0:  # what turns goes on with a clothoid
            first, last = last, (0.0 if last and kind < 2 else bend)
        else:
            first = last = bend if kind == 1 else 0.0
        yield (piece := Piece(*pose, length, first, last))
        pose, last = piece.end, last if kind == 0 else 0.0


def _limit(chance: random.Random, length: float) -> str:
    def speed() -> str:
        return chance.choice((
            '<speed max="50" unit="km/h"/>', '<speed max="25" unit="mph"/>',
            '<speed max="22.2" unit="m/s"/>', '<speed max="27.77"/>',
            '<speed max="no limit"/>', '<speed max="undefined"/>', "",
        ))  # fmt: skip

    texts = [f'<type s="{chance.choice((0.0, 0.0, 0.3))}" type="rural">{speed()}</type>']
    if chance.random() < 0.4:
        s = round(chance.uniform(5.0, max(length - 5.0, 6.0)), 1)
        texts.append(f'<type s="{s}" type="town">{speed()}</type>')
    return "\n".join(texts)


def chain(chance: random.Random) -> Sketch:
    """Roads one after the other."""
    made, pose, count = Sketch(), (0.0, 0.0, 0.0), chance.randrange(1, 5)
    for n in range(1, count + 1):
        pieces = list(_pieces(chance, pose, chance.randrange(1, 5)))
        rear, front = (f"{n - 1} end" if n > 1 else ""), (f"{n + 1} start" if n < count else "")
        road = Road(str(n), pieces, rear, front)
        road.limit = _limit(chance, road.length)
        made.roads.append(road)
        pose = pieces[-1].end
        if chance.random() < 0.2:  # lanes are counted from another line
            aside = chance.uniform(-14.0, 14.0)
            pose = (pose[0] - aside * sin(pose[2]), pose[1] + aside * cos(pose[2]), pose[2])
    if chance.random() < 0.1:
        made.roads[-1].front = f"{count + 7} start"  # at the edge of the excerpt
    return made


def chords(chance: random.Random) -> Sketch:
    """A bend drawn as straight chords."""
    angle, count = radians(chance.uniform(20.0, 150.0)), chance.randrange(2, 14)
    radius = chance.uniform(15.0, 120.0)
    chord = angle * radius / count
    lines, pose = [], (0.0, 0.0, 0.0)
    for n in range(count + 2):
        lines.append(Piece(*pose, 100.0 if n in (0, count + 1) else chord))
        x, y, heading = lines[-1].end
        pose = (x, y, heading + angle / (count + 1))
    return Sketch([Road("1", lines)])


def spike(chance: random.Random) -> Sketch:
    """A straight or a wide bend with short sharp arcs."""
    bend, pose, pieces = chance.choice((0.0, 0.002)), (0.0, 0.0, 0.0), []
    for _ in range(chance.randrange(1, 4)):
        sharp = chance.choice((-1, 1)) / chance.uniform(4.0, 40.0)
        for length, curvature in ((150.0, bend), (chance.uniform(0.05, 9.0), sharp), (80.0, bend)):
            pieces.append(Piece(*pose, length, curvature, curvature))
            pose = pieces[-1].end
    return Sketch([Road("1", pieces)])


def noise(chance: random.Random) -> Sketch:
    """A survey whose curvature is noise."""
    sigma, length = chance.choice((0.001, 0.002, 0.004)), chance.choice((5.0, 10.0))
    pose, pieces = (0.0, 0.0, 0.0), []
    for n in range(80):
        bend = chance.gauss(0.01 if 30 < n < 45 else 0.0, sigma)
        pieces.append(Piece(*pose, length, bend, bend))
        pose = pieces[-1].end
    return Sketch([Road("1", pieces)])


def star(chance: random.Random) -> Sketch:
    """A junction of three or four arms, all ways through it."""
    made, arms = Sketch(), chance.choice((3, 4))
    for n in range(arms):
        angle = 2.0 * pi * n / arms + chance.uniform(-0.3, 0.3)
        start = (15.0 * cos(angle), 15.0 * sin(angle), angle)
        pieces = list(_pieces(chance, start, chance.randrange(1, 3)))
        made.roads.append(Road(f"a{n}", pieces, rear="junction J"))
        made.roads[-1].limit = _limit(chance, made.roads[-1].length)
    for one in range(arms):
        for other in range(arms):
            if one != other:
                made.connect("J", f"a{one} start", f"a{other} start")
    return made


def roundabout(chance: random.Random) -> Sketch:
    """Four arms and a ring that is driven anticlockwise."""
    made, radius = Sketch(), chance.uniform(12.0, 40.0)
    for n in range(4):
        angle = 0.5 * pi * n + 0.35
        pose = (radius * cos(angle), radius * sin(angle), angle + 0.5 * pi)
        ring = Piece(*pose, radius * (0.5 * pi - 0.7), 1.0 / radius, 1.0 / radius)
        rear, front = f"junction J{n}", f"junction J{(n + 1) % 4}"
        made.roads.append(Road(f"r{n}", [ring], rear, front, sides="right"))
    for n in range(4):
        angle = 0.5 * pi * n
        start = ((radius + 15.0) * cos(angle), (radius + 15.0) * sin(angle), angle)
        made.roads.append(Road(f"a{n}", [Piece(*start, 80.0)], rear=f"junction J{n}"))
    for n in range(4):
        before = f"r{(n + 3) % 4} end"
        made.connect(f"J{n}", before, f"r{n} start")
        made.connect(f"J{n}", before, f"a{n} start")
        made.connect(f"J{n}", f"a{n} start", f"r{n} start")
    return made


def eight(chance: random.Random) -> Sketch:
    """Two circles that touch each other, closed."""
    radius = chance.uniform(20.0, 60.0)
    rounds = [
        Piece(0.0, 0.0, 0.0, 2.0 * pi * radius, bend / radius, bend / radius) for bend in (1, -1)
    ]
    return Sketch(
        [Road("1", rounds[:1], "2 end", "2 start"), Road("2", rounds[1:], "1 end", "1 start")]
    )


def loop(chance: random.Random) -> Sketch:
    """A road whose both ends are at one junction."""
    radius = chance.uniform(20.0, 50.0)
    arm = Piece(-100.0, 0.0, 0.0, 85.0)
    ring = Piece(radius * 0.7, -radius * 0.3, -0.25 * pi, 1.5 * pi * radius, *(1.0 / radius,) * 2)
    made = Sketch([Road("arm", [arm], front="junction J")])
    made.roads.append(Road("ring", [ring], "junction J", "junction J"))
    made.connect("J", "arm end", "ring start")
    made.connect("J", "ring end", "arm end")
    made.connect("J", "arm end", "ring end")
    made.connect("J", "ring start", "arm end")
    return made


DRAWINGS: Final[dict[str, Callable[[random.Random], Sketch]]] = {
    "chain": chain, "chords": chords, "spike": spike, "noise": noise, "star": star,
    "roundabout": roundabout, "eight": eight, "loop": loop,
}  # fmt: skip


def drawn(name: str, chance: random.Random) -> str:
    """Return a map of that kind; its roads drawn and its lanes numbered by chance."""
    made = DRAWINGS[name](chance)
    for road in list(made.roads):
        if chance.random() < 0.3:
            made.turn(road.name)
    if chance.random() < 0.2:
        swap = {"left": "right", "right": "left", "both": "both"}
        for road in made.roads:
            road.sides, road.rule = swap[road.sides], 'rule="LHT"'
    elif chance.random() < 0.3:
        road = chance.choice(made.roads)
        road.sides = chance.choice(("left", "right"))
    return made.text
