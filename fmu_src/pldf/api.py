"""The front door: what the commands do, for programs. ``import pldf`` offers all of it.

Each function imports what it needs when it is called: who reads a route waits for no compiler.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import ModelError
from .kernel.arrays import FloatArray
from .roads import Route
from .settings import Given, set_parameters

if TYPE_CHECKING:
    from .analysis.analysis import Analysis
    from .cosim.master import Drive
    from .profiles.store import StoredProfile
    from .recordings.offline import Learned
    from .recordings.recording import Recording
    from .recordings.replayed import Replay

PathLike = str | os.PathLike[str]

# ruff: noqa: PLC0415 - see above


def base_profile(route: Route) -> FloatArray:
    """Return the speed in m/s that is planned from limits and curves alone, with the defaults.

    Args:
        route: from ``open_route``.

    Returns:
        The speed at every whole metre of the route: ``route.nodes`` values.
    """
    from .route_facts import route_facts

    return route_facts(route).base_mps


def learn(
    recording: Recording,
    route: Route,
    *,
    profile: StoredProfile | None = None,
    parameters: Mapping[str, Given] | None = None,
) -> Learned:
    """Learn from the recording of a drive (SPAA), as ``pldf learn`` does.

    Args:
        recording: from ``read_recording`` or ``drive``; absent columns are derived.
        route: the route driven.
        profile: what the drive followed; None: the base profile.
        parameters: of the driving function, by FMI name, e.g. ``{"learning.weight": 0.4}``.

    Returns:
        The profile for the next drive in ``.profile``, what is new in it in ``.iteration``.

    Raises:
        ModelError: the recording is not on the route or contradicts itself, the profile
            belongs to another route, or there is no such parameter or value.
    """
    from .function import DrivingFunction
    from .recordings.contradictions import require_sound
    from .recordings.offline import learn_from
    from .roads import route_arrays

    function = DrivingFunction()
    set_parameters(function.record, parameters or {})
    function.check_parameters()  # before the recording is held against anything
    for finding in require_sound(recording, "recording", route_arrays(route)):
        if finding.severity == "warning":
            warnings.warn(str(finding), stacklevel=2)
    return learn_from(recording, route, profile, function)


def replay(
    recording: Recording,
    route: Route,
    *,
    profile: StoredProfile | None = None,
    parameters: Mapping[str, Given] | None = None,
) -> Replay:
    """Give the driving function the inputs of a recorded drive once more, step by step.

    With the version, profile and parameters of that drive it answers with the same bits.

    Args:
        recording: with every step and all inputs, as ``drive`` and the studies make it.
        route: the route driven.
        profile: what the drive followed; None: the base profile.
        parameters: of the driving function, by FMI name, e.g. ``{"learn_faithful": True}``.

    Returns:
        The recording with what the function answers now in ``.recording``, and what it learned in
        ``.iteration`` (None if it was not to learn).

    Raises:
        ModelError: inputs were not recorded, the profile belongs to another route, or there is no
            such parameter or value.
    """
    from .function import DrivingFunction
    from .recordings.offline import follow_known
    from .recordings.replayed import replay as replayed

    function = DrivingFunction()
    set_parameters(function.record, parameters or {})
    function.record.apply_learned = int(profile is not None)
    function.prepare(route)
    follow_known(function, route, profile)
    return replayed(recording, function)


def drive(  # noqa: PLR0913 - the options of a drive, all by name
    phase: str = "A2",
    *,
    route: str = "study",
    store: PathLike | None = None,
    driver_id: int = 1,
    seed: int = 1,
    fmus: PathLike | None = None,
    parameters: Mapping[str, Given] | None = None,
) -> Drive:
    """Drive once with the three coupled FMUs, as ``pldf drive`` does.

    Args:
        phase: drive of the study, A1 to B3: which profile is driven, whether the driver intervenes
            and whether the drive is learned from.
        route: a route file, ``study``, or the number of a packed route.
        store: folder of learned profiles; None: the environment variable ``PLDF_PROFILE_STORE``,
            and if there is none, nothing is loaded or kept.
        driver_id: whose profile.
        seed: of the drive: the driver's small irregularities and the occasion's part of the wish.
        fmus: folder of the FMUs; None: ``dist``, and if nobody has built any, they are built into
            the user's cache.
        parameters: of the FMUs, as ``--set`` takes them, e.g. ``{"wish.offset_mps": 2.0}``.

    Returns:
        The recording, and the outputs of the driving function at the end.

    Raises:
        ModelError: a name or value is unknown, an FMU reported an error, or the vehicle did not
            reach the end of the route.
    """
    from .build.first_use import fmus_to_drive
    from .cosim import master, settable
    from .cosim.kinds import USUAL_FOLDER
    from .cosim.road_values import road_values
    from .roads import open_road
    from .study.phases import PHASES, DriveSetting, values_of

    if phase not in PHASES:
        raise ModelError(f"phase {phase}: there are {', '.join(PHASES)}")
    road = open_road(route)
    choice = fmus_to_drive(Path(fmus) if fmus is not None else USUAL_FOLDER)
    with master.unpacked(choice.folder) as unpacked:
        setting = DriveSetting(
            road.route,
            road_values(road, unpacked["pldf"].folder.parent),
            driver_id,
            seed,
            None if store is None else Path(store),
            settable.chosen_values(unpacked, parameters or {}),
        )
        done = master.drive(unpacked, values_of(PHASES[phase], setting), setting.length_m)
    for message in done.messages:
        if message.level == "error":
            raise ModelError(f"{message.fmu}: {message.text}")
    if not done.arrived:
        raise ModelError(f"the drive was given up: the vehicle {done.ending}")
    return done


def run_study(
    file: PathLike | None = None,
    out: PathLike | None = None,
    *,
    jobs: int | None = None,
    restart: bool = False,
) -> Path:
    """Drive a study, as ``pldf study`` does; what was driven before is not driven again.

    On Windows and macOS a script that calls this with more than one job needs the usual
    ``if __name__ == "__main__":``, because the other processes import it.

    Args:
        file: study file (TOML), or ``paper``, the paper's study; None: one driver through the FMUs.
            Variants get a folder each, in ``out``.
        out: folder of the results; None: the study's own.
        jobs: processes; None: one for each core. The results are the same.
        restart: forget what was driven before.

    Returns:
        The folder of the results, for ``analyse``.

    Raises:
        ModelError: the study file cannot be used, the folder holds another study, or a drive
            failed.
    """
    from contextlib import ExitStack

    from .build.first_use import fmus_to_drive
    from .cosim.master import unpacked
    from .study.runner import in_processes, run_missing
    from .study.study_file import ONE_DRIVER, read_study, study_path
    from .study.unit import Job
    from .study.variants import open_folders

    study = read_study(study_path(ONE_DRIVER if file is None else os.fspath(file)))
    place = Path(out or study.out)
    with ExitStack() as stack:
        through_fmus = study.through == "fmus"
        fmus = stack.enter_context(unpacked(fmus_to_drive().folder)) if through_fmus else None
        folders, notes = open_folders(study, place, fmus, restart)
        for note in notes:
            warnings.warn(note, stacklevel=2)
        run = in_processes(jobs or os.cpu_count() or 1)
        for folder in folders:
            run_missing(folder, Job(folder.study.settings, fmus), run, lambda _: None)
    if study.variants:
        from .report.long_run import compare_variants

        compare_variants(folders, place)
    return place


def analyse(
    folder: PathLike,
    *,
    route: Route | None = None,
    without: Collection[str] = (),
    profiles: PathLike | None = None,
) -> Analysis:
    """Analyse a study, real or simulated, as ``pldf analyse`` does.

    Args:
        folder: with ``drives.csv`` or ``recordings/PARTICIPANT_PHASE.csv``, and
            ``questionnaire.csv`` if there is one.
        route: the route driven; needed if the recordings lack columns.
        without: participants (``P07``), drives (``P07_B2``) or names of recordings to leave out,
            beside ``exclusions.csv``.
        profiles: folder of the learned profiles, for recordings of system B without
            ``set_speed_offset_mps``; None: ``profiles`` in the folder, if there.

    Returns:
        Rates, scores, tests and effect sizes.

    Raises:
        ModelError: a file cannot be used, or there are too few participants.
    """
    from .analysis import checks, study_folder

    learned = None if profiles is None else Path(profiles)
    return checks.analysed(
        study_folder.StudyFolder(Path(folder), route, frozenset(without), profiles=learned)
    )[0]
