"""The report of a study: one HTML file that needs nothing else, no network above all.

The same study gives the same bytes. What the page may load is forbidden by its content policy.
"""

from __future__ import annotations

import json
import platform
from collections.abc import Mapping
from html import escape
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import Any, Final

from plotly.offline import get_plotlyjs  # type: ignore[import-untyped]

from vehicle_models.driver_state import DriverState
from vehicle_models.vehicle_state import VehicleState

from .. import __version__
from ..analysis.published import DRIVERS, published_means
from ..files.disk import replace_file
from ..kernel.signals import signals_of
from ..kernel.state import PldfState
from ..roads import fingerprint
from .figures.study import study_figures
from .material import VERSIONS, Material
from .page_tables import against_paper, percent, scores_table
from .screen import html_of

_POLICY: Final = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:"
)
_LIBRARIES: Final = ("numpy", "scipy", "plotly")
_RECORDS: Final = {"pldf": PldfState, "vehicle": VehicleState}


def write_report(path: Path, material: Material) -> None:
    """Write the report to ``path``."""
    replace_file(path, report_of(material).encode())


def report_of(material: Material) -> str:
    """Return the report as HTML."""
    parts = _sections(material)
    links = "".join(f'<a href="#{key}">{escape(title)}</a>' for key, title, _ in parts)
    body = "".join(
        f'<section id="{key}"><h2>{escape(title)}</h2>{content}</section>\n'
        for key, title, content in parts
    )
    here = files(__package__)
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(material.title)}</title>\n"
        f"<style>\n{(here / 'report.css').read_text(encoding='utf-8')}</style>\n"
        f"<script>{get_plotlyjs()}</script>\n"
        f"<script>\n{(here / 'report.js').read_text(encoding='utf-8')}</script>\n</head>\n<body>\n"
        f"{_head(material)}<nav>{links}</nav>\n{body}</body>\n</html>\n"
    )


def _head(material: Material) -> str:
    analysis = material.analysis
    kind = "simulated" if material.simulated else "recorded"
    people = "drivers" if material.simulated else "participants"
    combined, (paper_a, paper_b) = analysis.comparisons["combined"], published_means("combined")
    return (
        f"<h1>{escape(material.title)}</h1>\n"
        f'<p class="kind">{len(analysis.participants)} {kind} {people}, '
        f"{len(analysis.drives)} drives on {escape(material.route.route.name)}</p>\n"
        f'<p class="lead">Drivers intervened by pedals or set speed in '
        f"<b>{percent(combined.mean_first)}</b> of the driving time with the base function (A) "
        f"and in <b>{percent(combined.mean_second)}</b> with the function that had learned from "
        f"them (B). The paper reports {percent(paper_a)} and {percent(paper_b)} for {DRIVERS} "
        "people.</p>\n"
    )


def _sections(material: Material) -> list[tuple[str, str, str]]:
    """Return (anchor, title, HTML) of each part that the material allows."""
    drawn = {name: html_of(scene, name) for name, scene in study_figures(material).items()}
    parts = [("table", "Against the paper", against_paper(material.analysis))]
    if material.analysis.questionnaire:
        parts.append(("scores", "Questionnaires", scores_table(material.analysis)))
    for name, title in _TITLES.items():
        if name in drawn:
            who = material.driver.participant if material.driver else ""
            caption = escape(_CAPTIONS[name].format(driver=who, **_facts(material)))
            content = f"<figure>{drawn[name]}<figcaption>{caption}</figcaption></figure>"
            parts.append((name, title.format(driver=who), content))
    if material.driver is None:
        note = "There are no recordings in this folder, so no driver is shown in detail."
        parts.append(("driver", "One driver", f'<p class="note">{note}</p>'))
    parts.append(("reproduce", "Reproduce", _reproduction(material)))
    return parts


_TITLES: Final = {
    "rates": "Rates over the drives",
    "compared": "The drives of {driver}",
    "drives": "Drive by drive",
    "development": "What the function learned from {driver}",
    "steps": "One intervention, step by step",
    "long_run": "Drive after drive",
    "base": "The road and its base profile",
}
_CAPTIONS: Final = {
    "rates": (
        "Share of the driving time with interventions in the drives in which drivers intervene. "
        "Each grey line is one participant; the band is the 95 % confidence interval of the mean "
        "(t distribution). A: base function; B: after learning from the drives before. "
        "Click on an entry of the legend to hide or show it."
    ),
    "compared": (
        "Speed driven, where {driver} intervened, and the pedals. Drag along the "
        "distance to zoom, double click to go back, click on the legend to hide or show a drive. "
        "Drives in which the driver does not intervene are left out."
    ),
    "development": (
        "The speed profile that the function followed after each drive it learned from. The speeds "
        "driven are in the legend, to be switched on."
    ),
    "steps": (
        "Intervention {number} of {driver} in {drive}, computed by the functions that the driving "
        "function itself uses. 1: the recorded piece. 2: stretched to the left (eq. 1, factor "
        "{alpha:.2f} after its limits), since a driver acts later than the wish arises. 3: lifted "
        "so that it joins the recorded speed (eq. 2). 4: mean with the profile of that drive "
        "(eq. 3), within the bounds. 5: smoothed and faded into the unchanged profile, which the "
        "next drive follows. The buttons add one step after the other."
    ),
    "drives": (
        "The same drives, each with the profile that the function followed; interventions are "
        "shaded, and the strip below marks where the set speed had been changed."
    ),
    "long_run": (
        "Simulated drivers who intervene and are learned from in every drive, for several stretch "
        "factors. The error is what remains between the profile and the drivers' hidden wish, "
        "which no study with people can measure."
    ),
    "base": (
        "Legal limits, the speed that the curves allow, and the base profile planned from both "
        "with bounded acceleration and jerk."
    ),
}


def _facts(material: Material) -> dict[str, Any]:
    if material.driver is None or material.driver.steps is None:
        return {}
    steps = material.driver.steps
    return {"number": steps.number, "alpha": steps.alpha, "drive": material.driver.explained}


def _reproduction(material: Material) -> str:
    libraries = ", ".join(f"{name} {version(name)}" for name in _LIBRARIES)
    route = material.route.route
    text = (
        f"<p>Analysed with adaptive-pldf {__version__}, Python {platform.python_version()}, "
        f"{libraries}. Road: {escape(route.name)}, {route.length_m:.0f} m, fingerprint "
        f"<code>{fingerprint(route)}</code>.</p>"
    )
    for name, content in material.texts.items():
        text += f"<h3>{escape(name)}</h3><pre>{escape(_without_parameters(name, content))}</pre>"
    for part, record in _RECORDS.items():
        values = material.parameters.get(part)
        if values is not None or part == "pldf":
            text += _parameters(part, record, values)
    return text + _people(material.participants)


def _without_parameters(name: str, content: str) -> str:
    """Return what is printed of a file; parameters follow as tables."""
    if name != VERSIONS:
        return content
    return json.dumps({k: v for k, v in json.loads(content).items() if k != "parameters"}, indent=2)


def _parameters(part: str, record: type[Any], values: Mapping[str, float] | None) -> str:
    of = {"pldf": "driving function", "vehicle": "vehicle"}[part]
    title = f"Parameters of the {of}{'' if values else ' (defaults, for the figures)'}"
    rows = "".join(
        f"<tr><th>{escape(s.name)}</th><td>{(values or {}).get(s.name, s.start):.6g}</td>"
        f'<td class="left">{escape(s.unit)}</td><td class="left">{escape(s.description)}</td></tr>'
        for s in signals_of(record)
        if s.causality == "parameter"
    )
    return f"<details><summary>{title}</summary><table>{rows}</table></details>"


def _people(ranges: Mapping[str, tuple[float, float, float]]) -> str:
    if not ranges:
        return ""
    signals = {s.name: s for s in signals_of(DriverState)}
    rows = "".join(
        f"<tr><th>{escape(name)}</th>{''.join(f'<td>{value:.4g}</td>' for value in values)}"
        f'<td class="left">{escape(signals[name].unit)}</td>'
        f'<td class="left">{escape(signals[name].description)}</td></tr>'
        for name, values in ranges.items()
        if name in signals
    )
    heading = "<tr><th></th><th>smallest</th><th>median</th><th>largest</th><th></th><th></th></tr>"
    return (
        "<details><summary>Parameters of the simulated drivers (each one's are in "
        f"participants.csv)</summary><table>{heading}{rows}</table></details>"
    )
