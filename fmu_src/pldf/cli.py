"""The command ``pldf``: finds the sub-command, prints errors in one or two lines.

Exit status: 0 done, 1 bad input, 2 wrong usage, 130 interrupted.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Final

from . import __version__
from .instance import ModelError

COMMANDS: Final = (
    "build",
    "route",
    "script",
    "drive",
    "learn",
    "plot",
    "profiles",
    "study",
    "analyse",
    "export",
)


def build_parser() -> argparse.ArgumentParser:
    """Return the parser with every command's arguments."""
    parser = argparse.ArgumentParser(
        prog="pldf", description="A driving function that learns from its driver."
    )
    parser.add_argument("--version", action="version", version=f"pldf {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    for name in COMMANDS:
        module = import_module(f".commands.{name}", __package__)
        command = commands.add_parser(
            name,
            help=module.SUMMARY,
            description=module.SUMMARY,
            epilog=f"example:\n  {module.EXAMPLE}",
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        module.configure(command)
        command.set_defaults(run=module.run)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run ``pldf`` with ``arguments`` (default: those of the process); return the exit status."""
    options = build_parser().parse_args(arguments)
    try:
        options.run(options)
        sys.stdout.flush()
    except BrokenPipeError:  # the reader (head, a pager) has seen enough; that is no error
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except (ModelError, OSError) as error:
        print(f"pldf: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("pldf: interrupted", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
