"""The figures of a study: those that report and paper show."""

from __future__ import annotations

from ...study.phases import PHASES
from ..contents import Contents, DriverShown
from ..scene import Scene
from .driving import compared, drives
from .learning import development, long_run, steps
from .plan import plan
from .quality import quality
from .road import route
from .shares import rates


def study_figures(contents: Contents) -> dict[str, Scene]:
    """Return the figures that the contents allows, by name, in the order of the report."""
    figures = {"rates": rates(contents.analysis)}
    if contents.driver:
        figures |= _of_driver(contents.driver)
    if contents.long_run:
        figures["long_run"] = long_run(contents.long_run)
    if from_above := plan(contents.route):
        figures["plan"] = from_above
    figures["base"] = route(contents.route)
    if contents.checks.drives:
        figures["quality"] = quality(contents.checks)
    return figures


def _of_driver(driver: DriverShown) -> dict[str, Scene]:
    acting = {name: driver.recordings[name] for name in driver.acting}
    titles = {name: PHASES[name].about if name in PHASES else "" for name in acting}
    title = f"The drives of {driver.participant}"
    figures = {"compared": compared(acting, title), "drives": drives(acting, titles, title)}
    if driver.profile.iterations:
        names = [iteration.note for iteration in driver.profile.iterations]
        title = f"What the function learned from {driver.participant}"
        figures["development"] = development(driver.profile, names, acting, title, True)
    if driver.steps:
        figures["steps"] = steps(driver.steps)
    return figures
