"""What a study file says of a study with people."""

from __future__ import annotations

from pathlib import Path

import pytest
from pldf.cockpit.desk_study import DeskStudy, as_html, read_desk_study
from pldf.errors import ModelError


def desk(folder: Path, text: str) -> DeskStudy:
    path = folder / "my.toml"
    path.write_text(text, encoding="utf-8")
    return read_desk_study(str(path))


def test_the_packaged_study() -> None:
    packaged = read_desk_study()
    assert packaged.study.out == Path("out/cockpit")
    assert [phase.name for phase in packaged.study.settings.phases] == [
        "A1",
        "A2",
        "A3",
        "B1",
        "B2",
        "B3",
    ]
    assert packaged.study.settings.counterbalanced
    assert [one["id"] for one in packaged.questionnaires] == [
        "acceptance",
        "speed_profile",
        "remarks",
    ]
    assert "<h1>Welcome</h1>" in packaged.pages["welcome"]["en"]
    assert "<h1>Willkommen</h1>" in packaged.pages["welcome"]["de"]


def test_an_empty_file_is_a_study_for_people_too(tmp_path: Path) -> None:
    table = desk(tmp_path, "").table
    assert (table.practice, table.explanations, table.steering) == (1, ("text",), "assisted")


ALL = """
[cockpit]
language = "de"
welcome = "hello.md"
consent = { de = "hello.md" }
questionnaires = "ask.toml"
practice = 0
practice_end_m = 500
explanations = ["none", "icon", "text"]
steering = "person"
fov_deg = 100.5
[cockpit.breaks]
A3 = 5
[cockpit.ask]
nasa_tlx = ["A", "B"]
"""


def test_all_that_can_be_said(tmp_path: Path) -> None:
    (tmp_path / "hello.md").write_text("Guten *Tag*", encoding="utf-8")
    (tmp_path / "ask.toml").write_text('include = ["remarks"]\n', encoding="utf-8")
    found = desk(tmp_path, ALL)
    hello = "<p>Guten <em>Tag</em></p>\n"
    assert found.pages["welcome"] == {"en": hello, "de": hello}
    assert found.pages["consent"]["de"] == hello
    assert "Your consent" in found.pages["consent"]["en"]
    assert found.breaks == {"A3": 5.0}
    assert [one["id"] for one in found.questionnaires] == ["remarks", "nasa_tlx"]
    assert found.table.fov_deg == 100.5


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("[cockpit]\npractise = 2", "line 2, cockpit.practise: unknown; did you mean practice"),
        ("[cockpit]\npractice = 10", "line 2, cockpit.practice: 10 must be a whole number from 0"),
        ("[cockpit]\nfov_deg = 5", "line 2, cockpit.fov_deg: 5 must be a number from 20 to 150"),
        ("[cockpit]\nexplanations = []", "line 2, cockpit.explanations: empty"),
        ('[cockpit]\nexplanations = ["all"]', 'cockpit.explanations: "all" must be one of "none"'),
        ('[cockpit]\nsteering = "auto"', 'cockpit.steering: "auto" must be one of "assisted"'),
        ('[cockpit]\nwelcome = "none.md"', r"cockpit.welcome: .*none\.md cannot be read"),
        ("[cockpit]\nthanks = 3", "cockpit.thanks: 3 must be the name of a file in quotes, or"),
        (
            '[cockpit]\nthanks = { fr = "x" }',
            r'line 2, cockpit.thanks: { fr = "x" } must be the name',
        ),
        ("[cockpit]\nthanks = { en = 3 }", r"line 2, cockpit.thanks: { en = 3 } must be the name"),
        ('[cockpit]\nquestionnaires = "none.toml"', "line 2, cockpit.questionnaires: .*cannot be"),
        (
            "[cockpit.breaks]\nA9 = 5",
            'line 2, cockpit.breaks.A9: no drive of this study; known are "A1"',
        ),
        ("[cockpit.breaks]\nA1 = true", "cockpit.breaks.A1: true must be minutes"),
        ('[cockpit.ask]\nssq = ["now"]', r'line 2, cockpit.ask.ssq: \["now"\] must be a list'),
        ('[cockpit.ask]\nsqq = ["A"]', "line 2, cockpit.ask.sqq: unknown; did you mean ssq?"),
        (
            '[drives]\nphases = ["A2", "B1"]\n[cockpit.ask]\nssq = ["A3"]',
            r'line 4, cockpit.ask.ssq: \["A3"\] must be a list out of "A2", "B1", "start"',
        ),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, text: str, problem: str) -> None:
    with pytest.raises(ModelError, match=problem):
        desk(tmp_path, text)


WRONG = """
[cockpit]
practise_end_m = 3
explanation = "text"
language = "fr"
fov_deg = 5
"""
WRONG_TOO = """
[cockpit]
explanations = []
welcome = "none.md"
[cockpit.breaks]
A1 = 0
A9 = 1
[cockpit.ask]
sqq = ["A"]
ssq = ["begin"]
"""


@pytest.mark.parametrize(
    ("text", "keys"),
    [
        (WRONG, ("practise_end_m", "explanation", "language", "fov_deg")),
        (WRONG_TOO, ("explanations", "welcome", "breaks.A1", "breaks.A9", "ask.sqq", "ask.ssq")),
    ],
)
def test_all_that_is_wrong_is_told_at_once(
    tmp_path: Path, text: str, keys: tuple[str, ...]
) -> None:
    with pytest.raises(ModelError) as refused:
        desk(tmp_path, text)
    for key in keys:
        assert f", cockpit.{key}: " in str(refused.value)


@pytest.mark.parametrize(
    "text",
    [
        "<script>alert(1)</script>",
        '<img src=x onerror="alert(1)">',
        "[click](javascript:alert(1))",
        "[click](data:text/html;base64,PHNjcmlwdD4=)",
        "![x](javascript:alert(1))",
        "<a href='javascript:alert(1)'>x</a>",
    ],
)
def test_nothing_in_a_text_can_run(text: str) -> None:
    html = as_html(text)
    for tag in ("<script", "<img", "<a "):
        assert tag not in html
