"""The SSP packages: rules of importers, schemas, values that fit the FMUs, the same bytes."""

from __future__ import annotations

import re
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from fmpy import read_model_description
from fmpy.ssp.ssd import read_ssd
from lxml import etree
from pldf.build import ssp
from pldf.build.packages import SERIES, Series, sources, start_values, write_packages
from pldf.cosim.fmu import Fmu
from pldf.cosim.kinds import PARTS_IN_TRAFFIC
from pldf.cosim.master import connections, unpacked
from pldf.errors import ModelError
from pldf.kernel.codes import MODE
from pldf.study.phases import PHASES
from pyssp_standard.ssp import SSP

IN_REPOSITORY = Path(__file__).parents[2] / "ssp"
NS = {
    prefix: f"http://ssp-standard.org/SSP1/SystemStructure{rest}"
    for prefix, rest in (("ssd", "Description"), ("ssc", "Common"), ("ssv", "ParameterValues"))
}
KINDS = ("Real", "Integer", "Boolean")


@pytest.fixture(scope="module", params=["fmu_folder", "native_folder"])
def folder(request: pytest.FixtureRequest) -> Path:
    """Return a folder with FMUs, Python ones or native ones, and the packages of them."""
    found: Path = request.getfixturevalue(request.param)
    return found


@pytest.fixture(scope="module", params=SERIES, ids=lambda series: series.name)
def series(request: pytest.FixtureRequest) -> Series:
    found: Series = request.param
    return found


@pytest.fixture(params=PHASES)
def package(request: pytest.FixtureRequest, folder: Path, series: Series) -> Path:
    return folder / f"{series.name}_{request.param}.ssp"


@pytest.fixture(scope="module")
def variables(folder: Path) -> dict[str, dict[str, Any]]:
    """Return what the FMUs themselves say of their variables, by part and name."""
    return {
        part: {
            variable.name: variable
            for variable in read_model_description(folder / f"{fmu}.fmu").modelVariables
        }
        for part, fmu in PARTS_IN_TRAFFIC.items()
    }


@pytest.fixture(scope="module")
def structure(folder: Path, series: Series) -> Any:
    with zipfile.ZipFile(folder / f"{series.name}_A1.ssp") as archive:
        return etree.fromstring(archive.read(ssp.STRUCTURE))


def test_sources_in_the_repository_are_what_is_packed(traffic_fmus: dict[str, Fmu]) -> None:
    """When this fails: pldf build --ssp-sources ssp."""
    there = {
        path.relative_to(IN_REPOSITORY).as_posix(): path.read_bytes()
        for path in IN_REPOSITORY.rglob("*")
        if path.is_file()
    }
    assert there == sources(traffic_fmus)


def test_packages_of_native_fmus_say_the_same(
    traffic_fmus: dict[str, Fmu], native_traffic_fmus: dict[str, Fmu]
) -> None:
    assert sources(native_traffic_fmus) == sources(traffic_fmus)


def test_packages_hold_the_fmus_and_the_sources(package: Path, series: Series) -> None:
    with zipfile.ZipFile(package) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    phase = package.stem.removeprefix(f"{series.name}_")
    said = IN_REPOSITORY / series.folder
    assert members.pop(ssp.STRUCTURE) == (said / ssp.STRUCTURE).read_bytes()
    for part, fmu in series.parts.items():
        text = members.pop(f"resources/{part}.ssv")
        assert text == (said / phase / f"{part}.ssv").read_bytes()
        assert members.pop(f"resources/{fmu}.fmu") == (package.parent / f"{fmu}.fmu").read_bytes()
    assert members == {}


def test_the_second_form_has_the_values_inline_and_says_the_same(
    package: Path, series: Series
) -> None:
    with zipfile.ZipFile(package) as archive, zipfile.ZipFile(_inline(package)) as inline:
        fmus = {name for name in archive.namelist() if name.endswith(".fmu")}
        assert set(inline.namelist()) == {ssp.STRUCTURE, *fmus}
        assert all(inline.read(name) == archive.read(name) for name in fmus)
        root = etree.fromstring(inline.read(ssp.STRUCTURE))
        for component in root.iterfind(".//ssd:Component", NS):
            (binding,) = component.iterfind("ssd:ParameterBindings/ssd:ParameterBinding", NS)
            assert dict(binding.attrib) == {}
            (values,) = binding.iterfind("ssd:ParameterValues/ssv:ParameterSet", NS)
            file = etree.fromstring(archive.read(f"resources/{component.get('name')}.ssv"))
            assert _values(values) == _values(file) != {}
            binding.getparent().remove(binding)
        usual = etree.fromstring(archive.read(ssp.STRUCTURE))
        for binding in list(usual.iterfind(".//ssd:ParameterBinding", NS)):
            binding.getparent().remove(binding)
        assert etree.tostring(root, method="c14n2", strip_text=True) == etree.tostring(
            usual, method="c14n2", strip_text=True
        )
    assert [e.name for e in read_ssd(str(_inline(package))).system.elements] == list(series.parts)


def _inline(package: Path) -> Path:
    return package.parent / "inline" / package.name


def _values(root: Any) -> dict[str, tuple[str, dict[str, str]]]:
    """Return type and attributes of each value by name."""
    return {
        parameter.get("name"): (etree.QName(parameter[0]).localname, dict(parameter[0].attrib))
        for parameter in root.iterfind("ssv:Parameters/ssv:Parameter", NS)
    }


def test_packages_are_the_same_bytes_on_each_build(folder: Path, tmp_path: Path) -> None:
    for fmu in PARTS_IN_TRAFFIC.values():
        (tmp_path / f"{fmu}.fmu").write_bytes((folder / f"{fmu}.fmu").read_bytes())
    with unpacked(tmp_path, PARTS_IN_TRAFFIC) as fmus:
        for path in write_packages(tmp_path, fmus):
            place = path.relative_to(tmp_path)
            assert path.read_bytes() == (folder / place).read_bytes()


def test_connectors_are_as_in_the_fmus_and_all_inputs_are_fed_once(
    structure: Any, variables: dict[str, dict[str, Any]]
) -> None:
    inputs = []
    for component in structure.iterfind(".//ssd:Component", NS):
        part = component.get("name")
        assert component.get("type") == "application/x-fmu-sharedlibrary"
        assert component.get("source") == f"resources/{PARTS_IN_TRAFFIC[part]}.fmu"
        for connector in component.iterfind("ssd:Connectors/ssd:Connector", NS):
            variable = variables[part][connector.get("name")]
            (kind,) = connector
            assert connector.get("kind") == variable.causality
            assert etree.QName(kind).localname == variable.type
            assert etree.QName(kind).localname in KINDS
            assert kind.get("unit") == variable.unit
            if connector.get("kind") == "input":
                inputs.append((part, connector.get("name")))
    fed = [
        (one.get("endElement"), one.get("endConnector"))
        for one in structure.iterfind(".//ssd:Connection", NS)
    ]
    assert len(fed) == len(set(fed))
    assert sorted(fed) == sorted(inputs)


def test_the_connections_are_those_of_the_coupled_drives(
    structure: Any, series: Series, traffic_fmus: dict[str, Fmu]
) -> None:
    fmus = {part: traffic_fmus[part] for part in series.parts}
    names = ("startElement", "startConnector", "endElement", "endConnector")
    found = [
        tuple(one.get(name) for name in names)
        for one in structure.iterfind(".//ssd:Connection", NS)
    ]
    assert found == [(*source, *target) for source, target in connections(fmus)]


def test_the_structure_is_flat_and_says_how_to_step(structure: Any, series: Series) -> None:
    assert structure.get("version") == "1.0"
    assert len(structure.findall(".//ssd:System", NS)) == 1
    path = "ssd:System/ssd:Annotations/ssc:Annotation[@type='org.openmodelica']"
    (annotation,) = structure.iterfind(path, NS)
    (master,) = annotation.iterfind(".//{*}SimulationInformation/{*}FixedStepMaster")
    assert float(master.get("stepSize")) == 0.01
    experiment = structure.find("ssd:DefaultExperiment", NS)
    path = "ssd:Annotations/ssc:Annotation[@type='org.openmodelica']//{*}SimulationInformation"
    (results,) = experiment.iterfind(path, NS)  # without it OMSimulator warns
    assert results.get("resultFile") == f"{structure.get('name')}.csv"
    long_enough = (211.0, 220.0) if series.traffic is None else (300.0, 400.0)
    assert long_enough[0] < float(experiment.get("stopTime")) <= long_enough[1]
    for gone in ("Enumerations", "SignalDictionaries", "SystemGeometry"):
        assert structure.find(f".//ssd:{gone}", NS) is None


def test_prefixes_are_literal(folder: Path) -> None:
    with zipfile.ZipFile(folder / "study_A1.ssp") as archive:
        assert b"<ssd:SystemStructureDescription " in archive.read(ssp.STRUCTURE)
        assert b"<ssv:ParameterSet " in archive.read("resources/pldf.ssv")


def test_values_fit_the_variables_of_the_fmus(
    package: Path, series: Series, variables: dict[str, dict[str, Any]]
) -> None:
    with zipfile.ZipFile(package) as archive:
        for part in series.parts:
            root = etree.fromstring(archive.read(f"resources/{part}.ssv"))
            assert root.get("name") == "initialValues"
            for parameter in root.iterfind("ssv:Parameters/ssv:Parameter", NS):
                variable = variables[part][parameter.get("name")]
                (value,) = parameter
                assert variable.causality == "parameter"
                assert etree.QName(value).localname == variable.type
                assert value.get("unit") == variable.unit
                if variable.type == "Boolean":
                    assert value.get("value") in ("true", "false")
                else:
                    low, high = float(variable.min), float(variable.max)
                    assert low <= float(value.get("value")) <= high


def test_the_documentation_says_what_makes_a_phase() -> None:
    text = (IN_REPOSITORY.parent / "docs" / "ssp.md").read_text(encoding="utf-8")
    row = re.compile(r"\| ([AB]\d) \| (\w+) \| (\w+) \| (\d).* \| (\d) \|")
    documented = {name: values for name, *values in row.findall(text)}
    made = {}
    for drive, phase in enumerate(PHASES.values()):
        values = start_values(phase, drive)
        flags = [bool(values["pldf"][name]) for name in ("apply_learned", "learn_faithful")]
        numbers = [values["driver"][name] for name in ("kind", "seed")]
        made[phase.name] = [*(str(flag).lower() for flag in flags), *map(str, numbers)]
    assert documented == made
    assert [phase.learn for phase in PHASES.values()] == [row[1] == "true" for row in made.values()]


def test_schemas_and_checks_of_pyssp(package: Path, series: Series) -> None:
    with SSP(package, mode="r") as opened:
        with opened.system_structure as described:
            described.__check_compliance__()
            everything = {"unconnected_inputs": True, "connector_not_in_system": True}
            assert described.check_connections(**everything) == []
            units = {unit.name for unit in described.units}
            bound = [
                binding.source
                for element in described.system.elements
                for binding in element.parameter_bindings
            ]
        assert units == {"1", "m", "m/s", "m/s2", "m/s3", "s"}
        assert sorted(bound) == [f"resources/{part}.ssv" for part in sorted(series.parts)]
        for values in opened.ssv:
            values.__check_compliance__()


def test_schemas_of_ssp_1_0(package: Path, series: Series) -> None:
    system = read_ssd(str(package)).system  # validates the structure and all parameter sets
    assert [element.name for element in system.elements] == list(series.parts)


def test_a_package_that_breaks_the_schema_is_not_left_behind(
    fmu_folder: Path, traffic_fmus: dict[str, Fmu], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for fmu in PARTS_IN_TRAFFIC.values():
        (tmp_path / f"{fmu}.fmu").write_bytes((fmu_folder / f"{fmu}.fmu").read_bytes())
    good = ssp.structure
    monkeypatch.setattr(ssp, "structure", lambda *of: good(*of).replace(b'kind="', b'sort="'))
    with pytest.raises(ModelError, match=r"study_A1\.ssp is not a valid SSP package"):
        write_packages(tmp_path, traffic_fmus)
    assert list(tmp_path.rglob("*.ssp")) == []


@pytest.mark.parametrize(
    ("values", "problem"),
    [
        ({"start_speed_mps": 81.0}, "start_speed_mps = 81.0 is not in 0 .. 80"),
        ({"grade_from_route": 2}, "grade_from_route = 2 is not in 0 .. 1"),
        ({"route_file": "road.csv"}, "not every SSP importer can handle type String"),
        ({"speed_mps": 1.0}, "speed_mps is an output"),
    ],
)
def test_values_that_no_fmu_would_take_are_refused(
    fmus: dict[str, Fmu], values: dict[str, Any], problem: str
) -> None:
    with pytest.raises(ValueError, match=problem):
        ssp.parameter_set(fmus["vehicle"].signals, values)


def test_an_enumeration_between_fmus_is_refused(traffic_fmus: dict[str, Fmu]) -> None:
    fmus = traffic_fmus
    changed = {}
    for part in ("driver", "pldf"):
        mode = replace(fmus[part].signals["mode"], kind="Enumeration", enumeration=MODE)
        changed[part] = replace(fmus[part], signals={**fmus[part].signals, "mode": mode})
    with pytest.raises(ModelError, match="mode: not every SSP importer can handle"):
        sources({**fmus, **changed})
