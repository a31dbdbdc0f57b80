"""The folders of a study: its own, or one for each variant, all driven as one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from ..cosim.fmu import Fmu
from .own_files import COMPARED
from .results import StudyResults
from .study_file import Study


def open_folders(
    study: Study, out: Path, fmus: Mapping[str, Fmu] | None, restart: bool
) -> tuple[list[StudyResults], list[str]]:
    """Make the folders ready that a study is driven into: ``out``, or within it one per variant.

    Args:
        study: to be driven.
        out: where its results go.
        fmus: what drives; None: the kernels.
        restart: forget what was driven before.

    Returns:
        The folders, and what was put aside since it is damaged, a sentence each.

    Raises:
        ModelError: a folder is that of something else, or cannot be written.
    """
    variants = study.variants or {"": study}
    folders = [StudyResults(one, out / name, fmus) for name, one in variants.items()]
    notes = [note for folder in folders for note in folder.open(restart)]
    if restart and study.variants:
        for name in COMPARED:
            (out / name).unlink(missing_ok=True)
    return folders, notes


def missing_in(folders: Sequence[StudyResults]) -> int:
    """Return how many participants have no results yet; who drives n variants counts n times."""
    return sum(len(folder.missing()) for folder in folders)
