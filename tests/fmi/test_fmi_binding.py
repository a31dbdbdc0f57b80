"""The parts of the FMI binding that need no FMU."""

from dataclasses import dataclass, replace
from pathlib import Path
from xml.etree.ElementTree import tostring

import pytest
from fmpy.validation import validate_fmu
from pldf.build import isolate
from pldf.build.archive import with_guid
from pldf.build.description3 import model_description3
from pldf.build.documentation import document
from pldf.errors import ModelError
from pldf.fmi.access import Access
from pldf.fmi.description import Model, model_description
from pldf.fmi.phases import CALLS, Phase, next_phase
from pldf.fmi.units import base_unit
from pldf.kernel.signals import (
    Enumeration,
    by_reference,
    choice_input,
    count_parameter,
    flag_output,
    real_input,
    real_output,
    real_parameter,
    signals_of,
    since,
    text_parameter,
    time_reference,
    variables_of,
)

COLOUR = Enumeration("Colour", ("RED", "GREEN"))


@dataclass
class Record:
    """One variable of most kinds."""

    gain: float = real_parameter("Gain <1>", "1/s", start=0.1, low=0.0, high=1.0)
    size: int = count_parameter("Size", start=3, low=1, high=9)
    speed: float = real_input("Speed", "m/s", start=1.0, low=0.0, high=10.0)
    colour: int = choice_input("Colour", COLOUR, start=1)
    out: float = real_output("Out", "m")
    flag: int = flag_output("Flag")


SIGNALS = signals_of(Record)


# Units


@pytest.mark.parametrize(
    ("unit", "factor", "exponents"),
    [
        ("m/s3", 1.0, {"m": 1, "s": -3}),
        ("1/m", 1.0, {"m": -1}),
        ("N", 1.0, {"kg": 1, "m": 1, "s": -2}),
        ("kg/m3", 1.0, {"kg": 1, "m": -3}),
        ("N.m", 1.0, {"kg": 1, "m": 2, "s": -2}),
        ("kW", 1000.0, {"kg": 1, "m": 2, "s": -3}),
        ("m/m", 1.0, {}),
    ],
)
def test_unit_in_base_units(unit, factor, exponents):
    assert base_unit(unit) == (factor, exponents)


@pytest.mark.parametrize("unit", ["kmh", "m/x", "m//s", "m s", "%"])
def test_unknown_unit_is_refused(unit):
    with pytest.raises(ValueError, match="unit"):
        base_unit(unit)


# Order of calls


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("phase", Phase)
def test_every_call_in_every_phase(phase, call):
    if phase in CALLS[call]:
        assert next_phase(phase, call) == CALLS[call][phase]
    else:
        with pytest.raises(ModelError, match=f"not allowed in phase {phase.name}"):
            next_phase(phase, call)


def test_a_drive_passes_the_phases_in_order():
    phase = Phase.INSTANTIATED
    seen = []
    for call in CALLS:
        if call.startswith("fmi2"):
            phase = next_phase(phase, call)
            seen.append(phase)
    assert seen[-1] is Phase.TERMINATED
    assert sorted(seen) == seen


# Value references


def test_access_reads_in_the_order_asked_for():
    access = Access(SIGNALS, frozenset({"Real"}))
    record = Record(gain=0.5, speed=2.0, out=3.0)
    assert access.group([4, 0, 2]).read(record) == [3.0, 0.5, 2.0]
    assert access.group([2]).read(record) == [2.0]
    assert access.group([]).read(record) == []


@pytest.mark.parametrize("reference", [-1, 1, 3, 6, 99, 4294967295])
def test_access_refuses_references_of_other_types_and_unknown_ones(reference):
    access = Access(SIGNALS, frozenset({"Real"}))
    with pytest.raises(ModelError, match=f"no Real variable with value reference {reference}"):
        access.group([0, reference])


def test_a_later_release_moves_no_value_reference():
    """Behind the first release's variables is the place of FMI 3.0's ``time``."""

    @dataclass
    class Later(Record):
        """As two releases later; one field stands in the middle of the others."""

        newest: int = since("0.10", flag_output("Newest"))
        size: int = count_parameter("Size", start=3, low=1, high=9)
        new: float = since("0.9", real_parameter("New", "m", start=1.0, low=0.0, high=2.0))

    @dataclass
    class Texts:
        """A String parameter of the first release."""

        file: str = text_parameter("File")

    first = by_reference((*signals_of(Record), *signals_of(Texts)))
    assert time_reference(first.values()) == len(first) == 7
    later = by_reference((*signals_of(Later), *signals_of(Texts)))
    assert {reference: later[reference].name for reference in first} == {
        reference: signal.name for reference, signal in first.items()
    }
    assert later.keys() == {*range(7), 8, 9}
    assert [later[8].name, later[9].name] == ["new", "newest"]
    assert by_reference(later.values()) == later
    assert tuple(later.values()) == variables_of(Later, Texts)


def test_access_knows_what_may_be_set():
    access = Access(SIGNALS, frozenset({"Real"}))
    assert access.writable([0, 2]).fixed
    assert not access.writable([2]).fixed
    with pytest.raises(ModelError, match="out is an output"):
        access.writable([2, 4])


def test_access_forgets_groups_that_are_never_repeated():
    access = Access(SIGNALS, frozenset({"Real"}))
    for length in range(1, 1000):
        assert len(access.group([0] * length).fields) == length
    assert len(access._groups) < 300


# Model description


def described(describe=model_description, **changes):
    signals = tuple(replace(s, **changes.get(s.field, {})) for s in SIGNALS)
    return describe(Model("M", "about", signals, 10.0), {"logAll": "all"})


@pytest.mark.parametrize("describe", [model_description, model_description3])
@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"speed": {"start": 11.0}}, "speed: start 11.0 is not in 0 .. 10"),
        ({"colour": {"start": 2}}, "colour: start 2 is not in 0 .. 1"),
        ({"speed": {"name": "gain"}}, "'gain' is used twice"),
        ({"speed": {"name": "a b"}}, "not a structured name"),
        ({"speed": {"name": "a" * 56}}, "at most 55"),
        ({"speed": {"unit": "furlong"}}, "unit 'furlong'"),
        (
            {"speed": {"enumeration": Enumeration("Colour", ("RED", "BLUE"))}},
            "two different enumerations",
        ),
    ],
)
def test_tables_that_break_a_rule_are_refused(describe, changes, message):
    with pytest.raises(ValueError, match=message):
        described(describe, **changes)


def test_fmi_3_has_a_time_of_its_own():
    with pytest.raises(ValueError, match="'time' is the name of the independent variable"):
        described(model_description3, speed={"name": "time"})


@pytest.mark.parametrize("describe", [model_description, model_description3])
@pytest.mark.parametrize("kept", [(), SIGNALS[:2], SIGNALS[-1:], SIGNALS])
def test_models_that_lack_outputs_units_or_enumerations_are_valid_too(tmp_path, describe, kept):
    root = describe(Model("M", "about", kept, 10.0), {"logAll": "all"})
    (tmp_path / "modelDescription.xml").write_bytes(tostring(root, encoding="UTF-8"))
    problems = validate_fmu(str(tmp_path))
    if not kept and describe is model_description:  # FMI 2.0 knows no model without variables
        assert "ModelVariables" in problems.pop()
    assert problems == []


def test_numbers_are_exact_to_the_bit():
    start = 80.0 / 3.6 / 10
    real = described(speed={"start": start}).find(".//*[@name='speed']/Real")
    assert float(real.get("start")) == start


def test_date_follows_source_date_epoch(monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    assert described().get("generationDateAndTime") == "1970-01-02T00:00:00Z"


def test_documentation_lists_every_variable_and_escapes_text():
    page = document("Name", "a & b", "First.\n\n    Second <part>.", SIGNALS, "<p>Anywhere.</p>")
    assert all(f"<code>{s.name}</code>" in page for s in SIGNALS)
    assert "Gain &lt;1&gt;" in page
    assert "<p>Second &lt;part&gt;.</p>" in page
    assert "1 (3.6 km/h)" in page
    assert "0\N{NO-BREAK SPACE}RED, 1\N{NO-BREAK SPACE}GREEN" in page


def test_guid_follows_every_byte():
    placeholder = b'guid="{00000000-0000-0000-0000-000000000000}"'
    members = {"modelDescription.xml": placeholder, "resources/a.py": b"1"}
    first = with_guid(members)["modelDescription.xml"]
    assert first == with_guid(dict(reversed(members.items())))["modelDescription.xml"]
    assert first != with_guid({**members, "resources/a.py": b"2"})["modelDescription.xml"]
    assert first != with_guid({**members, "resources/b.py": b""})["modelDescription.xml"]
    with pytest.raises(ValueError, match="placeholder"):
        with_guid({"modelDescription.xml": first})


# Isolated packages


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("from pldf.a import b, c\n", "from pldf_1.a import b, c\n"),
        ("from pldf import a\n", "from pldf_1 import a\n"),
        ("import pldf\n", "import pldf_1 as pldf\n"),
        ("import pldf.a as a\n", "import pldf_1.a as a\n"),
        ("import pldf as p\n", "import pldf_1 as p\n"),
        ("def f():\n    from pldf.a import (\n        b,\n    )\n",) * 2,
        ("from .pldf import a\n",) * 2,
        ("import numpy, pldfx\n",) * 2,
        ("text = 'from pldf.a import b'\n",) * 2,
    ],
)
def test_absolute_imports_are_renamed(before, after):
    expected = after.replace("    from pldf.a", "    from pldf_1.a")
    assert isolate.rename_imports(before, {"pldf": "pldf_1"}) == expected


def test_import_that_binds_the_old_name_is_refused():
    with pytest.raises(ValueError, match=r"line 2: write 'from pldf\.a import"):
        isolate.rename_imports("import os\nimport pldf.a\n", {"pldf": "pldf_1"})


def package(folder: Path, **files: str) -> Path:
    folder.mkdir(parents=True)
    for name, text in files.items():
        folder.joinpath(f"{name}.py").write_text(text)
    return folder


def test_digest_follows_names_and_contents(tmp_path):
    files = []
    for number, text in enumerate(("x = 1\n", "x = 1\n", "x = 2\n")):
        pack = package(tmp_path / str(number), part=text)
        files.append(pack / "part.py")
    one, same, other = ({"part": file} for file in files)
    assert isolate.digest(one) == isolate.digest(same) != isolate.digest(other)
    assert isolate.digest(one) != isolate.digest({"trap": files[0]})


def test_skipped_files_and_caches_stay_out(tmp_path):
    pack = package(tmp_path / "pack", __init__="", tool="import numba\n")
    package(pack / "inner", __init__="", tool="import matplotlib\n", part="")
    package(pack / "__pycache__", junk="")
    assert isolate.packed_files(pack, ["tool.py", "inner/tool.py"]) == [
        "__init__.py",
        "inner/__init__.py",
        "inner/part.py",
    ]


def test_imports_that_the_target_need_not_have_are_refused(tmp_path):
    pack = package(tmp_path / "pack", __init__="import numpy\nfrom scipy import signal\n")
    with pytest.raises(ValueError, match=r"__init__.py, line 2: 'scipy' must not be needed"):
        isolate.copy_package(pack, tmp_path / "out", (), {})
