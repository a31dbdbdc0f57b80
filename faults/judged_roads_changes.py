"""What happens to a road's file: elements, links, numbers, bytes and encodings that are wrong."""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from typing import Final
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from .byte_changes import DAMAGES

# Changes a map: its tree, by chance; returns where.
Change = Callable[[Element, random.Random], str]
_ENDS: Final = {"start": "end", "end": "start"}
_IDS: Final = ("id", "elementId", "incomingRoad", "connectingRoad", "junction")
_NUMBERS: Final = frozenset(
    ("s", "x", "y", "hdg", "length", "curvature", "curvStart", "curvEnd", "max", "sOffset",
     *(c + axis for axis in "UV" for c in "abcd"))
)  # fmt: skip
_WORDS: Final = (
    "nan", "inf", "-inf", "1e300", "-1e300", "1e9", "-1", "0", "", " ", "1,5", "12 m", "1_0",
    "0x1F", "9" * 40, "\u0663", "\u22121", "1e-300", "-0", "1e5",
)  # fmt: skip
_ENCODINGS: Final = (
    "utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "utf-32", "latin-1", "cp1252",
    "ascii", "gb2312", "gb18030", "shift_jis", "euc-jp", "big5", "koi8-r", "utf-7", "cp037",
)  # fmt: skip


def _parents(root: Element) -> list[tuple[Element, Element]]:
    return [(parent, child) for parent in root.iter() for child in parent]


def _drop(root: Element, chance: random.Random) -> str:
    parent, child = chance.choice(_parents(root))
    parent.remove(child)
    return f"{child.tag} of {parent.tag}"


def _double(root: Element, chance: random.Random) -> str:
    parent, child = chance.choice(_parents(root))
    parent.insert(list(parent).index(child) + chance.randrange(2), child)
    return f"{child.tag} of {parent.tag}"


def _reorder(root: Element, chance: random.Random) -> str:
    parent = chance.choice([element for element in root.iter() if len(element) > 1])
    children = list(parent)
    chance.shuffle(children)
    parent[:] = children
    return parent.tag


def _move(root: Element, chance: random.Random) -> str:
    parent, child = chance.choice(_parents(root))
    inside = set(child.iter())
    target = chance.choice([element for element in root.iter() if element not in inside])
    parent.remove(child)
    target.insert(chance.randrange(len(target) + 1), child)
    return f"{child.tag} of {parent.tag} to {target.tag}"


def _contact(root: Element, chance: random.Random) -> str:
    element = _one_with(root, chance, "contactPoint")
    if chance.random() < 0.2:
        element.attrib.pop("contactPoint", None)
    else:
        element.set("contactPoint", _ENDS.get(element.get("contactPoint", ""), "start"))
    return element.tag


def _one_with(root: Element, chance: random.Random, *names: str) -> Element:
    found = [e for e in root.iter() if any(name in e.attrib for name in names)]
    return chance.choice(found or [root])


def _id(root: Element, chance: random.Random) -> str:
    element = _one_with(root, chance, *_IDS)
    names = [name for name in _IDS if name in element.attrib] or ["id"]
    name = chance.choice(names)
    others = [e.attrib[n] for e in root.iter() for n in _IDS if n in e.attrib]
    element.set(name, chance.choice([*others, "", "-1", "nobody", " 1", "1,2", "\u00e4"]))
    return f"{element.tag}@{name}"


def _number_of(root: Element, chance: random.Random) -> tuple[Element, str]:
    found = [(e, name) for e in root.iter() for name in e.attrib if name in _NUMBERS]
    return chance.choice(found)


def _word(root: Element, chance: random.Random) -> str:
    element, name = _number_of(root, chance)
    element.set(name, chance.choice(_WORDS))
    return f"{element.tag}@{name} {element.get(name)!r}"


def _changed(element: Element, name: str, change: Callable[[float], float]) -> str:
    try:
        element.set(name, repr(change(float(element.get(name, "0")))))
    except ValueError:
        element.set(name, "0")
    return f"{element.tag}@{name}"


def _negative(root: Element, chance: random.Random) -> str:
    return _changed(*_number_of(root, chance), lambda value: -value)


def _scaled(root: Element, chance: random.Random) -> str:
    factor = chance.choice((0.5, 0.9, 1.001, 1.1, 2.0, 3.6, 10.0, 1000.0))
    return _changed(*_number_of(root, chance), lambda value: value * factor)


def _shifted(root: Element, chance: random.Random) -> str:
    by = chance.choice((-50.0, -1.0, -0.01, 0.01, 0.4, 1.0, 5.0, 100.0))
    return _changed(_one_with(root, chance, "s"), "s", lambda value: value + by)


def _rotated(root: Element, chance: random.Random) -> str:
    by = chance.choice((-3.14159, -1.5708, -0.2, 0.001, 0.05, 0.6, 1.5708, 6.283185307179586))
    return _changed(_one_with(root, chance, "hdg"), "hdg", lambda value: value + by)


def _lost(root: Element, chance: random.Random) -> str:
    element = chance.choice([e for e in root.iter() if e.attrib])
    name = chance.choice(list(element.attrib))
    del element.attrib[name]
    return f"{element.tag}@{name}"


def _unit(root: Element, chance: random.Random) -> str:
    element = chance.choice([e for e in root.iter("speed")] or [root])
    element.set("unit", chance.choice(("km/h", "mph", "m/s", "kmh", "kn", "", "KM/H", "m/h")))
    return f"speed@unit {element.get('unit')!r}"


TREE_CHANGES: Final[dict[str, Change]] = {
    "drop": _drop, "double": _double, "reorder": _reorder, "move": _move, "contact": _contact,
    "id": _id, "word": _word, "negative": _negative, "scaled": _scaled, "shifted": _shifted,
    "rotated": _rotated, "lost": _lost, "unit": _unit,
}  # fmt: skip
BYTE_CHANGES: Final = (*DAMAGES, "encoding")


def changed(text: str, name: str, chance: random.Random) -> tuple[str, bytes, str | None]:
    """Return what was done to a map, its file, and what anybody reads in that; None: nobody knows.

    All that counts in these maps is ASCII.
    """
    if name in TREE_CHANGES:
        root = ElementTree.fromstring(text.encode("utf-8"))
        where = TREE_CHANGES[name](root, chance)
        data = ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)
        return where, data, data.decode("utf-8")
    if name == "encoding":
        encoding = chance.choice(_ENCODINGS)
        said = chance.choice((encoding, encoding, encoding.upper(), "UTF-8", ""))
        text = text.replace('name="drawn"', 'name="Stra\u00dfe"')
        declared = f' encoding="{said}"' if said else ""
        written = re.sub(r' encoding="[^"]*"', declared, text, count=1)
        return f"{encoding} said {said!r}", written.encode(encoding, errors="replace"), text
    data = DAMAGES[name](text.encode("utf-8"), chance)
    counts = data[max(data.find(b"<OpenDRIVE"), 0) :]  # what stands before it is passed over
    return name, data, None if b"\0" in counts else counts.decode("latin-1")
