"""Columns of a recording whose titles are almost our names."""

from __future__ import annotations

from dataclasses import replace

from ..files.tables import meant_names, misspelt, told_meant, told_misspelt
from ..findings import Finding
from .columns import LABORATORY, RECORDING
from .inputs import Input
from .mapping import RecordingMap, Source


def with_meant_names(file: Input, mapping: RecordingMap, notes: list[Finding]) -> RecordingMap:
    """Return ``mapping`` with titles that are our names but for capitals; tell what is alike."""
    ours = [column.name for column in LABORATORY.columns if column.name not in mapping.columns]
    meant = meant_names(file.names, ours)
    for title, name in meant.items():
        notes.append(Finding("note", str(file.path), 0, name, told_meant(title, name)))
    absent = [name for name in ours if name not in file.names and name not in meant.values()]
    others = [name for name in file.names if name not in meant and name not in RECORDING.names]
    for title, name in misspelt(others, absent).items():
        notes.append(Finding("warning", str(file.path), 0, name, told_misspelt(title, name)))
    sources = {name: Source(0, (title,)) for title, name in meant.items()}
    return replace(mapping, columns={**mapping.columns, **sources})
