"""``pldf drive``: one drive of the coupled FMUs."""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import Final

import numpy as np

from ..cosim.kinds import PARTS, PARTS_IN_TRAFFIC
from ..cosim.master import Drive, drive
from ..cosim.road_values import road_values
from ..cosim.values import Value
from ..durations import minutes
from ..errors import ModelError
from ..kernel.codes import LEARN
from ..kernel.units import KMH_PER_MPS
from ..outcome_words import is_outcome
from ..profiles.store import STORE_VARIABLE, ProfileStore
from ..recordings.recording import Recording, write_recording
from ..roads import fingerprint
from ..study.phases import (
    PHASES,
    SCRIPT,
    TRAFFIC,
    TRAFFIC_SCRIPT,
    DriveSetting,
    Phase,
    values_of,
)
from .shared.coupling import (
    NATIVE_IF_GOOD,
    add_coupling,
    add_fmu,
    chosen_fmus,
    chosen_values,
    print_warnings,
    require_no_errors,
)
from .shared.progress import progress_bar
from .shared.road import required_road

EXAMPLE: Final = (
    "pldf drive --phase A2 --store profiles --out out/A2.csv\n"
    "  pldf drive --phase B1 --store profiles --out out/B1.csv --set driver.wish.offset_mps=3\n"
    "  pldf drive --seed 2 --set person_seed=7 --set wish.offset_person_sd_mps=1"
    " --set wish.offset_occasion_sd_mps=0.6\n"
    "  pldf drive --driver script --script my_drive.csv --route road.xodr\n"
    "  pldf drive --traffic --driver none --seed 3"
)

_BY_ITSELF: Final = Path()  # --traffic without a script
_DRIVING_MPS: Final = 5.0  # below, a time gap says nothing
_CHANGED_MPS: Final = 0.1 / KMH_PER_MPS  # smaller changes do not count as learned

_SEED_OF: Final = (
    "the drive: small irregularities of the driver, the occasion's part of the wish, and traffic; "
    "who drives: --set person_seed=N (default: 1)"
)


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``pldf drive``."""
    parser.add_argument(
        "--phase", choices=list(PHASES),
        help="drive of the study: sets --apply, --learn and --driver",
    )  # fmt: skip
    parser.add_argument(
        "--apply", action=argparse.BooleanOptionalAction, default=None,
        help="drive the learned or the base profile (default: learned, if there is a store)",
    )  # fmt: skip
    parser.add_argument(
        "--learn", choices=LEARN.items, help="what is learned from the drive (default: OFF)"
    )
    parser.add_argument(
        "--store", type=Path, metavar="FOLDER",
        help=f"folder of learned profiles (default: the environment variable {STORE_VARIABLE})",
    )  # fmt: skip
    parser.add_argument(
        "--driver", choices=("preference", "script", "none"),
        help="who intervenes: a hidden wish, a script, nobody (default: preference)",
    )  # fmt: skip
    parser.add_argument(
        "--script", type=Path, metavar="CSV", help="driver script, implies --driver script"
    )
    parser.add_argument(
        "--traffic", type=Path, nargs="?", const=_BY_ITSELF, metavar="CSV",
        help="with cars ahead: from a traffic script or, without one, cars that drive the road by "
        "themselves, cut in and stop (--seed chooses which)",
    )  # fmt: skip
    parser.add_argument(
        "--out", type=Path, default=Path("out"), metavar="PATH",
        help="recording (.csv), or folder for drive.csv (default: out)",
    )  # fmt: skip
    parser.add_argument(
        "--plot", type=Path, metavar="PNG", help="picture (default: beside the recording)"
    )
    add_coupling(parser, 1, _SEED_OF)
    add_fmu(parser, NATIVE_IF_GOOD)
    parser.set_defaults(wrong_usage=parser.error)


def run(options: argparse.Namespace) -> None:
    """Drive, write recording and picture, print rates and what was learned."""
    phase = _phase(options)
    road = required_road(options)
    csv = options.out if options.out.suffix.lower() == ".csv" else options.out / "drive.csv"
    with chosen_fmus(options, PARTS if options.traffic is None else PARTS_IN_TRAFFIC) as fmus:
        setting = DriveSetting(
            road.route, road_values(road, fmus["pldf"].folder.parent),
            options.driver_id, options.seed, options.store,
            _with_script(options, chosen_values(fmus, options.settings)),
            _traffic(options),
        )  # fmt: skip
        with progress_bar(phase.name, road.route.length_m / 1e3, "km") as bar:
            done = drive(
                fmus, values_of(phase, setting), setting.length_m, options.step,
                lambda s_m: bar.update(bar.task_ids[0], completed=s_m / 1e3),
            )  # fmt: skip
    csv.parent.mkdir(parents=True, exist_ok=True)
    write_recording(csv, done.recording)
    print_warnings(done.messages, road.route.notes)
    print(f"recording  {csv}")
    _plot(options.plot or csv.with_suffix(".png"), done, phase.name)
    _print_rates(done)
    if options.traffic is not None:
        _print_traffic(done.recording)
    require_no_errors(done.messages)
    if phase.learn:
        _print_outcomes(done)
        _print_learned(setting)
    if not done.arrived:
        raise ModelError(f"the drive was given up: the vehicle {done.ending}")


def _phase(options: argparse.Namespace) -> Phase:
    """Return the phase asked for; wrong usage if the options contradict each other."""
    if options.phase and (options.apply is not None or options.learn):
        options.wrong_usage("--phase sets --apply and --learn; leave out one or the other")
    if options.script and options.driver not in (None, "script"):
        options.wrong_usage(f"--script needs --driver script, not {options.driver}")
    driver = options.driver or ("script" if options.script else "")
    if options.phase:
        phase = PHASES[options.phase]
        return phase._replace(intervenes=driver != "none") if driver else phase
    return Phase(
        name="Drive",
        apply_learned=bool(_store(options.store)) if options.apply is None else options.apply,
        learn=options.learn == "FAITHFUL",
        intervenes=driver != "none",
    )


def _store(folder: Path | None) -> Path | str:
    return folder or os.environ.get(STORE_VARIABLE, "")


def _with_script(
    options: argparse.Namespace, more: dict[str, dict[str, Value]]
) -> dict[str, dict[str, Value]]:
    if options.driver != "script" and not options.script:
        return more
    script: dict[str, Value] = {"kind": SCRIPT}
    if options.script:
        script["script_file"] = str(options.script.resolve())
    return {**more, "driver": {**script, **more.get("driver", {})}}


def _traffic(options: argparse.Namespace) -> dict[str, Value] | None:
    """Return what to set in the car ahead; None without traffic."""
    if options.traffic is None:
        return None
    if options.traffic == _BY_ITSELF:
        return {"kind": TRAFFIC}
    return {"kind": TRAFFIC_SCRIPT, "script_file": str(options.traffic.resolve())}


def _plot(path: Path, done: Drive, name: str) -> None:
    from ..report.figures import one_drive  # noqa: PLC0415 - slow to import, not always used
    from ..report.paper import save  # noqa: PLC0415

    rates = done.outputs
    title = f"{name}: interventions in {100 * rates['rate.combined']:.0f} % of the time"
    save(path, one_drive(done.recording, title))
    print(f"picture    {path}")


def _print_rates(done: Drive) -> None:
    time_s = float(done.recording["time_s"][-1])
    rates = done.outputs
    print(f"time       {minutes(time_s, 1)} min, {done.ending}")
    print(
        f"rates      pedal {rates['rate.pedal']:.1%}, set speed {rates['rate.set_speed']:.1%}, "
        f"combined {rates['rate.combined']:.1%}"
    )
    print(f"pedal      {rates['drive.interventions']:.0f} interventions")


def _print_traffic(recording: Recording) -> None:
    """Print how much traffic there was, and how close it came."""
    there = recording["lead_present"] > 0.0
    if not there.any():
        print("traffic    no car was ahead")
        return
    gap_m, speed_mps = recording["lead_gap_m"][there], recording["speed_mps"][there]
    limits = recording["following_limits"] > 0.0
    print(
        f"traffic    a car ahead for {np.mean(there):.0%} of the time, it limited ours for "
        f"{np.mean(limits):.0%}; smallest gap {np.min(gap_m):.1f} m"
    )
    moving = speed_mps > _DRIVING_MPS
    if moving.any():
        print(f"           smallest time gap {np.min(gap_m[moving] / speed_mps[moving]):.1f} s")
    calls = int(np.sum(np.diff(recording["hmi_take_over"], prepend=0.0) > 0.0))
    if calls:
        print(f"           the driver was asked to take over: {calls} times")


def _print_outcomes(done: Drive) -> None:
    """Print what the function said of each intervention."""
    told = [message.text for message in done.messages if is_outcome(message.text)]
    for line in dict.fromkeys(told):
        print(f"  {line}")


def _print_learned(setting: DriveSetting) -> None:
    folder = _store(setting.store)
    if not folder:
        print("learned    nothing kept: there is no profile store")
        return
    pldf = setting.more.get("pldf", {})
    driver_id = int(pldf.get("driver_id", setting.driver_id))
    store = ProfileStore(str(pldf.get("profile_store", folder)))
    profile = store.load(driver_id, fingerprint(setting.route), setting.route.nodes)
    if profile is None or not profile.iterations:
        print(f"learned    nothing in {folder}")
        return
    number = len(profile.iterations)
    before = profile.iteration(number - 1).learned_mps
    change = profile.iteration().learned_mps - before
    changed = change[np.abs(change) > _CHANGED_MPS]
    print(f"learned    {len(changed)} m as drive {number}", end="")
    if len(changed):
        largest = changed[np.argmax(np.abs(changed))]
        print(
            f", on average {KMH_PER_MPS * np.mean(changed):+.1f} km/h, "
            f"at most {KMH_PER_MPS * largest:+.1f} km/h",
            end="",
        )
    print(f"\nprofile    {store.path(driver_id, fingerprint(setting.route))}")
