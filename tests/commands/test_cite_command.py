"""``pldf cite``: BibTeX from ``CITATION.cff``, which is the one source."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import yaml
from pldf import __version__, cli
from pldf.commands import cite
from pldf.errors import ModelError

FILE = Path(__file__).parents[2] / "CITATION.cff"


def entries(text: str) -> dict[str, dict[str, str]]:
    """Return the fields of each entry by its kind; a reader of BibTeX in a few lines."""
    found = re.findall(r"^@(\w+)\{(\w+),\n(.*?)^\}$", text, re.MULTILINE | re.DOTALL)
    fields = re.compile(r"^  (\w+) = \{(.*)\},$", re.MULTILINE)
    return {kind: {"key": key, **dict(fields.findall(body))} for kind, key, body in found}


def test_paper_and_software_are_cited(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["cite"]) == 0
    text = capsys.readouterr().out
    assert text.count("{") == text.count("}")
    found = entries(text)
    assert found["misc"] == {
        "key": "schwager2026",
        "title": "{Improving Driver Satisfaction with a Driving Function Learning from Implicit "
        "Human Feedback - a Test Group Study}",
        "author": "Schwager, Robin and Anastasio, Andrea and others",
        "year": "2026",
        "eprint": "2602.13733",
        "archivePrefix": "arXiv",
        "url": "https://arxiv.org/abs/2602.13733",
    }
    software = found["software"]
    assert software["title"].startswith("{Adaptive PLDF: ")
    assert software["author"] == "{The Adaptive PLDF authors}"
    assert software["version"] == __version__


def test_the_installed_citation_is_that_of_the_sources_and_of_this_version() -> None:
    source = yaml.safe_load(FILE.read_text(encoding="utf-8"))
    assert cite.read_citation() == source
    assert source["version"] == __version__


def test_year_and_address_follow_when_they_are_known() -> None:
    citation = {
        **cite.read_citation(),
        "date-released": "2026-11-25",
        "repository-code": "https://example.org/pldf",
    }
    fields = entries(cite.software_entry(citation))["software"]
    assert (fields["year"], fields["url"]) == ("2026", "https://example.org/pldf")


def test_a_package_without_its_citation_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cite, "files", lambda _: None)
    with pytest.raises(ModelError, match=r"no CITATION\.cff; install it anew"):
        cite.read_citation()
