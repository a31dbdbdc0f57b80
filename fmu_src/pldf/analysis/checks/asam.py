"""What ASAM's own checker of OpenDRIVE (PyPI: asam-qc-opendrive) finds in a road's file.

It is asked in a process of its own, as its authors offer it: a configuration file in, a file with
results (.xqar) out. So it may also be a program in an environment of its own, with other packages.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final
from xml.etree import ElementTree

from ...findings import Finding, Severity
from .xml_places import Places, places_in

_PROGRAM: Final = "qc_opendrive"
# What it imports: without the last, which is not compiled for every system, it does not start.
_MODULES: Final = (_PROGRAM, "qc_baselib", "pyclothoids")
_BUNDLE: Final = "xodrBundle"  # what the checker calls itself in configurations
_LEVELS: Final[dict[str, Severity]] = {"1": "error", "2": "warning", "3": "note"}
_ALIKE_MAX: Final = 20  # findings of one rule
_WAIT_S: Final = 180.0  # it takes seconds for a town, hours for 100 000 geometries in one road
# Rules about what our own reader refuses with more words.
_ALSO_OURS: Final = ("xml.valid_xml_document", "xml.root_tag_is_opendrive")
HOW_TO_GET: Final = (
    "to have the file's own standard checked, too: pip install 'adaptive-pldf[asam]', then "
    "pip install --no-deps asam-qc-opendrive"
)


def checker() -> list[str] | None:
    """Return the command that starts the checker: in this Python, else a program; None: neither."""
    if all(find_spec(module) for module in _MODULES):
        return [sys.executable, "-m", _PROGRAM]
    program = shutil.which(_PROGRAM)
    return [program] if program else None


def asam_findings(path: Path, ours: Iterable[Finding]) -> list[Finding]:
    """Return what the checker finds in ``path``, and how much of it was checked.

    Args:
        path: an OpenDRIVE file.
        ours: what is known already, and not told again.
    """
    command = checker()
    if command is None:
        return []
    with TemporaryDirectory() as folder:
        results = Path(folder, "results.xqar")
        configuration = Path(folder, "configuration.xml")
        configuration.write_bytes(_configuration(path, results))
        try:
            done = subprocess.run(
                [*command, "-c", str(configuration)], check=False, timeout=_WAIT_S,
                capture_output=True, text=True, errors="replace", stdin=subprocess.DEVNULL,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return [_note(path, f"ASAM's checker was stopped: no result within {_WAIT_S:g} s")]
        try:
            told = ElementTree.parse(results).getroot()
        except (OSError, ElementTree.ParseError):
            last = (done.stderr.strip().splitlines() or ["it said nothing"])[-1]
            return [
                _note(path, f"ASAM's checker gave no result (status {done.returncode}): {last}")
            ]
    refused = any(finding.severity == "error" for finding in ours)
    return [*_issues(path, told, refused), _note(path, _extent(told))]


def _configuration(path: Path, results: Path) -> bytes:
    root = ElementTree.Element("Config")
    ElementTree.SubElement(root, "Param", name="InputFile", value=str(path.resolve()))
    bundle = ElementTree.SubElement(root, "CheckerBundle", application=_BUNDLE)
    ElementTree.SubElement(bundle, "Param", name="resultFile", value=str(results))
    return bytes(ElementTree.tostring(root, encoding="utf-8", xml_declaration=True))


def _issues(path: Path, told: ElementTree.Element, refused: bool) -> Iterator[Finding]:
    """Yield a finding per issue; of many of one rule the first, and how many more there are."""
    issues = list(told.iter("Issue"))
    if not issues:
        return
    xpaths = {at.get("xpath", "") for issue in issues for at in issue.iter("XMLLocation")}
    places = places_in(path.read_bytes(), xpaths)
    of_rule = Counter[str]()
    for issue in issues:
        rule = issue.get("ruleUID", "")
        if refused and rule.endswith(_ALSO_OURS):
            continue
        of_rule[rule] += 1
        if of_rule[rule] <= _ALIKE_MAX:
            yield _finding(path, issue, places)
    for rule, number in of_rule.items():
        if number > _ALIKE_MAX:
            yield _note(path, f"ASAM rule {rule}: {number - _ALIKE_MAX} more like those told")


def _finding(path: Path, issue: ElementTree.Element, places: Places) -> Finding:
    """Return an issue as a finding at the first place that it names."""
    text = issue.get("description", "").strip()
    line, place = 0, ""
    for locations in issue.iter("Locations"):
        row, node = locations.find("FileLocation"), locations.find("XMLLocation")
        if row is not None:  # of a rule about any file: what it is in this one stands here
            line, place = int(row.get("row", "0")), places.road_at(int(row.get("row", "0")))
            text = locations.get("description", text)
            break
        if node is not None:
            line, place = places.of_xpath.get(node.get("xpath", ""), (0, ""))
            break
    severity = _LEVELS.get(issue.get("level", ""), "warning")
    return Finding(
        severity, str(path), line, place, f"ASAM rule {issue.get('ruleUID', '')}: {text}"
    )


def _extent(told: ElementTree.Element) -> str:
    """Return how much was checked: rules of other versions of OpenDRIVE do not apply."""
    checks = list(told.iter("Checker"))
    states = Counter(check.get("status", "") for check in checks)
    failed = [check.get("checkerId", "") for check in checks if check.get("status") == "error"]
    text = f"ASAM's checker made {states['completed']} of its {len(checks)} checks"
    if states["skipped"]:
        text += " (the others are of other versions of OpenDRIVE, or need what is missing)"
    return text + (f"; it failed in {', '.join(failed)}" if failed else "")


def _note(path: Path, text: str) -> Finding:
    return Finding("note", str(path), 0, "", text)
