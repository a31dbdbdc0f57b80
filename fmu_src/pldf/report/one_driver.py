"""What a study of one driver shows: its drives, rates and profiles as figures, and a table.

All of it is read from the folder of the results.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from rich.table import Table

from ..analysis.drives_table import read_drives
from ..analysis.published import DRIVERS, PUBLISHED
from ..durations import minutes
from ..profiles.store import ProfileStore, StoredProfile
from ..recordings.interventions import Rates
from ..recordings.recording import Recording, read_recording
from ..roads import fingerprint
from ..study.drive_row import DriveRow
from ..study.own_files import DRIVES
from ..study.phases import Phase
from ..study.study_file import Study
from . import figures
from .paper import save


def draw_one_driver(study: Study, out: Path) -> list[Path]:
    """Draw the only participant of ``study``, driven into ``out``; return the pictures' paths.

    Raises:
        ModelError: a file of the results cannot be used, or a picture cannot be written.
    """
    rows = read_drives(out / DRIVES)
    phases = {phase.name: phase for phase in study.settings.phases}
    recordings = {row.phase: _recording(out, row) for row in rows}
    drawn = {
        "drives.png": figures.drives(
            recordings,
            {row.phase: _panel_title(row, phases[row.phase]) for row in rows},
            _headline(rows, phases.values()),
        ),
        "rates.png": figures.rate_bars(
            {row.phase: row.rates for row in rows},
            "Share of each drive with an intervention",
        ),
    }
    profile = _profile(study, out)
    if profile is not None:
        drawn["profile.png"] = figures.development(
            profile,
            [row.phase for row in rows if phases[row.phase].learn],
            {rows[0].phase: recordings[rows[0].phase]},
            "What the function has learned after each drive",
        )
    for name, figure in drawn.items():
        save(out / name, figure)
    return [out / name for name in drawn]


def table_of(study: Study, out: Path) -> Table:
    """Return the drives of the only participant of ``study``, with the paper's means below."""
    rows = read_drives(out / DRIVES)
    phases = {phase.name: phase for phase in study.settings.phases}
    table = Table(
        title="Pedal interventions and shares of the driving time in %",
        caption=f"paper: mean of {DRIVERS} drivers over both drives with interventions",
    )
    for heading in ("Drive", "Profile", "Learns", "Time", "Uses"):
        table.add_column(heading, justify="right" if heading in ("Time", "Uses") else "left")
    for heading in ("Pedal", "Set speed", "Either"):
        table.add_column(heading, justify="right")
    for row, following in zip(rows, [*rows[1:], None], strict=True):
        phase = phases[row.phase]
        table.add_row(
            phase.name,
            "learned" if phase.apply_learned else "base",
            "yes" if phase.learn else "no",
            minutes(row.duration_s),
            f"{row.interventions:.0f}",
            *_percent(row.rates),
            end_section=following is None or following.system != row.system,
        )
    for system, published in PUBLISHED.items():
        acting = _acting(rows, phases.values(), system)
        if acting:
            table.add_row(f"{system} mean", "", "", "", "", *_percent(_mean(acting)))
            table.add_row(f"{system} paper", "", "", "", "", *_percent(published))
    return table


def _recording(out: Path, row: DriveRow) -> Recording:
    return read_recording(out / "recordings" / f"{row.participant}_{row.phase}.csv")


def _profile(study: Study, out: Path) -> StoredProfile | None:
    route = study.settings.route
    store = ProfileStore(out / "profiles")
    return store.load(study.participants[0].number, fingerprint(route), route.nodes)


def _acting(rows: Sequence[DriveRow], phases: Iterable[Phase], system: str) -> list[DriveRow]:
    """Return the drives with one system in which the driver intervenes."""
    names = [phase.name for phase in phases if phase.intervenes]
    return [row for row in rows if row.system == system and row.phase in names]


def _mean(rows: Sequence[DriveRow]) -> Rates:
    columns = zip(*(row.rates for row in rows), strict=True)
    return Rates(*(float(np.mean(column)) for column in columns))


def _headline(rows: Sequence[DriveRow], phases: Iterable[Phase]) -> str:
    phases = list(phases)
    both = [_acting(rows, phases, system) for system in PUBLISHED]
    if not all(both):
        return "The drives of one driver"
    base, learned = (100 * _mean(acting).combined for acting in both)
    return (
        f"One driver intervenes in {base:.0f} % of the time with the base function, "
        f"in {learned:.0f} % after learning"
    )


def _panel_title(row: DriveRow, phase: Phase) -> str:
    if not phase.intervenes:
        return phase.about
    pedal, set_speed, combined = (f"{100 * rate:.0f} %" for rate in row.rates)
    return f"{phase.about}: pedal {pedal}, set speed {set_speed}, either {combined} of the time"


def _percent(rates: Rates) -> list[str]:
    return [f"{100.0 * rate:.2f}" for rate in rates]
