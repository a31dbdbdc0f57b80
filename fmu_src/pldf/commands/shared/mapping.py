"""How a mapping file is named and remembered."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from ...errors import ModelError
from ...files.disk import reason, replace_file
from ...recordings.mapping import MAP_FILE, RecordingMap, map_bytes, read_map, ready_maps


def add_map(parser: argparse.ArgumentParser) -> None:
    """Add the argument that names a mapping file."""
    parser.add_argument(
        "--map",
        metavar="MAP",
        help="mapping file (TOML): which columns are ours, in which units; or a ready map: "
        f"{', '.join(ready_maps())} (default: {MAP_FILE} beside a recording or in the folder of "
        "its study)",
    )


def chosen_map(options: argparse.Namespace) -> RecordingMap | None:
    """Return the map that was named; None if none was."""
    return read_map(options.map) if options.map else None


def remember_map(options: argparse.Namespace, folder: Path) -> None:
    """Keep the map that was named in the folder of a study, unless there is one already.

    Raises:
        ModelError: the folder cannot be written.
    """
    kept = folder / MAP_FILE
    if not options.map or not folder.is_dir():
        return
    content = map_bytes(options.map)
    try:
        if not kept.exists():
            replace_file(kept, content)
            print(f"pldf: the map is kept as {kept} and read without --map next time")
        elif kept.read_bytes() != content:
            text = f"--map {options.map} counts this time; copy it there to have it count always"
            print(f"pldf: {kept} is another map and is left as it is; {text}", file=sys.stderr)
    except OSError as error:
        raise ModelError(f"{kept}: cannot be written ({reason(error)})") from error
