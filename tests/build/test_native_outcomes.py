"""The log of a native FMU says of each intervention what the Python FMU says, to the letter."""

from __future__ import annotations

from pathlib import Path

import pytest
from fmi3_host import Host3
from fmi_host import Host
from told_drive import driven, told_drive, write_road

pytest.importorskip("ziglang", reason="needs the extra: pip install -e .[native]")

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
