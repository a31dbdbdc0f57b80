"""What a study file says of a study with people: texts, breaks, questionnaires, conditions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final

from markdown_it import MarkdownIt

from ..errors import ModelError
from ..study.study_file import Study, read_study, study_path
from ..study.study_tables import CockpitTable, StudyTables
from ..toml_file import TomlFile, listed, shown
from .problems import Problems
from .questionnaires import PACKAGED, Asked, read_questionnaires

# The packaged study of people at a desk.
DESK: Final = "cockpit"
_TEXTS: Final = Path(__file__).parent / "texts"
_PAGES: Final = ("welcome", "consent", "thanks")
LANGUAGES: Final = ("en", "de")
_TABLE: Final = ("cockpit",)
_BREAK_MAX_MIN: Final = 24 * 60


@dataclass(frozen=True, eq=False)
class DeskStudy:
    """A study for people.

    Attributes:
        study: road, drives and parameters.
        table: the table ``[cockpit]`` of its file.
        pages: safe HTML of welcome, consent and thanks, by these names and by language.
        breaks: phase -> minutes of rest after it.
        questionnaires: in the form of the page.
    """

    study: Study
    table: CockpitTable
    pages: dict[str, dict[str, str]]
    breaks: dict[str, float]
    questionnaires: list[dict[str, Any]]


def read_desk_study(name: str = DESK) -> DeskStudy:
    """Read a study file for people: ``name`` is its path, or a packaged study.

    Raises:
        ModelError: naming file, line, key and the allowed values; of the table ``[cockpit]`` and
            of questionnaires all that is wrong.
    """
    path = study_path(name)
    file = TomlFile(path)
    problems = Problems()
    if isinstance(file.within("cockpit"), dict):
        for text in file.problems(CockpitTable, "cockpit"):
            problems.note(text)
    problems.finish()
    study = read_study(path)
    table = file.read(StudyTables).cockpit
    phases = [phase.name for phase in study.settings.phases]
    if not table.explanations:
        problems.wrong(file, (*_TABLE, "explanations"), 'empty; choose "none", "icon" or "text"')
    desk = DeskStudy(
        study=study,
        table=table,
        pages={page: _pages(file, table, page, problems) for page in _PAGES},
        breaks=_breaks(file, table, phases, problems),
        questionnaires=_questionnaires(file, table, phases, problems),
    )
    problems.finish()
    return desk


def as_html(markdown: str) -> str:
    """Return Markdown as HTML in which nothing can run: HTML in the text is shown as text."""
    return str(MarkdownIt("js-default").render(markdown))


def _pages(file: TomlFile, table: CockpitTable, page: str, problems: Problems) -> dict[str, str]:
    """Return a text in both languages; the laboratory's own may be in one alone."""
    named: str | dict[str, str] = getattr(table, page)
    own = dict.fromkeys(LANGUAGES, named) if isinstance(named, str) else named
    made = {}
    for language in LANGUAGES:
        packaged = _TEXTS / f"{page}.{language}.md"
        path = file.path.parent / own[language] if own.get(language) else packaged
        made[language] = problems.tried(partial(_page, file, page, path)) or ""
    return made


def _page(file: TomlFile, page: str, path: Path) -> str:
    try:
        return as_html(path.read_text(encoding="utf-8-sig"))
    except (OSError, UnicodeDecodeError) as problem:
        reason = getattr(problem, "strerror", None) or "not a UTF-8 text file"
        file.fail((*_TABLE, page), f"{path} cannot be read ({reason}); write it beside the study")


def _breaks(
    file: TomlFile, table: CockpitTable, phases: Sequence[str], problems: Problems
) -> dict[str, float]:
    good = {}
    for phase, minutes in table.breaks.items():
        key = (*_TABLE, "breaks", phase)
        number = isinstance(minutes, int | float) and not isinstance(minutes, bool)
        if phase not in phases:
            problems.wrong(file, key, f"no drive of this study; known are {listed(phases)}")
        elif not number or not 0 < minutes <= _BREAK_MAX_MIN:
            text = f"{shown(minutes)} must be minutes, above 0 and up to {_BREAK_MAX_MIN}"
            problems.wrong(file, key, text)
        else:
            good[phase] = float(minutes)
    return good


def _questionnaires(
    file: TomlFile, table: CockpitTable, phases: Sequence[str], problems: Problems
) -> list[dict[str, Any]]:
    named = file.path.parent / table.questionnaires if table.questionnaires else PACKAGED
    asked = Asked(file, table.ask, phases)
    try:
        return read_questionnaires(named, asked, problems)
    except ModelError as problem:  # it is not there, or no TOML
        problems.wrong(file, (*_TABLE, "questionnaires"), str(problem))
        return []
