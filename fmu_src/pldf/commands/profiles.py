"""``pldf profiles``: look at what was learned, take it elsewhere, go back to an older state."""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Final

import numpy as np

from ..errors import ModelError
from ..files.tables import table_csv, write_table
from ..kernel.arrays import FloatArray
from ..kernel.codes import BOUND
from ..kernel.units import KMH_PER_MPS
from ..outcome_words import told_holds
from ..outcomes import held_places
from ..profiles.store import (
    STORE_VARIABLE,
    ProfileRefused,
    ProfileStore,
    ProfileUnreadable,
    StoredProfile,
    export_format_1,
    read_profile,
    rollback_profile,
)
from ..profiles.stored_profile import Iteration
from ..recordings.interventions import runs
from .shared.moving import add_move, chosen_older, move
from .shared.road import required_road

EXAMPLE: Final = """pldf profiles list --store profiles
  pldf profiles show profiles/driver-000017_route-0123456789abcdef.pldf --plot profile.png
  pldf profiles history 17 --store profiles
  pldf profiles export 17 --store profiles --out learned.csv
  pldf profiles rollback 17 --store profiles --to 2
  pldf profiles move 17 --store profiles --route town.xodr --start-road 12

All but 'list' take a profile file or, with a store, the number of a driver."""

_SHOWN_MPS: Final = 0.1 / KMH_PER_MPS  # smaller differences round to nothing in the tables
_LEFT_OUT: Final = "kinds, lessons, bounds and evidence are left out: it does not know them"
_EXAMPLES: Final = {
    "list": "pldf profiles list --store profiles",
    "show": "pldf profiles show 17 --store profiles --plot profile.png",
    "history": "pldf profiles history 17 --store profiles",
    "export": "pldf profiles export driver-000017_route-0123456789abcdef.pldf --iteration 2\n"
    "  pldf profiles export 17 --store profiles --format 1 --out old.pldf",
    "rollback": "pldf profiles rollback 17 --store profiles --to 2",
    "move": "pldf profiles move driver-000017_route-0123456789abcdef.pldf --route my_road.xodr\n"
    "  pldf profiles move 17 --store profiles --route town.xodr --start-road 12 --to 45",
}

Action = Callable[[argparse.Namespace], None]


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the actions and their arguments."""
    actions = parser.add_subparsers(metavar="ACTION", required=True)
    _action(actions, "list", "list the profiles of a store", _list)
    show = _action(actions, "show", "show where the profile differs from its base", _show)
    _action(actions, "history", "show what each drive changed", _history)
    export = _action(actions, "export", "print s_m,base_mps,learned_mps,offset_mps as CSV", _export)
    rollback = _action(actions, "rollback", "make an older state the newest one", _rollback)
    add_move(
        _action(actions, "move", "carry what was learned over to a new reading of its road", _move)
    )
    show.add_argument("--plot", metavar="PNG", type=Path, help="draw base and learned speed")
    for command in (show, export):
        command.add_argument(
            "--iteration", metavar="N", type=int, help="state after drive N, 0 = base (newest)"
        )
    export.add_argument("--out", metavar="FILE", type=Path, help="write to this file (stdout)")
    export.add_argument(
        "--format",
        type=int,
        choices=(1,),
        help="write a profile file for release 0.2.0 and older, which know format 1 (with --out)",
    )
    rollback.add_argument(
        "--to", metavar="N", type=int, required=True, help="iteration to go back to, 0 = base"
    )


def run(options: argparse.Namespace) -> None:
    """Do the chosen action.

    Raises:
        ModelError: a file, driver or iteration does not exist or cannot be used.
    """
    options.action(options)


def _action(
    actions: argparse._SubParsersAction[argparse.ArgumentParser],
    name: str,
    summary: str,
    action: Action,
) -> argparse.ArgumentParser:
    parser = actions.add_parser(
        name,
        help=summary,
        description=f"{summary.capitalize()}.",
        epilog=f"example:\n  {_EXAMPLES[name]}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    if name != "list":
        parser.add_argument("file", metavar="FILE", help="profile file, or driver number in STORE")
    parser.add_argument(
        "--store", metavar="FOLDER", help=f"profile store (environment: {STORE_VARIABLE})"
    )
    parser.set_defaults(action=action, wrong_usage=parser.error)
    return parser


def _store(options: argparse.Namespace) -> ProfileStore:
    folder: str = options.store or os.environ.get(STORE_VARIABLE, "")
    if not folder:
        options.wrong_usage(f"give --store FOLDER, or set {STORE_VARIABLE}")
    if not os.path.isdir(folder):
        raise ModelError(f"{folder}: no such folder; give the profile store with --store")
    return ProfileStore(folder)


def _is_file(options: argparse.Namespace) -> bool:
    """Tell whether a file is named, not the number of a driver."""
    return Path(options.file).exists() or not re.fullmatch("[0-9]{1,9}", options.file)


def _path(options: argparse.Namespace) -> Path:
    if _is_file(options):
        return Path(options.file)
    store = _store(options)
    files = store.files_of(int(options.file))
    if not files:
        raise ModelError(f"{store.folder}: no profile of driver {options.file}")
    if len(files) > 1:
        names = ", ".join(file.name for file in files)
        raise ModelError(f"driver {options.file} has {len(files)} profiles, name one: {names}")
    return files[0]


def _list(options: argparse.Namespace) -> None:
    store = _store(options)
    print(f"{'driver':>9}  {'route':16}  {'length m':>8}  {'iterations':>10}  file")
    for path in store.files():
        try:
            profile = read_profile(path)
        except (ProfileRefused, ProfileUnreadable) as refusal:
            print(f"pldf: {refusal}", file=sys.stderr)
            continue
        print(
            f"{profile.driver_id:9}  {profile.route}  {profile.nodes - 1:8}  "
            f"{len(profile.iterations):10}  {path}"
        )
    for path in store.refused():
        print(f"pldf: {path}: put aside because it could not be used", file=sys.stderr)
    for path in store.replaced():
        print(f"pldf: {path}: put aside when another took its place by force", file=sys.stderr)


def _show(options: argparse.Namespace) -> None:
    path = _path(options)
    profile = read_profile(path)
    iteration = profile.iteration(options.iteration)
    print(f"driver     {profile.driver_id}")
    print(f"route      {profile.route}, {profile.nodes - 1} m")
    told = f"{iteration.kind}, {iteration.note}" if iteration.note else iteration.kind
    print(f"iteration  {iteration.number} of {len(profile.iterations)}: {told}")
    _print_places("learned minus base speed", iteration.learned_mps - iteration.base_mps, iteration)
    _print_places("learned offset of the set speed", iteration.offset_mps, iteration)
    _print_holds(iteration)
    if options.plot is not None:
        _plot(options.plot, profile, iteration)
        print(f"plot       {options.plot}")


def _print_places(title: str, difference_mps: FloatArray, iteration: Iteration) -> None:
    places = runs(np.abs(difference_mps) > _SHOWN_MPS)
    if not places:
        print(f"{title}: none")
        return
    print(
        f"{title}:\n{'from m':>9} {'to m':>9} {'mean km/h':>10} {'peak km/h':>10} lessons  cut by"
    )
    for first, behind in places:
        kmh = difference_mps[first:behind] * KMH_PER_MPS
        peak = kmh[np.argmax(np.abs(kmh))]
        lessons = int(iteration.lessons[first:behind].max())
        print(
            f"{first:9} {behind - 1:9} {kmh.mean():+10.1f} {peak:+10.1f} {lessons:7}  "
            f"{_bounds(iteration.bound[first:behind])}"
        )


def _print_holds(iteration: Iteration) -> None:
    """Say where a bound, not the driver's wish, holds the learned speed."""
    told = told_holds(held_places(iteration.bound, iteration.learned_mps))
    print("bounds: none holds it" if not told else "bounds:")
    for hold in told:
        print(f"  {hold}")


def _bounds(codes: FloatArray) -> str:
    """Return the bounds that cut a place, by name, or a dash."""
    names = [BOUND.items[int(code)].lower() for code in np.unique(codes) if code > 0.0]
    return ", ".join(names) or "-"


def _history(options: argparse.Namespace) -> None:
    profile = read_profile(_path(options))
    print(
        "change of the learned speed against the iteration before, as absolute values;\n"
        "then how much was shaped by a lesson and how much was cut by a bound, in all"
    )
    print(
        f"{'iteration':>9} {'kind':8} {'interventions':>13} {'changed m':>9} "
        f"{'mean km/h':>9} {'max km/h':>9} {'taught m':>8} {'cut m':>7}  note"
    )
    for iteration in profile.iterations:
        before = profile.iteration(iteration.number - 1)
        kmh = np.abs(iteration.learned_mps - before.learned_mps) * KMH_PER_MPS
        changed = int(np.count_nonzero(kmh > _SHOWN_MPS * KMH_PER_MPS))
        print(
            f"{iteration.number:9} {iteration.kind:8} {iteration.interventions:13} {changed:9} "
            f"{kmh.mean():9.2f} {kmh.max():9.2f} {np.count_nonzero(iteration.lessons):8} "
            f"{np.count_nonzero(iteration.bound):7}  {iteration.note}"
        )


def _export(options: argparse.Namespace) -> None:
    if options.format is not None:
        _export_older(options)
        return
    profile = read_profile(_path(options))
    iteration = profile.iteration(options.iteration)
    columns = {
        "s_m": np.arange(profile.nodes, dtype=np.float64),
        "base_mps": iteration.base_mps,
        "learned_mps": iteration.learned_mps,
        "offset_mps": iteration.offset_mps,
    }
    if options.out is None:
        sys.stdout.write(table_csv(columns).decode())
    else:
        write_table(options.out, columns)


def _export_older(options: argparse.Namespace) -> None:
    if options.out is None:
        options.wrong_usage("--format 1 needs --out FILE")
    if options.iteration is not None:
        options.wrong_usage("--format 1 writes all iterations, so --iteration makes no sense")
    path = _path(options)
    profile = read_profile(path)
    export_format_1(options.out, profile)
    print(f"{options.out}: {path} in format 1; {_LEFT_OUT}")


def _rollback(options: argparse.Namespace) -> None:
    path = _path(options)
    profile = rollback_profile(path, options.to)
    print(f"{path}: iteration {len(profile.iterations)} is now a copy of iteration {options.to}")


def _move(options: argparse.Namespace) -> None:
    route = required_road(options).route
    if _is_file(options):
        move(Path(options.file), route, options)
    else:
        move(chosen_older(_store(options), int(options.file), route), route, options)


def _plot(path: Path, profile: StoredProfile, iteration: Iteration) -> None:
    from matplotlib.figure import Figure  # noqa: PLC0415 - slow to import, rarely needed

    figure = Figure(figsize=(10, 4), layout="constrained")
    axes = figure.subplots()
    kilometres = np.arange(profile.nodes) / 1000.0
    for label, speed_mps in (("base", iteration.base_mps), ("learned", iteration.learned_mps)):
        axes.plot(kilometres, speed_mps * KMH_PER_MPS, label=label, linewidth=1.2)
    axes.set(
        xlabel="distance in km",
        ylabel="speed in km/h",
        title=f"Driver {profile.driver_id}, route {profile.route}, iteration {iteration.number}",
    )
    axes.grid(alpha=0.3)
    axes.legend()
    try:
        figure.savefig(path, dpi=120)
    except (OSError, ValueError) as error:  # ValueError: a file type that is unknown
        raise ModelError(f"{path}: cannot be written ({error})") from error
