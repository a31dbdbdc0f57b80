"""What ASAM's own checker finds in a road is told in our list: severity, rule, place."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

import pytest
from pldf.analysis.checks import asam
from pldf.analysis.checks.asam import asam_findings, checker
from pldf.analysis.checks.files import Known, check_file
from pldf.analysis.checks.xml_places import places_in
from pldf.cli import main
from pldf.findings import Finding
from pldf.roads.load import DATA

STUDY = DATA / "study_road.xodr"
INSTALLED = pytest.mark.skipif(
    checker() is None and "PLDF_CI" not in os.environ, reason="needs asam-qc-opendrive"
)
# A lane that is level again behind one that is not tilted with the road; and a speed of no kind.
UNEVEN = """<OpenDRIVE>
  <header revMajor="1" revMinor="7" name="uneven" version="1.00"/>
  <road name="" length="200" id="5" junction="-1">
    <link/>
    <type s="0" type="rural"><speed max="{0}" unit="km/h"/></type>
    <planView>
      <geometry s="0" x="0" y="0" hdg="0" length="200"><line/></geometry>
    </planView>
    <lanes>
      <laneSection s="0">
        <center><lane id="0" type="none" level="false"/></center>
        <right>
          <lane id="-1" type="driving" level="true">{1}</lane>
        </right>
      </laneSection>
      <laneSection s="120">
        <center><lane id="0" type="none" level="false"/></center>
        <right>
          <lane id="-1" type="driving" level="true">{1}</lane>
          <lane id="-2" type="driving" level="false">{1}</lane>
        </right>
      </laneSection>
    </lanes>
  </road>
</OpenDRIVE>
"""
WIDTH = '<width sOffset="0" a="3" b="0" c="0" d="0"/>'
RESULTS = """import sys
from pathlib import Path
from xml.etree import ElementTree
given = ElementTree.parse(sys.argv[sys.argv.index("-c") + 1]).getroot()
out = next(p.get("value") for p in given.iter("Param") if p.get("name") == "resultFile")
Path(out).write_text(Path(__file__).with_name("results.xml").read_text())
"""


def checked(path: Path) -> list[Finding]:
    return [one for one in check_file(path, Known(asam=True)).findings if "ASAM" in one.text]


@INSTALLED
def test_the_study_road_breaks_no_rule() -> None:
    (extent,) = checked(STUDY)  # that it was checked, and nothing else
    assert extent.severity == "note"
    made = int(extent.text.split("made ")[1].split(" of")[0])
    assert made >= 20


@INSTALLED
def test_a_broken_rule_is_told_with_severity_rule_and_place(tmp_path: Path) -> None:
    path = tmp_path / "un & even.xodr"  # names are written into the checker's configuration
    path.write_text(UNEVEN.format("70", WIDTH))
    found = [one for one in checked(path) if "road.lane.level" in one.text]
    line = 1 + UNEVEN.splitlines().index(
        next(row for row in UNEVEN.splitlines() if 'id="-2"' in row)
    )
    assert [(one.severity, one.place) for one in found] == [("error", "road 5, s = 120 m")]
    assert abs(found[0].line - line) <= 1
    assert "asam.net:xodr:1.7.0:road.lane.level_true_one_side" in found[0].text


@INSTALLED
def test_a_file_that_is_no_xml_is_refused_once(tmp_path: Path) -> None:
    path = tmp_path / "torn.xodr"
    path.write_text(UNEVEN.format("70", WIDTH)[:600])
    findings = check_file(path, Known(asam=True)).findings
    assert [one.severity for one in findings].count("error") == 1


@INSTALLED
def test_check_asks_it_and_can_be_told_not_to(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(STUDY)]) == 0
    assert "ASAM's checker made" in capsys.readouterr().out
    assert main(["check", str(STUDY), "--no-asam"]) == 0
    assert "ASAM" not in capsys.readouterr().out


def test_where_it_is_missing_one_note_says_how_to_get_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(asam, "find_spec", lambda _name: None)
    monkeypatch.setattr(asam.shutil, "which", lambda _name: None)
    other = tmp_path / "other.xodr"
    other.write_text(UNEVEN.format("70", WIDTH))
    assert main(["check", "--json", str(STUDY), str(other)]) == 0
    told = [f for f in json.loads(capsys.readouterr().out)["findings"] if "ASAM" in f["text"]]
    assert len(told) == 1
    assert "pip install 'adaptive-pldf[asam]'" in told[0]["way_out"]
    road = tmp_path / "road.csv"
    road.write_text("s_m,curvature_per_m,speed_limit_mps\n0,0,20\n900,0,20\n")
    assert main(["check", str(road)]) == 0  # rules of OpenDRIVE say nothing of a CSV road
    assert "ASAM" not in capsys.readouterr().out


def results_of(path: Path, monkeypatch: pytest.MonkeyPatch, results: str) -> list[Finding]:
    """Return what is made of the results of a checker that gives these."""
    program = path.with_name("program.py")
    program.write_text(RESULTS)
    path.with_name("results.xml").write_text(results)
    monkeypatch.setattr(asam, "checker", lambda: [sys.executable, str(program)])
    return asam_findings(path, [])


def test_results_are_read_as_the_format_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "uneven.xodr"
    path.write_text(UNEVEN.format("fast", WIDTH))
    schema = (
        '<Issue issueId="{0}" level="1" description="any" ruleUID="x:xodr:1.0.0:schema">{1}</Issue>'
    )
    row = '<Locations description="max is fast"><FileLocation row="5" column="0"/></Locations>'
    lane = (
        '<Issue issueId="99" level="2" description="Lanes." ruleUID="x:xodr:1.7.0:lane">'
        '<Locations description="here"><XMLLocation '
        'xpath="/OpenDRIVE/road/lanes/laneSection[2]/right/lane[2]"/></Locations></Issue>'
    )
    schemas = "".join(schema.format(k, row) for k in range(25))
    findings = results_of(
        path, monkeypatch,
        f'<CheckerResults><CheckerBundle><Checker status="completed">{schemas}</Checker>'
        f'<Checker status="completed">{lane}</Checker><Checker status="skipped"/>'
        '<Checker status="error" checkerId="check_x"/></CheckerBundle></CheckerResults>',
    )  # fmt: skip
    text = "ASAM rule x:xodr:1.0.0:schema: max is fast"
    assert findings[0] == Finding("error", str(path), 5, "road 5", text)
    assert [one.text for one in findings].count(text) == 20
    lanes = next(one for one in findings if "Lanes." in one.text)
    assert (lanes.severity, lanes.line, lanes.place) == ("warning", 20, "road 5, s = 120 m")
    assert any(one.text.endswith("schema: 5 more like those told") for one in findings)
    assert "made 2 of its 4 checks" in findings[-1].text
    assert findings[-1].text.endswith("it failed in check_x")


def test_a_checker_that_gives_nothing_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    program = tmp_path / "program.py"
    program.write_text("raise SystemExit('no licence today')")
    monkeypatch.setattr(asam, "checker", lambda: [sys.executable, str(program)])
    (told,) = asam_findings(STUDY, [])
    assert (told.severity, told.line) == ("note", 0)
    assert told.text == "ASAM's checker gave no result (status 1): no licence today"


def test_a_checker_that_does_not_end_is_stopped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    program = tmp_path / "program.py"
    program.write_text("import threading; threading.Event().wait()")
    monkeypatch.setattr(asam, "checker", lambda: [sys.executable, str(program)])
    monkeypatch.setattr(asam, "_WAIT_S", 0.5)
    (told,) = asam_findings(STUDY, [])
    assert told.text == "ASAM's checker was stopped: no result within 0.5 s"


def test_places_of_elements() -> None:
    data = (
        b'<OpenDRIVE>\n<road id="a"/>\n<road id="b &amp; c">\n<planView>\n<geometry s="7.6"/>'
        b"</planView>\n</road><junction>\n<connection/><connection/></junction></OpenDRIVE>"
    )
    paths = ["/OpenDRIVE/road[2]/planView/geometry", "/OpenDRIVE/junction/connection[2]", "/none"]
    places = places_in(data, paths)
    assert places.of_xpath == {paths[0]: (5, "road b & c, s = 8 m"), paths[1]: (7, "")}
    assert [places.road_at(line) for line in (1, 2, 4, 7)] == ["", "road a", "road b & c", ""]
    assert places_in(data[:60], paths).of_xpath == {}
