"""What a study with variants shows: rates and errors of each drive, as a table and a figure."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..analysis.long_run import read_long_run, write_long_run
from ..study.own_files import COMPARED, DRIVES
from ..study.results import StudyResults
from . import figures, paper


def compare_variants(folders: Sequence[StudyResults], out: Path) -> list[Path]:
    """Compare the variants, driven into ``folders``, in a table and a picture in ``out``.

    Returns:
        The paths of both.

    Raises:
        ModelError: a file of the results cannot be used, or the picture cannot be written.
    """
    table, picture = (out / name for name in COMPARED)
    write_long_run(table, {folder.out.name: folder.out / DRIVES for folder in folders})
    paper.save(picture, figures.long_run(read_long_run(table)))
    return [table, picture]
