"""What a study file says of a study with people: texts, breaks, questionnaires, conditions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from markdown_it import MarkdownIt

from ..errors import ModelError
from ..study.study_file import Study, read_study, study_path
from ..study.study_tables import CockpitTable, StudyTables
from ..toml_file import TomlFile, listed, shown
from .questionnaires import PACKAGED, read_questionnaires

# The packaged study of people at a desk.
DESK: Final = "cockpit"
_TEXTS: Final = Path(__file__).parent / "texts"
_PAGES: Final = ("welcome", "consent", "thanks")
LANGUAGES: Final = ("en", "de")
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
        ModelError: naming file, line, key and the allowed values; all problems of questionnaires
            at once.
    """
    path = study_path(name)
    study = read_study(path)
    file = TomlFile(path)
    table = file.read(StudyTables).cockpit
    phases = [phase.name for phase in study.settings.phases]
    if not table.explanations:
        file.fail(("cockpit", "explanations"), 'empty; choose out of "none", "icon", "text"')
    return DeskStudy(
        study=study,
        table=table,
        pages={page: _pages(file, table, page) for page in _PAGES},
        breaks=_breaks(file, table, phases),
        questionnaires=_questionnaires(file, table),
    )


def as_html(markdown: str) -> str:
    """Return Markdown as HTML in which nothing can run: HTML in the text is shown as text."""
    return str(MarkdownIt("js-default").render(markdown))


def _pages(file: TomlFile, table: CockpitTable, page: str) -> dict[str, str]:
    """Return a text in both languages; the laboratory's own may be in one alone."""
    named: str | dict[str, str] = getattr(table, page)
    own = dict.fromkeys(LANGUAGES, named) if isinstance(named, str) else named
    return {
        language: _page(file, page, own.get(language, ""), f"{page}.{language}.md")
        for language in LANGUAGES
    }


def _page(file: TomlFile, page: str, own: str, packaged: str) -> str:
    path = file.path.parent / own if own else _TEXTS / packaged
    try:
        return as_html(path.read_text(encoding="utf-8-sig"))
    except (OSError, UnicodeDecodeError) as problem:
        reason = getattr(problem, "strerror", None) or "not a UTF-8 text file"
        file.fail(("cockpit", page), f"{path} cannot be read ({reason}); write it beside the study")


def _breaks(file: TomlFile, table: CockpitTable, phases: Sequence[str]) -> dict[str, float]:
    for phase, minutes in table.breaks.items():
        key = ("cockpit", "breaks", phase)
        if phase not in phases:
            file.fail(key, f"no drive of this study; known are {listed(phases)}")
        number = isinstance(minutes, int | float) and not isinstance(minutes, bool)
        if not number or not 0 < minutes <= _BREAK_MAX_MIN:
            file.fail(key, f"{shown(minutes)} must be minutes, above 0 and up to {_BREAK_MAX_MIN}")
    return {phase: float(minutes) for phase, minutes in table.breaks.items()}


def _questionnaires(file: TomlFile, table: CockpitTable) -> list[dict[str, Any]]:
    named = file.path.parent / table.questionnaires if table.questionnaires else PACKAGED
    try:
        return read_questionnaires(named, table.ask)
    except ModelError as problem:
        key = "questionnaires" if table.questionnaires else "ask"
        file.fail(("cockpit", key), str(problem))
