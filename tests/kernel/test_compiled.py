"""The kernel stays in the subset that compiles to machine code, and computes the same there."""

from __future__ import annotations

import ast
import inspect
import sys
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from types import CodeType, FrameType, FunctionType, ModuleType
from typing import Any

import numba
import numpy as np
import pytest
from laboratory import STEP_S
from numpy.typing import NDArray
from pldf.compiled import KERNEL_MODULES, compile_modules, kernel, pack, unpack
from pldf.instance import view, views, zeros
from pldf.kernel import replay as replay_module
from pldf.kernel import substeps
from pldf.kernel.arrays import NextArrays, ProfileArrays, RouteArrays, TraceArrays, Work
from pldf.kernel.codes import INPUT_OK, LAP_BEGUN_ANEW, LEARN_CONSISTENT, LEARN_FAITHFUL, XY
from pldf.kernel.replay import Samples
from pldf.kernel.state import PldfState
from pldf.profiles.learned_columns import LEARNED
from pldf.roads import packed_route, route_arrays

NODES = 1500
STEPS = 7000
FOLDER = Path(inspect.getfile(replay_module)).parent

Outcome = list[bytes]


@cache
def plain() -> dict[str, FunctionType]:
    """The same functions as in ``kernel()``, as CPython runs them."""
    return {
        name: value
        for module in KERNEL_MODULES
        for name, value in vars(module).items()
        if isinstance(value, FunctionType) and value.__module__ == module.__name__
    }


def part_of_the_study_road() -> RouteArrays:
    full = route_arrays(packed_route(0))
    return RouteArrays(*(np.array(column)[600 : 600 + NODES] for column in full))


class Bench:
    """A drive of 70 s with pedals, lever and a fault, by the functions given."""

    def __init__(
        self, functions: Mapping[str, Callable[..., Any]], native: bool, **start: Any
    ) -> None:
        self.functions, self.native = functions, native
        self.arrays = tuple(
            part_of_the_study_road() if kind is RouteArrays else zeros(kind, NODES)
            for kind in (RouteArrays, ProfileArrays, TraceArrays, Work, NextArrays)
        )
        seen = self.arrays if native else tuple(views(x) for x in self.arrays)
        self.route, self.profile, self.trace, self.work, self.following = seen
        self.plain_state = PldfState(learn=1, **start)
        self.packed = pack(self.plain_state)
        self.st: Any = self.packed.view(np.recarray)[0] if native else self.plain_state
        self.history: list[tuple[float, ...]] = []
        self.called: set[CodeType] = set()

    def state(self) -> PldfState:
        """The record, as CPython sees it."""
        if self.native:
            unpack(self.packed, self.plain_state)
        return self.plain_state

    def drive(self) -> None:
        """Plan and drive, with a point mass for a car."""
        self.functions["start_drive"](self.st, self.route, self.profile, self.work)
        self.functions["refresh"](self.st, self.route, self.profile)
        s_m, speed, acceleration = 0.5, 21.0, 0.0
        x_m, y_m = (np.array(self.arrays[0].x_m), np.array(self.arrays[0].y_m))
        nodes = np.arange(float(NODES))
        step = self.functions["drive_step"]
        for k in range(STEPS):
            st = self.st
            st.vehicle_s_m, st.vehicle_speed_mps = s_m, speed
            st.vehicle_x_m = float(np.interp(s_m, nodes, x_m))
            st.vehicle_y_m = float(np.interp(s_m, nodes, y_m)) + 0.5
            st.vehicle_acceleration_mps2 = acceleration if k != 6000 else float("nan")
            st.lever_resume = int(50 < k < 60 or 3600 < k < 3610)
            st.lever_up_long = int(2200 < k < 2210)
            st.driver_gas_pedal = 0.3 if 1000 < k < 1300 else 0.0
            st.driver_brake_pedal = 0.3 if 3000 < k < 3150 else 0.0
            self._let_a_car_cut_in(k)
            step(st, self.route, self.profile, self.trace, STEP_S if k % 100 else 0.037)
            wanted = float(st.acceleration_request_mps2) if st.function_active else 0.0
            acceleration = wanted + 4.0 * st.driver_gas_pedal - 7.0 * st.driver_brake_pedal
            speed = max(speed + acceleration * STEP_S, 0.0)
            s_m += speed * STEP_S
            seen = (wanted, st.mode, st.target_speed_mps, st.set_speed_mps, st.hmi_reason)
            self.history.append((*seen, st.hmi_next_distance_m, st.rate_combined))

    def _let_a_car_cut_in(self, k: int) -> None:
        """Too near, then gone for a moment, then braking to a stop; and a temporary limit."""
        st = self.st
        st.lead_present = int(4000 < k < 4300 or 4330 < k < 5000)
        st.lead_gap_m = 9.0 if k < 4100 else 25.0 if k < 4300 else 2.0
        st.lead_speed_mps = 8.0 if k < 4300 else 0.0
        st.limit_override_mps = 14.0 if 5500 < k < 5600 else 0.0

    def learn(self) -> None:
        """Learn, and take over what was learned, under a harder bound: so the bounds cut it."""
        given = (self.st, self.route, self.profile, self.trace, self.work, self.following)
        for name in ("evidence_slower", "pending_slower"):  # what this drive keeps silent about
            np.asarray(getattr(self.profile, name))[:] = 1.0
        # The same drive again and again: evidence waits, then accepts, a share of the set speed;
        # then all is learned at once.
        rounds = ((LEARN_CONSISTENT, 1.0), (LEARN_CONSISTENT, 0.6), (LEARN_FAITHFUL, 1.0))
        for learn, gain in rounds:
            self.st.learn, self.st.learning_set_speed_gain = learn, gain
            self.functions["learn_drive"](*given)
            for name in LEARNED:
                following = np.asarray(getattr(self.following, name))
                np.asarray(getattr(self.profile, name))[:] = following
        taught = (self.following.drive, self.following.offset_mps)
        self.taught = [np.count_nonzero(column) for column in taught]
        self.st.learning_lateral_accel_max_mps2 = 2.4
        self.functions["adopt_learned"](self.st, self.route, self.profile, self.work)

    def look(self) -> None:
        """What the cluster says along the road that was learned."""
        for i in range(0, NODES, 5):
            st = self.st
            st.mode, st.vehicle_s_m = 2, float(i)
            st.vehicle_x_m, st.vehicle_y_m = self.arrays[0].x_m[i], self.arrays[0].y_m[i]
            self.functions["refresh"](st, self.route, self.profile)
            self.history.append((st.hmi_reason, st.mode, st.hmi_learned_delta_mps))

    def speak(self) -> None:
        """The driver's last word, in every form."""
        st, given = self.st, (self.st, self.route, self.profile, self.trace)
        off = np.abs(np.asarray(self.profile.learned_mps) - np.asarray(self.profile.planned_mps))
        at = int(np.argmax(off))
        st.vehicle_s_m, st.vehicle_speed_mps = float(at), 40.0
        st.vehicle_x_m, st.vehicle_y_m = self.arrays[0].x_m[at], self.arrays[0].y_m[at]
        for button in ("teach_pause", "teach_undo", "teach_undo"):
            for pressed in (1, 0):
                setattr(st, button, pressed)
                self.functions["drive_step"](*given, 0.01)
        st.s_m, st.input_state = float(at), INPUT_OK
        self.functions["forget_here"](*given, self.work, self.following)
        self.functions["drive_step"](*given, 0.01)
        self.following.evidence_faster[at] = 1.25  # gone since
        self.functions["mark_lesson"](self.profile, self.following, self.work, 1)
        for column in self.following:
            np.asarray(column)[:] = 0.0
        st.taken_back = 1
        self.functions["take_back_lesson"](*given, self.work, self.following)
        self.history.append((st.hmi_event, st.words, st.settling, st.target_speed_mps))

    def run(self) -> None:
        """All of it."""
        self.drive()
        self.learn()
        self.look()
        self.speak()

    def outcome(self) -> Outcome:
        """Everything that came out, as bytes."""
        arrays = [np.asarray(x).tobytes() for group in self.arrays for x in group]
        history = np.array([value for row in self.history for value in row])
        return [history.tobytes(), pack(self.state()).tobytes(), *arrays]


@cache
def benches(localization: int = 0) -> tuple[Bench, Bench]:
    """The same drive in CPython, with notes of the functions called, and in machine code."""
    in_python = Bench(plain(), False, localization=localization)
    native = Bench(kernel(), True, localization=localization)

    def note(frame: FrameType, event: str, _: object) -> None:
        if event == "call":
            in_python.called.add(frame.f_code)

    before = sys.getprofile()
    sys.setprofile(note)
    try:
        in_python.run()
    finally:
        sys.setprofile(before)
    native.run()
    return in_python, native


@pytest.mark.parametrize("localization", [0, XY])
def test_a_drive_and_its_learning_are_the_same_to_the_bit(localization: int) -> None:
    in_python, native = benches(localization)
    assert in_python.outcome() == native.outcome()
    st = in_python.state()
    # The drive was worth comparing.
    assert st.drive_interventions == 2
    assert st.set_speed_ns > 0
    assert {row[1] for row in in_python.history} == {1, 2, 3, 4}
    assert min(in_python.taught) > 50
    assert st.words == 2


def test_replaying_a_recording_is_the_same_to_the_bit() -> None:
    results = []
    random = np.random.default_rng(3)
    count = 2000
    brought_back = np.arange(count) < 100  # to where the drive begins
    columns = [
        0.05 * np.arange(count),
        np.cumsum(random.uniform(-0.05, 1.2, count)) + 300.0 * brought_back,
        random.uniform(0.0, 30.0, count),
        np.where(brought_back, 1.0, random.integers(0, 5, count)),
        random.choice([0.0, 0.3], count),
        random.choice([20.0, 25.0], count),
        random.choice([0.0, 2.0], count),
        random.integers(0, 2, count).astype(float),
        random.integers(0, 2, count).astype(float),
        random.integers(0, 2, count).astype(float),
        random.choice([0.0, 15.0], count),
    ]
    for functions, native in ((plain(), False), (kernel(), True)):
        bench = Bench(functions, native)
        samples = Samples(*(columns if native else map(view, columns)))  # type: ignore[arg-type]
        functions["replay"](bench.st, bench.route, bench.trace, samples)
        results.append(bench.outcome())
        assert bench.state().lap == LAP_BEGUN_ANEW
    assert results[0] == results[1]


SMALL_CALLS: dict[str, list[tuple[Any, ...]]] = {
    "cell_at": [(10, s) for s in (-1.0, 0.0, 3.7, 9.0, 1e9)],
    "cell_cap": [(20.0, 0.01, 2.5), (10.0, 0.0, 2.5)],
    "next_mode": [(mode, event) for mode in range(5) for event in range(10)],
    "stretched_position": [(101.3, 140.7, 0.3)],
    "source_position": [(101.3, 140.7, 0.3)],
    "curvature_factor": [(k, 0.004, 0.016) for k in (0.0, 0.004, 0.0073, 0.016, 0.1)],
    "steepest_rise": [(-3.1, 0.15, 4.0), (0.07, 0.15, 4.0), (3.9, 0.15, 4.0)],
}


@pytest.mark.parametrize("name", SMALL_CALLS)
def test_single_functions_are_the_same_to_the_bit(name: str) -> None:
    for arguments in SMALL_CALLS[name]:
        assert kernel()[name](*arguments) == plain()[name](*arguments)


def test_that_drive_has_called_every_function_of_the_kernel() -> None:
    called = benches()[0].called | benches(XY)[0].called
    missing = {name for name, function in plain().items() if function.__code__ not in called}
    assert missing == {"replay", "_set_back"}  # compared above


def test_code_that_allocates_does_not_compile() -> None:
    """All of the above was compiled without numba's runtime: this is what proves it."""
    module = ModuleType("allocating")
    source = FunctionType(_allocating.__code__, {"np": np}, "allocating")
    source.__module__ = "allocating"
    module.np, module.allocating = np, source  # type: ignore[attr-defined]
    assert _allocating(3) == 0.0
    with pytest.raises(numba.core.errors.TypingError, match="zeros"):
        _compiled(module)["allocating"](3)


def _allocating(count: int) -> float:
    return float(np.zeros(count)[0])


def _compiled(module: ModuleType) -> dict[str, Callable[..., Any]]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(inspect, "getsource", lambda _: "made in a test")
        return compile_modules((module,))


# The subset, from the source


ALLOWED_CALLS = {"len", "range", "min", "max", "abs", "int", "float", "sqrt", "floor"}
FORBIDDEN = {
    ast.Try: "exceptions", ast.Raise: "exceptions", ast.Assert: "exceptions",
    ast.With: "contexts", ast.List: "lists", ast.Dict: "dictionaries", ast.Set: "sets",
    ast.ListComp: "lists", ast.DictComp: "dictionaries", ast.SetComp: "sets",
    ast.GeneratorExp: "generators", ast.Yield: "generators", ast.Lambda: "closures",
    ast.JoinedStr: "strings", ast.Pow: "powers", ast.FloorDiv: "integer division",
    ast.Mod: "remainders", ast.Global: "globals", ast.Nonlocal: "closures",
    ast.Import: "imports", ast.ImportFrom: "imports", ast.Starred: "unpacking",
    ast.MatMult: "matrices", ast.Delete: "deleting",
}  # fmt: skip


def kernel_functions() -> list[Any]:
    found = []
    for module in KERNEL_MODULES:
        tree = ast.parse(inspect.getsource(module))
        for node in tree.body:
            if isinstance(node, ast.FunctionDef):
                found.append(pytest.param(node, id=f"{module.__name__[12:]}.{node.name}"))
    return found


@pytest.mark.parametrize("function", kernel_functions())
def test_the_source_stays_in_the_subset(function: ast.FunctionDef) -> None:
    body = function.body[1:] if ast.get_docstring(function) else function.body
    for node in (inner for statement in body for inner in ast.walk(statement)):
        reason = FORBIDDEN.get(type(node))
        assert reason is None, f"line {node.lineno}: {reason}"  # type: ignore[attr-defined]
        if isinstance(node, ast.Call):
            assert isinstance(node.func, ast.Name), f"line {node.lineno}: a method"
            known = node.func.id in ALLOWED_CALLS or node.func.id in kernel()
            assert known, f"line {node.lineno}: {node.func.id}"
            assert not node.keywords, f"line {node.lineno}: a named argument"
        if isinstance(node, ast.Constant):
            assert not isinstance(node.value, str), f"line {node.lineno}: a string"


def test_every_module_of_the_kernel_is_compiled() -> None:
    names = {module.__name__.rpartition(".")[2] for module in KERNEL_MODULES}
    tables = {"__init__", "arrays", "inputs", "ranges", "signals", "state", "units"}
    tables |= {"parameters", "following_parameters"}
    assert names == {path.stem for path in FOLDER.glob("*.py")} - tables


def test_two_functions_of_one_name_are_refused() -> None:
    twin = ModuleType("twin")
    source = FunctionType(_allocating.__code__, {}, "replay")
    source.__module__ = "twin"
    twin.replay = source  # type: ignore[attr-defined]
    with pytest.raises(ValueError, match="replay is defined in"):
        compile_modules((replay_module, twin))


def test_two_constants_of_one_name_must_be_equal() -> None:
    """The modules share one namespace: one would compute with the value of the other."""
    twin = ModuleType("twin")
    twin.SUBSTEP_MAX_S = 0.5  # type: ignore[attr-defined]
    with pytest.raises(ValueError, match="SUBSTEP_MAX_S in twin has another value elsewhere"):
        compile_modules((substeps, twin))


def test_packing_a_record_loses_nothing() -> None:
    record = PldfState(s_m=0.1, time_ns=2**60 + 1, mode=3)
    back: Any = PldfState()
    unpack(pack(record), back)
    assert back == record
    packed: NDArray[np.void] = pack(record)
    assert packed["time_ns"][0] == 2**60 + 1
