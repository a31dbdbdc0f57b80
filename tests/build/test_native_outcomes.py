"""The log of a native FMU says of each intervention what the Python FMU says, to the letter."""

from __future__ import annotations

from pathlib import Path

import pytest
from fmi3_host import Host3
from fmi_host import Host
from told_drive import driven, told_drive, write_road

pytest.importorskip("ziglang", reason="needs the extra: pip install -e .[native]")

from consistent_drives import DRIVES, inputs_of, told_in_python, write_straight_road
from pldf.cosim.prepared import write_prepared_route
from pldf.roads import chosen_route


def native_lines(host: Host | Host3, road: Path) -> list[str]:
    """Return what an FMU says of the drive in its events."""
    slave = host.instantiate()
    slave.start(route_file=str(road), learn_faithful=True)
    for time_s, step_s, inputs in told_drive():
        slave.set(**{name.replace("_", "__", 1): value for name, value in inputs.items()})
        slave.fmu.doStep(time_s, step_s)
    slave.fmu.terminate()
    said = slave.texts("logEvents")
    slave.free()
    return said


def test_the_logs_are_equal(native_folder: Path, tmp_path: Path) -> None:
    road = write_road(tmp_path)
    prepared = tmp_path / "road.prepared"
    write_prepared_route(chosen_route(0, str(road)), prepared)
    expected = [message.text for message in driven(road).messages if message.level == "info"]
    assert len(expected) > 10
    assert "(road 12 Hauptstra\N{LATIN SMALL LETTER SHARP S}e to road 7)" in expected[1]
    assert native_lines(Host(native_folder / "AdaptivePLDF.fmu"), prepared) == expected
    assert native_lines(Host3(native_folder / "fmi3" / "AdaptivePLDF.fmu"), prepared) == expected


@pytest.mark.parametrize(("fmi", "set_speed_gain"), [(2, 1.0), (3, 1.0), (2, 0.63)])
def test_evidence_is_weighed_and_told_as_in_python(
    native_folder: Path, tmp_path: Path, fmi: int, set_speed_gain: float
) -> None:
    """Drives in a row that only learn what is consistent: equal logs, equal profile files."""
    road = write_straight_road(tmp_path)
    prepared = tmp_path / "road.prepared"
    write_prepared_route(chosen_route(0, str(road)), prepared)
    expected = told_in_python(road, tmp_path / "python", set_speed_gain)
    folder = native_folder if fmi == 2 else native_folder / "fmi3"
    host = (Host if fmi == 2 else Host3)(folder / "AdaptivePLDF.fmu")
    for k, done in enumerate(DRIVES):
        slave = host.instantiate()
        slave.start(
            route_file=str(prepared), profile_store=str(tmp_path / "native"), learn_consistent=True,
            learning__set_speed_gain=set_speed_gain,
        )  # fmt: skip
        for time_s, step_s, inputs in inputs_of(done):
            slave.set(**{name.replace("_", "__", 1): value for name, value in inputs.items()})
            slave.fmu.doStep(time_s, step_s)
        slave.fmu.terminate()
        said = slave.texts("logEvents")
        slave.free()
        assert [line for line in said if " saved in " not in line] == [
            line for line in expected[k] if " saved in " not in line
        ]
    (native,), (python,) = ((tmp_path / name).glob("*.pldf") for name in ("native", "python"))
    assert native.read_bytes() == python.read_bytes()
