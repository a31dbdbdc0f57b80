"""Entry points of the driving function: C pointers in, calls of the kernel, nothing else.

Every entry has the signature ``(record, block, nodes, rows, step_s)``; see ``NativeModel``.
"""

from __future__ import annotations

from typing import Any, Final

from ...bound_parameters import BOUNDS
from ...compiled import KERNEL_MODULES
from ...function import Files
from ...function_words import WATCHES
from ...kernel.arrays import NextArrays, ProfileArrays, RouteArrays, TraceArrays, Work
from ...kernel.drive import drive_step, refresh
from ...kernel.last_word import forget_here, take_back_lesson
from ...kernel.learning import learn_drive
from ...kernel.preparation import adopt_learned, start_drive
from ...kernel.state import PldfState
from ...kernel.undo import mark_lesson
from .model import NativeModel
from .pointers import columns, record_at

PROFILE_AT: Final = len(RouteArrays._fields)
TRACE_AT: Final = PROFILE_AT + len(ProfileArrays._fields)
WORK_AT: Final = TRACE_AT + len(TraceArrays._fields)
NEXT_AT: Final = WORK_AT + len(Work._fields)


def _start(record: Any, block: Any, nodes: int, rows: int, step_s: float) -> None:
    st = record_at(record)
    route = columns(RouteArrays, block, 0, nodes)
    profile = columns(ProfileArrays, block, PROFILE_AT * nodes, nodes)
    work = columns(Work, block, WORK_AT * nodes, nodes)
    start_drive(st, route, profile, work)


def _adopt(record: Any, block: Any, nodes: int, rows: int, step_s: float) -> None:
    st = record_at(record)
    route = columns(RouteArrays, block, 0, nodes)
    profile = columns(ProfileArrays, block, PROFILE_AT * nodes, nodes)
    work = columns(Work, block, WORK_AT * nodes, nodes)
    adopt_learned(st, route, profile, work)


def _refresh(record: Any, block: Any, nodes: int, rows: int, step_s: float) -> None:
    st = record_at(record)
    route = columns(RouteArrays, block, 0, nodes)
    profile = columns(ProfileArrays, block, PROFILE_AT * nodes, nodes)
    refresh(st, route, profile)


def _step(record: Any, block: Any, nodes: int, rows: int, step_s: float) -> None:
    if nodes < 2:  # never; but now the compiler knows that the last node's index is not negative
        return
    st = record_at(record)
    route = columns(RouteArrays, block, 0, nodes)
    profile = columns(ProfileArrays, block, PROFILE_AT * nodes, nodes)
    trace = columns(TraceArrays, block, TRACE_AT * nodes, nodes)
    drive_step(st, route, profile, trace, step_s)


def _learn(record: Any, block: Any, nodes: int, rows: int, step_s: float) -> None:
    st = record_at(record)
    route = columns(RouteArrays, block, 0, nodes)
    profile = columns(ProfileArrays, block, PROFILE_AT * nodes, nodes)
    trace = columns(TraceArrays, block, TRACE_AT * nodes, nodes)
    work = columns(Work, block, WORK_AT * nodes, nodes)
    following = columns(NextArrays, block, NEXT_AT * nodes, nodes)
    learn_drive(st, route, profile, trace, work, following)


def _forget(record: Any, block: Any, nodes: int, rows: int, step_s: float) -> None:
    st = record_at(record)
    route = columns(RouteArrays, block, 0, nodes)
    profile = columns(ProfileArrays, block, PROFILE_AT * nodes, nodes)
    trace = columns(TraceArrays, block, TRACE_AT * nodes, nodes)
    work = columns(Work, block, WORK_AT * nodes, nodes)
    following = columns(NextArrays, block, NEXT_AT * nodes, nodes)
    forget_here(st, route, profile, trace, work, following)


def _mark(record: Any, block: Any, nodes: int, rows: int, step_s: float) -> None:
    profile = columns(ProfileArrays, block, PROFILE_AT * nodes, nodes)
    work = columns(Work, block, WORK_AT * nodes, nodes)
    following = columns(NextArrays, block, NEXT_AT * nodes, nodes)
    mark_lesson(profile, following, work, record_at(record).taken_back)


def _take_back(record: Any, block: Any, nodes: int, rows: int, step_s: float) -> None:
    st = record_at(record)
    route = columns(RouteArrays, block, 0, nodes)
    profile = columns(ProfileArrays, block, PROFILE_AT * nodes, nodes)
    trace = columns(TraceArrays, block, TRACE_AT * nodes, nodes)
    work = columns(Work, block, WORK_AT * nodes, nodes)
    following = columns(NextArrays, block, NEXT_AT * nodes, nodes)
    take_back_lesson(st, route, profile, trace, work, following)


MODEL: Final = NativeModel(
    name="AdaptivePLDF",
    about="Predictive longitudinal driving function that learns from its driver (PLDF with SPAA)",
    record=PldfState,
    texts=Files,
    modules=KERNEL_MODULES,
    entries={
        "start": _start,
        "adopt": _adopt,
        "refresh": _refresh,
        "step": _step,
        "learn": _learn,
        "forget": _forget,
        "mark": _mark,
        "take_back": _take_back,
    },
    groups=(RouteArrays, ProfileArrays, TraceArrays, Work, NextArrays),
    kept=3,
    route=RouteArrays,
    watches=WATCHES,
    bounds=BOUNDS,
)
