"""``pldf cockpit``: people drive the study road in a browser, on the same FMUs."""

from __future__ import annotations

import argparse
import socket
import sys
import webbrowser
from contextlib import suppress
from math import nan
from pathlib import Path
from typing import Any, Final

from ..cockpit.desk_study import DESK, LANGUAGES, DeskStudy, read_desk_study
from ..study.study_tables import FOV_MAX_DEG, FOV_MIN_DEG
from .shared.telling import tell

EXAMPLE: Final = (
    "pldf cockpit\n"
    "      drive in the browser: at once, or the whole study at a desk, into out/cockpit\n"
    "  pldf cockpit my_study.toml --out laboratory --language de\n"
    "      a study of one's own; then: pldf analyse laboratory\n"
    "  pldf cockpit my_study.toml --export cockpit.html\n"
    "      one file that needs neither pldf nor network; then: pldf analyse pldf-cockpit.zip"
)
# The drives whose interventions are compared (docs/study-data.md).
_COMPARED: Final = ("A1", "A2", "B1", "B2")


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``pldf cockpit``."""
    parser.add_argument(
        "file", nargs="?", metavar="STUDY.toml", default=DESK,
        help="study file, whose table [cockpit] says what people read and are asked (default: "
        f"'{DESK}', the packaged study on the study road)",
    )  # fmt: skip
    parser.add_argument(
        "--out", type=Path, metavar="FOLDER",
        help="recordings, profiles and answers (default: STUDY.toml's output); a study that was "
        "begun there goes on",
    )  # fmt: skip
    parser.add_argument(
        "--export", type=Path, metavar="HTML",
        help="write the page as one file instead, which keeps its data in the browser",
    )  # fmt: skip
    parser.add_argument(
        "--language", choices=LANGUAGES, default="", help="of the page (default: STUDY.toml's)"
    )
    parser.add_argument(
        "--fov", type=_field_of_view, metavar="DEG",
        help="horizontal field of view of the screen: 2 atan(width / (2 distance)) (default: "
        "STUDY.toml's)",
    )  # fmt: skip
    parser.add_argument(
        "--bind", metavar="ADDRESS", default="127.0.0.1",
        help="also let other machines in, for a cluster on a tablet: 0.0.0.0 or an address of this "
        "machine (default: this machine only)",
    )  # fmt: skip
    parser.add_argument(
        "--no-browser", dest="browser", action="store_false", help="only print the address"
    )
    parser.set_defaults(wrong_usage=parser.error)


def run(options: argparse.Namespace) -> None:
    """Serve the page until Ctrl-C, or write it."""
    if options.export and options.out:
        options.wrong_usage("--out: an exported page keeps its data in the browser")
    from ..cockpit.bundle import bundle  # noqa: PLC0415 - slow to import
    from ..cockpit.page_json import as_json  # noqa: PLC0415

    desk = read_desk_study(options.file)
    tell(desk.study.notes)
    _warn_of_missing_drives(desk)
    told = bundle(desk, options.language, _announce)
    if options.fov is not None:
        told["plan"]["fov_deg"] = options.fov
    if options.export:
        from ..cockpit.export import write_export  # noqa: PLC0415

        write_export(options.export, as_json(told))
        size_mb = options.export.stat().st_size / 1e6
        print(f"{options.export}: {size_mb:.1f} MB; open it in a browser, on any machine.")
        return
    _serve(options, desk, told)


def _warn_of_missing_drives(desk: DeskStudy) -> None:
    """Say before anybody drives what the analysis would say afterwards."""
    there = {phase.name for phase in desk.study.settings.phases}
    absent = [name for name in _COMPARED if name not in there]
    if absent:
        _announce(
            f"{desk.study.title}: no drive {', '.join(absent)}, and pldf analyse compares "
            f"{', '.join(_COMPARED)}; write them into [drives] phases"
        )


def _serve(options: argparse.Namespace, desk: DeskStudy, told: dict[str, Any]) -> None:
    from ..cockpit.guard import LOOPBACK  # noqa: PLC0415 - as above
    from ..cockpit.page_json import as_json, beside_data  # noqa: PLC0415
    from ..cockpit.server import Cockpit, listen, serve  # noqa: PLC0415
    from ..cockpit.storage import Folder  # noqa: PLC0415

    out = options.out or desk.study.out
    cockpit = Cockpit(as_json(told), out, options.bind)
    if Folder(out, beside_data(told)).of_another_study:
        _announce(
            f"{out}: was begun with another study file or road ({', '.join(told['beside'])}); who "
            "begins now drives by the new one. A folder of its own: --out"
        )
    with listen(options.bind) as listening:
        port = listening.getsockname()[1]
        address = f"http://{_name(options.bind)}:{port}/{cockpit.token}/"
        if options.bind not in LOOPBACK:
            print(
                f"pldf: --bind {options.bind}: whoever is in this network and has the address can "
                "drive, read and write the study's data, and it travels unencrypted; use a "
                "network of your own",
                file=sys.stderr,
            )
        print(f"{desk.study.title}: {address}", flush=True)
        print(f"experimenter: {address}experimenter.html", flush=True)
        print(f"cluster on a second screen: {address}cluster.html", flush=True)
        print(f"Data go to {cockpit.folder}. Ctrl-C ends.", flush=True)
        if options.browser:
            webbrowser.open(address)
        with suppress(KeyboardInterrupt):
            serve(cockpit, listening)
    if cockpit.folder.exists():
        print(f"Look at the result with: pldf analyse {cockpit.folder}")


def _field_of_view(text: str) -> float:
    try:
        degrees = float(text)
    except ValueError:
        degrees = nan
    if not FOV_MIN_DEG <= degrees <= FOV_MAX_DEG:
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a number from {FOV_MIN_DEG:g} to {FOV_MAX_DEG:g}, in degrees"
        )
    return degrees


def _announce(what: str) -> None:
    print(f"pldf: {what}", file=sys.stderr, flush=True)


def _name(bind: str) -> str:
    """Return how the machine is called in an address."""
    if bind in ("0.0.0.0", "::"):
        return socket.gethostname()
    return f"[{bind}]" if ":" in bind else bind
