"""A judge's own reading of the line of an OpenDRIVE road: numpy and scipy, by the heading."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_simpson

from .sheets import Unclear

Array = NDArray[np.float64]

STEP_M: Final = 0.25
# By so much the lengths of a road and of its geometries may differ.
_ROUNDED_M: Final = 0.5
_BACK_RAD: Final = np.radians(175.0)
_NUMBER: Final = re.compile(r"\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*", re.ASCII)
_SHAPES: Final = ("line", "arc", "spiral", "poly3", "paramPoly3")


@dataclass(frozen=True)
class Line:
    """The line of a road along its drawing direction, every ``STEP_M`` and at both ends.

    Attributes:
        s_m: float64 [n].
        turned_rad: change of heading since the start, with the corners between geometries.
        x_m, y_m: where it is.
        heading_rad: at the start.
    """

    s_m: Array
    turned_rad: Array
    x_m: Array
    y_m: Array
    heading_rad: float


def number(element: Element, name: str, default: float | None = None) -> float:
    """Return a finite number that anybody would read."""
    text = element.get(name)
    if text is None and default is not None:
        return default
    if text is None or not _NUMBER.fullmatch(text) or not np.isfinite(float(text)):
        raise Unclear(f"{element.tag}@{name} {text!r}")
    return float(text)


def only(elements: Sequence[Element]) -> Element | None:
    """Return the only one; what stands there twice, letter by letter, counts once."""
    if any(_bytes(each) != _bytes(elements[0]) for each in elements[1:]):
        raise Unclear(f"two {elements[0].tag}")
    return elements[0] if elements else None


def once(elements: Sequence[Element], name: str, default: float | None = None) -> list[Element]:
    """Return those in the order of their places; two different ones at one place are unclear."""
    by_place: dict[float, list[Element]] = {}
    for each in elements:
        by_place.setdefault(number(each, name, default), []).append(each)
    return [one for s in sorted(by_place) if (one := only(by_place[s])) is not None]


def _bytes(element: Element) -> bytes:
    return ElementTree.tostring(element).strip()


def line_of(road: Element, length_m: float) -> Line:
    """Return the line of a road of that length, with the corners between its geometries.

    Raises:
        Unclear: it has gaps, or none.
    """
    plan = only(road.findall("planView"))
    if plan is None:
        raise Unclear("no planView")
    geometries = once(plan.findall("geometry"), "s")
    parts, turned, start = [], 0.0, 0.0
    before: float | None = None
    for at, geometry in enumerate(geometries):
        s, length = number(geometry, "s"), number(geometry, "length")
        behind = geometries[at + 1 :]
        stop = number(behind[0], "s") if behind else length_m
        if abs(s - start) > _ROUNDED_M or abs(s + length - stop) > _ROUNDED_M or length < 0.0:
            raise Unclear("gap in planView")
        s, start = (0.0 if at == 0 else s), stop
        if stop - s <= 0.0:
            continue
        ds = np.linspace(0.0, stop - s, max(int((stop - s) / STEP_M), 2) + 1)
        heading, dx, dy = _shape(geometry, ds, length)
        if before is not None:
            corner = wrapped(float(heading[0]) - before)
            if abs(corner) > _BACK_RAD:
                raise Unclear("it turns back, to the left or to the right")
            turned += corner
        x, y = number(geometry, "x"), number(geometry, "y")
        parts.append(np.stack((s + ds, turned + heading - heading[0], x + dx, y + dy)))
        turned += float(heading[-1] - heading[0])
        before = float(heading[-1])
        if len(parts) == 1:
            first = float(heading[0])
    if not parts:
        raise Unclear("no line")
    s_m, turned_rad, x_m, y_m = np.concatenate(parts, axis=1)
    return Line(s_m, turned_rad, x_m, y_m, first)


def wrapped(angle_rad: float) -> float:
    """Return the angle between -pi and pi."""
    return float((angle_rad + np.pi) % (2.0 * np.pi) - np.pi)


def _shape(geometry: Element, ds: Array, length_m: float) -> tuple[Array, Array, Array]:
    """Return heading (unwrapped), and x and y from the start, at ``ds``."""
    shape, heading = (
        only([each for each in geometry if each.tag in _SHAPES]),
        number(geometry, "hdg"),
    )
    if shape is None:
        raise Unclear("no shape")
    if shape.tag in ("poly3", "paramPoly3"):
        return _polynomial(shape, heading, ds, length_m)
    first, last = {
        "line": lambda: (0.0, 0.0),
        "arc": lambda: (number(shape, "curvature"),) * 2,
        "spiral": lambda: (number(shape, "curvStart"), number(shape, "curvEnd")),
    }[shape.tag]()
    if length_m <= 0.0:
        raise Unclear("geometry without length")
    angle = heading + first * ds + 0.5 * (last - first) / length_m * ds * ds
    if np.max(np.abs((first, last))) > 1.0:
        raise Unclear("a curve tighter than 1 m")
    return angle, *_integrated(angle, ds)


def _integrated(angle: Array, ds: Array) -> tuple[Array, Array]:
    x, y = (cumulative_simpson(f(angle), x=ds, initial=0.0) for f in (np.cos, np.sin))
    return x, y


def _polynomial(
    shape: Element, heading: float, ds: Array, length_m: float
) -> tuple[Array, Array, Array]:
    if shape.tag == "poly3":
        u = np.array([0.0, 1.0, 0.0, 0.0])
        v = np.array([number(shape, name) for name in "abcd"])
        end = length_m
    else:
        u, v = (np.array([number(shape, c + axis) for c in "abcd"]) for axis in "UV")
        ends = {"arcLength": length_m, "normalized": 1.0}
        if shape.get("pRange", "normalized") not in ends:
            raise Unclear("pRange")
        end = ends[shape.get("pRange", "normalized")]
    # The parameter by arc length: many points, and their distances.
    p = np.linspace(0.0, end, 20 * len(ds))
    pu, pv = (np.polyval(c[::-1], p) for c in (u, v))
    arc = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(pu), np.diff(pv)))))
    if shape.tag == "paramPoly3" and abs(arc[-1] - length_m) > 0.05 * length_m:
        raise Unclear(f"a curve of {arc[-1]:.6g} m on {length_m:.6g} m")
    at = np.interp(ds * (1.0 if shape.tag == "poly3" else arc[-1] / length_m), arc, p)
    du, dv = (np.polyval(np.polyder(c[::-1]), at) for c in (u, v))
    if np.min(np.hypot(du, dv)) < 1e-9:
        raise Unclear("a curve that stands still")
    angle = heading + np.unwrap(np.arctan2(dv, du))
    x, y = (np.polyval(c[::-1], at) for c in (u, v))
    cos, sin = np.cos(heading), np.sin(heading)
    return angle, cos * x - sin * y, sin * x + cos * y
