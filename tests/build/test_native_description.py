"""What the archives of native FMUs say in FMI 3.0: the same as in FMI 2.0, and its own rules."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element, fromstring

import pytest
from fmpy.validation import validate_fmu
from pldf.build import fmus as fmu_build
from pldf.build_version import build_version

TYPES = {"Float64": "Real", "Int32": "Integer"}  # the others have the same name


class Archives(NamedTuple):
    """One model in both versions of FMI, and what its model descriptions say."""

    path2: Path
    path3: Path
    xml2: Element
    xml3: Element


@pytest.fixture(params=fmu_build.FMUS)
def archives(request: pytest.FixtureRequest, native_folder: Path) -> Archives:
    file = f"{request.param}.fmu"
    paths = (native_folder / file, native_folder / "fmi3" / file)
    two, three = (fromstring(zipfile.ZipFile(p).read("modelDescription.xml")) for p in paths)
    return Archives(*paths, two, three)


def listed(root: Element, path: str) -> list[Element]:
    found = root.find(path)
    assert found is not None
    return list(found)


def variables2(root: Element) -> list[dict[str, str]]:
    """Return the variables of FMI 2.0 with their type's attributes."""
    return [{"type": v[0].tag, **v.attrib, **v[0].attrib} for v in listed(root, "ModelVariables")]


def variables3(root: Element) -> list[dict[str, str]]:
    """Return the variables of FMI 3.0 in the words of FMI 2.0."""
    found = []
    for v in listed(root, "ModelVariables"):
        start = v.find("Start")
        more = {"start": start.attrib["value"]} if start is not None else {}
        found.append({"type": TYPES.get(v.tag, v.tag), **v.attrib, **more})
    return found


def test_fmpy_finds_no_problem(archives: Archives) -> None:
    assert validate_fmu(str(archives.path2)) == []
    assert validate_fmu(str(archives.path3)) == []


def test_variables_are_those_of_fmi_2_and_the_time(archives: Archives) -> None:
    """Names, references, types, ranges, units, start values: only the spelling differs."""
    shared = variables3(archives.xml3)
    time = next(v for v in shared if v["causality"] == "independent")
    shared.remove(time)
    assert time.pop("valueReference") not in {v["valueReference"] for v in shared}
    assert shared == variables2(archives.xml2)
    assert time == {
        "type": "Real",
        "name": "time",
        "causality": "independent",
        "variability": "continuous",
        "description": "Simulation time",
        "unit": "s",
    }


def test_start_values_stand_where_they_must_and_nowhere_else(archives: Archives) -> None:
    for v in variables3(archives.xml3):
        assert ("start" in v) == (v["causality"] in ("parameter", "input")), v["name"]
        initial = {"parameter": "exact", "output": "calculated"}
        assert v.get("initial") == initial.get(v["causality"]), v["name"]
    texts = archives.xml3.findall("ModelVariables/String")
    assert texts
    assert not any("start" in text.attrib for text in texts)
    assert all(len(text) == (text.attrib["causality"] == "parameter") for text in texts)


def test_outputs_are_the_initial_unknowns(archives: Archives) -> None:
    known = variables3(archives.xml3)
    outputs = [v["valueReference"] for v in known if v["causality"] == "output"]
    structure = listed(archives.xml3, "ModelStructure")
    for name in ("Output", "InitialUnknown"):
        assert [e.attrib["valueReference"] for e in structure if e.tag == name] == outputs
    assert len(structure) == 2 * len(outputs)


def test_dependencies_are_those_of_fmi_2(archives: Archives) -> None:
    """There an index counts from one, here stands a value reference."""
    references = [int(v["valueReference"]) for v in variables2(archives.xml2)]

    def earlier(text: str | None) -> list[int] | None:
        return None if text is None else [references[int(index) - 1] for index in text.split()]

    def now(text: str | None) -> list[int] | None:
        return None if text is None else [int(reference) for reference in text.split()]

    for old, new in (("Outputs", "Output"), ("InitialUnknowns", "InitialUnknown")):
        before = [e.get("dependencies") for e in listed(archives.xml2, f"ModelStructure/{old}")]
        after = [e.get("dependencies") for e in archives.xml3.findall(f"ModelStructure/{new}")]
        assert [now(text) for text in after] == [earlier(text) for text in before]


def test_units_and_enumerations_are_defined(archives: Archives) -> None:
    units = {u.attrib["name"]: u for u in listed(archives.xml3, "UnitDefinitions")}
    types = {t.attrib["name"] for t in archives.xml3.findall("TypeDefinitions/EnumerationType")}
    for v in variables3(archives.xml3):
        if "unit" in v:
            displays = [e.attrib["name"] for e in units[v["unit"]].findall("DisplayUnit")]
            assert v.get("displayUnit") in (None, *displays)
        assert ("declaredType" in v) == (v["type"] == "Enumeration")
        assert v.get("declaredType") in (None, *types)
    assert all(unit.find("BaseUnit") is not None for unit in units.values())
    assert units.keys() == {v["unit"] for v in variables3(archives.xml3) if "unit" in v}


def test_capabilities(archives: Archives) -> None:
    two, three = (root.find("CoSimulation") for root in (archives.xml2, archives.xml3))
    assert two is not None
    assert three is not None
    assert two.attrib["modelIdentifier"] == three.attrib["modelIdentifier"] == archives.path2.stem
    for name in ("needsExecutionTool", "canBeInstantiatedOnlyOncePerProcess"):
        assert two.attrib[name] == three.attrib[name] == "false"
    able = {name for name, value in three.attrib.items() if value == "true"}
    assert able == {
        "canHandleVariableCommunicationStepSize",
        "canGetAndSetFMUState",
        "canSerializeFMUState",
    }
    assert three.attrib["hasEventMode"] == "false"


def test_identity_and_version(archives: Archives) -> None:
    two, three = archives.xml2.attrib, archives.xml3.attrib
    assert (two["fmiVersion"], three["fmiVersion"]) == ("2.0", "3.0")
    assert two["version"] == three["version"] == build_version()
    uuid = re.compile(r"\{[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}\}")
    assert uuid.fullmatch(two["guid"])
    assert uuid.fullmatch(three["instantiationToken"])
    assert two["guid"] != three["instantiationToken"]


def test_log_categories_and_default_experiment_are_those_of_fmi_2(archives: Archives) -> None:
    for path in ("LogCategories", "DefaultExperiment"):
        two, three = (root.find(path) for root in (archives.xml2, archives.xml3))
        assert two is not None
        assert three is not None
        assert [e.attrib for e in two.iter()] == [e.attrib for e in three.iter()]


def test_one_library_with_both_identities_is_in_both_archives(archives: Archives) -> None:
    name = archives.path2.stem
    two, three = (zipfile.ZipFile(path) for path in archives[:2])
    library = two.read(f"binaries/linux64/{name}.so")
    assert library == three.read(f"binaries/x86_64-linux/{name}.so")
    for identity in (
        archives.xml2.attrib["guid"],
        archives.xml3.attrib["instantiationToken"],
    ):
        assert library.count(identity.encode()) == 1


def test_members_are_where_the_standards_want_them(archives: Archives) -> None:
    two, three = (set(zipfile.ZipFile(path).namelist()) for path in archives[:2])
    resources = {name for name in two if name.startswith("resources/")}
    assert "resources/route/0.prepared" in resources
    shared = {
        "modelDescription.xml",
        "documentation/index.html",
        "documentation/licenses/license.txt",
        "documentation/licenses/zig.txt",
        *resources,
    }
    name = archives.path2.stem
    assert two == {*shared, "model.png", f"binaries/linux64/{name}.so"}
    assert three == {*shared, "terminalsAndIcons/icon.png", f"binaries/x86_64-linux/{name}.so"}


def test_documentation_says_that_nothing_else_is_needed(archives: Archives) -> None:
    for path, version in zip(archives[:2], ("2.0", "3.0"), strict=True):
        page = zipfile.ZipFile(path).read("documentation/index.html").decode()
        assert f"FMI {version} co-simulation" in page
        assert "nothing else has to be installed" in page
        assert "NumPy" not in page
        linked = re.findall(r'href="(licenses/[^"]+)"', page)
        assert {f"documentation/{place}" for place in linked} <= set(
            zipfile.ZipFile(path).namelist()
        )


def test_all_identities_differ(native_folder: Path) -> None:
    found = set()
    for path in (*native_folder.glob("*.fmu"), *native_folder.glob("fmi3/*.fmu")):
        root = fromstring(zipfile.ZipFile(path).read("modelDescription.xml"))
        found.add(root.get("guid") or root.get("instantiationToken"))
    assert len(found) == 2 * len(fmu_build.FMUS)
