"""The archives of FMUs and their model descriptions, as strict importers see them."""

from __future__ import annotations

import re
import shutil
import zipfile
from xml.etree import ElementTree

import pytest
from fmi_host import Host
from fmpy import platform
from fmpy.validation import validate_fmu
from pldf import cli
from pldf.build import fmus as fmu_build
from pldf.build.builder import build
from pushed_cart import EXAMPLE, cart_recipe, recipe_with


@pytest.mark.parametrize("name", fmu_build.FMUS)
def test_fmus_are_valid_and_complete(fmu_folder, name):
    path = fmu_folder / f"{name}.fmu"
    assert validate_fmu(str(path)) == []
    names = set(zipfile.ZipFile(path).namelist())
    assert {
        f"binaries/linux64/{name}.so",
        f"binaries/win64/{name}.dll",
        "documentation/index.html",
        "documentation/licenses/license.txt",
        "documentation/licenses/pythonfmu.txt",
        "model.png",
        "modelDescription.xml",
        "resources/slavemodule.txt",
    } <= names
    unwanted = ("/study/", "commands", "cli.py", "compiled", "packing", "__pycache__", "numba")
    assert not [n for n in names if any(part in n for part in unwanted)]


@pytest.mark.parametrize("name", fmu_build.FMUS)
def test_every_column_of_the_documentation_has_a_title(fmu_folder, name):
    page = zipfile.ZipFile(fmu_folder / f"{name}.fmu").read("documentation/index.html").decode()
    tables = re.findall(r"<table>.*?</table>", page, re.DOTALL)
    assert tables
    for table in tables:
        titles = re.findall(r"<th>(.*?)</th>", table)
        assert titles[0] == "Name"
        assert titles[-1] == "Description"
        rows = re.findall(r"<tr>(<td.*?)</tr>", table, re.DOTALL)
        assert rows
        assert {row.count("<td") for row in rows} == {len(titles)}
        assert all(row.endswith("</td>") and not row.endswith("></td>") for row in rows)


def test_same_sources_give_the_same_bytes(cart_fmu, tmp_path):
    shutil.copytree(EXAMPLE, tmp_path / "moved")
    again = build(cart_recipe(tmp_path / "moved"), tmp_path / "out")
    assert again.read_bytes() == cart_fmu.read_bytes()


def test_guids_differ(fmu_folder, cart_fmu):
    guids = {Host(p).description.guid for p in [cart_fmu, *fmu_folder.glob("*.fmu")]}
    assert len(guids) == 1 + len(fmu_build.FMUS)


def test_invalid_fmu_fails_the_build(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(fmu_build, "FMUS", {"Cart": cart_recipe()})
    monkeypatch.setattr(fmu_build, "validate_fmu", lambda _: ["something is wrong"])
    assert cli.main(["build", "--out", str(tmp_path)]) == 1
    assert "Cart.fmu is not a valid FMU:\n  something is wrong" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_source_that_needs_more_than_numpy_fails_the_build(tmp_path, monkeypatch, capsys):
    bad = recipe_with(tmp_path, "pldf/snapshot.py", "import json\n", "import json, numba\n")
    monkeypatch.setattr(fmu_build, "FMUS", {"Cart": bad})
    assert cli.main(["build", "--out", str(tmp_path / "out")]) == 1
    assert "'numba' must not be needed in an FMU" in capsys.readouterr().err


# The model description, rules 1 to 4 of strict importers


@pytest.fixture(params=["cart", *fmu_build.FMUS])
def xml(request, cart_fmu, fmu_folder):
    path = cart_fmu if request.param == "cart" else fmu_folder / f"{request.param}.fmu"
    return ElementTree.fromstring(zipfile.ZipFile(path).read("modelDescription.xml"))


def indices(xml, element):
    return [int(u.get("index")) for u in xml.findall(f"ModelStructure/{element}/Unknown")]


def test_outputs_and_initial_unknowns_are_exactly_the_outputs(xml):
    variables = xml.findall("ModelVariables/ScalarVariable")
    outputs = [i for i, v in enumerate(variables, 1) if v.get("causality") == "output"]
    assert outputs
    assert indices(xml, "Outputs") == outputs
    assert indices(xml, "InitialUnknowns") == outputs


def test_start_initial_and_variability(xml):
    for variable in xml.findall("ModelVariables/ScalarVariable"):
        (kind,) = variable
        causality = variable.get("causality")
        assert (kind.get("start") is not None) == (causality in ("input", "parameter"))
        wanted = {"input": None, "parameter": "exact", "output": "calculated"}
        assert variable.get("initial") == wanted[causality]
        expected = "continuous" if kind.tag == "Real" else "discrete"
        if causality == "parameter":
            name = str(variable.get("name"))
            tunable = name.startswith(("following.", "hmi.", "control.tip_"))
            expected = "tunable" if tunable else "fixed"
        assert variable.get("variability") == expected
        start = float(kind.get("start", "nan").replace("true", "1").replace("false", "0") or 0)
        if causality != "output" and kind.tag in ("Real", "Integer"):
            assert float(kind.get("min", "-inf")) <= start <= float(kind.get("max", "inf"))


def test_header_categories_and_default_experiment(xml):
    assert xml.get("fmiVersion") == "2.0"
    date = xml.get("generationDateAndTime")
    assert len(date) == 20
    assert date[10] == "T"
    assert date.endswith("Z")
    categories = [c.get("name") for c in xml.findall("LogCategories/Category")]
    assert len(categories) == len(set(categories)) > 0
    experiment = xml.find("DefaultExperiment")
    assert float(experiment.get("stopTime")) > float(experiment.get("startTime"))
    assert float(experiment.get("stepSize")) == 0.01


def test_units_and_types_are_declared(xml):
    units = {u.get("name"): u for u in xml.findall("UnitDefinitions/Unit")}
    assert all(u.find("BaseUnit") is not None for u in units.values())
    assert units["m/s"].find("DisplayUnit").attrib == {"name": "km/h", "factor": "3.6"}
    types = {t.get("name") for t in xml.findall("TypeDefinitions/SimpleType")}
    for variable in xml.findall("ModelVariables/ScalarVariable"):
        (kind,) = variable
        assert (kind.get("unit") in units) == (kind.tag == "Real")
        assert (kind.get("quantity") is not None) == (kind.tag == "Real")
        connected = variable.get("causality") != "parameter"
        assert (kind.get("nominal") is not None) == (kind.tag == "Real" and connected)
        ratios = ("driver.gas_pedal", "driver.brake_pedal", "rate.", "hmi.confidence")
        if variable.get("name").startswith(ratios):
            assert kind.get("unit") == "1"
        if kind.tag == "Enumeration":
            assert kind.get("declaredType") in types
        assert kind.get("displayUnit") == ("km/h" if kind.get("unit") == "m/s" else None)


def test_value_references_and_names_are_unique(xml):
    variables = xml.findall("ModelVariables/ScalarVariable")
    references = [int(v.get("valueReference")) for v in variables]
    assert references == sorted(set(references))
    assert len({v.get("name") for v in variables}) == len(variables)
    assert all(len(v.get("name")) <= 55 and v.get("description") for v in variables)


def test_every_function_of_the_standard_is_exported(cart_host):
    suffix = {"linux64": "so", "win64": "dll"}[platform]
    library = cart_host.folder / "binaries" / platform / f"PushedCart.{suffix}"
    slave = cart_host.instantiate()
    exported = [n for n in _functions() if hasattr(slave.fmu.dll, n)]
    slave.free()
    assert exported == _functions(), library


def _functions():
    types = ("Real", "Integer", "Boolean", "String")
    return [
        "fmi2GetTypesPlatform", "fmi2GetVersion", "fmi2SetDebugLogging", "fmi2Instantiate",
        "fmi2FreeInstance", "fmi2SetupExperiment", "fmi2EnterInitializationMode",
        "fmi2ExitInitializationMode", "fmi2Terminate", "fmi2Reset",
        *(f"fmi2{call}{kind}" for call in ("Get", "Set") for kind in types),
        "fmi2GetFMUstate", "fmi2SetFMUstate", "fmi2FreeFMUstate", "fmi2SerializedFMUstateSize",
        "fmi2SerializeFMUstate", "fmi2DeSerializeFMUstate", "fmi2GetDirectionalDerivative",
        "fmi2SetRealInputDerivatives", "fmi2GetRealOutputDerivatives", "fmi2DoStep",
        "fmi2CancelStep", "fmi2GetStatus", "fmi2GetRealStatus", "fmi2GetIntegerStatus",
        "fmi2GetBooleanStatus", "fmi2GetStringStatus",
    ]  # fmt: skip
