"""Study files and explicit participants: what they say, and errors that say where and what."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest
from pldf.errors import ModelError
from pldf.kernel.codes import LEARN_CONSISTENT
from pldf.roads import fingerprint, packed_route, write_route_csv
from pldf.study.participants import DRIVER_SIGNALS
from pldf.study.participants_file import participants_csv, read_participants
from pldf.study.phases import PHASES
from pldf.study.population import read_distribution, sample_participants
from pldf.study.study_file import PACKAGED, Study, read_study, study_path
from pldf.toml_file import line_of

from studies import fit_population

PAPER = study_path("paper")


def study(folder: Path, text: str) -> Study:
    path = folder / "my.toml"
    path.write_text(text, encoding="utf-8")
    return read_study(path)


def test_the_papers_study() -> None:
    paper = read_study(PAPER)
    assert len(paper.participants) == 43
    assert [phase.name for phase in paper.settings.phases] == ["A1", "A2", "A3", "B1", "B2", "B3"]
    assert not paper.settings.counterbalanced
    assert len(paper.settings.recorded) == 1  # who it is: test_typical.py
    assert paper.settings.step_s == 0.01
    assert paper.out == Path("out/paper")
    assert paper.source == PAPER.read_text(encoding="utf-8")


def test_a_file_of_ones_own_comes_before_a_packaged_study(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert study_path("paper").parent == PACKAGED
    Path("cockpit").mkdir()  # a folder of that name is no study file
    assert study_path("cockpit").parent == PACKAGED
    Path("paper").write_text("")
    assert study_path("paper") == Path("paper")


def test_an_unknown_study_names_the_packaged_ones() -> None:
    with pytest.raises(ModelError, match=r"nowhere: no such study file; packaged are .*paper"):
        study_path("nowhere")


def test_an_empty_file_is_the_papers_study_with_other_people(tmp_path: Path) -> None:
    empty, paper = study(tmp_path, ""), read_study(PAPER)
    assert empty.settings.phases == paper.settings.phases
    assert empty.participants[0].seed == sample_participants(1, 1)[0].seed
    assert (empty.title, empty.out) == ("my", Path("out/my"))
    assert empty.settings.recorded == frozenset()


def test_everything_can_be_said(tmp_path: Path) -> None:
    write_route_csv(packed_route(0), tmp_path / "road.csv")
    said = study(
        tmp_path,
        """
        title = "long"
        output = "there"
        drives.phases = ["A2", "B1"]
        drives.per_phase = 3
        drives.order = "counterbalanced"
        drives.threshold_growth_per_drive = 0.02
        participants = { count = 3, seed = 9 }
        recordings.participants = ["P003", "P001"]
        road.route = "road.csv"
        [function]
        learn = "CONSISTENT"
        "learning.stretch_factor" = 0.75
        "learning.stretch_time_mode" = "CONSTANT_SPEED"
        [vehicle]
        "grade_from_route" = false
        [distribution]
        "driver.uses_lever" = { law = "share", share = 0.0 }
        "wish.offset_mps" = { law = "uniform", low = 3.0, high = 3.5 }
        "driver.spread" = 0.1
        """,
    )
    assert [phase.name for phase in said.settings.phases] == ["A1", "A2", "A3", "B1", "B2", "B3"]
    learns = [(p.apply_learned, p.learn, p.intervenes) for p in said.settings.phases]
    assert learns == [PHASES["A2"][1:]] * 3 + [PHASES["B1"][1:]] * 3
    assert said.settings.counterbalanced
    assert said.settings.threshold_growth_per_drive == 0.02
    assert said.settings.learn == LEARN_CONSISTENT
    assert said.settings.function == {
        "learn": LEARN_CONSISTENT,
        "learning.stretch_factor": 0.75,
        "learning.stretch_time_mode": 1,
    }
    assert said.settings.vehicle == {"grade_from_route": 0}
    assert said.settings.road.file == tmp_path / "road.csv"
    assert said.settings.recorded == {"P001", "P003"}
    assert [one.id for one in said.participants] == ["P001", "P002", "P003"]
    for one in said.participants:
        assert one.value("driver_uses_lever") == 0
        assert 3.0 <= one.value("wish_offset_mps") <= 3.5
        assert one.value("driver_spread") == 0.1


ERRORS = {
    'title = "a"\n[drives]\nphases = ["A1", "B4"]': (
        'line 3, drives.phases: "B4" must be one of "A1", "A2", "A3", "B1", "B2", "B3"'
    ),
    'drives.phases = "A1"': 'line 1, drives.phases: "A1" must be a list out of "A1", ',
    "drives.phases = []": "line 1, drives.phases: empty; choose out of A1,",
    'drives.phases = ["A1", "A1"]': "line 1, drives.phases: an item occurs twice",
    '\n[drives]\n# order = 3\norder = "random"': (
        'line 4, drives.order: "random" must be one of "fixed", "counterbalanced"'
    ),
    "[drives]\nper_phase = 0": (
        "line 2, drives.per_phase: 0 must be a whole number from 1 to 1000"
    ),
    "[drives]\nstep_s = 0.5": "line 2, drives.step_s: 0.5 must be a number from 0.0001 to 0.1",
    "[drives]\nstep_s = nan": "line 2, drives.step_s: nan must be a number",
    "[participants]\nseed = 4\ncount = 1.5": (
        "line 3, participants.count: 1.5 must be a whole number from 1 to 1000000"
    ),
    "[participants]\ncount = true": "line 2, participants.count: true must be a whole number",
    "[participants]\ncuont = 3": "line 2, participants.cuont: unknown; did you mean count?",
    "participants = 3": "line 1, participants: 3 must be a table: write [participants]",
    "[people]\ncount = 3": "line 1, people: unknown; known are participants, drives,",
    '"`title" = 3': "line 1, `title: unknown; did you mean title?",
    "titel = 3": "line 1, titel: unknown; did you mean title?",
    "title = 3": "line 1, title: 3 must be a text in quotes",
    'title = "a"\nx = ?\n': "not valid TOML: Invalid value (at line 2, column 5)",
    "[drives]\nthreshold_growth_per_drive = -0.1": (
        "line 2, drives.threshold_growth_per_drive: -0.1 must be a number from 0 to 1"
    ),
    "[drives]\nper_phase = 3\nthreshold_growth_per_drive = 0.5": (
        "line 3, drives.threshold_growth_per_drive: P0"
    ),
    '[road]\nroute = "nowhere.csv"': "line 2, road.route: nowhere.csv: cannot be read",
    '[function]\n"learning.stretch_factor" = 9.0': (
        "line 2, function.learning.stretch_factor: 9.0 must be a number from 0 to "
    ),
    '[function]\n"learning.stretch" = 9.0': (
        "line 2, function.learning.stretch: unknown; did you mean learning.stretch"
    ),
    "[function]\nlearning.weight = 0.4": (
        "line 1, function.learning: is a table, and [function] has none within; a name with dots "
        "is written in quotes"
    ),
    "[variants.x.function]\nlearn = 'CONSISTENT'": (
        "line 1, variants.x.function: is a table, and [variants.x] has none within"
    ),
    "[function]\nlearn_faithful = true": "line 2, function.learn_faithful: unknown",
    "[function]\nlearn = 1": 'line 2, function.learn: 1 must be one of "OFF", "FAITHFUL", ',
    '[function]\nlearn = "OFF"': 'line 2, function.learn: "OFF": the drives say whether they learn',
    '[function]\n"learning.stretch_time_mode" = "NO"': (
        'line 2, function.learning.stretch_time_mode: "NO" must be one of "RECORDED", '
    ),
    "[vehicle]\ngrade_from_route = 1": "line 2, vehicle.grade_from_route: 1 must be true or false",
    '\n[distribution]\n"wish.offset_mps" = 33.0': (
        'line 3, distribution.wish.offset_mps: distribution: "wish.offset_mps" = 33.0 must be a '
        "number from -20 to 30 m/s"
    ),
    '[distribution]\n"wish.offset_mps" = { law = "normal", mean = 3 }': (
        "line 2, distribution.wish.offset_mps: "
    ),
    '[recordings]\nparticipants = ["P044"]': (
        'line 2, recordings.participants: "P044" must be one of "P001", "P002",'
    ),
    '[participants]\nfile = "x.csv"\ncount = 3': "line 3, participants.count: not together with",
    '[participants]\nfile = "x.csv"': "x.csv: cannot be read",
}


@pytest.mark.parametrize("text", ERRORS)
def test_errors_name_file_line_key_and_what_is_allowed(tmp_path: Path, text: str) -> None:
    with pytest.raises(ModelError) as caught:
        study(tmp_path, text)
    told = str(caught.value)
    assert told.startswith(str(tmp_path))
    assert ERRORS[text] in told
    assert "\n" not in told


def test_a_missing_file_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"no\.toml: cannot be read \(No such file"):
        read_study(tmp_path / "no.toml")


def test_lines_are_found_in_every_way_to_write_a_key() -> None:
    text = 'a = 1\nb.c = 2\n[d]\ne = 3 # e = 4\n[d."f.g"]\n"h" = 5\n[ i ] # x\n'
    lines = {("a",): 1, ("b", "c"): 2, ("d", "e"): 4, ("d", "f.g", "h"): 6, ("i",): 7}
    assert {key: line_of(text, key) for key in lines} == lines
    assert line_of(text, ("d", "absent")) == 3
    assert line_of(text, ("absent",)) == 1


def test_participants_read_back_to_the_same_bits(tmp_path: Path) -> None:
    varying = {"wish.offset_person_sd_mps": 0.972222, "wish.lateral_occasion_sigma": 0.11}
    people = sample_participants(5, 3, read_distribution(varying))
    path = tmp_path / "people.csv"
    path.write_bytes(participants_csv(people))
    back = read_participants(path)
    assert [(one.id, one.seed) for one in back] == [(one.id, one.seed) for one in people]
    for one, other in zip(back, people, strict=True):
        assert all(one.value(field) == other.value(field) for field in DRIVER_SIGNALS)
        assert one.value("wish_offset_person_sd_mps") == 0.972222
        assert one.value("wish_lateral_occasion_sigma") == 0.11
    assert participants_csv(back) == path.read_bytes()


def test_explicit_participants_in_a_study(tmp_path: Path) -> None:
    (tmp_path / "people.csv").write_text(
        "# two people\nseed,wish.offset_mps,driver.uses_lever\n5,1.5,0\n\n6,-1.0,1\n"
    )
    people = study(tmp_path, '[participants]\nfile = "people.csv"').participants
    assert [(one.id, one.seed) for one in people] == [("P001", 5), ("P002", 6)]
    assert [dict(one.values) for one in people] == [
        {"wish_offset_mps": 1.5, "driver_uses_lever": 0.0},
        {"wish_offset_mps": -1.0, "driver_uses_lever": 1.0},
    ]


DAYS = "seed,wish.offset_occasion_sd_mps\n"


@pytest.mark.parametrize(
    ("rows", "told"),
    [
        ("100,0.6\n103,0.6", "P001 and P002: seeds 100 and 103 are less than 6 drives apart;"),
        ("103,0.6\n9,0.6\n100,0.6\n10,0.6", "seeds 9 and 10 are less than 6 drives apart, as do 1"),
        ("100,0.6\n106,0.6", ""),
        ("100,0.6\n101,0", ""),  # whose wish does not vary has no days
        ("100,0.6\n100,0.6", ""),  # the same person twice, perhaps with another threshold
    ],
)
def test_people_with_the_same_days_are_told(tmp_path: Path, rows: str, told: str) -> None:
    (tmp_path / "people.csv").write_text(DAYS + rows)
    notes = study(tmp_path, '[participants]\nfile = "people.csv"').notes
    warned = [str(note) for note in notes if note.severity == "warning"]
    assert len(warned) == bool(told)
    assert told in "".join(warned)


CSV_ERRORS = {
    "": "no header; a list of participants has the columns seed",
    "seed\n": "no participants",
    "participant\nP001": "line 1: missing column seed; a list of participants has",
    "seed,height\n1,2": "line 1: unknown column height; a list of participants has the columns",
    "seed,seed\n1,2": "line 1: repeated column seed",
    "seed\n1,2": "line 2: 2 values for 1 columns",
    "seed\n1\n-1": "line 3, seed: '-1' is not a whole number from 0 to",
    "seed,wish.offset_mps\n1,x": "line 2, wish.offset_mps: 'x' is not a number from -20 to 30",
    "seed,driver.uses_lever\n1,0.5": "line 2, driver.uses_lever: '0.5' is not 0 or 1",
    "seed,participant\n1,Anna": "line 2, participant: 'Anna' is not P and a number",
    "seed,participant\n1,P002\n1,P002": "line 3, participant: P002 occurs twice",
}


@pytest.mark.parametrize("text", CSV_ERRORS)
def test_errors_in_participants_name_line_and_column(tmp_path: Path, text: str) -> None:
    path = tmp_path / "people.csv"
    path.write_text(text)
    with pytest.raises(ModelError) as caught:
        read_participants(path)
    assert CSV_ERRORS[text] in str(caught.value)


def test_the_old_model_is_kept_beside_the_papers_study() -> None:
    old = tomllib.loads(study_path("paper_constant_wish").read_text(encoding="utf-8"))
    fitted = Path(fit_population.__file__).with_name("population_constant_wish.toml")
    assert old["distribution"] == tomllib.loads(fitted.read_text(encoding="utf-8"))["distribution"]
    settings = read_study(study_path("paper_constant_wish")).settings
    paper = read_study(PAPER).settings
    assert settings.phases == paper.phases
    assert fingerprint(settings.route) == fingerprint(paper.route)
    assert settings.step_s == paper.step_s
    assert settings.function == paper.function == {}
