"""``pldf script``: read a script, say what it does, prepare it for native FMUs."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

from vehicle_models.driver_script import (
    CONTROLS,
    UNITS,
    Event,
    packed_script,
    read_script,
    script_arrays,
)
from vehicle_models.lead_script import ACTIONS, LeadEvent, read_traffic, traffic_arrays
from vehicle_models.lead_script_kernel import APPEAR, SPEED, LeadScriptArrays
from vehicle_models.script_kernel import AT_POSITION, BRAKE, GAS, RESUME, ScriptArrays

from ..cosim.prepared import SUFFIX, write_prepared_script
from ..files.tables import read_header
from .shared.telling import tell

EXAMPLE: Final = "pldf script my_drive.csv --export my_drive.prepared"

_LISTED_MAX: Final = 40
_CONTROL_NAMES: Final = {code: name for name, code in CONTROLS.items()}
_ACTION_NAMES: Final = {code: name for name, code in ACTIONS.items()}
_UNIT_NAMES: Final = {code: name for name, code in UNITS.items()}


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        "file",
        metavar="FILE",
        help="driver or traffic script (CSV), or the number of a shipped driver script: 0, 1",
    )
    parser.add_argument(
        "--export",
        metavar=f"OUT{SUFFIX}",
        type=_prepared_file,
        help="write the script prepared for script_file of a native FMU",
    )


def run(options: argparse.Namespace) -> None:
    """Print the events; export them if asked to."""
    path = Path(options.file)
    if options.file.isdigit() and not path.exists():
        path = packed_script(int(options.file))
    lines: Iterator[str]
    columns: ScriptArrays | LeadScriptArrays
    if "action" in read_header(path):
        scene = read_traffic(path)
        tell(scene.notes)
        lines, columns = _scene(scene), traffic_arrays(scene)
    else:
        events = read_script(path)
        tell(events.notes)
        lines, columns = _summary(events), script_arrays(events)
    print(f"script       {path}")
    print("\n".join(lines))
    if options.export is not None:
        write_prepared_script(columns, options.export)
        print(f"written      {options.export}")


def _scene(events: Sequence[LeadEvent]) -> Iterator[str]:
    """What the car ahead does."""
    placed = sum(event.unit == AT_POSITION for event in events)
    yield f"events       {len(events)}: {len(events) - placed} at a time, {placed} at a position"
    yield f"{'begins at':>12} {'action':7} {'gap':>7} {'speed':>9}"
    in_order = sorted(events, key=lambda event: (event.unit, event.at))
    for event in in_order[:_LISTED_MAX]:
        gap = f"{event.gap_m:g} m" if event.action == APPEAR else ""
        speed = f"{event.speed_mps:g} m/s" if event.action in (APPEAR, SPEED) else ""
        begins = f"{event.at:g} {_UNIT_NAMES[event.unit]}"
        yield f"{begins:>12} {_ACTION_NAMES[event.action]:7} {gap:>7} {speed:>9}".rstrip()
    yield from _more(len(events))


def _summary(events: Sequence[Event]) -> Iterator[str]:
    placed = sum(event.unit == AT_POSITION for event in events)
    yield f"events       {len(events)}: {len(events) - placed} at a time, {placed} at a position"
    if not any(event.control == RESUME for event in events):
        yield "note         nothing switches the function on (control resume)"
    yield f"{'begins at':>12} {'control':10} {'value':>6} {'held':>8}"
    in_order = sorted(events, key=lambda event: (event.unit, event.at))
    for event in in_order[:_LISTED_MAX]:
        begins = f"{event.at:g} {_UNIT_NAMES[event.unit]}"
        value = f"{event.value:g}" if event.control in (GAS, BRAKE) else ""
        held = f"{event.duration_s:g} s"
        yield f"{begins:>12} {_CONTROL_NAMES[event.control]:10} {value:>6} {held:>8}"
    yield from _more(len(events))


def _more(events: int) -> Iterator[str]:
    if events > _LISTED_MAX:
        yield f"{'':12} and {events - _LISTED_MAX} more"


def _prepared_file(text: str) -> Path:
    path = Path(text)
    if path.suffix != SUFFIX:  # also keeps the script itself from being overwritten
        raise argparse.ArgumentTypeError(f"{text!r} must end in {SUFFIX}")
    return path
