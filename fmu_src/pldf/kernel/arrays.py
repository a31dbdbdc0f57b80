"""The per-metre arrays of one instance, sized by the route when it is initialized.

Node ``i`` lies at ``s = i`` metres, ``i = 0 .. n - 1``; cell ``i`` is the metre from node ``i`` to
node ``i + 1`` (the last cell repeats its predecessor). Flags and numbers of drives are held as
float64 too: one kind of array keeps the native build's memory a single block.

In CPython the kernel gets ``memoryview`` objects over NumPy arrays (reading one element is three
times faster and gives a Python float); compiled by numba it gets the NumPy arrays themselves.
"""

from __future__ import annotations

from typing import Annotated, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from .codes import MODE, REASON
from .ranges import COUNT, EVIDENCE, NODE, Range

MODE_CODE = Range(0, len(MODE.items) - 1)
REASON_CODE = Range(0, len(REASON.items) - 1)

# Outside the kernels: a vector of one value per row, metre or person.
FloatArray = NDArray[np.float64]


class Floats(Protocol):
    """A mutable float64 vector: ``memoryview`` or ``numpy.ndarray``."""

    def __len__(self) -> int: ...

    def __getitem__(self, index: int, /) -> float: ...

    def __setitem__(self, index: int, value: float, /) -> None: ...


class RouteArrays(NamedTuple):
    """What the map says."""

    limit_mps: Floats  # cell: lowest legal limit
    curvature_per_m: Floats  # cell: largest absolute curvature
    grade: Floats  # node: rise over run
    x_m: Floats  # node: the route's line (all zero when the source has none)
    y_m: Floats  # node


class ProfileArrays(NamedTuple):
    """What the function wants to drive; all speeds in m/s."""

    base_mps: Floats  # node: planned from the legal limits alone
    planned_mps: Floats  # node: planned from limits plus learned offsets
    open_mps: Floats  # node: planned from curvature alone, for manual set speeds above the limit
    learned_mps: Floats  # node: the profile that this drive follows
    offset_mps: Floats  # cell: learned offset of the set speed from the limit
    drive: Floats  # node: number of the drive that changed it last, 0 = never
    intervention: Floats  # node: number of the intervention in that drive, 0 = set speed
    lessons: Floats  # node: how many drives shaped it
    bound: Floats  # node: which bound cut it last (BOUND in codes)
    evidence_faster: Annotated[Floats, EVIDENCE]  # node: for going faster (section 6)
    evidence_slower: Annotated[Floats, EVIDENCE]  # node
    pending_faster: Annotated[Floats, COUNT]  # node: how many demonstrations wait for more evidence
    pending_slower: Annotated[Floats, COUNT]  # node
    pending_faster_mps: Floats  # node: their mean speed
    pending_slower_mps: Floats  # node
    offset_evidence_faster: Annotated[Floats, EVIDENCE]  # cell: the same by the lever
    offset_evidence_slower: Annotated[Floats, EVIDENCE]  # cell
    offset_pending_faster: Annotated[Floats, COUNT]  # cell
    offset_pending_slower: Annotated[Floats, COUNT]  # cell
    offset_pending_faster_mps: Floats  # cell: their mean offset from the legal limit
    offset_pending_slower_mps: Floats  # cell
    limit_end_m: Floats  # node: position of the next change of the legal limit, else route end
    turn_m: Annotated[Floats, NODE]  # node: where the present or next acceleration phase ends
    braking_mps: Floats  # node: highest speed from which braking keeps the hard caps
    braking_by_hand_mps: Floats  # node: the same under a set speed set by hand
    reason: Annotated[Floats, REASON_CODE]  # node: why the profile is no faster (REASON in codes)
    aim_m: Annotated[Floats, NODE]  # node: whose speed the profile goes to from here


class TraceArrays(NamedTuple):
    """What happened in this drive, recorded by metre (see ``recorder``)."""

    time_s: Floats  # node: time of first arrival
    speed_mps: Floats  # node: recorded speed; the minimum where the car stood
    eligible: Floats  # node: 1 = learning was allowed, 0 = it was not, or not driven
    active: Floats  # node: 1 = the function drove (mode ACTIVE)
    gap: Floats  # node: 1 = interpolated over a hole in the recording
    set_speed_mps: Floats  # node: manual set speed in force, 0 = none
    set_barred: Floats  # node: 0, or why no set speed of before is learned (OUTCOME in codes)
    start_m: Floats  # intervention k: position at which it began
    end_m: Floats  # intervention k: position at which it ended
    barred: Floats  # intervention k: 0, or why it must not be learned (OUTCOME in codes)
    word_kind: Floats  # word k of the driver: WORD_FORGET or WORD_UNDO (codes)
    word_at: Floats  # word k: position of the car, or number of the iteration taken back
    # For the function's own recording (see ``log``): what was in force at
    mode: Annotated[Floats, MODE_CODE]  # node: MODE in codes
    gas_pedal: Floats  # node: travel, 0..1
    brake_pedal: Floats  # node: travel, 0..1
    shown_mps: Floats  # node: set speed
    offset_mps: Floats  # node: offset of the set speed that the driver set
    profile_mps: Floats  # node: profile followed
    reason: Annotated[Floats, REASON_CODE]  # node: REASON in codes


class Work(NamedTuple):
    """Scratch space of planner, learning and bounds, one value per node each."""

    a: Floats
    b: Floats
    c: Floats
    d: Floats
    e: Floats
    f: Floats
    g: Floats
    h: Floats


class NextArrays(NamedTuple):
    """What a finished drive leaves for the next one, and what became of each intervention.

    The meaning of what is there per node or cell is that of ``ProfileArrays``.
    """

    planned_mps: Floats
    learned_mps: Floats
    offset_mps: Floats
    drive: Floats
    intervention: Floats
    lessons: Floats
    bound: Floats
    evidence_faster: Floats
    evidence_slower: Floats
    pending_faster: Floats
    pending_slower: Floats
    pending_faster_mps: Floats
    pending_slower_mps: Floats
    offset_evidence_faster: Floats
    offset_evidence_slower: Floats
    offset_pending_faster: Floats
    offset_pending_slower: Floats
    offset_pending_faster_mps: Floats
    offset_pending_slower_mps: Floats
    outcome: Floats  # pedal intervention k: what became of it (OUTCOME in codes)
    set_from_m: Floats  # series k of presses: where its offset begins to hold
    set_to_m: Floats  # series k: where it ends
    set_wish_mps: Floats  # series k: offset from the legal limit that the driver set
    set_offset_mps: Floats  # series k: what was adopted of it
    set_outcome: Floats  # series k: what became of it (OUTCOME in codes)
    taught_m: Floats  # pedal intervention k: how many nodes it shaped last
    taught_from_m: Floats  # pedal intervention k: the first of them
    taught_to_m: Floats  # pedal intervention k: the last of them
    mean_change_mps: Floats  # pedal intervention k: of these nodes, against the profile driven
    largest_change_mps: Floats  # pedal intervention k: the same; with its sign
    hole_s: Floats  # pedal intervention k: time of the holes that cost it
    hole_m: Floats  # pedal intervention k: length of the holes that cost it
    proof: Floats  # pedal intervention k: evidence of what waits for more (section 6)
    barred_m: Floats  # pedal intervention k: how much of it lies where learning was not allowed
    set_proof: Floats  # series k: the same of its offset
    set_barred_m: Floats  # series k: how much of it lies where learning was not allowed
    hold_bound: Floats  # hold k, a run of nodes cut by one bound: which (BOUND in codes)
    hold_intervention: Floats  # hold k: of which intervention's lesson, 0 = set speed
    hold_from_m: Floats  # hold k: its first node
    hold_to_m: Floats  # hold k: its last node
    hold_low_mps: Floats  # hold k: lowest speed of the learned profile there
    hold_high_mps: Floats  # hold k: highest speed of the learned profile there
    place_by: Floats  # place k whose evidence changed: by pedals or lever (EVIDENCE_BY in codes)
    place_sign: Floats  # place k: 1 = for going faster, -1 = slower
    place_change: Floats  # place k: what became of it (EVIDENCE_CHANGE in codes)
    place_from_m: Floats  # place k: its first node
    place_to_m: Floats  # place k: its last node
    place_evidence: Floats  # place k: its highest evidence after the drive
