"""The native function's own recording has the bytes of the Python one's, and says the same."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from fmi_host import Host, Slave
from laboratory import files
from pldf.function import DrivingFunction

pytest.importorskip("ziglang", reason="needs the extra: pip install -e .[native]")

STEP_S = 0.02
# From which step on (of 20 ms) which inputs hold; the car goes on from there.
PLAN: list[tuple[int, dict[str, Any]]] = [
    (0, {"lever_resume": 1}),
    (5, {"lever_resume": 0}),
    (300, {"driver_gas_pedal": 0.3}),
    (500, {"driver_gas_pedal": 0.0}),
    (700, {"lever_up_long": 1}),
    (710, {"lever_up_long": 0}),
    (1000, {"eligible": 0}),
    (1060, {"driver_brake_pedal": 0.3}),
    (1100, {"eligible": 1}),
    (1300, {"driver_brake_pedal": 0.0}),
    (1500, {"lever_resume": 1}),
    (1505, {"lever_resume": 0}),
]
STEPS = 2000


def motion(k: int) -> tuple[float, float]:
    """Position and speed: 22 m/s, and eight seconds at a standstill after the brake."""
    moving = min(k, 1100) + max(k - 1500, 0)
    return 22.0 * STEP_S * moving + 0.37, 22.0 if k < 1100 or k >= 1500 else 0.0


def by_python(folder: str) -> DrivingFunction:
    made = DrivingFunction()
    made.texts.recording_folder = folder
    made.record.driver_id, made.record.apply_learned = 4, 0
    made.initialize()
    plan = dict(PLAN)
    for k in range(STEPS):
        for name, value in plan.get(k, {}).items():
            setattr(made.record, name, value)
        made.record.vehicle_s_m, made.record.vehicle_speed_mps = motion(k)
        made.step(STEP_S)
    made.finish()
    return made


def by_native(host: Host, folder: str) -> Slave:
    slave = host.instantiate()
    slave.set(recording_folder=folder, driver_id=4, apply_learned=False)
    slave.start()
    plan = dict(PLAN)
    for k in range(STEPS):
        changed = {name.replace("_", "__", 1): v for name, v in plan.get(k, {}).items()}
        s_m, speed_mps = motion(k)
        slave.set(**changed, vehicle__s_m=s_m, vehicle__speed_mps=speed_mps)
        slave.fmu.doStep(k * STEP_S, STEP_S)
    slave.fmu.terminate()
    return slave


@pytest.fixture(scope="module")
def host(native_folder: Path) -> Host:
    return Host(native_folder / "AdaptivePLDF.fmu")


def told(made: DrivingFunction) -> list[str]:
    return [message.text for message in made.messages if "recording of this" in message.text]


def test_the_same_drive_gives_the_same_file(host: Host, tmp_path: Path) -> None:
    """Twice: the second gets a name of its own, in a folder with letters beyond ASCII."""
    ours, theirs = tmp_path / "python", tmp_path / "nativ Ж" / "neu"
    for _ in range(2):
        made, slave = by_python(str(ours)), by_native(host, str(theirs))
        said = [text for text in slave.texts("logEvents") if "recording of this" in text]
        assert [text.replace(str(theirs), str(ours)) for text in said] == told(made)
        slave.free()
    written = files(ours)
    assert files(theirs) == written
    assert sorted(written) == ["P004_A1.csv", "P004_A2.csv"]
    rows = written["P004_A1.csv"].decode().splitlines()
    assert sum(",STANDBY," in row for row in rows) > 5  # the standstill is among them


def test_a_folder_that_cannot_be_is_told_in_the_same_words(host: Host, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    folder = str(tmp_path / "file" / "folder")
    made, slave = by_python(folder), by_native(host, folder)
    said = [*slave.texts("logStatusWarning"), *slave.texts("logStatusError")]
    before, after = (text for text in said if "recording of this" in text)
    assert before == told(made)[0]
    assert after.split(":")[0] == told(made)[1].split(":")[0]
    slave.free()
