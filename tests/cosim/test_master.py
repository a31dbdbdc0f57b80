"""The three built FMUs in one loop: wiring, limits, recordings, persistence, communication step."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pldf.cosim.fmu import Fmu, Slave
from pldf.cosim.master import ARRIVED, Drive, connections, drive
from pldf.errors import ModelError
from pldf.kernel.codes import ACTIVE, GAS_OVERRIDE, STANDBY
from pldf.profiles.store import ProfileStore, StoredProfile
from pldf.recordings.columns import COLUMNS
from pldf.recordings.interventions import Interval, pedal_interventions, rates_of
from pldf.recordings.offline import learn_from
from pldf.recordings.recording import Recording, read_recording, write_recording
from pldf.roads import fingerprint, packed_route, route_arrays
from pldf.study.phases import PHASES, DriveSetting, Phase, values_of

# How closely the function follows its profile on the study road with the shipped vehicle.
TRACKING_MPS = 0.2
# The function gives the profile where it expects the vehicle after its step: a * step**2 away.
AHEAD_MPS = 1e-3
WIRES = {
    "vehicle.acceleration_request_mps2": "pldf.acceleration_request_mps2",
    "vehicle.function_active": "pldf.function_active",
    "vehicle.driver.gas_pedal": "driver.driver.gas_pedal",
    "vehicle.driver.brake_pedal": "driver.driver.brake_pedal",
    "driver.vehicle.s_m": "vehicle.s_m",
    "driver.vehicle.speed_mps": "vehicle.speed_mps",
    "driver.vehicle.acceleration_mps2": "vehicle.acceleration_mps2",
    "driver.mode": "pldf.mode",
    "driver.target_speed_mps": "pldf.target_speed_mps",
    "driver.set_speed_mps": "pldf.set_speed_mps",
    "driver.limit_mps": "pldf.limit_mps",
    "pldf.vehicle.s_m": "vehicle.s_m",
    "pldf.vehicle.speed_mps": "vehicle.speed_mps",
    "pldf.vehicle.acceleration_mps2": "vehicle.acceleration_mps2",
    "pldf.driver.gas_pedal": "driver.driver.gas_pedal",
    "pldf.driver.brake_pedal": "driver.driver.brake_pedal",
    **{
        f"pldf.lever.{contact}": f"driver.lever.{contact}"
        for contact in ("resume", "cancel", "up", "down", "up_long", "down_long")
    },
    **{f"pldf.teach.{word}": f"driver.teach.{word}" for word in ("pause", "forget_here", "undo")},
}


STEP_S = 0.02


def setting(store: Path | None = None, **more: dict[str, Any]) -> DriveSetting:
    return DriveSetting(packed_route(0), {"route_id": 0}, store=store, more=more)


def driven(
    fmus: Mapping[str, Fmu],
    phase: Phase,
    chosen: DriveSetting,
    length_m: float | None = None,
    step_s: float = STEP_S,
) -> Drive:
    return drive(fmus, values_of(phase, chosen), length_m or chosen.length_m, step_s)


@pytest.fixture(scope="module")
def hands_off(fmus: dict[str, Fmu]) -> Drive:
    return driven(fmus, PHASES["A3"], setting())


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("profiles")


@pytest.fixture(scope="module")
def taught(fmus: dict[str, Fmu], store: Path) -> Drive:
    """Return a drive with interventions whose lesson is in ``store``."""
    return driven(fmus, PHASES["A2"], setting(store))


def stored(folder: Path) -> StoredProfile:
    route = packed_route(0)
    profile = ProfileStore(folder).load(1, fingerprint(route), route.nodes)
    assert profile is not None
    return profile


def test_every_input_is_fed_by_the_output_of_its_name(fmus: dict[str, Fmu]) -> None:
    found = {".".join(target): ".".join(source) for source, target in connections(fmus)}
    assert found == WIRES
    inputs = {f"{part}.{s.name}" for part, fmu in fmus.items() for s in fmu.named("input")}
    asked = {"eligible", "limit.override_mps"}
    outside = {"lead.present", "lead.gap_m", "lead.speed_mps", "vehicle.x_m", "vehicle.y_m"}
    ahead = {"lead.present", "lead.gap_m", "lead.speed_mps"}  # by LeadVehicle, in traffic
    wanted = {f"pldf.{name}" for name in asked | outside} | {f"driver.{name}" for name in ahead}
    assert inputs - set(found) == wanted


def test_ends_that_differ_in_unit_are_not_connected(fmus: dict[str, Fmu]) -> None:
    speed = fmus["driver"].signals["set_speed_mps"]
    signals = {**fmus["driver"].signals, "set_speed_mps": replace(speed, unit="km/h")}
    with pytest.raises(ModelError, match="set_speed_mps differ in type or unit"):
        connections({**fmus, "driver": replace(fmus["driver"], signals=signals)})


def test_the_base_function_keeps_limits_and_profile(hands_off: Drive) -> None:
    recording, arrays = hands_off.recording, route_arrays(packed_route(0))
    assert (hands_off.arrived, hands_off.ending, hands_off.messages) == (True, ARRIVED, [])
    assert np.all(recording["speed_mps"] < recording["limit_mps"] + TRACKING_MPS)
    active = recording["mode"] == ACTIVE
    assert np.all(active[recording["time_s"] > 1.5])
    error = recording["speed_mps"] - recording["base_mps"]
    assert np.max(np.abs(error[recording["s_m"] > 300.0])) < TRACKING_MPS
    curvature = np.asarray(arrays.curvature_per_m)[recording["s_m"].astype(int)]
    assert np.max(recording["speed_mps"] ** 2 * curvature) < 2.5 * 1.03
    time_s = recording["time_s"][-1]
    assert 200.0 < time_s < 220.0  # 3:20 to 3:40 min


def test_rows_are_what_was_seen_before_each_step(hands_off: Drive) -> None:
    recording = hands_off.recording
    assert tuple(recording.columns) == COLUMNS
    assert np.array_equal(recording["time_s"], np.arange(len(recording)) * 0.02)
    assert recording["s_m"][0] == 0.0
    assert recording["mode"][0] == STANDBY
    assert recording["speed_mps"][0] == recording["base_mps"][0] == recording["limit_mps"][0]
    assert recording["s_m"][-1] < 4500.0 <= recording["s_m"][-1] + 0.02 * 30.0
    assert np.array_equal(recording["profile_mps"], recording["base_mps"])
    assert np.all(recording["eligible"] == 1.0)


def test_the_same_drive_twice_is_the_same_to_the_bit(fmus: dict[str, Fmu], taught: Drive) -> None:
    phase = PHASES["A1"]  # A2 without learning
    again = driven(fmus, phase, setting())
    for name in COLUMNS:
        assert np.array_equal(again.recording[name], taught.recording[name]), name
    other = driven(fmus, phase, replace(setting(), seed=2))
    assert not np.array_equal(other.recording["gas_pedal"], taught.recording["gas_pedal"])


def test_rates_recomputed_from_the_recording_equal_those_of_the_fmu(taught: Drive) -> None:
    outputs = taught.outputs
    rates = rates_of(taught.recording)
    assert rates.pedal == pytest.approx(outputs["rate.pedal"], abs=1e-12)
    assert rates.set_speed == pytest.approx(outputs["rate.set_speed"], abs=1e-12)
    assert rates.combined == pytest.approx(outputs["rate.combined"], abs=1e-12)
    assert len(pedal_interventions(taught.recording)) == outputs["drive.interventions"]
    assert min(rates) > 0.1


def test_rates_of_the_example_in_section_4() -> None:
    time = np.arange(0.0, 200.5, 0.5)
    mode = np.full(len(time), float(ACTIVE))
    mode[((time >= 10) & (time < 14)) | ((time >= 30) & (time < 33))] = GAS_OVERRIDE
    mode[(time >= 50) & (time < 58)] = STANDBY
    recording = Recording(
        {
            "time_s": time,
            "mode": mode,
            "brake_pedal": np.where((time >= 50) & (time < 52), 0.3, 0.0),
            "set_speed_offset_mps": np.where((time >= 25) & (time < 60), 2.0, 0.0),
        }
    )
    assert rates_of(recording) == pytest.approx((0.075, 0.175, 0.195))
    kinds = [interval.kind for interval in pedal_interventions(recording)]
    assert kinds == ["gas", "gas", "brake"]


def test_standby_by_the_lever_is_no_pedal_intervention_and_short_gaps_merge() -> None:
    time = np.arange(0.0, 20.0, 0.1)
    mode = np.full(len(time), float(ACTIVE))
    mode[20:40] = STANDBY  # cancelled by the lever
    mode[100:120] = GAS_OVERRIDE
    mode[122:130] = GAS_OVERRIDE  # after 0.2 s
    recording = Recording({"time_s": time, "mode": mode, "brake_pedal": np.zeros(len(time))})
    assert pedal_interventions(recording) == [Interval("gas", 100, 130)]


def test_the_fmu_learns_what_offline_learning_does(
    taught: Drive, store: Path, tmp_path: Path
) -> None:
    write_recording(tmp_path / "a2.csv", taught.recording)
    offline = learn_from(read_recording(tmp_path / "a2.csv"), packed_route(0)).iteration
    online = stored(store).iteration(1)
    assert np.max(np.abs(online.learned_mps - stored(store).base_mps)) > 1.0
    for name in ("learned_mps", "offset_mps", "drive", "intervention"):
        assert np.array_equal(getattr(online, name), getattr(offline, name)), name


def test_a_second_drive_follows_and_offline_learning_goes_on_from_there(
    fmus: dict[str, Fmu], taught: Drive, store: Path
) -> None:
    before = stored(store)
    second = driven(fmus, PHASES["B1"], setting(store))
    follows = np.interp(
        second.recording["s_m"], np.arange(before.nodes), before.iteration(1).learned_mps
    )
    assert np.max(np.abs(second.recording["profile_mps"] - follows)) < AHEAD_MPS
    assert second.outputs["rate.combined"] < 0.5 * taught.outputs["rate.combined"]
    offline = learn_from(second.recording, packed_route(0), before).iteration
    assert np.array_equal(stored(store).iteration(2).learned_mps, offline.learned_mps)


def test_what_was_learned_outlives_the_process(
    fmu_folder: Path, store: Path, taught: Drive, tmp_path: Path
) -> None:
    assert taught.arrived  # in this process
    command = [
        sys.executable, "-m", "pldf.cli", "drive", "--phase", "B3", "--store", str(store),
        "--fmus", str(fmu_folder), "--step", "0.05", "--out", str(tmp_path / "b3.csv"),
    ]  # fmt: skip
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    recording = read_recording(tmp_path / "b3.csv")
    newest = stored(store).iteration()
    follows = np.interp(recording["s_m"], np.arange(len(newest.learned_mps)), newest.learned_mps)
    assert np.max(np.abs(recording["profile_mps"] - follows)) < AHEAD_MPS
    assert np.max(recording["profile_mps"] - recording["base_mps"]) > 1.0


@pytest.mark.parametrize(
    ("step_s", "hands_off_mps", "intervening_mps"),
    [(0.001, 0.03, 0.25), (0.02, 0.03, 0.25), (0.1, 0.08, 0.6)],
)
def test_the_communication_step_hardly_matters(
    fmus: dict[str, Fmu], step_s: float, hands_off_mps: float, intervening_mps: float
) -> None:
    """Tolerances in m/s at the same place, against 10 ms; a pedal goes down one step later."""
    length_m = 450.0 if step_s < 0.01 else 1500.0
    places = np.arange(0.0, length_m - 20.0)
    for phase, tolerance in ((PHASES["A3"], hands_off_mps), (PHASES["A1"], intervening_mps)):
        speeds = []
        for step in (0.01, step_s):
            recording = driven(fmus, phase, setting(), length_m, step).recording
            speeds.append(np.interp(places, recording["s_m"], recording["speed_mps"]))
        assert np.max(np.abs(speeds[1] - speeds[0])) < tolerance


def test_what_an_fmu_refuses_is_told_once_and_leaves_no_harm(
    fmus: dict[str, Fmu], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(ModelError) as refused:
        driven(fmus, PHASES["A3"], setting(pldf={"route_id": 7}))
    assert str(refused.value).startswith("AdaptivePLDF: route_id 7 is unknown; packed routes: 0")
    assert capsys.readouterr().err == ""
    assert driven(fmus, PHASES["A3"], setting(), 200.0).arrived


def test_fmus_that_lack_a_variable_are_named_with_the_way_out(fmus: dict[str, Fmu]) -> None:
    """Those of an older release have not all parameters that are set today."""
    with pytest.raises(ModelError) as refused:
        driven(fmus, PHASES["A3"], setting(driver={"wish.later": 1.0}))
    assert str(refused.value).startswith("ScriptedDriver: this FMU has no variable wish.later")
    assert str(refused.value).endswith("build all FMUs anew with 'pldf build'")


def test_what_the_fmus_say_is_kept(
    fmus: dict[str, Fmu], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("PLDF_PROFILE_STORE", raising=False)
    result = driven(fmus, PHASES["A2"], setting(), 300.0)
    warning, *outcomes = result.messages
    assert warning.level == "warning"
    assert "no profile store" in warning.text
    # What the drive taught is said, too, though there is no store to keep it.
    assert outcomes
    assert {message.level for message in outcomes} == {"info"}
    assert all(m.text.startswith(("pedal intervention", "set speed")) for m in outcomes)
    assert capsys.readouterr().err == ""


def test_a_broken_profile_is_warned_of_and_kept_aside(fmus: dict[str, Fmu], tmp_path: Path) -> None:
    path = ProfileStore(tmp_path).path(1, fingerprint(packed_route(0)))
    path.write_bytes(b"not a profile")
    result = driven(fmus, PHASES["B3"], setting(tmp_path), 300.0)
    assert [message.level for message in result.messages] == ["warning"]
    assert "the drive goes on with the base profile" in result.messages[0].text
    assert [file.read_bytes() for file in ProfileStore(tmp_path).refused()] == [b"not a profile"]


def test_a_vehicle_without_power_is_given_up(fmus: dict[str, Fmu]) -> None:
    weak = setting(vehicle={"body.power_max_w": 1.0, "start_s_m": 1000.0})
    result = driven(fmus, PHASES["A3"], weak, step_s=0.1)
    assert not result.arrived
    assert "stood still for 60 s at" in result.ending or "only at" in result.ending


def test_progress_is_reported(fmus: dict[str, Fmu]) -> None:
    seen: list[float] = []
    drive(fmus, values_of(PHASES["A3"], setting()), 1500.0, 0.1, seen.append)
    assert seen[0] == 0.0
    assert seen == sorted(seen)
    assert len(seen) > 1


def test_ctrl_c_in_the_middle_of_a_call_ends_the_drive_after_it(
    fmus: dict[str, Fmu], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Pressed while an FMU works, whose wrapper would take the exception for its own."""
    steps, usual = [], Slave.step

    def step_interrupted(slave: Slave, time_s: float, step_s: float) -> None:
        usual(slave, time_s, step_s)
        steps.append(slave)
        if len(steps) == 4:
            with suppress(KeyboardInterrupt):  # as pythonfmu does
                signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(Slave, "step", step_interrupted)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            drive(fmus, values_of(PHASES["A3"], setting()), 100.0, 0.1)
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("handler", [signal.SIG_IGN, signal.SIG_DFL])
def test_ctrl_c_that_others_handle_stays_theirs(fmus: dict[str, Fmu], handler: Any) -> None:
    seen: list[Any] = []
    before = signal.signal(signal.SIGINT, handler)
    try:
        drive(
            fmus, values_of(PHASES["A3"], setting()), 10.0, 0.1,
            lambda _: seen.append(signal.getsignal(signal.SIGINT)),
        )  # fmt: skip
    finally:
        signal.signal(signal.SIGINT, before)
    assert seen and set(seen) == {handler}


def test_the_working_folder_stays(fmus: dict[str, Fmu]) -> None:
    before = os.getcwd()
    driven(fmus, PHASES["A3"], setting(), 100.0, 0.1)
    assert os.getcwd() == before
