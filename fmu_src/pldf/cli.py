"""The command ``pldf``: finds the sub-command, prints errors in one or two lines.

Exit status: 0 done, 1 bad input, 2 wrong usage, 130 interrupted.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from importlib import import_module

from . import __version__
from .commands import COMMANDS
from .errors import ModelError


def build_parser(chosen: str | None) -> argparse.ArgumentParser:
    """Return the parser of all commands, with the arguments of the ``chosen`` one.

    Only that one's module is imported: together they take a second, and ``--help`` needs none.
    """
    parser = argparse.ArgumentParser(
        prog="pldf", description="A driving function that learns from its driver."
    )
    parser.add_argument("--version", action="version", version=f"pldf {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    for name, summary in COMMANDS.items():
        command = commands.add_parser(
            name,
            help=summary,
            description=summary,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        if name == chosen:
            module = import_module(f".commands.{name}", __package__)
            command.epilog = f"example:\n  {module.EXAMPLE}"
            module.configure(command)
            command.set_defaults(run=module.run)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run ``pldf`` with ``arguments`` (default: those of the process); return the exit status."""
    arguments = sys.argv[1:] if arguments is None else arguments
    # No option before the command takes a value, so the first word is the command.
    chosen = next((word for word in arguments if not word.startswith("-")), None)
    options = build_parser(chosen).parse_args(arguments)
    status = 0
    try:
        status = options.run(options) or 0
        sys.stdout.flush()
    except BrokenPipeError:  # the reader (head, a pager) has seen enough; that is no error
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except ModelError as error:
        print(f"pldf: {error}", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"pldf: {_refused(error)}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("pldf: interrupted", file=sys.stderr)
        return 130
    return status


def _refused(error: OSError) -> str:
    """Return what the operating system refused; where it names a file, what to look at."""
    if error.filename is None:
        return str(error)
    return (
        f"{error.filename}: cannot be read or written ({error.strerror}); check path and "
        "permissions"
    )


if __name__ == "__main__":
    sys.exit(main())
