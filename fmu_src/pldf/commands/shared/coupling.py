"""The commands that drive the coupled FMUs: which FMUs, for whom, how, and what they say."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from ...cosim import settable
from ...cosim.drive_limits import STEP_S
from ...cosim.fmu import Fmu
from ...cosim.kinds import KINDS, NATIVE_FOLDER, PARTS, USUAL_FOLDER
from ...cosim.master import unpacked
from ...cosim.settable import Chosen
from ...cosim.values import FmuMessage
from ...errors import ModelError
from ...findings import Finding
from .road import Parser, add_road
from .settings import setting, split_settings

NATIVE_IF_GOOD: Final = "native, if they are there for this platform and up to date"


def add_coupling(parser: Parser, seed: int | None, seed_of: str) -> None:
    """Add the arguments that say which FMUs drive, for whom, where and how.

    ``seed`` is usual, ``seed_of`` says what of.
    """
    add_road(parser, default="study")
    parser.add_argument(
        "--driver-id", type=_whole, default=1, metavar="N", help="whose profile (default: 1)"
    )
    parser.add_argument(
        "--seed", type=_whole, default=seed, metavar="N", help=f"seed of {seed_of}",
    )  # fmt: skip
    parser.add_argument(
        "--step", type=_step, default=STEP_S, metavar="S",
        help="communication step in seconds (default: 0.01)",
    )  # fmt: skip
    parser.add_argument(
        "--set", dest="settings", type=setting, metavar="FMU.VARIABLE=VALUE", action="append",
        default=[],
        help="set a parameter, e.g. driver.wish.offset_mps=2 or pldf.learning.weight=0.4; FMU is "
        "pldf, vehicle, driver or lead (the car ahead) and may be left out where the name is clear "
        "(repeatable)",
    )  # fmt: skip


def add_fmu(parser: argparse.ArgumentParser, usual: str) -> None:
    """Add ``--fmu`` and ``--fmus``; ``usual`` says what happens without the first."""
    parser.add_argument(
        "--fmu", choices=KINDS,
        help="drive the native FMUs (quick) or the Python ones; the results are the same "
        f"(default: {usual})",
    )  # fmt: skip
    parser.add_argument(
        "--fmus", type=Path, default=USUAL_FOLDER, metavar="FOLDER",
        help=f"where pldf build put the FMUs, the native ones in its folder {NATIVE_FOLDER} "
        f"(default: {USUAL_FOLDER})",
    )  # fmt: skip


@contextmanager
def chosen_fmus(
    options: argparse.Namespace, parts: Mapping[str, str] = PARTS
) -> Iterator[dict[str, Fmu]]:
    """Unpack the FMUs of these parts that ``--fmus`` and ``--fmu`` ask for; say which they are."""
    from ...build.first_use import fmus_to_drive  # noqa: PLC0415 - brings all that builds

    choice = fmus_to_drive(options.fmus, options.fmu)
    for note in choice.notes:
        print(f"pldf: {note}", file=sys.stderr)
    with unpacked(choice.folder, parts) as fmus:
        print(f"FMUs       {choice.kind}, in {choice.folder}")
        yield fmus


def chosen_values(fmus: Mapping[str, Fmu], settings: list[str]) -> Chosen:
    """Return the values of ``--set`` by part and variable; ModelError if one cannot be set."""
    given = split_settings(settings)
    try:
        return settable.chosen_values(fmus, given)
    except ModelError as problem:
        raise ModelError(f"--set {problem}") from None


def print_warnings(messages: Iterable[FmuMessage], told: Iterable[Finding] = ()) -> None:
    """Print what the FMUs warned of, once, on stderr; not what was told of their files before."""
    # An FMU knows a file by its whole path, a person by the name that was given.
    known = tuple(str(finding).removeprefix(finding.file) for finding in told)
    for message in dict.fromkeys(messages):
        if message.level == "warning" and not message.text.endswith(known):
            print(f"pldf: {message.fmu}: {message.text}", file=sys.stderr)


def require_no_errors(messages: Iterable[FmuMessage]) -> None:
    """Raise ModelError with the first error that an FMU reported and survived."""
    for message in messages:
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
