"""``table.h``: every size, code, number and text that Python defines and C needs, too."""

from __future__ import annotations

from dataclasses import fields
from typing import Final

from ... import own_recording
from ...driver_words import WORD_TEXTS
from ...fmi.phases import Phase
from ...fmi.session import STEP_MAX_S
from ...function_words import OLDER_READING
from ...kernel.arrays import NextArrays, TraceArrays
from ...kernel.codes import (
    BOUND,
    EVIDENCE_BY,
    EVIDENCE_CHANGE,
    LANGUAGE,
    LOCALIZATION,
    OUTCOME,
    PROFILE_STATUS,
    WORD_FORGET,
    WORD_UNDO,
)
from ...kernel.sentences import EVENT_SENTENCES, EVENTS, NUMBERS, REASONS
from ...kernel.signals import parameters_of
from ...kernel.units import KMH_PER_MPS
from ...outcome_words import HOLDS_TOLD, TEXTS, TRANSITION_MIN_M
from ...outcomes import SAME_OFFSET_MPS
from ...profiles.file_parts import ALIGNMENT, CHECKSUM_SIZE, COLUMNS, NODES_MAX
from ...profiles.learned_columns import LEARNED
from ...profiles.older_reading import ALIKE_MPS, ALIKE_SHARE, LENGTH_SHARE
from ...profiles.profile_format_1 import COLUMNS_1
from ...profiles.stored_profile import KINDS
from ...roads.marks import KIND_WORDS, NAME_BYTES_MAX
from .c_source import literal, number
from .model import NativeModel

_CODES: Final = {
    "LOCALIZATION": LOCALIZATION,
    "PROFILE_STATUS": PROFILE_STATUS,
    "OUTCOME": OUTCOME,
    "BOUND": BOUND,
    "LANGUAGE": LANGUAGE,
    "EVIDENCE": EVIDENCE_CHANGE,
    "BY": EVIDENCE_BY,
}
# Bytes of the longest sentence in UTF-8, with all its numbers and the end.
SENTENCE_SIZE: Final = 64 * (len(NUMBERS) + 1) + max(
    len(text.encode()) for row in (*REASONS, *EVENTS) for text in (row.english, row.german)
)


def header(model: NativeModel) -> str:
    """Return ``table.h``: the sizes and codes that the compiler must know."""
    sizes = {
        "MODEL_CELLS": len(fields(model.record)),
        "WATCHES": len(model.watches),
        "MODEL_TEXTS": len(parameters_of(model.texts)),
        "REASON_COUNT": len(REASONS),
        "EVENT_COUNT": len(EVENTS),
        "EVENT_SENTENCES": EVENT_SENTENCES,
        "SENTENCE_NUMBERS": len(NUMBERS),
        "SENTENCE_DRIVE": NUMBERS.index("drive"),
        "SENTENCE_SIZE": SENTENCE_SIZE,
        "ROUTE_COLUMNS": len(model.route._fields),
        "PROFILE_COLUMNS": len(COLUMNS),
        "COLUMN_BASE": _column_at("base_mps"),
        "COLUMN_LEARNED": _column_at(LEARNED[0]),
        "COLUMN_OFFSET": _column_at("offset_mps"),
        "COLUMN_DRIVE": _column_at("drive"),
        "KERNEL_COLUMNS": len(LEARNED),
        "FORMAT_1_COLUMNS": len(COLUMNS_1),
        "PROFILE_KINDS": len(KINDS),
        "WORD_FORGET": WORD_FORGET,
        "WORD_UNDO": WORD_UNDO,
        "MARK_KINDS": len(KIND_WORDS),
        "NAME_BYTES_MAX": NAME_BYTES_MAX,
        "NODES_MAX": NODES_MAX,
        "ALIGNMENT": ALIGNMENT,
        "CHECKSUM_SIZE": CHECKSUM_SIZE,
        "HOLDS_TOLD": HOLDS_TOLD,
        "TRANSITION_MIN_M": TRANSITION_MIN_M,
        **{f"TRACE_{name.upper()}": at for at, name in enumerate(TraceArrays._fields)},
        **{f"NEXT_{name.upper()}": at for at, name in enumerate(NextArrays._fields)},
    }
    lines = [f"enum {{ {name} = {size} }};" for name, size in sizes.items()]
    for prefix, codes in _CODES.items():
        names = (f"{prefix}_{item}" for item in codes.items)
        lines.append(f"enum {{ {', '.join(names)} }};")
    lines.append(f"typedef enum {{ {', '.join(phase.name for phase in Phase)} }} Phase;")
    numbers = {
        "STEP_MAX_S": STEP_MAX_S,
        "KMH_PER_MPS": KMH_PER_MPS,
        "SAME_OFFSET_MPS": SAME_OFFSET_MPS,
        "LENGTH_SHARE": LENGTH_SHARE,
        "ALIKE_SHARE": ALIKE_SHARE,
        "ALIKE_MPS": ALIKE_MPS,
        "RECORDING_ROW_S": own_recording.ROW_S,
        "RECORDING_ROWS_MAX": own_recording.ROWS_BETWEEN_MAX,
    }
    lines += [f"#define {name} {number(value)}" for name, value in numbers.items()]
    lines.append(f"#define RECORDING_VARIABLE {literal(own_recording.FOLDER_VARIABLE)}")
    recording = {
        "RECORDING_HEAD": own_recording.HEAD,
        "RECORDING_WRITTEN": own_recording.WRITTEN,
        "RECORDING_NOT_WRITTEN": own_recording.NOT_WRITTEN,
        "RECORDING_NOT_WRITABLE": own_recording.NOT_WRITABLE,
    }
    texts = {**TEXTS, **WORD_TEXTS, **recording, "OLDER_READING": OLDER_READING}
    lines += [f"#define TEXT_{name} {literal(text)}" for name, text in texts.items()]
    return "\n".join([*lines, ""])


def _column_at(name: str) -> int:
    return [column.name for column in COLUMNS].index(name)
