"""States that somebody changed: refused, or driven like any other."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np
from forged import forgeries
from pldf.cosim.prepared import write_prepared_route
from pldf.errors import ModelError
from pldf.fmi.phases import Phase
from pldf.fmi.session import Session
from pldf.roads import packed_route

from .experiment import Counts, Experiment, Progress
from .models import KINDS, Kind, c_host, described, is_sound_step, run, short_road

STEPS: Final = 100  # before the state is taken
NODES: Final = 40  # of the road on which states are forged in C


def forged_states(count: int, seed: int, progress: Progress) -> Counts:
    """Change one or two values of a state of a Python model, restore it, drive on."""
    rng = np.random.default_rng(seed)
    found: Counter[str] = Counter(refused=0, accepted=0, violations=0)
    with short_road() as road:
        sessions = [_driven(kind, road, rng) for kind in KINDS]
        places = [[state for _, state in forgeries(session)] for session, _ in sessions]
        for round_ in range(count):
            which = round_ % len(KINDS)
            session, honest = sessions[which]
            chosen = rng.integers(0, len(places[which]), rng.integers(1, 3))
            state = _changed(honest, [places[which][i] for i in chosen])
            found.update(_judged(session, honest, state, rng))
            progress(round_ + 1)
    return dict(found)


def _driven(kind: Kind, road: Path, rng: np.random.Generator) -> tuple[Session, bytes]:
    session = Session(kind.create)
    session.model.texts.route_file = str(road)
    for field, value in kind.parameters.items():
        setattr(session.model.record, field, value)
    session.enter()
    session.exit()
    for _ in range(STEPS):
        is_sound_step(session.model, session.signals, rng)
    return session, session.state()


def _changed(honest: bytes, forged: Sequence[bytes]) -> bytes:
    """Return the honest state with the changes of several forged ones."""
    state = np.frombuffer(honest, np.uint8).copy()
    for other in forged:
        values = np.frombuffer(other, np.uint8)
        places = np.flatnonzero(values != np.frombuffer(honest, np.uint8))
        state[places] = values[places]
    return state.tobytes()


def _judged(session: Session, honest: bytes, state: bytes, rng: np.random.Generator) -> Counts:
    try:
        session.restore(state)
    except ModelError:
        return {"refused": 1, "violations": int(session.state() != honest)}
    broken = 0
    if session.phase is Phase.STEPPING:
        broken += not all(is_sound_step(session.model, session.signals, rng) for _ in range(4))
        session.terminate()
    session.restore(honest)
    return {"accepted": 1, "violations": broken}


def forged_states_native(count: int, seed: int, progress: Progress) -> Counts:
    """Let the C host change every word of a state of a native FMU, each with the right checksum."""
    found: Counter[str] = Counter(violations=0)
    cases = [(kind, version) for kind in KINDS for version in (2, 3)]
    with c_host() as (folder, host):
        route = packed_route(0)
        short: dict[str, Any] = {name: knots[:NODES] for name, knots in route.knots.items()}
        write_prepared_route(replace(route, **short), folder / "road.prepared")
        for round_ in range(count):
            kind, version = cases[(round_ + seed) % len(cases)]
            settings = {"route_file": str(folder / "road.prepared"), **kind.parameters}
            said = run(host, "forge", described(folder, version, kind.fmu, settings))
            counts = dict(zip(*[iter((said or "").split())] * 2, strict=True))
            found.update({name: int(number) for name, number in counts.items()})
            found["violations"] += said is None
            progress(round_ + 1)
    return dict(found)


EXPERIMENTS: Final = (
    Experiment(
        "forged_states",
        "A state that was changed is refused and changes nothing, or drives like any other.",
        forged_states,
        count=32_000,
        short=300,
    ),
    Experiment(
        "forged_states_native",
        "So does a native FMU with every word of a state changed, under the right checksum.",
        forged_states_native,
        count=40,
        short=1,
    ),
)
