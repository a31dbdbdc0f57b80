"""Room for texts on a map: beside a line, hiding neither it nor each other."""

from __future__ import annotations

from typing import Final

import numpy as np

from ...kernel.arrays import FloatArray
from ..scene import Note

# Of the letters of a note, on paper.
_LETTER_IN: Final = 0.072
_HEIGHT_IN: Final = 0.15
_MARGIN_IN: Final = 0.06
_AWAY_IN: Final = (0.1, 0.22, 0.4)  # of a text from the line, the nearest first
_DIRECTIONS: Final = 8  # in which a text may stand


class Labels:
    """Texts set one after the other, each where nothing is yet.

    Attributes:
        notes: those that found room.
    """

    def __init__(self, x: FloatArray, y: FloatArray, per_in: float) -> None:
        """Begin with a map.

        Args:
            x: of the points that no text may hide.
            y: of the same.
            per_in: length on the map of an inch on paper.
        """
        self.notes: list[Note] = []
        self._x, self._y, self._per_in = x, y, per_in
        self._taken: list[tuple[float, float, float, float]] = []

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
                box = (
                    middle_x - half_width, middle_x + half_width,
                    middle_y - half_height, middle_y + half_height,
                )  # fmt: skip
                if self._is_free(box):
                    self._taken.append(box)
                    self.notes.append(Note(middle_x, middle_y, text, place="middle"))
                    return True
        return False

    def keep_free(self, box: tuple[float, float, float, float]) -> None:
        """Let no text into the box from x to x and from y to y."""
        self._taken.append(box)

    def _is_free(self, box: tuple[float, float, float, float]) -> bool:
        left, right, foot, top = box
        if any(
            left < other[1] and other[0] < right and foot < other[3] and other[2] < top
            for other in self._taken
        ):
            return False
        across = (self._x > left) & (self._x < right) & (self._y > foot) & (self._y < top)
        return not np.any(across)
