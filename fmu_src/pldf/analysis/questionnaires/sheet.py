"""The rows of a questionnaire's file: which are answers, by whom, after which drives.

Qualtrics has three lines of header (names, the text of the question, the id for import as JSON),
SoSci Survey may have two (names, labels); both are recognised.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import nan
from pathlib import Path
from typing import Final, NamedTuple

from ...files.tables import Column, Fault, Format, Table, read_header, read_table
from ...findings import Finding
from .columns import Columns, columns_of
from .labels import boxes_of, plain
from .scales import SCALES
from .survey_map import SurveyMap

_IMPORT_ID: Final = re.compile(r'\{"?"ImportId"?":', re.IGNORECASE)
_SOSCI: Final = ("CASE", "QUESTNNR")
_HEADING_MAX: Final = 2  # rows below the first line
_GROUP: Final = re.compile("[AB][0-9]*")
_NO_GROUP: Final = (
    "not a system, A or B, or one of its drives, such as A1; correct it, or say in a mapping file "
    "what it means, [questionnaire.systems]"
)
_CELL_MAX: Final = 40  # characters of a wrong answer that an error repeats
_TICKED: Final = (
    "the number of a box, 1 (left) to 5 (right), nor a known label; correct it, or say in a "
    "mapping file which box it is, [questionnaire.answers], or that it is none, missing"
)


# Says of a participant and a drive, or of the participant if that is empty, whether not to count.
LeftOut = Callable[[str, str], bool]


class Filled(NamedTuple):
    """One questionnaire that somebody filled in.

    Attributes:
        line: in the file.
        participant: who.
        group: after which system or drive.
        scored: item -> score, the favourable answer being the higher one; NaN if not answered.
    """

    line: int
    participant: str
    group: str
    scored: Mapping[str, float]


@dataclass(frozen=True)
class Sheet:
    """All questionnaires of a file.

    Attributes:
        filled: in the order of the file.
        scales: those whose items the file asks.
        notes: how it was read.
    """

    filled: Sequence[Filled]
    scales: Sequence[str]
    notes: Sequence[Finding]


def read_sheet(
    path: Path, left_out: LeftOut, names: SurveyMap, known_as: Callable[[str], str]
) -> Sheet:
    """Read the questionnaires in the file ``path``; arguments as of ``read_questionnaire``.

    Raises:
        ModelError: naming file, line, column and value of all that is missing or no answer.
    """
    header = read_header(path)
    columns = columns_of(path, header, names)
    others = [name for name in (*_SOSCI, *names.only) if name in header]
    used = dict.fromkeys((columns.participant, columns.group, *columns.asked, *others))
    form = Format(
        "questionnaire",
        "answer",
        tuple(Column(name, "text", blank=True) for name in used if name),
        rows_min=0,
        key=tuple(filter(None, (columns.participant, columns.group))),
    )
    table = read_table(path, form, lambda row: left_out(row[columns.participant], ""))
    people = table.texts[columns.participant]
    people[:] = [known_as(name) if name else "" for name in people]
    heading = _heading(table, columns, names)
    counted = [row for row in range(heading, len(table)) if _counts(table, row, names)]
    rows = [row for row in counted if not _is_empty(table, row, columns, names)]
    groups = _groups(table, rows, columns, names)
    scored, told = _scored(table, rows, columns, names)
    asked = {one.item for one in columns.asked.values()}
    return Sheet(
        [
            one
            for one in _filled(table, groups, columns, scored)
            if not left_out(one.participant, one.group if len(one.group) > 1 else "")
        ],
        [scale for scale, items in SCALES.items() if asked.issuperset(items)],
        [*table.notes, *_notes(table, heading, len(counted), len(rows)), *told],
    )


def _heading(table: Table, columns: Columns, names: SurveyMap) -> int:
    """Return how many rows below the first line still belong to the header."""
    if names.header_lines:
        return min(names.header_lines - 1, len(table))
    for row in range(min(_HEADING_MAX, len(table))):
        if _IMPORT_ID.match(table.texts[columns.participant][row]):
            return row + 1
    sosci = all(name in table for name in _SOSCI)
    return int(sosci and len(table) > 0 and not table.texts[_SOSCI[0]][0].isdigit())


def _counts(table: Table, row: int, names: SurveyMap) -> bool:
    """Tell whether ``row`` is one of those that the map wants."""
    return all(plain(table.texts[name][row]) in texts for name, texts in names.only.items())


def _is_empty(table: Table, row: int, columns: Columns, names: SurveyMap) -> bool:
    """Tell whether nothing is answered in ``row``, such as that of a visit without questions."""
    return all(plain(table.texts[name][row]) in names.missing for name in columns.asked)


def _notes(table: Table, heading: int, counted: int, filled: int) -> Iterator[Finding]:
    """Yield which rows are no answers."""
    if heading:
        more = f"its first {heading + 1} lines" if heading > 1 else "its first two lines"
        what = "names, texts and import ids" if heading > 1 else "names and labels"
        yield _note(table.path, f"{more} are the header: {what}")
    if others := len(table) - heading - counted:
        yield _note(table.path, f"{others} rows passed over, as the mapping file wants ('only')")
    if not filled:
        text, cost = "no answers below the header", "nobody has a score"
        yield Finding("warning", str(table.path), 0, "", text, cost, "export the answers again")
    if empty := counted - filled:
        yield _note(table.path, f"{empty} rows without any answer passed over")


def _note(path: Path, text: str, place: str = "") -> Finding:
    return Finding("note", str(path), 0, place, text)


def _groups(
    table: Table, rows: Sequence[int], columns: Columns, names: SurveyMap
) -> dict[int, str]:
    """Return after which system or drive each row was answered, empty if its columns say so.

    Refuses rows without participant or system, and what was answered twice.
    """
    groups = dict.fromkeys(rows, "")
    faults = []
    first: dict[tuple[str, str], int] = {}
    for row in rows:
        participant = table.texts[columns.participant][row]
        if not participant:
            text = "'' is not the name of a participant; enter it or delete the line"
            faults.append(table.fault(row, columns.participant, text))
            continue
        if columns.group:
            text = table.texts[columns.group][row]
            groups[row] = names.systems.get(plain(text), text.upper())
            if not _GROUP.fullmatch(groups[row]):
                faults.append(table.fault(row, columns.group, f"{text!r} is {_NO_GROUP}"))
        line = first.setdefault((participant, groups[row]), table.lines[row])
        if line != table.lines[row]:
            faults.append(table.fault(row, "", f"answered in line {line} already"))
    table.refuse(faults)
    table.refuse(_mixed(table, groups, columns))
    return groups


def _mixed(table: Table, groups: Mapping[int, str], columns: Columns) -> Iterator[Fault]:
    """Yield the drives of those who answered for the system as a whole, too."""
    people = table.texts[columns.participant]
    whole = {(people[row], group): table.lines[row] for row, group in groups.items()}
    for row, group in groups.items():
        if len(group) > 1 and (line := whole.get((people[row], group[0]))):
            text = f"line {line} has the answers for system {group[0]} as a whole; keep one of them"
            yield table.fault(row, columns.group, text)


def _scored(
    table: Table, rows: Sequence[int], columns: Columns, names: SurveyMap
) -> tuple[dict[str, list[float]], list[Finding]]:
    """Return the scores of each column, NaN for no answer, and how its answers were read."""
    cells = {name: [plain(table.texts[name][row]) for row in rows] for name in columns.asked}
    texts: dict[str, list[str]] = {}
    for name, asked in columns.asked.items():
        texts.setdefault(asked.item, []).extend(cells[name])
    boxes = boxes_of(texts, names.answers, names.missing)
    table.refuse(
        table.fault(row, name, f"{table.texts[name][row][:_CELL_MAX]!r} is not {_TICKED}")
        for name, asked in columns.asked.items()
        for row, answer in zip(rows, cells[name], strict=True)
        if answer not in names.missing and (asked.item, answer) not in boxes
    )
    scored = {
        name: [
            nan if answer in names.missing else asked.scored(boxes[asked.item, answer])
            for answer in cells[name]
        ]
        for name, asked in columns.asked.items()
    }
    return scored, list(_labels_told(table.path, boxes))


def _labels_told(path: Path, boxes: Mapping[tuple[str, str], float]) -> Iterator[Finding]:
    """Yield which answers were no numbers, and which boxes they were taken for."""
    words = {answer: int(box) for (_, answer), box in boxes.items() if answer != f"{box:g}"}
    if words:
        told = ", ".join(f"{a} = {box}" for a, box in sorted(words.items(), key=lambda one: one[1]))
        yield _note(path, f"answers read as boxes: {told}")


def _filled(
    table: Table,
    groups: Mapping[int, str],
    columns: Columns,
    scored: Mapping[str, Sequence[float]],
) -> Iterator[Filled]:
    """Yield the questionnaires, one per row and group."""
    for place, (row, group) in enumerate(groups.items()):
        items: dict[str, dict[str, float]] = {}
        for name, asked in columns.asked.items():
            items.setdefault(group or asked.group, {})[asked.item] = scored[name][place]
        for answered_for, scores in items.items():
            participant = table.texts[columns.participant][row]
            yield Filled(table.lines[row], participant, answered_for, scores)
