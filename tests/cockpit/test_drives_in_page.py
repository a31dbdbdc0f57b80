"""Drives of the page's engine, and the same by the native FMUs: the same bytes."""

from __future__ import annotations

import base64
import json
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from node import node
from pldf.cockpit.bundle import bundle
from pldf.cockpit.desk_study import read_desk_study
from pldf.cosim.fmu import Fmu, Slave
from pldf.cosim.master import Drive, drive
from pldf.cosim.values import Value
from pldf.profiles.store import Iteration, read_profile
from pldf.recordings.recording import Recording, read_recording, recording_csv
from pldf.study.phases import TRAFFIC
from repeated_person import drive_again, read_changes

DRIVER = "tests/cockpit/javascript/engine_driven.mjs"
PERSON = {"who": "person", "pace": "real", "activate": True, "steering": "person"}
MODEL = {"who": "model", "pace": "fast", "activate": False, "steering": "assisted"}
COMMON = {"inputs": [], "device": "keyboard", "step_s": 0.01}
LEARNING = ("A2", "B1")


class Page(NamedTuple):
    """A bundle and what the page's engine did with it.

    Attributes:
        folder: with a folder per drive, and ``bundle.json``.
        plan: of the bundle.
        road: the prepared file.
    """

    folder: Path
    plan: dict[str, Any]
    road: Path

    def drive(self, drives: list[dict[str, Any]], name: str) -> Path:
        """Let the page's engine drive, one after the other with what was learned before."""
        folder = self.folder / name
        task = {"bundle": str(self.folder / "bundle.json"), "folder": str(folder), "drives": drives}
        result = node(DRIVER, given=json.dumps(task))
        assert result.returncode == 0, result.stderr
        return folder

    def values(self, phase: str) -> dict[str, dict[str, Value]]:
        """Return the values of a drive of the plan."""
        (found,) = (one for one in self.plan["drives"] if one["phase"] == phase)
        return {part: dict(values) for part, values in found["values"].items()}

    def setup(self, phase: str, more: Mapping[str, Any]) -> dict[str, Any]:
        """Return what the engine is told to drive."""
        return {
            **COMMON,
            "name": phase,
            "values": self.values(phase),
            "end_m": self.plan["end_m"],
            **more,
        }

    def natively(self, phase: str, store: Path) -> dict[str, dict[str, Value]]:
        """Return what the native FMUs are told for the same drive."""
        values = self.values(phase)
        values["pldf"]["profile_store"] = str(store)
        for chosen in values.values():
            chosen["route_file"] = str(self.road)
        return values


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Page:
    """Return the packaged study's page."""
    folder = tmp_path_factory.mktemp("page")
    made = bundle(read_desk_study())
    (folder / "bundle.json").write_text(json.dumps(made))
    road = folder / "road.prepared"
    road.write_bytes(base64.b64decode(made["road"]["prepared"]))
    return Page(folder, made["plan"], road)


@pytest.fixture(scope="module")
def driven(page: Page) -> Path:
    """Return the folder of a person's A2 and B1."""
    setups = [page.setup(phase, {**PERSON, "seed": ord(phase[0])}) for phase in LEARNING]
    return page.drive(setups, "person")


@pytest.fixture(scope="module")
def again(page: Page, driven: Path, native_fmus: dict[str, Fmu]) -> dict[str, Drive]:
    """Return the same drives by native FMUs; behind each, its profiles are in ``again/PHASE``."""
    store = page.folder / "store"
    drives = {}
    for phase in LEARNING:
        changes = read_changes(driven / phase / "inputs.csv")
        values = page.natively(phase, store)
        drives[phase] = drive_again(native_fmus, values, changes, page.plan["end_m"], 0.01)
        shutil.copytree(store, page.folder / "again" / phase)
    return drives


def profiles(folder: Path) -> dict[str, bytes]:
    """Return the profiles in a folder by name; nothing else may be there but a lock."""
    found = {path.name: path.read_bytes() for path in folder.iterdir()}
    found.pop("pldf-store.lock", None)
    return found


def as_written(recording: Recording, comments: tuple[str, ...]) -> bytes:
    return recording_csv(Recording(recording.columns, comments))


def result_of(folder: Path) -> dict[str, Any]:
    return dict(json.loads((folder / "result.json").read_text(encoding="utf-8")))


def iterations(folder: Path) -> tuple[Iteration, ...]:
    (path,) = (folder / "profiles").glob("*.pldf")
    return read_profile(path).iterations


@pytest.mark.parametrize("phase", LEARNING)
def test_a_persons_drive_is_that_of_the_native_fmus(
    page: Page, driven: Path, again: dict[str, Drive], phase: str
) -> None:
    path = driven / phase / "recording.csv"
    comments = read_recording(path).comments
    assert comments[:2] == ("device: keyboard", "steering: person")
    assert path.read_bytes() == as_written(again[phase].recording, comments)
    learned = profiles(driven / phase / "profiles")
    assert learned == profiles(page.folder / "again" / phase)
    (profile,) = learned.values()
    assert profile.count(b"\niteration ") >= LEARNING.index(phase) + 1


@pytest.mark.parametrize("phase", LEARNING)
def test_what_the_function_says_at_the_end_is_the_same(
    page: Page, driven: Path, again: dict[str, Drive], phase: str
) -> None:
    result = result_of(driven / phase)
    assert result["ending"] == "arrived"
    outputs = {k: v for k, v in result["outputs"].items() if not isinstance(v, str)}
    # The page asks behind the end of the drive, when the cluster says what was learned.
    own = {k: v for k, v in again[phase].outputs.items() if not k.startswith("hmi.")}
    assert {k: outputs[k] for k in own} == own
    assert outputs["drive.interventions"] > 0
    said = [m["text"] for m in result["messages"] if m["part"] == "pldf"]
    heard = [m.text for m in again[phase].messages if m.fmu == "AdaptivePLDF"]
    store = str(page.folder / "store")
    assert said == [text.replace(store, "/profiles") for text in heard]


def test_lost_time_is_in_the_data_with_time_and_size(driven: Path) -> None:
    result = result_of(driven / "A2")
    late, hidden = result["interruptions"]
    assert late["reason"] == "late"
    assert 0.4 < late["lost_s"] < 0.45
    assert (hidden["reason"], hidden["lost_s"]) == ("hidden", 5.0)
    comments = read_recording(driven / "A2" / "recording.csv").comments
    assert comments[2:] == tuple(
        f"interrupted at {one['time_s']:.2f} s for {one['lost_s']:.3f} s: {one['reason']}"
        for one in (late, hidden)
    )
    assert result["timing"]["late_steps"] > 0
    steps = len(read_recording(driven / "A2" / "recording.csv"))
    assert result["timing"]["steps"] == steps


def test_inputs_that_were_recorded_give_the_same_drive_in_the_page(
    page: Page, driven: Path
) -> None:
    inputs = [change._asdict() for change in read_changes(driven / "A2" / "inputs.csv")]
    setup = page.setup("A2", {**PERSON, "who": "inputs", "pace": "fast", "inputs": inputs})
    repeated = page.drive([setup], "repeated") / "A2"
    assert (repeated / "inputs.csv").read_bytes() == (driven / "A2" / "inputs.csv").read_bytes()
    assert profiles(repeated / "profiles") == profiles(driven / "A2" / "profiles")
    once_more = read_recording(repeated / "recording.csv")
    comments = read_recording(driven / "A2" / "recording.csv").comments
    assert as_written(once_more, comments) == (driven / "A2" / "recording.csv").read_bytes()


def test_the_driver_fmu_drives_as_in_python(
    page: Page, tmp_path: Path, native_fmus: dict[str, Fmu]
) -> None:
    setups = [page.setup(phase, MODEL) for phase in ("A1", "A2", "B1")]
    folder = page.drive(setups, "model")
    for phase in ("A1", "A2", "B1"):
        one = drive(native_fmus, page.natively(phase, tmp_path), page.plan["end_m"], 0.01)
        written = (folder / phase / "recording.csv").read_bytes()
        assert written == as_written(one.recording, ())
    assert profiles(folder / "B1" / "profiles") == profiles(tmp_path)


def test_a_car_ahead_drives_along_if_the_plan_has_one(
    page: Page, tmp_path: Path, native_traffic_fmus: dict[str, Fmu]
) -> None:
    lead: dict[str, Value] = {"kind": TRAFFIC, "seed": 3}
    setup = page.setup("A1", MODEL)
    setup["values"]["lead"] = {**lead, "route_file": "road.prepared"}
    recording = page.drive([setup], "traffic") / "A1" / "recording.csv"
    values = page.natively("A1", tmp_path)
    values["lead"] = {**lead, "route_file": str(page.road)}
    one = drive(native_traffic_fmus, values, page.plan["end_m"], 0.01)
    assert np.any(one.recording["lead_present"])
    assert recording.read_bytes() == as_written(one.recording, ())


def press(fmu: Fmu, values: Mapping[str, Value], button: str, s_m: float) -> None:
    """Let the native function alone hear a button at ``s_m``."""
    slave = Slave(fmu, "pldf", [])
    slave.set({**values, "learn": 0, "apply_learned": 1, "vehicle.s_m": s_m})
    slave.begin()
    slave.ready()
    slave.step(0.0, 0.01)
    slave.set({button: 1})
    slave.step(0.01, 0.01)
    slave.terminate()
    slave.free()


def test_what_was_learned_can_be_forgotten_after_the_drive_and_the_newest_lesson_undone(
    page: Page, tmp_path: Path, native_fmus: dict[str, Fmu]
) -> None:
    a2 = page.setup("A2", MODEL)
    learned = page.drive([a2], "learned") / "A2"
    known = iterations(learned)[-1]
    changed_m = np.flatnonzero(np.abs(known.learned_mps - known.base_mps) > 0.5)
    places_m = [float(changed_m[0]), float(changed_m[-1])]
    forget = page.setup("A2", {**MODEL, "name": "forget", "forget_m": places_m})
    undo = page.setup("A2", {**MODEL, "name": "undo", "undo": True})
    folder = page.drive([a2, forget, undo], "last word")

    store = tmp_path / "store"
    shutil.copytree(learned / "profiles", store)
    values = page.natively("A2", store)["pldf"]
    for s_m in places_m:
        press(native_fmus["pldf"], values, "teach.forget_here", s_m)
    assert profiles(folder / "forget" / "profiles") == profiles(store)
    press(native_fmus["pldf"], values, "teach.undo", 0.0)
    assert profiles(folder / "undo" / "profiles") == profiles(store)

    forgotten, undone = iterations(folder / "forget")[-1], iterations(folder / "undo")
    assert [one.kind for one in undone] == ["drive", "forget", "forget", "undo"]
    for s_m in places_m:
        assert forgotten.learned_mps[int(s_m)] == forgotten.base_mps[int(s_m)]
    assert np.any(forgotten.learned_mps != forgotten.base_mps)
    assert np.any(forgotten.offset_mps)
    assert not np.any(undone[-1].offset_mps)


def test_a_place_where_nothing_is_known_is_forgotten_without_a_trace(page: Page) -> None:
    forget = page.setup("A2", {**MODEL, "name": "forget", "forget_m": [100.0]})
    folder = page.drive([forget], "nothing") / "forget"
    assert not (folder / "profiles").exists()


def test_a_drive_that_fails_says_so(page: Page) -> None:
    setup = page.setup("A2", MODEL)
    setup["values"]["pldf"]["route_file"] = "nowhere.prepared"
    with pytest.raises(AssertionError, match=r"nowhere\.prepared"):
        page.drive([setup], "failing")
