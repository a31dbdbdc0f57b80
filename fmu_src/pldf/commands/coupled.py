"""What the commands that drive the coupled FMUs share: arguments, settings, progress, messages."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from rich.console import Console
from rich.progress import BarColumn, Progress, ProgressColumn, TextColumn, TimeElapsedColumn

from ..build.first_use import fmus_to_drive
from ..cosim import settable
from ..cosim.fmu import Fmu, Said
from ..cosim.master import STEP_S, unpacked
from ..cosim.settable import Chosen
from ..cosim.which_fmus import KINDS, NATIVE_FOLDER, USUAL_FOLDER
from ..instance import ModelError
from .options import split_settings

NATIVE_IF_GOOD: Final = "native, if they are there for this platform and up to date"


def add_coupling(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that say which FMUs drive, for whom and how."""
    parser.add_argument(
        "--route", default="study",
        help="route file (.xodr or .csv), or number of a packed route (default: the study road)",
    )  # fmt: skip
    parser.add_argument(
        "--driver-id", type=_whole, default=1, metavar="N", help="whose profile (default: 1)"
    )
    parser.add_argument(
        "--seed", type=_whole, default=1, metavar="N",
        help="seed of the driver's small irregularities (default: 1)",
    )  # fmt: skip
    parser.add_argument(
        "--step", type=_step, default=STEP_S, metavar="S",
        help="communication step in seconds (default: 0.01)",
    )  # fmt: skip
    parser.add_argument(
        "--fmus", type=Path, default=USUAL_FOLDER, metavar="FOLDER",
        help=f"where pldf build put the FMUs, the native ones in its folder {NATIVE_FOLDER} "
        f"(default: {USUAL_FOLDER})",
    )  # fmt: skip
    parser.add_argument(
        "--set", dest="settings", metavar="FMU.VARIABLE=VALUE", action="append", default=[],
        help="set a parameter, e.g. driver.wish.offset_mps=2 or pldf.learning.weight=0.4; FMU is "
        "pldf, vehicle or driver and may be left out where the name is clear (repeatable)",
    )  # fmt: skip


def add_fmu(parser: argparse.ArgumentParser, usual: str) -> None:
    """Add ``--fmu``; ``usual`` says what happens without it."""
    parser.add_argument(
        "--fmu", choices=KINDS,
        help="drive the native FMUs (quick) or the Python ones; the results are the same "
        f"(default: {usual})",
    )  # fmt: skip


@contextmanager
def chosen_fmus(options: argparse.Namespace) -> Iterator[dict[str, Fmu]]:
    """Unpack the FMUs that ``--fmus`` and ``--fmu`` ask for; say which they are."""
    choice = fmus_to_drive(options.fmus, options.fmu)
    for note in choice.notes:
        print(f"pldf: {note}", file=sys.stderr)
    with unpacked(choice.folder) as fmus:
        print(f"FMUs       {choice.kind}, in {choice.folder}")
        yield fmus


def chosen_values(fmus: Mapping[str, Fmu], settings: list[str]) -> Chosen:
    """Return the values of ``--set`` by part and variable; ModelError if one cannot be set."""
    given = split_settings(settings)
    try:
        return settable.chosen_values(fmus, given)
    except ModelError as problem:
        raise ModelError(f"--set {problem}") from None


def stderr_progress(*columns: ProgressColumn) -> Progress:
    """Return a progress display of ``columns`` that is silent where nobody watches."""
    console = Console(file=sys.stderr)
    return Progress(
        *columns,
        console=console,
        transient=True,
        disable=not console.is_terminal,
        redirect_stdout=False,
        redirect_stderr=False,
    )


@contextmanager
def progress_bar(total_m: float) -> Iterator[Progress]:
    """Show a bar on stderr while driving; nothing when stderr is not a terminal."""
    with stderr_progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.completed:.2f} of {task.total:.2f} km"),
        TimeElapsedColumn(),
    ) as bar:
        bar.add_task("Getting ready", total=total_m / 1000.0)
        yield bar


def tell(said: Iterable[Said]) -> None:
    """Print what the FMUs warned of, once, on stderr."""
    for message in dict.fromkeys(said):
        if message.level == "warning":
            print(f"pldf: {message.fmu}: {message.text}", file=sys.stderr)


def require_no_errors(said: Iterable[Said]) -> None:
    """Raise ModelError with the first error that an FMU reported and survived."""
    for message in said:
        if message.level == "error":
            raise ModelError(f"{message.fmu}: {message.text}")


def _whole(text: str) -> int:
    if not text.isdigit() or int(text) > 999_999_999:  # range of the FMUs' parameters
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 0 to 999999999")
    return int(text)


def _step(text: str) -> float:
    try:
        step = float(text)
    except ValueError:
        step = 0.0
    if not 1e-4 <= step <= 0.1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a step from 0.0001 to 0.1 s")
    return step
