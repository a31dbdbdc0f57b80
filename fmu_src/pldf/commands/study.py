"""``pldf study``: a study file's participants, or the six drives for one driver."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from ..analysis.published import PUBLISHED
from ..cosim.which_fmus import USUAL_FOLDER
from ..profiles.store import StoredProfile
from ..recordings.interventions import Rates
from ..study.phases import PHASES, Phase, Setting, choose_route
from ..study.run import Driven, mean_rates, run_study
from .coupled import (
    NATIVE_IF_GOOD,
    add_coupling,
    add_fmu,
    chosen_fmus,
    chosen_values,
    progress_bar,
    tell,
)
from .participants import add_running, run_file

EXAMPLE: Final = (
    "pldf study paper --jobs 2\n  pldf study --out out_careful --set wish.offset_mps=-2 --seed 7"
)

# Arguments that a study file takes the place of.
_OF_ONE_DRIVER: Final = {
    "route": "--route",
    "driver_id": "--driver-id",
    "seed": "--seed",
    "step": "--step",
    "settings": "--set",
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``pldf study``."""
    add_running(parser)
    parser.add_argument(
        "--out", type=Path, metavar="FOLDER",
        help="where everything is written (default: FILE's output; without FILE: out)",
    )  # fmt: skip
    add_coupling(parser)
    add_fmu(parser, f"{NATIVE_IF_GOOD}; with FILE none, but the same source in process, quickest")
    usual = {name: parser.get_default(name) for name in _OF_ONE_DRIVER}
    parser.set_defaults(refuse=parser.error, usual=usual)


def run(options: argparse.Namespace) -> None:
    """Drive a study file, or one driver with figures."""
    if options.scheduler and options.fmu:
        options.refuse("--fmu drives on this machine only, not with --scheduler")
    if options.file is not None:
        for name, value in options.usual.items():
            if getattr(options, name) != value:
                options.refuse(f"{_OF_ONE_DRIVER[name]} is for one driver; write it into FILE")
        if options.fmus != USUAL_FOLDER and not options.fmu:
            options.refuse("--fmus needs --fmu: FILE is driven in process, with the same results")
        run_file(options)
    elif options.scheduler or options.restart:
        options.refuse("--scheduler and --restart need a study FILE")
    else:
        options.out = options.out or Path("out")
        _run_one_driver(options)


def _run_one_driver(options: argparse.Namespace) -> None:
    """Drive all phases, draw them, print the table and where to look."""
    route, road = choose_route(options.route)
    phases = list(PHASES.values())
    with chosen_fmus(options) as fmus:
        setting = Setting(
            route, road, options.driver_id, options.seed, options.out / "profiles", options.step,
            chosen_values(fmus, options.settings),
        )  # fmt: skip
        with progress_bar(len(phases) * route.length_m) as bar:
            driven, profile = run_study(
                fmus, phases, setting, options.out,
                lambda phase, s_m: _show(bar, phases.index(phase) * route.length_m + s_m, phase),
            )  # fmt: skip
    tell(said for one in driven for said in one.drive.said)
    figures = _draw(driven, profile, options.out)
    Console().print(_table(driven))
    print(f"Look at {', '.join(str(figure) for figure in figures)}.")
    print(
        f"Numbers are in {options.out / 'rates.csv'}, recordings in {options.out / 'recordings'},"
    )
    print(f"profiles in {options.out / 'profiles'} and {options.out / 'profile_after'}.")


def _show(bar: Progress, driven_m: float, phase: Phase) -> None:
    bar.update(
        bar.task_ids[0], completed=driven_m / 1000.0, description=f"{phase.name} {phase.about}"
    )


def _draw(driven: Sequence[Driven], profile: StoredProfile | None, out: Path) -> list[Path]:
    from ..report import figures  # noqa: PLC0415 - slow to import
    from ..report.paper import save  # noqa: PLC0415

    by_name = {one.phase.name: one for one in driven}
    drawn = {
        "drives.png": figures.drives(
            {name: one.recording for name, one in by_name.items()},
            {name: _panel_title(one) for name, one in by_name.items()},
            _headline(driven),
        ),
        "rates.png": figures.rate_bars(
            {name: one.rates for name, one in by_name.items()},
            "Share of each drive with an intervention",
        ),
    }
    if profile is not None:
        drawn["profile.png"] = figures.development(
            profile,
            [one.phase.name for one in driven if one.phase.learn],
            {driven[0].phase.name: driven[0].recording},
            "What the function has learned after each drive",
        )
    for name, figure in drawn.items():
        save(figure, out / name)
    return [out / name for name in drawn]


def _headline(driven: Sequence[Driven]) -> str:
    base, learned = (100 * mean_rates(driven, group).combined for group in PUBLISHED)
    return (
        f"One driver intervenes in {base:.0f} % of the time with the base function, "
        f"in {learned:.0f} % after learning"
    )


def _panel_title(one: Driven) -> str:
    if not one.phase.intervenes:
        return one.phase.about
    pedal, set_speed, combined = (f"{100 * rate:.0f} %" for rate in one.rates)
    return f"{one.phase.about}: pedal {pedal}, set speed {set_speed}, either {combined} of the time"


def _table(driven: Sequence[Driven]) -> Table:
    table = Table(
        title="Pedal interventions and shares of the driving time in %",
        caption="paper: mean of 43 drivers over both drives with interventions",
    )
    for heading in ("Drive", "Profile", "Learns", "Time", "Uses"):
        table.add_column(heading, justify="right" if heading in ("Time", "Uses") else "left")
    for heading in ("Pedal", "Set speed", "Either"):
        table.add_column(heading, justify="right")
    for one in driven:
        minutes, seconds = divmod(round(one.time_s), 60)
        table.add_row(
            one.phase.name,
            "learned" if one.phase.apply_learned else "base",
            "yes" if one.phase.learn else "no",
            f"{minutes}:{seconds:02d}",
            str(one.interventions),
            *_percent(one.rates),
            end_section=one.phase.name == "A3" or one is driven[-1],
        )
    for group, published in PUBLISHED.items():
        mean = mean_rates(driven, group)
        table.add_row(f"{group} mean", "", "", "", "", *_percent(mean))
        table.add_row(f"{group} paper", "", "", "", "", *_percent(published))
    return table


def _percent(rates: Rates) -> list[str]:
    return [f"{100.0 * rate:.2f}" for rate in rates]
