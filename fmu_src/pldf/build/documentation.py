"""The page that an importer shows for an FMU, made from the table of signals."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from inspect import cleandoc
from string import Template
from typing import Final

from ..fmi.description import unit_of
from ..fmi.units import DISPLAY
from ..kernel.signals import Signal

_PAGE: Final = Template("""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>$name</title>
<style>
body { font: 15px/1.5 system-ui, sans-serif; max-width: 90em; margin: 2em auto; padding: 0 1em; }
p { max-width: 46em; }
div.wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; }
th, td { border-bottom: 1px solid #ccc; padding: .3em .6em; text-align: left; vertical-align: top; }
td.number { white-space: nowrap; }
td.range { min-width: 12em; max-width: 26em; }
td.text { min-width: 22em; }
code { font-size: 95%; }
</style>
</head>
<body>
<h1>$name</h1>
<p>$about</p>
$text
<h2>Inputs</h2>
<p>Connect every input that the simulator can deliver; one that is not connected keeps its start
value. Speeds are in m/s, positions in m along the route.</p>
$inputs
<h2>Outputs</h2>
<p>Valid as soon as the initialization has ended.</p>
$outputs
<h2>Parameters</h2>
<p>Set before the initialization ends, tunable ones also between steps; a value outside its range is
refused with a message.</p>
$parameters
<h2>Running it</h2>
$running
</body>
</html>
""")
TITLES: Final = ("Name", "Type", "Unit", "Start", "Range", "Description")
_STEPS: Final = "co-simulation, default step 10 ms, any step from 0.1 ms to 100 ms."
_LOGGING: Final = "Switch the importer's logging on to see the messages of the model."
IN_PYTHON: Final = f"""<p>FMI 2.0 {_STEPS} The FMU runs in
Python: the machine needs Python 3.11 or newer with NumPy on its path. On Linux the simulator itself
has to be a Python program; on Windows any importer with access to a Python installation will do.
{_LOGGING}</p>
<p>Licences: <a href="licenses/license.txt">this FMU</a>,
<a href="licenses/pythonfmu.txt">pythonfmu</a>.</p>"""


def as_machine_code(fmi: str, platforms: str, licenses: Sequence[str]) -> str:
    """Return how a native FMU runs; ``licenses`` names what else is linked into it."""
    others = "".join(f', <a href="licenses/{name}.txt">{name}</a>' for name in licenses)
    return f"""<p>FMI {fmi} {_STEPS} Machine code
for {platforms}: nothing else has to be installed. Roads and scripts of your own are prepared files.
{_LOGGING}</p>
<p>Licences: <a href="licenses/license.txt">this FMU</a>{others}.</p>"""


def document(name: str, about: str, text: str, signals: Sequence[Signal], running: str) -> str:
    """Return the page.

    Args:
        name: of the model.
        about: one sentence.
        text: plain paragraphs separated by blank lines.
        signals: the variables.
        running: HTML that says what the FMU needs.
    """
    paragraphs = [escape(part) for part in cleandoc(text).split("\n\n") if part]
    tables = {
        f"{causality}s": _table([s for s in signals if s.causality == causality])
        for causality in ("input", "output", "parameter")
    }
    return _PAGE.substitute(
        name=escape(name),
        about=escape(about),
        text="\n".join(f"<p>{part}</p>" for part in paragraphs),
        running=running,
        **tables,
    )


def _table(signals: Sequence[Signal]) -> str:
    if not signals:
        return "<p>None.</p>"
    head = "".join(f"<th>{title}</th>" for title in TITLES)
    rows = "\n".join(f"<tr>{_row(signal)}</tr>" for signal in signals)
    return f'<div class="wide"><table>\n<tr>{head}</tr>\n{rows}\n</table></div>'


def _row(signal: Signal) -> str:
    start = "" if signal.causality == "output" else _start(signal)
    kind = f"{signal.kind}, tunable" if signal.tunable else signal.kind
    cells = (
        ("number", kind),
        ("number", unit_of(signal)),
        ("number", start),
        ("range", _range(signal)),
        ("text", signal.description),
    )
    name = f"<td><code>{escape(signal.name)}</code></td>"
    return name + "".join(f'<td class="{of}">{escape(text)}</td>' for of, text in cells)


def _start(signal: Signal) -> str:
    if isinstance(signal.start, str):
        return f'"{signal.start}"'
    if signal.enumeration is not None:
        return signal.enumeration.items[int(signal.start)]
    if signal.kind == "Boolean":
        return "true" if signal.start else "false"
    return _with_display(signal, signal.start)


def _range(signal: Signal) -> str:
    if signal.enumeration is not None:
        items = enumerate(signal.enumeration.items)
        return ", ".join(f"{code}\N{NO-BREAK SPACE}{item}" for code, item in items)
    if signal.low is None and signal.high is None:
        return ""
    low, high = signal.range
    return f"{low:g} … {high:g}"


def _with_display(signal: Signal, value: float) -> str:
    if signal.unit not in DISPLAY or not value:
        return f"{value:.6g}"
    name, factor = DISPLAY[signal.unit]
    return f"{value:.6g} ({value * factor:.4g} {name})"
