"""A first mapping file for a recording, from its header, for a person to complete."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final, NamedTuple

from ..files.tables import Column, Format
from ..kernel.codes import MODE
from ..toml_file import shown
from .columns import LABORATORY
from .inputs import Input, open_input
from .mapping import map_bytes, ready_maps
from .matching import fits
from .units import header_of, unit_named, units_of

# What a column may be called, without unit, capitals, blanks and signs; the first fits best.
_NAMES: Final = {
    "time_s": (
        "time", "t", "timestamp", "simtime", "simulationtime", "elapsedtime", "elapsed", "zeit",
        "zeitstempel", "datetime", "utc", "utctime", "epoch", "clock", "stamp",
    ),
    "s_m": (
        "s", "position", "pos", "distance", "dist", "station", "chainage", "arclength",
        "odometer", "odo", "travelleddistance", "traveleddistance", "distancetravelled",
        "distancetraveled", "roads", "routes", "mileage", "weg", "wegstrecke", "strecke",
    ),
    "speed_mps": (
        "speed", "v", "velocity", "vx", "longitudinalspeed", "longspeed", "vlon", "vlong",
        "groundspeed", "geschwindigkeit", "tacho", "velocityx",
    ),
    "acceleration_mps2": (
        "acceleration", "accel", "acc", "a", "ax", "along", "longacc", "longaccel",
        "longitudinalacceleration", "accelerationx", "beschleunigung", "laengsbeschleunigung",
    ),
    "mode": (
        "mode", "state", "status", "accmode", "accstate", "accstatus", "pldfmode", "pldfstate",
        "systemmode", "systemstate", "functionmode", "functionstate", "functionstatus",
        "cruisestate", "ccstate", "modus", "zustand",
    ),
    "gas_pedal": (
        "gaspedal", "gas", "throttle", "accelerator", "acceleratorpedal", "accpedal",
        "gaspedalposition", "throttleposition", "throttlepedal", "fahrpedal", "gaspedalstellung",
    ),
    "brake_pedal": (
        "brakepedal", "brake", "braking", "brakepedalposition", "brakeposition", "bremse",
        "bremspedal", "bremspedalstellung",
    ),
    "set_speed_mps": (
        "setspeed", "accsetspeed", "cruisesetspeed", "cruisespeed", "vset", "setvelocity",
        "desiredspeed", "speedset", "sollgeschwindigkeit", "wunschgeschwindigkeit", "setzspeed",
    ),
    "set_speed_offset_mps": ("setspeedoffset", "speedoffset", "offset"),
    "profile_mps": ("profile", "profilespeed", "speedprofile", "learnedspeed"),
    "base_mps": ("base", "basespeed", "baseprofile"),
    "limit_mps": (
        "limit", "speedlimit", "legallimit", "vlimit", "limitspeed", "legalspeed", "maxspeed",
        "tempolimit", "hoechstgeschwindigkeit",
    ),
    "eligible": ("eligible", "freedriving", "freeflow"),
}  # fmt: skip
_OWNERS: Final = re.compile(r"^(ego|vehicle|veh|car|host|own|sim|subject|driver|pldf)+(?=.)")
_VALUES_MAX: Final = 12  # more than that many texts or numbers are no modes
_LINE: Final = 96


class Guess(NamedTuple):
    """A column of a file that may be one of ours; ``unit`` empty: it does not say which."""

    name: str
    unit: str
    rank: int


def suggest_map(path: str | os.PathLike[str]) -> str:
    """Return a mapping file for the recording ``path``, with ? where a person has to decide.

    Raises:
        ModelError: the file cannot be read.
    """
    file = open_input(Path(path))
    if ready := [name for name, known in ready_maps().items() if fits(file, known)]:
        said = f"# The ready map {ready[0]} fits {file.path.name}: --map {ready[0]} reads it.\n"
        return said + map_bytes(ready[0]).decode("utf-8")
    guesses = {column.name: _guess(column, file) for column in LABORATORY.columns}
    return "\n".join(
        [
            f"# Mapping file for recordings such as {file.path.name}.",
            "# Check every line, and replace each ? by what is right; then give it with --map, or",
            "# save it as map.toml in the folder of the study.",
            *_listed("# Columns of the file", [*dict.fromkeys(file.names)]),
            "",
            "[recording]",
            *(line for c in LABORATORY.columns for line in _column(c, guesses[c.name])),
            *_words(file, LABORATORY.columns, guesses),
            "",
        ]
    )


def _guess(column: Column, file: Input) -> Guess | None:
    """Return the column of ``file`` whose name fits best, and of those the one with a unit."""
    fitting = [guess for name in file.names if (guess := _fits(column, name, file))]
    return min(fitting, key=lambda guess: (guess.rank, not guess.unit), default=None)


def _fits(column: Column, name: str, file: Input) -> Guess | None:
    if name == column.name:
        return Guess(name, column.unit, -1)
    header = header_of(name)
    allowed = units_of(column.unit)
    stated = unit_named(file.units.get(name, ""))
    if stated and stated not in allowed:
        return None
    for plain in (_plain(header.name), _plain(name)):
        for short in (plain, _OWNERS.sub("", plain)):
            if short in _NAMES[column.name]:
                unit = stated or ("" if allowed else column.unit)
                return Guess(name, unit, _NAMES[column.name].index(short))
    return None


def _plain(name: str) -> str:
    spelt = name.lower().replace("ä", "ae").replace("ö", "oe").replace("ü", "ue")
    return re.sub(r"[^a-z0-9]", "", spelt)


def _column(column: Column, guess: Guess | None) -> Iterator[str]:
    if guess and guess.rank < 0:
        yield f"# {column.name}: the file has it, by this name and in {column.unit or 'our words'}"
    elif guess and not column.unit:
        yield f"{column.name} = {{ column = {shown(guess.name)} }}"
    elif guess:
        unit = guess.unit or "?"
        options = "" if guess.unit else f"  # one of {', '.join(units_of(column.unit))}"
        yield f'{column.name} = {{ column = {shown(guess.name)}, unit = "{unit}" }}{options}'
    elif column.needed:
        yield f'{column.name} = {{ column = "?"{_unit_to_fill(column)} }}  # needed'
    else:
        yield f'# {column.name} = {{ column = "?"{_unit_to_fill(column)} }}'


def _unit_to_fill(column: Column) -> str:
    return f', unit = "{column.unit}"' if column.unit else ""


def _words(
    file: Input, columns: Sequence[Column], guesses: dict[str, Guess | None]
) -> Iterator[str]:
    """Yield the tables of words: what stands for a mode, and for eligible."""
    for column in columns:
        guess = guesses[column.name]
        if column.unit or guess is None or (guess.rank < 0 and column.kind == "flag"):
            continue
        values = _values(file, guess.name)
        if column.kind == "word" and set(values) <= set(MODE.items):
            continue
        if len(values) > _VALUES_MAX:
            yield f"\n# [{column.name}]: {guess.name} has {len(values)} different values"
        else:
            allowed = "true or false" if column.kind == "flag" else ", ".join(MODE.items)
            yield f"\n[{column.name}]  # what stands in {guess.name}, and what it is: {allowed}"
            yield from (f'{shown(value)} = "?"' for value in values)


def _values(file: Input, name: str) -> list[str]:
    column = Column(name, "text", blank=True)
    table, _ = file.table(Format("recording", "sample", (column,)))
    return sorted(set(table.texts[name]))


def _listed(heading: str, names: Sequence[str]) -> list[str]:
    """Return the names as comments of limited width."""
    lines = [f"{heading}:"]
    for name in map(shown, names):
        if len(lines[-1]) + len(name) + 2 > _LINE:
            lines.append("#  ")
        lines[-1] += f" {name},"
    return [line.rstrip(",") for line in lines]
