"""``pldf export``: recordings for tools that do not read CSV."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Final

from ..recordings.exports import write_mdf4, write_parquet
from ..recordings.recording import read_recording
from .shared.mapping import add_map, chosen_map
from .shared.telling import tell

EXAMPLE: Final = "pldf export out/recordings/P001_B1.csv --parquet b1.parquet --mdf4 b1.mf4"


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``pldf export``."""
    parser.add_argument("recording", metavar="RECORDING.csv", type=Path)
    add_map(parser)
    parser.add_argument(
        "--parquet", type=Path, metavar="OUT", help="needs pip install 'adaptive-pldf[parquet]'"
    )
    parser.add_argument(
        "--mdf4", type=Path, metavar="OUT", help="needs pip install 'adaptive-pldf[mdf]'"
    )
    parser.set_defaults(wrong_usage=parser.error)


def run(options: argparse.Namespace) -> None:
    """Write what was asked for and say where it is."""
    chosen = [(write_parquet, options.parquet), (write_mdf4, options.mdf4)]
    wanted = [(write, path) for write, path in chosen if path]
    if not wanted:
        options.wrong_usage("say what to write: --parquet OUT, --mdf4 OUT or both")
    recording = read_recording(options.recording, chosen_map(options))
    tell(recording.notes)
    for write, path in wanted:
        write(path, recording)
        print(f"{len(recording)} rows, {len(recording.columns)} columns in {path}")
