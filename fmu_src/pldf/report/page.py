"""The report of a study: one HTML file that needs nothing else, no network above all.

The same study gives the same bytes. What the page may load is forbidden by its content policy.
"""

from __future__ import annotations

import json
import platform
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup, escape
from plotly.offline import get_plotlyjs  # type: ignore[import-untyped]

from vehicle_models.driver_state import DriverState
from vehicle_models.vehicle_state import VehicleState

from .. import __version__
from ..analysis import published
from ..analysis.statistics import EXACT_PAIRS_MAX
from ..files.disk import replace_file
from ..findings import Finding
from ..kernel.signals import Signal, signals_of
from ..kernel.state import PldfState
from ..roads import fingerprint
from ..study.own_files import VERSIONS
from .contents import Contents
from .figures.shares import RATE_TITLES
from .figures.study import study_figures
from .screen import html_of

_LIBRARIES: Final = ("numpy", "scipy", "plotly")
_RECORDS: Final = {"pldf": PldfState, "vehicle": VehicleState}
_PARTS: Final = {"pldf": "driving function", "vehicle": "vehicle"}
_SCALE_TITLES: Final = {
    "usefulness": "Usefulness (-2 … +2)",
    "satisfying": "Satisfying (-2 … +2)",
    "speed_profile": "Speed profile, six items (1 … 5)",
}
# Title and caption by figure.
_FIGURES: Final = {
    "rates": (
        "Rates over the drives",
        "Share of the driving time with interventions in the drives in which drivers intervene. "
        "Each grey line is one participant; the band is the 95 % confidence interval of the mean "
        "(t distribution). A: base function; B: after learning from the drives before. "
        "Click on an entry of the legend to hide or show it.",
    ),
    "compared": (
        "The drives of {driver}",
        "Speed driven, where {driver} intervened, and the pedals. Drag along the distance to zoom, "
        "double click to go back, click on the legend to hide or show a drive. Drives in which the "
        "driver does not intervene are left out.",
    ),
    "drives": (
        "Drive by drive",
        "The same drives, each with the profile that the function followed; interventions are "
        "shaded, and the strip below marks where the set speed had been changed.",
    ),
    "development": (
        "What the function learned from {driver}",
        "The speed profile that the function followed after each drive it learned from. The speeds "
        "driven are in the legend, to be switched on.",
    ),
    "steps": (
        "One intervention, step by step",
        "Intervention {number} of {driver} in {drive}, computed by the functions that the driving "
        "function itself uses. 1: the recorded piece. 2: stretched to the left (eq. 1, factor "
        "{alpha:.2f} after its limits), since a driver acts later than the wish arises. 3: lifted "
        "so that it joins the recorded speed (eq. 2). 4: mean with the profile of that drive "
        "(eq. 3), within the bounds. 5: smoothed and faded into the unchanged profile, which the "
        "next drive follows. The buttons add one step after the other.",
    ),
    "long_run": (
        "Drive after drive",
        "Simulated drivers who intervene and are learned from in every drive, with several "
        "variants of the function. The errors are what remains between the profile and the "
        "drivers' hidden wish, the one that lasts and that of the drive, which no study with "
        "people can measure.",
    ),
    "plan": (
        "The road from above",
        "Where the road runs, to scale, with its legal limits in colours, the faster the wider. "
        "Shaded: curves that bind, with their smallest radius and the speed that they allow. Drag "
        "a rectangle to zoom, double click to go back.",
    ),
    "base": (
        "The road and its base profile",
        "Legal limits, the speed that the curves allow, and the base profile planned from both "
        "with bounded acceleration and jerk.",
    ),
    "quality": (
        "Data quality",
        "Each cell is a recording; hovering says its rate, how much of the road it covers and what "
        "drop-outs of the logger cost. One with an error cannot be used; one with a warning can, "
        "but a number may not mean what one takes it for: see below.",
    ),
}
# What follows a figure: its template.
_BELOW: Final = {"quality": "quality.html"}


@dataclass(frozen=True)
class Section:
    """A part of the page: a figure with its caption, or the template of its anchor's name.

    ``below``: a template for what follows the figure.
    """

    anchor: str
    title: str
    figure: Markup | None = None
    caption: str = ""
    below: str = ""


@dataclass(frozen=True)
class ParameterTable:
    """Parameters with one value or several, as texts."""

    title: str
    headings: tuple[str, ...]
    rows: Sequence[tuple[Signal, tuple[str, ...]]]


def write_report(path: Path, contents: Contents) -> None:
    """Write the report to ``path``."""
    replace_file(path, report_of(contents).encode())


def report_of(contents: Contents) -> str:
    """Return the report as HTML."""
    libraries = ", ".join(f"{name} {version(name)}" for name in _LIBRARIES)
    versions = f"adaptive-pldf {__version__}, Python {platform.python_version()}, {libraries}"
    return (
        _templates()
        .get_template("report.html")
        .render(
            contents=contents,
            analysis=contents.analysis,
            published=published,
            sections=_sections(contents),
            plotly_script=Markup(get_plotlyjs()),
            rate_titles=RATE_TITLES,
            scale_titles=_SCALE_TITLES,
            exact_pairs_max=EXACT_PAIRS_MAX,
            versions=versions,
            fingerprint=fingerprint(contents.route.route),
            texts={name: _without_parameters(name, text) for name, text in contents.texts.items()},
            parameter_tables=list(_parameter_tables(contents)),
        )
    )


def _templates() -> Environment:
    templates = Environment(
        loader=PackageLoader(__package__), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True,
    )  # fmt: skip
    templates.filters.update(
        minus=_minus,
        percent=_percent,
        change=_change,
        listed=_listed,
        file_name=_name,
        in_folder=_in_folder,
    )
    return templates


def _minus(text: str) -> Markup:
    """Return ``text`` with the sign for minus in place of hyphens."""
    return Markup(str(escape(text)).replace("-", "&minus;"))


def _name(path: str) -> str:
    return Path(path).name


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _in_folder(finding: Finding) -> str:
    """Return what is told about a file of the study, wherever the study lies."""
    return str(finding._replace(file=Path(finding.file).name))


def _percent(share: float) -> str:
    return f"{100 * share:.1f} %"


def _change(before: float, after: float) -> Markup:
    if before <= 0.0:
        return Markup("&ndash;")
    return _minus(f"{100 * (after - before) / before:+.0f} %")


def _sections(contents: Contents) -> list[Section]:
    """Return the parts that the contents allow."""
    sections = [Section("table", "Against the paper")]
    if contents.analysis.questionnaire:
        sections.append(Section("scores", "Questionnaires"))
    words = _words(contents)
    for name, scene in study_figures(contents).items():
        title, caption = (text.format(**words) for text in _FIGURES[name])
        caption += _not_known(contents, name) + _no_plan(contents, name)
        below = _BELOW.get(name, "")
        sections.append(Section(name, title, Markup(html_of(scene, name)), caption, below))
    if contents.driver is None:
        sections.append(Section("driver", "One driver"))
    else:
        title = f"What became of each intervention of {contents.driver.participant}"
        sections.append(Section("outcomes", title))
    if contents.analysis.exclusions or contents.analysis.notes:
        sections.append(Section("left_out", "What was left out, and how the data were read"))
    return [*sections, Section("reproduce", "Reproduce")]


def _not_known(contents: Contents, figure: str) -> str:
    """Return what a figure leaves out and why, to stand behind its caption."""
    driver = contents.driver
    if driver is None or not driver.not_known or figure not in ("drives", "development"):
        return ""
    return (
        f" Not known, so left out: the profile followed in {_listed(driver.not_known)}. It was not "
        "recorded (profile_mps), and there is no learned profile to take it from (--profiles)."
    )


def _no_plan(contents: Contents, figure: str) -> str:
    """Return why there is no plan view, to stand behind the caption of the road's other figure."""
    if figure != "base" or contents.route.route.has_line:
        return ""
    return " The road's file has no x and y, so there is no plan view."


def _words(contents: Contents) -> dict[str, Any]:
    """Return what titles and captions of the figures name."""
    driver = contents.driver
    if driver is None:
        return {}
    words = {"driver": driver.participant, "drive": driver.explained}
    steps = driver.steps
    return words if steps is None else {**words, "number": steps.number, "alpha": steps.alpha}


def _without_parameters(name: str, text: str) -> str:
    """Return what is printed of a file; parameters follow as tables."""
    if name != VERSIONS:
        return text
    return json.dumps({k: v for k, v in json.loads(text).items() if k != "parameters"}, indent=2)


def _parameter_tables(contents: Contents) -> Iterator[ParameterTable]:
    for part, record in _RECORDS.items():
        values = contents.parameters.get(part)
        if values is not None or part == "pldf":
            yield _table_of(part, record, values or {})
    if contents.participants:
        signals = {signal.name: signal for signal in signals_of(DriverState)}
        rows = [
            (signals[name], tuple(f"{value:.4g}" for value in values))
            for name, values in contents.participants.items()
            if name in signals
        ]
        title = "Parameters of the simulated drivers (each one's are in participants.csv)"
        yield ParameterTable(title, ("smallest", "median", "largest"), rows)


def _table_of(part: str, record: type[Any], values: Mapping[str, float]) -> ParameterTable:
    rows = [
        (signal, (_written(signal, values),))
        for signal in signals_of(record)
        if signal.causality == "parameter"
    ]
    defaults = "" if values else " (defaults, for the figures)"
    return ParameterTable(f"Parameters of the {_PARTS[part]}{defaults}", (), rows)


def _written(signal: Signal, values: Mapping[str, float]) -> str:
    """Return the value that the run had; a release that knew the parameter not yet wrote none."""
    if signal.name in values or not values:
        return f"{values.get(signal.name, signal.start):.6g}"
    return f"not known to the run ({signal.start:.6g} here)"
