"""docs/cluster.md has the table of sentences, every row as it is."""

from __future__ import annotations

from pathlib import Path

import pytest
from pldf.kernel.sentences import EVENTS, REASONS, Sentence

PAGE = Path(__file__).parents[1] / "docs" / "cluster.md"
HEAD = (
    "| code | name | priority | icon | English | German | said when |\n"
    "|---|---|---|---|---|---|---|\n"
)


def table(rows: tuple[Sentence, ...]) -> str:
    """Return the rows as the page has them."""
    lines = (
        f"| {code} | {row.name} | {row.priority} | {row.icon} | {row.english} | {row.german} "
        f"| {row.meaning} |\n"
        for code, row in enumerate(rows)
    )
    return HEAD + "".join(lines)


@pytest.mark.parametrize("rows", [REASONS, EVENTS], ids=["reasons", "events"])
def test_the_page_has_the_table(rows: tuple[Sentence, ...]) -> None:
    assert table(rows) in PAGE.read_text(encoding="utf-8"), f"write:\n{table(rows)}"
