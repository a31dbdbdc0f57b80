"""A native FMU finds a car on ways that pass a place more than once as the Python FMU does."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fmi_host import Host
from pldf.function import DrivingFunction
from pldf.kernel.codes import XY
from pldf.kernel.signals import variables_of
from pldf.roads import Route, write_route_csv
from ways import WAYS

pytest.importorskip("ziglang", reason="needs the extra: pip install -e .[native]")

from pldf.cosim.prepared import write_prepared_route

STEP_S = 0.1


def with_limits(route: Route) -> Route:
    """Let the limit tell the place: another one every 5 m."""
    return replace(route, speed_limit_mps=8.0 + 0.01 * np.floor(route.s_m / 5.0))


@pytest.mark.parametrize("name", WAYS)
def test_every_output_is_the_same_to_the_bit(
    native_folder: Path, tmp_path: Path, name: str
) -> None:
    route = with_limits(WAYS[name].route())
    road, prepared = tmp_path / "road.csv", tmp_path / "road.prepared"
    write_route_csv(route, road)
    write_prepared_route(route, prepared)
    python = DrivingFunction()
    python.texts.route_file, python.record.localization = str(road), XY
    python.initialize()
    slave = Host(native_folder / "AdaptivePLDF.fmu").instantiate()
    slave.start(route_file=str(prepared), localization=XY)
    outputs = [s for s in variables_of(python.record, python.texts) if s.causality == "output"]
    s_m = np.arange(0.0, WAYS[name].length_m - 1.0, 1.4)
    x, y = WAYS[name].beside(s_m, -1.0)
    limits = []
    for i in range(len(s_m)):
        python.record.vehicle_x_m, python.record.vehicle_y_m = x[i], y[i]
        python.record.vehicle_speed_mps = 14.0
        python.step(STEP_S)
        slave.set(vehicle__x_m=x[i], vehicle__y_m=y[i], vehicle__speed_mps=14.0)
        slave.fmu.doStep(i * STEP_S, STEP_S)
        python.say()
        for signal in outputs:
            record = python.texts if signal.kind == "String" else python.record
            assert slave.get(signal.name) == getattr(record, signal.field), signal.name
        limits.append(python.record.limit_mps)
    slave.free()
    places = np.minimum(s_m + 1.4, route.length_m)  # outputs are those of the end of the step
    expected = 8.0 + 0.01 * np.floor(places / 5.0)
    assert np.abs(np.array(limits) - expected).max() < 0.0101  # half a metre beside a sign
