"""``pldf profiles``: look at what was learned, take it elsewhere, go back to an older state."""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Callable, Collection
from pathlib import Path
from typing import Final

import numpy as np

from ..errors import ModelError
from ..files.tables import table_csv, write_table
from ..kernel.units import KMH_PER_MPS
from ..profiles.last_word import forgotten, undone
from ..profiles.lessons import lessons_in_force, number_named, taught
from ..profiles.store import (
    STORE_VARIABLE,
    ProfileRefused,
    ProfileStore,
    ProfileUnreadable,
    StoredProfile,
    change_profile,
    export_format_1,
    read_profile,
    rollback_profile,
)
from .shared.moving import add_move, chosen_older, move
from .shared.profile_places import SHOWN_MPS, show
from .shared.road import add_road, required_road

EXAMPLE: Final = """pldf profiles list --store profiles
  pldf profiles show profiles/driver-000017_route-0123456789abcdef.pldf --plot profile.png
  pldf profiles history 17 --store profiles
  pldf profiles export 17 --store profiles --out learned.csv
  pldf profiles forget 17 --store profiles --from 800 --to 1400
  pldf profiles undo 17 --store profiles
  pldf profiles delete 17 --store profiles
  pldf profiles rollback 17 --store profiles --to 2
  pldf profiles move 17 --store profiles --route town.xodr --start-road 12

All but 'list' take a profile file or, with a store, the number of a driver."""

_LEFT_OUT: Final = "kinds, lessons, bounds and evidence are left out: it does not know them"
_EXAMPLES: Final = {
    "list": "pldf profiles list --store profiles",
    "show": "pldf profiles show 17 --store profiles --plot profile.png --route my_road.xodr",
    "forget": "pldf profiles forget 17 --store profiles --from 800 --to 1400",
    "undo": "pldf profiles undo 17 --store profiles",
    "delete": "pldf profiles delete 17 --store profiles",
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
    shown = _action(
        actions, "show", "show what is learned where, how much and from which drives", _show
    )
    _action(actions, "history", "show what each drive changed", _history)
    export = _action(actions, "export", "print s_m,base_mps,learned_mps,offset_mps as CSV", _export)
    rollback = _action(actions, "rollback", "make an older state the newest one", _rollback)
    add_move(
        _action(actions, "move", "carry what was learned over to a new reading of its road", _move)
    )
    add_road(shown, "road of the profile, whose legal limit is drawn (not needed: the shipped one)")
    shown.add_argument(
        "--plot", metavar="PNG", type=Path, help="draw legal limit, base and learned speed"
    )
    for command in (shown, export):
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
    forget = _action(actions, "forget", "put a piece of the road back to base", _forget)
    forget.add_argument(
        "--from", dest="from_m", metavar="M", type=float, required=True, help="where it begins"
    )
    forget.add_argument(
        "--to", dest="to_m", metavar="M", type=float, required=True, help="where it ends"
    )
    _action(actions, "undo", "take the newest lesson back; again: the one before", _undo)
    _action(
        actions, "delete", "delete all that is kept of a driver, or a file and those beside it",
        _delete,
    )  # fmt: skip
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
    show(options, read_profile(_path(options)))


def _history(options: argparse.Namespace) -> None:
    profile = read_profile(_path(options))
    print(
        "change of the learned speed against the iteration before, as absolute values;\n"
        "then how much was shaped by a lesson and how much was cut by a bound, in all,\n"
        "and whether what it taught is in force (-: it taught nothing)"
    )
    print(
        f"{'iteration':>9} {'kind':8} {'interventions':>13} {'changed m':>9} "
        f"{'mean km/h':>9} {'max km/h':>9} {'taught m':>8} {'cut m':>7} {'in force':>8}  note"
    )
    in_force = set(lessons_in_force(profile))
    for iteration in profile.iterations:
        before = profile.iteration(iteration.number - 1)
        now = _in_force(profile, iteration.number, in_force)
        kmh = np.abs(iteration.learned_mps - before.learned_mps) * KMH_PER_MPS
        changed = int(np.count_nonzero(kmh > SHOWN_MPS * KMH_PER_MPS))
        print(
            f"{iteration.number:9} {iteration.kind:8} {iteration.interventions:13} {changed:9} "
            f"{kmh.mean():9.2f} {kmh.max():9.2f} {np.count_nonzero(iteration.lessons):8} "
            f"{np.count_nonzero(iteration.bound):7} {now:>8}  {iteration.note}"
        )


def _in_force(profile: StoredProfile, number: int, in_force: Collection[int]) -> str:
    if profile.iteration(number).kind not in ("drive", "learn") or not taught(profile, number):
        return "-"
    return "yes" if number in in_force else "no"


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


def _forget(options: argparse.Namespace) -> None:
    path = _path(options)
    known = len(read_profile(path).iterations)
    profile = change_profile(path, lambda p: forgotten(p, options.from_m, options.to_m))
    where = f"{options.from_m:g} and {options.to_m:g} m"
    if len(profile.iterations) == known:
        print(f"{path}: nothing is learned between {where}: nothing to forget")
    else:
        print(f"{path}: iteration {len(profile.iterations)} is at base between {where}")


def _undo(options: argparse.Namespace) -> None:
    path = _path(options)
    known = len(read_profile(path).iterations)
    profile = change_profile(path, lambda p: undone(p)[0])
    number = len(profile.iterations)
    if number == known:
        print(f"{path}: nothing that was taught is in force: nothing to undo")
    else:
        of = number_named(profile.iteration())
        print(f"{path}: iteration {number} is without what iteration {of} taught")


def _delete(options: argparse.Namespace) -> None:
    if _is_file(options):
        path = Path(options.file)
        gone = ProfileStore(path.parent).delete_file(path)
    else:
        store = _store(options)
        gone = store.delete(int(options.file))
        if not gone:
            print(f"{store.folder}: nothing is kept of driver {options.file}")
    for path in gone:
        print(f"deleted {path}")
