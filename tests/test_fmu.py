"""FMUs as an importer sees them: a cart with every kind of variable, and our three."""

from __future__ import annotations

import math
import os
import shutil
import subprocess
import sys
import zipfile
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest
from fmi_host import Host
from fmpy import platform
from fmpy.validation import validate_fmu
from pldf.fmi.packing.builder import Package, Recipe, build

import build_fmu

OK, DISCARD, FATAL = 0, 2, 4
EXAMPLE = Path(__file__).parent / "fmi_example"
OURS = build_fmu.FMUS["AdaptivePLDF"]


def cart_recipe(example: Path = EXAMPLE, pldf: Package = build_fmu.PLDF) -> Recipe:
    script = example / "cart_slave.py"
    return replace(OURS, script=script, packages=(pldf, Package(example / "cart")))


def recipe_with(folder: Path, file: str, old: str, new: str) -> Recipe:
    """Return the recipe of the cart from sources in which ``old`` was replaced."""
    shutil.copytree(EXAMPLE, folder / "example")
    shutil.copytree(build_fmu.PLDF.folder, folder / "pldf")
    source = folder / file
    assert old in source.read_text()
    source.write_text(source.read_text().replace(old, new))
    return cart_recipe(folder / "example", Package(folder / "pldf", build_fmu.PLDF.skip))


@pytest.fixture(scope="module")
def cart_fmu(tmp_path_factory) -> Path:
    return build(cart_recipe(), tmp_path_factory.mktemp("cart"))


@pytest.fixture(scope="module")
def cart_host(cart_fmu, tmp_path_factory) -> Host:
    return Host(cart_fmu, tmp_path_factory.mktemp("unpacked"))


@pytest.fixture
def cart(cart_host):
    slave = cart_host.instantiate()
    yield slave
    slave.free()


@pytest.fixture(scope="session")
def dist(tmp_path_factory) -> Path:
    out = tmp_path_factory.mktemp("dist")
    assert build_fmu.main(["--out", str(out)]) == 0
    return out


def push(slave, **values):
    """Start a cart that moves."""
    return slave.start(force_n=4.0, **values)


# The archive


@pytest.mark.parametrize("name", build_fmu.FMUS)
def test_fmus_are_valid_and_complete(dist, name):
    path = dist / f"{name}.fmu"
    assert validate_fmu(str(path)) == []
    names = set(zipfile.ZipFile(path).namelist())
    assert {
        f"binaries/linux64/{name}.so",
        f"binaries/win64/{name}.dll",
        "documentation/index.html",
        "documentation/licenses/LICENSE.txt",
        "documentation/licenses/pythonfmu.txt",
        "model.png",
        "modelDescription.xml",
        "resources/slavemodule.txt",
    } <= names
    unwanted = ("/study/", "commands", "cli.py", "compiled", "packing", "__pycache__", "numba")
    assert not [n for n in names if any(part in n for part in unwanted)]


def test_same_sources_give_the_same_bytes(cart_fmu, tmp_path):
    shutil.copytree(EXAMPLE, tmp_path / "moved")
    again = build(cart_recipe(tmp_path / "moved"), tmp_path / "out")
    assert again.read_bytes() == cart_fmu.read_bytes()


def test_guids_differ(dist, cart_fmu):
    guids = {Host(p).description.guid for p in [cart_fmu, *dist.glob("*.fmu")]}
    assert len(guids) == 4


def test_invalid_fmu_fails_the_build(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(build_fmu, "FMUS", {"Cart": cart_recipe()})
    monkeypatch.setattr(build_fmu, "validate_fmu", lambda _: ["something is wrong"])
    assert build_fmu.main(["--out", str(tmp_path)]) == 1
    assert "Cart: not a valid FMU:\n  something is wrong" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_source_that_needs_more_than_numpy_fails_the_build(tmp_path, monkeypatch, capsys):
    bad = recipe_with(tmp_path, "pldf/instance.py", "import json\n", "import json, numba\n")
    monkeypatch.setattr(build_fmu, "FMUS", {"Cart": bad})
    assert build_fmu.main(["--out", str(tmp_path / "out")]) == 1
    assert "'numba' must not be needed in an FMU" in capsys.readouterr().err


# The model description, rules 1 to 4 of strict importers


@pytest.fixture(params=["cart", *build_fmu.FMUS])
def xml(request, cart_fmu, dist):
    path = cart_fmu if request.param == "cart" else dist / f"{request.param}.fmu"
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
        assert variable.get("variability") == ("fixed" if causality == "parameter" else expected)
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
        assert kind.get("unit") is None or kind.get("unit") in units
        if kind.tag == "Enumeration":
            assert kind.get("declaredType") in types
        assert kind.get("displayUnit") == ("km/h" if kind.get("unit") == "m/s" else None)


def test_value_references_and_names_are_unique(xml):
    variables = xml.findall("ModelVariables/ScalarVariable")
    assert [int(v.get("valueReference")) for v in variables] == list(range(len(variables)))
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


# A run


def test_outputs_are_valid_after_initialization(cart):
    push(cart)
    assert cart.get("acceleration_mps2") == 2.0
    assert cart.get("engaged") == 1


def test_values_may_be_set_before_the_experiment_is_set_up_and_while_initializing(cart):
    cart.set(body__mass_kg=4.0, force_n=1.0)
    cart.fmu.setupExperiment(startTime=0.0)
    cart.fmu.enterInitializationMode()
    cart.set(force_n=8.0)
    cart.fmu.exitInitializationMode()
    assert cart.get("acceleration_mps2") == 2.0


def test_feedthrough_is_recomputed_in_initialization_mode_and_between_steps(cart):
    cart.fmu.setupExperiment(startTime=0.0)
    cart.fmu.enterInitializationMode()
    for force in (1.0, 5.0):
        cart.set(force_n=force)
        assert cart.get("acceleration_mps2") == force / 2.0
    cart.set(body__mass_kg=1.0)
    assert cart.get("acceleration_mps2") == 5.0
    cart.fmu.exitInitializationMode()
    cart.fmu.doStep(0.0, 0.01)
    before = cart.outputs()
    cart.set(force_n=-3.0, brake=True)
    assert cart.get("acceleration_mps2") == 0.0
    cart.set(brake=False)
    assert cart.outputs() == {**before, "acceleration_mps2": -3.0}


def test_reading_while_initializing_does_not_change_the_run(cart_host):
    runs = []
    for curious in (False, True):
        cart = cart_host.instantiate()
        cart.fmu.setupExperiment(startTime=0.0)
        cart.fmu.enterInitializationMode()
        if curious:
            cart.outputs()
        cart.set(force_n=3.0, memory_size=7)
        if curious:
            cart.outputs()
        cart.fmu.exitInitializationMode()
        runs.append(cart.run(0.0, 20))
        assert cart.texts("logStatusWarning") == ["memory of 7, 50%% used"]
        cart.free()
    assert runs[0] == runs[1]


def test_reset_starts_anew_and_runs_identically(cart):
    first = push(cart).run(0.0, 30)
    cart.fmu.reset()
    assert cart.get("force_n") == 0.0
    assert push(cart).run(0.0, 30) == first


@pytest.mark.parametrize("phase", ["stepping", "initializing", "instantiated"])
def test_state_continues_identically_in_another_instance(cart_host, phase):
    one, two = cart_host.instantiate(), cart_host.instantiate("two")
    two.start(force_n=-1.0, memory_size=50).run(0.0, 5)
    one.set(force_n=4.0, memory_size=2)
    if phase != "instantiated":
        one.fmu.setupExperiment(startTime=0.0)
        one.fmu.enterInitializationMode()
        assert one.get("acceleration_mps2") == 2.0
    steps = 10
    if phase == "stepping":
        one.fmu.exitInitializationMode()
        one.run(0.0, steps)
    state = one.state()
    ends = []
    for slave in (one, one, two):
        assert slave.restore(state) == OK
        if phase == "stepping":
            assert slave.state() == state
        if phase == "instantiated":
            slave.fmu.enterInitializationMode()
        if phase != "stepping":
            slave.fmu.exitInitializationMode()
        ends.append(slave.run(steps * 0.01, 10, gear=2))
    one.free()
    two.free()
    assert ends[0] == ends[1] == ends[2]


def test_restored_run_is_finished_with_its_own_parameters(cart_host, tmp_path):
    logs = [tmp_path / "one.txt", tmp_path / "two.txt"]
    one = push(cart_host.instantiate(), log_file=str(logs[0]))
    one.run(0.0, 3)
    state = one.state()
    two = push(cart_host.instantiate("two"), log_file=str(logs[1]))
    two.run(0.0, 1)
    fresh = cart_host.instantiate("fresh")
    for slave in (two, fresh):
        assert slave.restore(state) == OK
        slave.run(0.03, 2)
        slave.fmu.terminate()
    for slave in (one, two, fresh):
        slave.free()
    assert runs_of(logs[0]) == ["5 steps", "5 steps", "3 steps"]
    assert runs_of(logs[1]) == []


@pytest.mark.parametrize("damage", [lambda s: b"", lambda s: s[:-1], lambda s: b"x" + s[1:]])
def test_damaged_state_is_refused_and_changes_nothing(cart, damage):
    push(cart).run(0.0, 3)
    state = cart.state()
    assert cart.restore(damage(state)) == FATAL
    assert cart.texts()
    assert cart.state() == state
    cart.fmu.doStep(0.03, 0.01)


@pytest.mark.parametrize("step_s", [0.001, 0.01, 0.02, 0.1, 1.7e-13])
def test_communication_steps(cart, step_s):
    push(cart)
    time = 0.0
    for _ in range(20):
        cart.fmu.doStep(time, step_s)
        time += step_s + 1e-13
    assert cart.get("steps") == 20


# The end of a run


def runs_of(log: Path) -> list[str]:
    return log.read_text().splitlines() if log.exists() else []


@pytest.mark.parametrize("ending", ["terminate", "reset", "free", "terminate reset", "reset reset"])
def test_a_run_is_finished_exactly_once(cart_host, tmp_path, ending):
    log = tmp_path / "log.txt"
    cart = push(cart_host.instantiate(), log_file=str(log))
    cart.run(0.0, 3)
    for call in ending.split():
        if call != "free":
            getattr(cart.fmu, call)()
    if "free" not in ending:
        assert runs_of(log) == ["3 steps"]
    cart.free()
    assert runs_of(log) == ["3 steps"]


def test_a_run_that_never_started_is_not_finished(cart_host, tmp_path):
    log = tmp_path / "log.txt"
    cart = cart_host.instantiate()
    cart.set(log_file=str(log))
    cart.fmu.setupExperiment(startTime=0.0)
    cart.fmu.enterInitializationMode()
    cart.outputs()
    cart.free()
    assert runs_of(log) == []


def test_failure_at_the_very_end_is_said_on_stderr(cart_host, tmp_path, capfd):
    folder = tmp_path / "gone"
    folder.mkdir()
    cart = push(cart_host.instantiate("last one"), log_file=str(folder / "log.txt"))
    folder.rmdir()
    cart.free()
    assert "PushedCart 'last one': FileNotFoundError" in capfd.readouterr().err


# Wrong use: an error status, a message, no crash, and the instance goes on


def test_wrong_call_order(cart):
    assert cart.status("doStep", 0.0, 0.01) == DISCARD
    for call in ("exitInitializationMode", "terminate"):
        assert cart.status(call) == FATAL
    push(cart)
    for call in ("setupExperiment", "enterInitializationMode", "exitInitializationMode"):
        assert cart.status(call) == FATAL
    cart.run(0.0, 3)
    cart.fmu.terminate()
    assert cart.status("doStep", 0.03, 0.01) == DISCARD
    assert cart.status("terminate") == FATAL
    assert cart.get("steps") == 3
    assert len(cart.texts()) == 8
    assert cart.texts()[0] == "fmi2DoStep is not allowed in phase INSTANTIATED; step discarded"
    assert cart.texts()[2] == "fmi2Terminate is not allowed in phase INSTANTIATED, only in STEPPING"


@pytest.mark.parametrize("call", ["getReal", "getInteger", "getBoolean", "getString"])
@pytest.mark.parametrize("reference", [13, 99, 2**31, 2**32 - 1])
def test_unknown_value_reference_when_reading(cart, call, reference):
    push(cart)
    for _ in range(5):
        assert cart.status(call, [reference]) == FATAL
    assert (
        f"value reference {reference - (1 << 32 if reference >= 1 << 31 else 0)}" in cart.texts()[0]
    )
    cart.fmu.reset()
    assert len(push(cart).run(0.0, 3)) == 3


@pytest.mark.parametrize(
    ("call", "reference", "value", "message"),
    [
        ("setReal", 1, 1.0, "no Real variable with value reference 1"),
        ("setInteger", 3, 1, "no Enumeration/Integer variable"),
        ("setBoolean", 77, True, "no Boolean variable"),
        ("setString", 0, "x", "no String variable"),
        ("setReal", 6, 1.0, "position_m is an output, it cannot be set"),
        ("setReal", 0, 1.0, "setting a fixed parameter is not allowed in phase STEPPING"),
        ("setString", 12, "x", "setting a fixed parameter is not allowed in phase STEPPING"),
    ],
)
def test_what_cannot_be_set(cart, call, reference, value, message):
    push(cart)
    for _ in range(5):
        assert cart.status(call, [reference], [value]) == FATAL
    assert message in cart.texts()[0]
    assert len(cart.run(0.0, 3)) == 3


@pytest.mark.parametrize("step_s", [0.0, -0.01, 1e9, math.nan, math.inf])
def test_senseless_steps_are_discarded(cart, step_s):
    push(cart).run(0.0, 3)
    before = cart.state()
    for _ in range(3):
        assert cart.status("doStep", 0.03, step_s) == DISCARD
    assert cart.state() == before
    assert "a step must be above 0 and at most 60 s" in cart.texts()[0]
    assert len(cart.run(0.03, 3)) == 3


@pytest.mark.parametrize("time", [0.02, -1.0, math.nan, math.inf])
def test_senseless_times_are_discarded(cart, time):
    push(cart).run(0.0, 3)
    before = cart.state()
    assert cart.status("doStep", time, 0.01) == DISCARD
    assert cart.state() == before


@pytest.mark.parametrize("time", [math.nan, math.inf])
def test_senseless_start_times_are_refused(cart, time):
    assert cart.status("setupExperiment", None, time) == FATAL
    assert "the start time must be finite" in cart.texts()[0]
    push(cart)


def test_unusable_parameter_is_refused_with_a_clear_message(cart, capfd):
    cart.set(log_file="/no/such/folder/log.txt")
    cart.fmu.setupExperiment(startTime=0.0)
    cart.fmu.enterInitializationMode()
    assert cart.status("exitInitializationMode") == FATAL
    assert cart.texts() == ["log_file /no/such/folder/log.txt: no such folder, 100%% sure"]
    error = capfd.readouterr().err
    assert (
        error == "PushedCart 'one': log_file /no/such/folder/log.txt: no such folder, 100% sure\n"
    )
    cart.set(log_file="")
    cart.fmu.exitInitializationMode()
    assert len(cart.run(0.0, 3)) == 3


def test_exception_in_a_model_is_survived(cart, tmp_path):
    log = tmp_path / "log.txt"
    push(cart, log_file=str(log)).run(0.0, 3)
    cart.set(force_n=666.0)
    for _ in range(3):
        assert cart.status("doStep", 0.03, 0.01) == FATAL
    assert "ZeroDivisionError: the devil is in the 1%% detail (in step" in cart.texts()[0]
    cart.set(force_n=1.0)
    assert len(cart.run(0.03, 3)) == 3
    cart.fmu.terminate()
    assert runs_of(log) == ["6 steps"]


def test_messages_go_through_the_logger_once_and_nothing_to_stdout(cart, capfd):
    folder = os.getcwd()
    push(cart).run(0.0, 50)
    cart.fmu.terminate()
    assert [entry for entry in cart.log if entry[1]] == [
        (1, "logStatusWarning", "memory of 3, 50%% used")
    ]
    assert capfd.readouterr() == ("", "")
    assert os.getcwd() == folder


# Names and places


@pytest.mark.parametrize(
    "name", ["a b", "/tmp/x/y.z", "C:\\models\\a b", "%s%n%d", "ü ' \" {}", ""]
)
def test_instance_names(cart_host, name):
    cart = push(cart_host.instantiate(name))
    assert cart.status("doStep", 0.0, -1.0) == DISCARD
    cart.free()


@pytest.mark.skipif(os.name == "nt", reason="spelling of paths on POSIX systems")
@pytest.mark.parametrize(
    "spelling", ["file://{}/resources", "file:///{}/resources", "file://{}/resources/"]
)
def test_resource_locations(cart_fmu, tmp_path, spelling):
    host = Host(cart_fmu, tmp_path / "with space")
    place = str(host.folder).replace(" ", "%20")
    cart = host.instantiate(location=spelling.format(place))
    assert len(push(cart).run(0.0, 3)) == 3
    cart.free()


LOCATION = """
import sys
from pathlib import Path
sys.path.insert(0, {tests!r})
from fmi_host import Host
Host(Path({fmu!r}), Path({folder!r})).instantiate(location={location!r}).start()
"""


@pytest.mark.skipif(os.name == "nt", reason="spelling of paths on POSIX systems")
@pytest.mark.xfail(strict=True, reason="pythonfmu 0.7.0 crashes before any Python of the FMU runs")
@pytest.mark.parametrize("location", ["file:{}/resources", "file://{}%2B/resources"])
def test_resource_locations_that_the_wrapper_cannot_read(cart_fmu, tmp_path, location):
    """When this passes, the wrapper was repaired: docs/fmu.md can lose a limit."""
    folder = tmp_path / ("here+" if "%2B" in location else "here")
    script = LOCATION.format(
        tests=str(EXAMPLE.parent),
        fmu=str(cart_fmu),
        folder=str(folder),
        location=location.format(tmp_path / "here"),
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, check=False)
    assert done.returncode == 0


@pytest.mark.skipif(os.name == "nt", reason="permissions of POSIX systems")
def test_resources_may_be_read_only(cart_fmu, tmp_path):
    host = Host(cart_fmu, tmp_path / "fmu")
    for path in sorted(host.folder.rglob("*")):
        path.chmod(0o555 if path.is_dir() else 0o444)
    try:
        cart = push(host.instantiate())
        assert len(cart.run(0.0, 3)) == 3
        cart.free()
    finally:
        for path in sorted(host.folder.rglob("*")):
            path.chmod(0o755)


# Several at once, one after the other


def test_two_instances_do_not_share_anything(cart_host):
    alone = push(cart_host.instantiate())
    expected = alone.run(0.0, 20)
    one, two = cart_host.instantiate("one"), cart_host.instantiate("two")
    push(one)
    two.start(force_n=-9.0, memory_size=5)
    found = []
    for step in range(20):
        found += one.run(step * 0.01, 1)
        two.run(step * 0.01, 1)
    for slave in (alone, one, two):
        slave.free()
    assert found == expected


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("example/cart/model.py", "0.125 * step_s", "0.250 * step_s"),
        ("pldf/instance.py", "def report(", "def report_(self) -> None: ...\n\n    def report("),
        ("example/cart_slave.py", "A cart pushed", "A cart shoved"),
    ],
)
def test_two_builds_in_one_process_run_their_own_code(cart_fmu, tmp_path, file, old, new):
    other_fmu = build(recipe_with(tmp_path, file, old, new), tmp_path / "out")
    hosts = [Host(cart_fmu), Host(other_fmu)]
    assert hosts[0].description.guid != hosts[1].description.guid
    slaves = [push(host.instantiate()) for host in hosts]
    ends = [slave.run(0.0, 10)[-1]["position_m"] for slave in slaves]
    assert (ends[0] == ends[1]) == ("model" not in file)
    loaded = {name for name in sys.modules if name.startswith("cart_slave_")}
    for slave, host in zip(slaves, hosts, strict=True):
        slave.free()
        names = {p.name.removesuffix(".py") for p in host.folder.glob("resources/cart_slave_*")}
        assert names <= loaded
        shutil.rmtree(host.folder)


def test_load_unload_load_while_the_first_folder_vanishes(cart_fmu, tmp_path):
    expected = None
    for turn in range(3):
        host = Host(cart_fmu, tmp_path / str(turn))
        cart = push(host.instantiate())
        found = cart.run(0.0, 10)
        expected = expected or found
        assert found == expected
        cart.free()
        shutil.rmtree(host.folder)


def test_host_keeps_its_import_path(cart_host):
    before = list(sys.path)
    for _ in range(3):
        cart_host.instantiate().free()
    assert sys.path == before


def test_many_instances_one_after_the_other(cart_host):
    for number in range(60):
        cart = push(cart_host.instantiate(f"number {number}"))
        cart.status("getReal", [99])
        cart.fmu.doStep(0.0, 0.01)
        cart.fmu.reset()
        cart.free()


CLEAN_PROCESS = """
import sys
from pathlib import Path
sys.path.insert(0, {tests!r})
from fmi_host import Host
assert "pythonfmu" not in sys.modules
host = Host(Path({fmu!r}))
cart = host.instantiate()
cart.start(force_n=4.0)
print(cart.run(0.0, 100)[-1]["position_m"])
cart.status("getReal", [99])
cart.status("getReal", [99])
assert sys.modules["pythonfmu"].__file__.startswith(str(host.folder)), sys.modules["pythonfmu"]
if {free}:
    cart.free()
"""


@pytest.mark.parametrize("free", [True, False])
def test_clean_process_without_the_project(cart_fmu, cart, tmp_path, free):
    """The FMU brings its own pythonfmu, and the process ends well with or without a release."""
    script = CLEAN_PROCESS.format(tests=str(EXAMPLE.parent), fmu=str(cart_fmu), free=free)
    done = subprocess.run(
        [sys.executable, "-c", script],
        cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) == push(cart).run(0.0, 100)[-1]["position_m"]


# Our three


@pytest.mark.parametrize("name", build_fmu.FMUS)
def test_our_fmus_run_and_start_anew(dist, name, monkeypatch, tmp_path):
    monkeypatch.setenv("PLDF_PROFILE_STORE", str(tmp_path))
    host = Host(dist / f"{name}.fmu")
    slave = host.instantiate().start()
    first = slave.outputs()
    run = slave.run(0.0, 50)
    slave.fmu.terminate()
    state = slave.state()
    slave.fmu.reset()
    assert slave.start().outputs() == first
    assert slave.run(0.0, 50) == run
    assert slave.restore(state) == OK
    slave.free()
    assert all(math.isfinite(v) for o in (first, *run) for v in o.values())


def drive_on(slave, first: int, steps: int) -> list:
    """Drive at a constant 20 m/s from step ``first`` on and return the outputs."""
    found = []
    for step in range(first, first + steps):
        slave.set(vehicle__s_m=0.2 * step, vehicle__speed_mps=20.0, lever__resume=True)
        found += slave.run(0.01 * step, 1)
    return found


def test_drive_restored_in_another_instance_is_learned_for_its_own_driver(dist, tmp_path):
    host = Host(dist / "AdaptivePLDF.fmu")
    files = {"profile_store": str(tmp_path), "learn": 1}
    first = host.instantiate("first").start(**files, driver_id=1)
    other = host.instantiate("other").start(**files, driver_id=2)
    fresh = host.instantiate("fresh")
    drive_on(first, 0, 100)
    state = first.state()
    expected = drive_on(first, 100, 50)
    first.fmu.terminate()
    for slave in (other, fresh):
        assert slave.restore(state) == OK
        assert drive_on(slave, 100, 50) == expected
        slave.fmu.terminate()
    for number, slave in enumerate((first, other, fresh), start=1):
        assert f"drive {number} learned" in slave.texts("logEvents")[-1]
        slave.free()
    assert [p.name[:14] for p in tmp_path.glob("*.pldf")] == ["driver-000001_"]


def test_next_drive_follows_what_the_last_one_learned(dist, tmp_path):
    host = Host(dist / "AdaptivePLDF.fmu")
    found = []
    for ending in ("terminate", "reset", "freeInstance"):
        slave = host.instantiate().start(profile_store=str(tmp_path), learn=1)
        found.append((slave.get("profile.iteration"), slave.get("profile.status")))
        drive_on(slave, 0, 100)
        getattr(slave.fmu, ending)()
        if ending != "freeInstance":
            slave.free()
    last = host.instantiate().start(profile_store=str(tmp_path))
    assert [*found, (last.get("profile.iteration"), last.get("profile.status"))] == [
        (0, 0), (1, 1), (2, 1), (3, 1)
    ]  # fmt: skip
    last.free()


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("name", build_fmu.FMUS)
def test_inputs_that_are_no_numbers_never_come_out(dist, name, value):
    slave = Host(dist / f"{name}.fmu").instantiate().start()
    inputs = [n for n, v in slave.variables.items() if (v.causality, v.type) == ("input", "Real")]
    time = 0.0
    for bad in inputs:
        slave.set(**{bad: value})
        between = slave.outputs()
        after = slave.run(time, 2)
        assert all(math.isfinite(v) for o in (between, *after) for v in o.values()), bad
        slave.set(**{bad: 0.0})
        slave.run(time + 0.02, 2)
        time += 0.04
    assert len(slave.log) < 4 * len(inputs)
    slave.free()


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"route_id": 999}, "999"),
        ({"route_file": "/no/such/road.xodr"}, "/no/such/road.xodr"),
        ({"planner__accel_max_mps2": math.nan}, "planner.accel_max_mps2"),
        ({"learn": 7}, "learn"),
        ({"localization": -1}, "localization"),
    ],
)
def test_unusable_parameters_of_the_driving_function(dist, values, message):
    slave = Host(dist / "AdaptivePLDF.fmu").instantiate()
    slave.set(**values)
    slave.fmu.setupExperiment(startTime=0.0)
    slave.fmu.enterInitializationMode()
    assert slave.status("exitInitializationMode") == FATAL
    (text,) = slave.texts()
    assert message in text
    assert "Traceback" not in text
    slave.free()


def test_all_three_in_one_process(dist, monkeypatch, tmp_path):
    monkeypatch.setenv("PLDF_PROFILE_STORE", str(tmp_path))
    hosts = [Host(dist / f"{name}.fmu") for name in build_fmu.FMUS]
    slaves = [host.instantiate().start() for host in hosts]
    for slave in slaves:
        assert len(slave.run(0.0, 20)) == 20
    for slave in slaves:
        slave.free()


ONE_AFTER_THE_OTHER = """
import shutil, sys
from pathlib import Path
sys.path.insert(0, {tests!r})
from fmi_host import Host
for number, name in enumerate({names!r}):
    host = Host(Path({dist!r}, name + ".fmu"), Path(str(number)))
    slave = host.instantiate().start()
    slave.run(0.0, 5)
    slave.free()
    shutil.rmtree(host.folder)
"""


def test_one_after_the_other_from_folders_that_vanish(dist, tmp_path):
    names = list(build_fmu.FMUS)
    script = ONE_AFTER_THE_OTHER.format(
        tests=str(EXAMPLE.parent), dist=str(dist), names=[*reversed(names), *names]
    )
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == ""
