"""Entry points of vehicle, driver and car ahead for the native build.

See ``pldf.build.native.model``.
"""

from __future__ import annotations

from typing import Any, Final

from pldf.build.native.model import NativeModel
from pldf.build.native.pointers import columns, record_at
from pldf.cosim.prepared import SUFFIX, prepared_script
from pldf.instance import Watch
from pldf.kernel import interpolation, planner, substeps
from pldf.kernel.arrays import RouteArrays, Work

from . import (
    chance,
    clock,
    lead_kernel,
    lead_motion,
    lead_script_kernel,
    traffic_kernel,
    vehicle_kernel,
)
from .driver import INVALID_INPUT as DRIVER_INPUT
from .driver import KERNELS
from .driver_kernel import driver_start, driver_step
from .driver_script import PACKED, packed_script, read_script, script_arrays
from .driver_state import PREFERENCE, SCRIPT, DriverState, DriverTexts
from .lead import TROUBLE_TEXT
from .lead_kernel import lead_start, lead_step
from .lead_script import PACKED_TRAFFIC, packed_traffic, read_traffic, traffic_arrays
from .lead_script_kernel import LeadScriptArrays
from .lead_state import BY_SCRIPT, TRAFFIC, LeadState, LeadTexts
from .script_kernel import ScriptArrays
from .traffic_kernel import RoadArrays, prepare_road
from .vehicle import INVALID_INPUT as VEHICLE_INPUT
from .vehicle_kernel import vehicle_refresh, vehicle_start, vehicle_step
from .vehicle_state import VehicleState, VehicleTexts
from .wish_kernel import WishArrays, prepare_wish

# The vehicle's block is the route alone, of which it needs the grade.
GRADE: Final = RouteArrays._fields.index("grade")


def _vehicle_start(record: Any, block: Any, nodes: int, rows: int, step_s: float) -> None:
    vehicle_start(record_at(record), columns(RouteArrays, block, 0, nodes)[GRADE])


def _vehicle_refresh(record: Any, block: Any, nodes: int, rows: int, step_s: float) -> None:
    vehicle_refresh(record_at(record), columns(RouteArrays, block, 0, nodes)[GRADE])


def _vehicle_step(record: Any, block: Any, nodes: int, rows: int, step_s: float) -> None:
    vehicle_step(record_at(record), columns(RouteArrays, block, 0, nodes)[GRADE], step_s)


VEHICLE: Final = NativeModel(
    name="LongitudinalVehicle",
    about="Longitudinal dynamics of one documented car with pedals",
    record=VehicleState,
    texts=VehicleTexts,
    modules=(interpolation, substeps, vehicle_kernel),
    entries={"start": _vehicle_start, "refresh": _vehicle_refresh, "step": _vehicle_step},
    groups=(RouteArrays,),
    kept=1,
    route=RouteArrays,
    route_if=("grade_from_route", 1),
    watches=(Watch("invalid_input", ("", VEHICLE_INPUT), once=True, flag="warned"),),
)

ROUTE_AT: Final = len(WishArrays._fields)
WORK_AT: Final = ROUTE_AT + len(RouteArrays._fields)
SCRIPT_AT: Final = WORK_AT + len(Work._fields)


def _driver_start(record: Any, block: Any, nodes: int, rows: int, step_s: float) -> None:
    st = record_at(record)
    if st.kind == PREFERENCE:
        route = columns(RouteArrays, block, ROUTE_AT * nodes, nodes)
        wish = columns(WishArrays, block, 0, nodes)
        prepare_wish(st, route, wish, columns(Work, block, WORK_AT * nodes, nodes))
    driver_start(st)


def _driver_step(record: Any, block: Any, nodes: int, rows: int, step_s: float) -> None:
    wish = columns(WishArrays, block, 0, nodes)
    script = columns(ScriptArrays, block, SCRIPT_AT * nodes, rows)
    driver_step(record_at(record), wish, script, step_s)


DRIVER: Final = NativeModel(
    name="ScriptedDriver",
    about="Driver that follows a script or a hidden wish",
    record=DriverState,
    texts=DriverTexts,
    modules=(*KERNELS, interpolation, substeps, planner),
    entries={"start": _driver_start, "step": _driver_step},
    groups=(WishArrays, RouteArrays, Work),
    kept=1,
    route=RouteArrays,
    route_if=("kind", PREFERENCE),
    events=ScriptArrays,
    events_if=("kind", SCRIPT),
    watches=(Watch("invalid_input", ("", DRIVER_INPUT), once=True, flag="warned"),),
)


LEAD_ROUTE_AT: Final = len(RoadArrays._fields)
LEAD_WORK_AT: Final = LEAD_ROUTE_AT + len(RouteArrays._fields)
LEAD_SCRIPT_AT: Final = LEAD_WORK_AT + len(Work._fields)


def _lead_start(record: Any, block: Any, nodes: int, rows: int, step_s: float) -> None:
    st = record_at(record)
    if st.kind == TRAFFIC:
        route = columns(RouteArrays, block, LEAD_ROUTE_AT * nodes, nodes)
        road = columns(RoadArrays, block, 0, nodes)
        prepare_road(st, route, road, columns(Work, block, LEAD_WORK_AT * nodes, nodes))
    lead_start(st)


def _lead_step(record: Any, block: Any, nodes: int, rows: int, step_s: float) -> None:
    road = columns(RoadArrays, block, 0, nodes)
    script = columns(LeadScriptArrays, block, LEAD_SCRIPT_AT * nodes, rows)
    lead_step(record_at(record), road, script, step_s)


LEAD: Final = NativeModel(
    name="LeadVehicle",
    about="Car ahead: by parameters, by script, or traffic from a seed",
    record=LeadState,
    texts=LeadTexts,
    modules=(
        chance,
        clock,
        lead_kernel,
        lead_motion,
        lead_script_kernel,
        traffic_kernel,
        interpolation,
        substeps,
        planner,
    ),
    entries={"start": _lead_start, "step": _lead_step},
    groups=(RoadArrays, RouteArrays, Work),
    kept=1,
    route=RouteArrays,
    route_if=("kind", TRAFFIC),
    events=LeadScriptArrays,
    events_if=("kind", BY_SCRIPT),
    watches=(Watch("trouble", tuple(TROUBLE_TEXT[code] for code in sorted(TROUBLE_TEXT))),),
)


def packed_scripts() -> dict[str, bytes]:
    """Return the driver's prepared scripts by their path in ``resources/``."""
    scripts = [script_arrays(read_script(packed_script(i))) for i in range(len(PACKED))]
    return {f"script/{i}{SUFFIX}": prepared_script(arrays) for i, arrays in enumerate(scripts)}


def packed_traffic_scripts() -> dict[str, bytes]:
    """Return the prepared scripts of the car ahead by their path in ``resources/``."""
    numbers = range(len(PACKED_TRAFFIC))
    scripts = [traffic_arrays(read_traffic(packed_traffic(i))) for i in numbers]
    return {f"script/{i}{SUFFIX}": prepared_script(arrays) for i, arrays in enumerate(scripts)}
