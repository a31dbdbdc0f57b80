"""``pldf cite``: how to cite the paper and this software; ``CITATION.cff`` says it all."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from importlib.metadata import files
from pathlib import Path
from typing import Any, Final

import yaml

from .. import __version__
from ..errors import ModelError

EXAMPLE: Final = "pldf cite >> literature.bib"

_FILE: Final = "CITATION.cff"
_OTHERS: Final = {"name": "and others"}
_ARXIV: Final = "arXiv:"


def configure(parser: argparse.ArgumentParser) -> None:
    """There is nothing to choose."""


def run(_: argparse.Namespace) -> None:
    """Print an entry for the paper and one for the software."""
    citation = read_citation()
    print(paper_entry(citation["preferred-citation"]))
    print(software_entry(citation))


def read_citation() -> dict[str, Any]:
    """Return the content of the installed ``CITATION.cff``; ModelError if it is not there."""
    for file in files("adaptive-pldf") or ():
        if file.name == _FILE:
            text = Path(str(file.locate())).read_text(encoding="utf-8")
            citation: dict[str, Any] = yaml.safe_load(text)
            return citation
    raise ModelError(f"the installed package has no {_FILE}; install it anew")


def paper_entry(paper: Mapping[str, Any]) -> str:
    """Return the BibTeX entry of a paper on arXiv."""
    number = next(
        identifier["value"].removeprefix(_ARXIV)
        for identifier in paper["identifiers"]
        if identifier["value"].startswith(_ARXIV)
    )
    return _entry(
        "misc",
        f"{paper['authors'][0]['family-names'].lower()}{paper['year']}",
        {
            "title": f"{{{paper['title']}}}",
            "author": _authors(paper),
            "year": str(paper["year"]),
            "eprint": number,
            "archivePrefix": "arXiv",
            "url": paper["url"],
        },
    )


def software_entry(software: Mapping[str, Any]) -> str:
    """Return the BibTeX entry of this software in the version that is installed."""
    fields = {
        "title": f"{{{software['title']}}}",
        "author": _authors(software),
        "version": __version__,
        "note": f"License: {software['license']}",
    }
    if "date-released" in software:
        fields["year"] = str(software["date-released"])[:4]
    if "repository-code" in software:
        fields["url"] = software["repository-code"]
    return _entry("software", "adaptive_pldf", fields)


def _authors(work: Mapping[str, Any]) -> str:
    """Return BibTeX's list of names; a name of several words that is no person's stays whole."""
    return " and ".join(
        f"{author['family-names']}, {author['given-names']}"
        if "family-names" in author
        else ("others" if author == _OTHERS else f"{{{author['name']}}}")
        for author in work["authors"]
    )


def _entry(kind: str, key: str, fields: Mapping[str, str]) -> str:
    lines = "".join(f"  {name} = {{{value}}},\n" for name, value in fields.items())
    return f"@{kind}{{{key},\n{lines}}}"
