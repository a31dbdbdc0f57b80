"""Room for texts on a map: beside a line, hiding neither it nor each other."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from ...kernel.arrays import FloatArray
from ..scene import Note

# Of the letters of a note, on paper.
_LETTER_IN: Final = 0.072
_HEIGHT_IN: Final = 0.15
_MARGIN_IN: Final = 0.06
_AWAY_IN: Final = (0.1, 0.22, 0.4)  # of a text from the line, the nearest first
_DIRECTIONS: Final = 8  # in which a text may stand


class Rectangle(NamedTuple):
    """A part of a map."""

    left: float
    right: float
    foot: float
    top: float

    def meets(self, other: Rectangle) -> bool:
        """Return whether the two have a part in common."""
        across = self.left < other.right and other.left < self.right
        return across and self.foot < other.top and other.foot < self.top


class Labels:
    """Texts set one after the other, each where nothing is yet.

    Attributes:
        notes: those that found room.
    """

    def __init__(self, x: FloatArray, y: FloatArray, per_in: float, within: Rectangle) -> None:
        """Begin with a map.

        Args:
            x: of the points that no text may hide.
            y: of the same.
            per_in: length on the map of an inch on paper.
            within: where texts may stand.
        """
        self.notes: list[Note] = []
        self._x, self._y, self._per_in, self._within = x, y, per_in, within
        self._taken: list[Rectangle] = []

    def add(self, x: float, y: float, text: str) -> bool:
        """Set ``text`` near a point; return whether there was room."""
        half_width = 0.5 * (_LETTER_IN * len(text) + _MARGIN_IN) * self._per_in
        half_height = 0.5 * (_HEIGHT_IN + _MARGIN_IN) * self._per_in
        for away_in in _AWAY_IN:
            for turn in range(_DIRECTIONS):
                # Up, down, then to the sides: as a reader looks for it.
                angle = np.pi * (0.5 + turn % 2 + turn // 2 * 2.0 / _DIRECTIONS)
                east, north = float(np.cos(angle)), float(np.sin(angle))
                middle_x = x + east * (half_width + away_in * self._per_in)
                middle_y = y + north * (half_height + away_in * self._per_in)
                box = Rectangle(
                    middle_x - half_width, middle_x + half_width,
                    middle_y - half_height, middle_y + half_height,
                )  # fmt: skip
                if self._is_free(box):
                    self._taken.append(box)
                    self.notes.append(Note(middle_x, middle_y, text, place="middle"))
                    return True
        return False

    def _is_free(self, box: Rectangle) -> bool:
        left, right, foot, top = self._within
        if box.left < left or box.right > right or box.foot < foot or box.top > top:
            return False
        if any(box.meets(other) for other in self._taken):
            return False
        beside = (self._x < box.left) | (self._x > box.right)
        return bool(np.all(beside | (self._y < box.foot) | (self._y > box.top)))
