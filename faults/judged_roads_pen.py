"""A pen for small OpenDRIVE maps: pieces of line, roads, junctions, and the text of their file.

Roads are pieces of line, arc, clothoid or cubic, drawn one after the other with a pen; some are
drawn against the way that is driven, some lie in left-hand traffic, some are one-way.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import atan2, cos, hypot, pi, sin
from typing import Final, NamedTuple

import numpy as np

_FINE: Final = 400


class Piece(NamedTuple):
    """A geometry: where it starts, how long it is, its curvatures or cubics (aU ... dV)."""

    x: float
    y: float
    heading: float
    length: float
    first: float = 0.0
    last: float = 0.0
    cubic: tuple[float, ...] = ()

    @property
    def end(self) -> tuple[float, float, float]:
        """Where it ends: x, y, heading."""
        if self.cubic:
            u, v = sum(self.cubic[:4]), sum(self.cubic[4:])
            du, dv = (sum(n * c for n, c in enumerate(self.cubic[at : at + 4])) for at in (0, 4))
            turn = atan2(dv, du)
        else:
            s = (np.arange(_FINE) + 0.5) * self.length / _FINE
            angle = self.first * s + 0.5 * (self.last - self.first) / max(self.length, 1e-9) * s * s
            u, v = (float(np.mean(f(angle)) * self.length) for f in (np.cos, np.sin))
            turn = 0.5 * (self.first + self.last) * self.length
        c, s_ = cos(self.heading), sin(self.heading)
        return self.x + c * u - s_ * v, self.y + s_ * u + c * v, self.heading + turn

    @property
    def turned(self) -> Piece:
        """The same, drawn from its end."""
        x, y, heading = self.end
        if self.cubic:
            return between((x, y, heading + pi), (self.x, self.y, self.heading + pi))
        return Piece(x, y, heading + pi, self.length, -self.last, -self.first)

    def text(self, s_m: float) -> str:
        """The element."""
        if self.cubic:
            names = [c + axis for axis in "UV" for c in "abcd"]
            given = " ".join(f'{n}="{c!r}"' for n, c in zip(names, self.cubic, strict=True))
            shape = f'<paramPoly3 {given} pRange="normalized"/>'
        elif self.first != self.last:
            shape = f'<spiral curvStart="{self.first!r}" curvEnd="{self.last!r}"/>'
        else:
            shape = f'<arc curvature="{self.first!r}"/>' if self.first else "<line/>"
        return (
            f'<geometry s="{s_m!r}" x="{self.x!r}" y="{self.y!r}" hdg="{self.heading!r}" '
            f'length="{self.length!r}">{shape}</geometry>'
        )


def between(start: tuple[float, float, float], end: tuple[float, float, float]) -> Piece:
    """Return the cubic from one place and heading to another, as junctions are drawn."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    c, s = cos(start[2]), sin(start[2])
    u, v, turn = c * dx + s * dy, c * dy - s * dx, end[2] - start[2]
    pull = 1.2 * hypot(dx, dy)
    cubic = []
    for first, last, at in ((pull, pull * cos(turn), u), (0.0, pull * sin(turn), v)):
        cubic += [0.0, first, 3.0 * at - 2.0 * first - last, first + last - 2.0 * at]
    p = np.linspace(0.0, 1.0, 4001)
    steps = [np.diff(np.polyval(cubic[at : at + 4][::-1], p)) for at in (0, 4)]
    length = float(np.sum(np.hypot(*steps)))
    return Piece(*start, length, cubic=tuple(cubic))


@dataclass
class Road:
    """One road; links are texts like ``7 start`` or ``junction J``."""

    name: str
    pieces: list[Piece]
    rear: str = ""
    front: str = ""
    junction: str = "-1"
    limit: str = '<type s="0" type="rural"><speed max="70" unit="km/h"/></type>'
    sides: str = "both"  # both, right, left
    rule: str = ""
    signals: str = ""

    @property
    def length(self) -> float:
        """Of all pieces."""
        return sum(piece.length for piece in self.pieces)

    @property
    def text(self) -> str:
        """The element."""
        starts = np.concatenate(([0.0], np.cumsum([piece.length for piece in self.pieces])))
        plan = "\n".join(p.text(float(s)) for p, s in zip(self.pieces, starts, strict=False))
        sides = [s for s in ("left", "right") if self.sides in (s, "both")]
        lanes = "".join(
            f'<{s}><lane id="{1 if s == "left" else -1}" type="driving" level="false">'
            '<width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane></' + s + ">"
            for s in sides
        )
        return (
            f'<road id="{self.name}" length="{self.length!r}" junction="{self.junction}" '
            f"{self.rule}>\n<link>{_link('predecessor', self.rear)}"
            f"{_link('successor', self.front)}</link>\n{self.limit}\n<planView>\n{plan}\n"
            f'</planView>\n<elevationProfile><elevation s="0" a="100" b="0.01" c="0" d="0"/>'
            f'</elevationProfile>\n<lanes><laneSection s="0">{lanes}</laneSection></lanes>\n'
            f"{self.signals}</road>"
        )


def _link(tag: str, to: str) -> str:
    name, _, end = to.rpartition(" ")
    if not to:
        return ""
    if name == "junction":
        return f'<{tag} elementType="junction" elementId="{end}"/>'
    return f'<{tag} elementType="road" elementId="{name}" contactPoint="{end}"/>'


@dataclass
class Sketch:
    """Roads and junctions on their way to a file."""

    roads: list[Road] = field(default_factory=list)
    connections: dict[str, list[tuple[str, str, str]]] = field(default_factory=dict)

    def connect(self, junction: str, before: str, behind: str) -> None:
        """Add a connecting road from ``7 end`` to ``8 start``."""
        (one, end), (other, start) = before.split(), behind.split()
        name = f"{junction}{len(self.connections.get(junction, ()))}"
        x, y, heading = self.pose(one, end)
        x2, y2, heading2 = self.pose(other, start)
        piece = between((x, y, heading), (x2, y2, heading2 + pi))
        self.roads.append(Road(name, [piece], before, behind, junction, sides="right"))
        self.connections.setdefault(junction, []).append((one, name, "start"))

    def pose(self, road: str, end: str) -> tuple[float, float, float]:
        """Return where a road has its start or end, and the heading out of it."""
        pieces = next(r for r in self.roads if r.name == road).pieces
        if end == "end":
            return pieces[-1].end
        return pieces[0].x, pieces[0].y, pieces[0].heading + pi

    def turn(self, name: str) -> None:
        """Draw a road the other way round."""
        at = next(n for n, r in enumerate(self.roads) if r.name == name)
        road = self.roads[at]
        other = {f"{name} start": f"{name} end", f"{name} end": f"{name} start"}
        swap = {"left": "right", "right": "left", "both": "both"}
        self.roads[at] = replace(
            road, pieces=[p.turned for p in reversed(road.pieces)],
            rear=road.front, front=road.rear, sides=swap[road.sides],
        )  # fmt: skip
        for each in self.roads:
            each.rear, each.front = (
                other.get(each.rear, each.rear),
                other.get(each.front, each.front),
            )
        for junction, all_ in self.connections.items():
            ends = {"start": "end", "end": "start"}
            self.connections[junction] = [
                (one, inner, ends[c] if inner == name else c) for one, inner, c in all_
            ]

    @property
    def text(self) -> str:
        """The file."""
        junctions = "\n".join(
            f'<junction id="{name}">'
            + "".join(
                f'<connection id="{n}" incomingRoad="{one}" connectingRoad="{inner}" '
                f'contactPoint="{contact}"><laneLink from="-1" to="-1"/></connection>'
                for n, (one, inner, contact) in enumerate(each)
            )
            + "</junction>"
            for name, each in self.connections.items()
        )
        roads = "\n".join(road.text for road in self.roads)
        return (
            '<?xml version="1.0" encoding="UTF-8"?>\n<OpenDRIVE>\n'
            f'<header revMajor="1" revMinor="6" name="drawn"/>\n{roads}\n'
            f"{junctions}\n</OpenDRIVE>\n"
        )
