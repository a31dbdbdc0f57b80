"""Small networks of roads as OpenDRIVE text."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from xml.sax.saxutils import quoteattr

RIGHT = ("", "driving")
LEFT = ("driving", "")
BOTH = ("driving", "driving")
NONE = ("", "")


@dataclass
class Map:
    """Roads between points, and junctions between roads; written as one file.

    A road is a straight line; ``rear`` and ``front`` are its ``predecessor`` and ``successor``.
    """

    roads: list[str] = field(default_factory=list)
    connections: dict[str, list[str]] = field(default_factory=dict)
    kinds: dict[str, str] = field(default_factory=dict)

    def road(  # noqa: PLR0913 - what an element has
        self,
        name: str,
        start: tuple[float, float],
        end: tuple[float, float],
        *,
        rear: str = "",
        front: str = "",
        lanes: tuple[str, str] = RIGHT,
        junction: str = "-1",
        more: str = "",
    ) -> Map:
        """Add a road; links read ``7 start`` (a road and its end) or ``junction 9``.

        ``lanes`` are the types of the lane on the left and of that on the right.
        """
        length = math.dist(start, end)
        heading = math.atan2(end[1] - start[1], end[0] - start[0])
        links = _link("predecessor", rear) + _link("successor", front)
        self.roads.append(
            f'<road id={quoteattr(name)} length="{length!r}" junction="{junction}" {more}>\n'
            f'<link>{links}</link>\n<type s="0" type="rural"><speed max="50" unit="km/h"/></type>\n'
            f'<planView><geometry s="0" x="{start[0]!r}" y="{start[1]!r}" hdg="{heading!r}" '
            f'length="{length!r}"><line/></geometry></planView>\n{_lanes(lanes)}</road>'
        )
        return self

    def connect(
        self, junction: str, incoming: str, name: str, contact: str = "start", key: str = ""
    ) -> Map:
        """Add a connection; ``key`` is ``linkedRoad`` for direct junctions."""
        point = f' contactPoint="{contact}"' if contact else ""
        self.connections.setdefault(junction, []).append(
            f"<connection incomingRoad={quoteattr(incoming)} "
            f"{key or 'connectingRoad'}={quoteattr(name)}{point}/>"
        )
        return self

    @property
    def text(self) -> str:
        """The file."""
        junctions = [
            f'<junction id="{name}" {self.kinds.get(name, "")}>{"".join(each)}</junction>'
            for name, each in self.connections.items()
        ]
        body = "\n".join(self.roads + junctions)
        return f'<?xml version="1.0"?>\n<OpenDRIVE>\n{body}\n</OpenDRIVE>\n'


def _link(tag: str, to: str) -> str:
    name, _, end = to.rpartition(" ")
    if not to:
        return ""
    if name == "junction":
        return f'<{tag} elementType="junction" elementId="{end}"/>'
    point = f' contactPoint="{end}"' if end else ""
    return f'<{tag} elementType="road" elementId={quoteattr(name)}{point}/>'


def _lanes(kinds: tuple[str, str]) -> str:
    if kinds == NONE:
        return ""
    sides = "".join(
        f'<{side}><lane id="{number}" type="{kind}"/></{side}>'
        for side, number, kind in (("left", 1, kinds[0]), ("right", -1, kinds[1]))
        if kind
    )
    return f'<lanes><laneSection s="0">{sides}</laneSection></lanes>'


def crossing(lanes: tuple[str, str] = BOTH) -> Map:
    """Return a crossing of four arms of 100 m, w to e and s to n, drawn towards it and away.

    Arms: w (drawn towards the junction), s (towards), e (away), n (away). From each arm there are
    connecting roads of 20 m and more to all the others, named like ``we``, drawn as they are driven
    and with a lane on the right.
    """
    made = Map()
    arms = {"w": (-1.0, 0.0), "s": (0.0, -1.0), "e": (1.0, 0.0), "n": (0.0, 1.0)}
    inner = {name: (10.0 * x, 10.0 * y) for name, (x, y) in arms.items()}
    outer = {name: (110.0 * x, 110.0 * y) for name, (x, y) in arms.items()}
    at = {"w": "end", "s": "end", "e": "start", "n": "start"}
    for name in "ws":
        made.road(name, outer[name], inner[name], front="junction J", lanes=lanes)
    for name in "en":
        made.road(name, inner[name], outer[name], rear="junction J", lanes=lanes)
    for one in arms:
        for other in arms:
            if one != other:
                made.road(
                    one + other, inner[one], inner[other], junction="J",
                    rear=f"{one} {at[one]}", front=f"{other} {at[other]}",
                )  # fmt: skip
                made.connect("J", one, one + other)
    return made
