"""``pldf study``: the participants of a study file, or one driver, on all cores or a cluster."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Final

from ..cosim.fmu import Fmu
from ..cosim.kinds import USUAL_FOLDER
from ..study.own_files import DRIVES, PARTICIPANTS
from ..study.results import StudyResults
from ..study.runner import in_processes, on_cluster, prepare_processes, run_missing
from ..study.study_file import ONE_DRIVER, Study, read_study, study_path
from ..study.study_parameters import changes_of
from ..study.unit import Job, ParticipantResult
from ..study.variants import missing_in, open_folders
from ..toml_file import Key
from .shared.coupling import (
    NATIVE_IF_GOOD,
    add_coupling,
    add_fmu,
    chosen_fmus,
    print_warnings,
)
from .shared.progress import progress_bar
from .shared.road import road_options
from .shared.settings import split_settings
from .shared.telling import tell

EXAMPLE: Final = (
    "pldf study\n"
    "      one driver through the six drives, into out\n"
    "  pldf study paper --jobs 2\n"
    "      the paper's study, into out/paper\n"
    "  pldf study --out out_careful --set wish.offset_mps=-2 --seed 7"
)

# Option -> what it is called, and the key of the study file that it stands for.
_OF_ONE_DRIVER: Final[Mapping[str, tuple[str, Key]]] = {
    "road": ("--route", ("road", "route")),
    "start_road": ("--start-road", ("road", "start_road")),
    "via": ("--via", ("road", "via")),
    "to": ("--to", ("road", "to")),
    "reverse": ("--reverse", ("road", "reverse")),
    "default_limit": ("--default-limit", ("road", "default_limit_mps")),
    "limit_unit": ("--limit-unit", ("road", "limit_unit")),
    "signs": ("--no-signs", ("road", "signs")),
    "smoothing_m": ("--smoothing", ("road", "smoothing_m")),
    "driver_id": ("--driver-id", ("participants", "first")),
    "seed": ("--seed", ("participants", "seed")),
    "step": ("--step", ("drives", "step_s")),
    "settings": ("--set", ("function, vehicle or driver", "")),
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``pldf study``."""
    parser.add_argument(
        "file", nargs="?", metavar="FILE",
        help="study file (TOML), or 'paper', the paper's study ('paper_constant_wish': with "
        "drivers of one wish for ever); without it: one driver through the "
        f"FMUs ('{ONE_DRIVER}', a study file too), with figures",
    )  # fmt: skip
    parser.add_argument(
        "--out", type=Path, metavar="FOLDER", help="where everything is written (default: FILE's)"
    )
    parser.add_argument(
        "--jobs", type=_jobs, default=_cores(), metavar="N",
        help="processes (default: all cores); the results are the same",
    )  # fmt: skip
    parser.add_argument(
        "--scheduler", metavar="ADDRESS",
        help="drive on the Dask cluster with this scheduler, e.g. tcp://host:8786",
    )  # fmt: skip
    parser.add_argument(
        "--restart", action="store_true", help="forget what was driven before and start anew"
    )
    add_fmu(parser, f"what FILE says; FMUs are {NATIVE_IF_GOOD}")
    one_driver = parser.add_argument_group(
        "without FILE", "written into the study file of the one driver, beside the results"
    )
    add_coupling(
        one_driver, None, "the driver: what lasts in the wish, and the drives (default: the file's)"
    )
    usual = {name: parser.get_default(name) for name in _OF_ONE_DRIVER}
    parser.set_defaults(refuse=parser.error, usual=usual)


def run(options: argparse.Namespace) -> None:
    """Drive what is missing of a study; print where to look."""
    study = _study(options)
    tell(study.notes)
    if (options.fmu and options.scheduler) or (options.scheduler and study.through == "fmus"):
        options.refuse("FMUs drive on this machine only, not with --scheduler")
    if min(options.jobs, len(study.participants)) > 1 and not options.scheduler:
        prepare_processes()
    through_fmus = options.fmu or study.through == "fmus"
    if options.fmus != USUAL_FOLDER and not through_fmus:
        options.refuse("--fmus needs --fmu: FILE is driven in process, with the same results")
    out: Path = options.out or study.out
    with ExitStack() as stack:
        fmus = stack.enter_context(chosen_fmus(options)) if through_fmus else None
        folders, notes = open_folders(study, out, fmus, options.restart)
        for note in notes:
            print(f"pldf: {note}", file=sys.stderr)
        _drive(options, folders, fmus)
    drives = len(study.participants) * len(study.settings.phases)
    each = f" with each of {len(study.variants)} variants" if study.variants else ""
    print(f"{study.title}: {len(study.participants)} participants, {drives} drives{each}")
    if study.variants:
        _compare(folders, out)
        return
    print(f"Drives are in {out / DRIVES}, drivers in {out / PARTICIPANTS}.")
    if len(study.participants) == 1 and study.settings.recorded:
        _show(study, out)
    else:
        print(f"Look at the result with: pldf analyse {out}")


def _study(options: argparse.Namespace) -> Study:
    if options.file is None:
        return read_study(study_path(ONE_DRIVER), _changes(options))
    for name, (option, key) in _OF_ONE_DRIVER.items():
        if getattr(options, name) != options.usual[name]:
            options.refuse(f"{option} is for one driver; write it into FILE, table [{key[0]}]")
    return read_study(study_path(options.file))


def _changes(options: argparse.Namespace) -> dict[Key, Any]:
    """Return what the options change in the study file of the one driver."""
    values = {**vars(options), "default_limit": road_options(options).default_limit_mps}
    changed = {
        key: values[name]
        for name, (_, key) in _OF_ONE_DRIVER.items()
        if name != "settings" and getattr(options, name) != options.usual[name]
    }
    return {**changed, **changes_of(split_settings(options.settings))}


def _drive(
    options: argparse.Namespace, folders: Sequence[StudyResults], fmus: dict[str, Fmu] | None
) -> None:
    """Drive what is missing, with one bar over all folders; say what the FMUs warned of."""
    study = folders[0].study
    count, phases = len(study.participants) * len(folders), len(study.settings.phases)
    done = count - missing_in(folders)
    results: list[ParticipantResult] = []
    with progress_bar("drives", count * phases, "") as bar:

        def show(drives: float) -> None:
            bar.update(bar.task_ids[0], completed=(done + len(results)) * phases + drives)

        def note(result: ParticipantResult) -> None:
            results.append(result)
            show(0.0)

        show(0.0)
        run = (
            on_cluster(options.scheduler) if options.scheduler else in_processes(options.jobs, show)
        )
        try:
            for folder in folders:
                run_missing(folder, Job(folder.study.settings, fmus), run, note)
        except KeyboardInterrupt:
            bar.stop()
            print(
                f"pldf: {count - missing_in(folders)} of {count} participants are done; "
                "the same command goes on with the others",
                file=sys.stderr,
            )
            raise
    warnings = (warning for result in results for warning in result.warnings)
    print_warnings(warnings, study.notes)


def _compare(folders: Sequence[StudyResults], out: Path) -> None:
    """Write and draw what became of the drivers with each variant."""
    from ..report.long_run import compare_variants  # noqa: PLC0415 - slow to import

    written = compare_variants(folders, out)
    print(f"Rates and errors of each drive are in {' and '.join(map(str, written))},")
    print(f"the drives of each variant in a folder of its name, such as {folders[0].out / DRIVES}.")


def _show(study: Study, out: Path) -> None:
    """Draw the drives of the one participant and print a table of them."""
    from rich.console import Console  # noqa: PLC0415 - as the next

    from ..report.one_driver import draw_one_driver, table_of  # noqa: PLC0415 - slow to import

    figures = draw_one_driver(study, out)
    Console().print(table_of(study, out))
    print(f"Look at {', '.join(map(str, figures))}.")
    print(f"Recordings are in {out / 'recordings'}, profiles in {out / 'profiles'}.")


def _cores() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _jobs(text: str) -> int:
    if not text.isdigit() or not 1 <= int(text) <= 1024:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 1 to 1024")
    return int(text)
