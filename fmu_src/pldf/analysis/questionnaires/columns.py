"""Which columns of a questionnaire's file say what.

Long: a row per person and system, which stands in a column. Wide: a row per person, the system
stands behind the item in the column's name (``laan_1_A``).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final, NamedTuple

from ...files.tables import Fault, TableError
from .scales import SCALES, Asked, asked_by
from .survey_map import SurveyMap

GROUPS: Final = ("system", "phase")  # either says after which drives the answers were given

_TOLD_MAX: Final = 120  # characters of the header that an error repeats


class Columns(NamedTuple):
    """Which columns of a file say what; ``group`` is empty if the items' columns say it."""

    participant: str
    group: str
    asked: Mapping[str, Asked]


def columns_of(path: Path, header: Sequence[str], names: SurveyMap) -> Columns:
    """Return which columns are used; refuse a file in which some are missing or twice."""
    called = {one_line(name): name for name in header}
    asked = {}
    for name in header:
        what = names.items.get(name) or names.items.get(one_line(name))
        if one := asked_by(what or name):
            asked[name] = one
    group = names.system or next((name for name in GROUPS if name in header), "")
    named = (names.participant, names.system, *names.items, *names.only)
    missing = [name for name in named if name and one_line(name) not in called]
    faults = []
    if missing:
        text = f"missing column {', '.join(missing)}; {_there(header)}"
        faults.append(f"{text}; a mapping file says which column is which, [questionnaire]")
    faults += _faulty_groups(asked, group)
    faults += _faulty_scales(asked)
    if faults:
        raise TableError(path, [Fault(1, "", text) for text in faults])
    return Columns(called[one_line(names.participant)], called.get(one_line(group), ""), asked)


def _faulty_groups(asked: Mapping[str, Asked], group: str) -> Iterator[str]:
    """Yield what is wrong about where the systems stand."""
    wide = [name for name, one in asked.items() if one.group]
    if group and wide:
        yield (
            f"columns {group} and {wide[0]} both say after which system was asked; keep one of them"
        )
    whole = {(one.item, one.group): name for name, one in asked.items() if len(one.group) == 1}
    for name, (item, _, drive) in asked.items():
        if len(drive) > 1 and (system := whole.get((item, drive[0]))):
            yield f"columns {name} and {system}, a drive and its whole system; keep one of them"
    if not group and len(wide) < len(asked):
        long = next(name for name, one in asked.items() if not one.group)
        yield (
            f"missing column {' or '.join(GROUPS)}, and column {long} does not say after which "
            f"system was asked, as {long}_A would"
        )


def _faulty_scales(asked: Mapping[str, Asked]) -> Iterator[str]:
    """Yield which items are missing of a scale that is there in part, and which are twice."""
    if not asked:
        yield (
            "no items; columns are laan_1 .. laan_9, profile_1 .. profile_6, or what a mapping "
            "file says, [questionnaire.items]"
        )
    columns: dict[tuple[str, str], list[str]] = {}
    for name, one in asked.items():
        columns.setdefault((one.group, one.item), []).append(name)
    for (_, item), twice in columns.items():
        if len(twice) > 1:
            yield f"columns {' and '.join(twice)} are both {item}; keep one of them"
    for group in dict.fromkeys(group for group, _ in columns):
        for scale, items in SCALES.items():
            missing = [item for item in items if (group, item) not in columns]
            if 0 < len(missing) < len(items):
                absent = ", ".join(f"{item}_{group}" if group else item for item in missing)
                yield f"missing column {absent} of the scale {scale} ({', '.join(items)})"


def one_line(name: str) -> str:
    """Return a column's name with single blanks in it: a question's text may have line breaks."""
    return " ".join(name.split())


def _there(header: Sequence[str]) -> str:
    told = ", ".join(map(one_line, header))
    shown = told if len(told) <= _TOLD_MAX else f"{told[:_TOLD_MAX]} ..."
    return f"the file has {shown}"
