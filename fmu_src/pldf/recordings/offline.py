"""Learning from a recording, outside any FMU: the same kernel, the same result to the bit."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import ModelError
from ..findings import Finding
from ..function import DrivingFunction
from ..instance import view
from ..kernel.arrays import FloatArray
from ..kernel.codes import (
    BOUND,
    BOUND_LEGAL_LIMIT,
    EVIDENCE_BY,
    EVIDENCE_CHANGE,
    OUTCOME,
    OUTCOME_HOLE,
    OUTCOME_LEARNED,
)
from ..kernel.replay import Samples, replay
from ..kernel.stretch import stretch_factor, stretched_position
from ..kernel.units import KMH_PER_MPS
from ..outcome_words import NOT_LEARNED, TEXTS, pedal_words, place_words, set_speed_words
from ..outcomes import Hold, Outcomes, PedalOutcome, Place, SetSpeedOutcome, equal_runs
from ..profiles.older_reading import is_older_reading
from ..profiles.store import Iteration, StoredProfile
from ..roads import Route, fingerprint
from .derived import completed
from .recording import Recording

SAME_MPS = 1e-9
# A profile recorded that differs by more, on more than this share of the rows, is another one.
OTHER_PROFILE_KMH = 1.0
OTHER_PROFILE_SHARE = 0.01


@dataclass(frozen=True, eq=False)
class Learned:
    """What a recording taught.

    Attributes:
        function: the instance that learned, with trace, rates and the profile driven.
        profile: what was known before, with the new iteration added.
        iteration: that iteration.
        notes: how the recording was read, what was derived, and what it is taken to have followed.
    """

    function: DrivingFunction
    profile: StoredProfile
    iteration: Iteration
    notes: tuple[Finding, ...] = ()


def learn_from(
    recording: Recording,
    route: Route,
    stored: StoredProfile | None = None,
    function: DrivingFunction | None = None,
    file: str = "",
) -> Learned:
    """Apply SPAA to ``recording`` of a drive on ``route`` that followed the newest of ``stored``.

    Args:
        recording: columns as read; absent ones are derived.
        route: the route driven.
        stored: profile file of the driver; None: the drive followed the base profile.
        function: an instance whose parameters count (default: all defaults).
        file: of the recording, for the notes.

    Raises:
        ModelError: the recording is not on the route, or ``stored`` belongs to another route.
    """
    function = function or DrivingFunction()
    function.prepare(route)
    named = stored is not None
    stored = follow_known(function, route, stored)
    whole = completed(recording, function, file)
    columns = whole.columns
    absent = np.zeros(len(recording))  # not paused, no lead car limited, no temporary limit
    samples = Samples(
        *(view(np.ascontiguousarray(columns.get(name, absent))) for name in Samples._fields)
    )
    replay(function.record, function.route, function.trace, samples)
    if function.record.nodes < 2:
        where = f"{file}: " if file else ""
        raise ModelError(
            f"{where}the recording (s_m {columns['s_m'].min():g} to {columns['s_m'].max():g}) does "
            f"not advance on {route.name} (0 to {route.length_m:g} m)"
        )
    iteration = function.learn("learn")
    doubts = (*_contradicted(recording, function, file, named), *_last_words(recording, file))
    notes = (*whole.notes, *doubts)
    return Learned(function, stored.with_iteration(iteration), iteration, notes)


def follow_known(
    function: DrivingFunction, route: Route, stored: StoredProfile | None
) -> StoredProfile:
    """Have ``function``, prepared for ``route``, follow a profile; None: the base profile.

    Raises:
        ModelError: it belongs to another route.
    """
    if stored is None:
        base = np.array(function.profile.base_mps)
        stored = StoredProfile(function.record.driver_id, fingerprint(route), base)
    elif stored.route != fingerprint(route):
        raise ModelError(
            f"the profile belongs to route {stored.route}, not to {route.name} "
            f"({fingerprint(route)}); {_way_out(stored, np.array(function.profile.base_mps))}"
        )
    function.follow(stored)
    return stored


def _way_out(stored: StoredProfile, base_mps: FloatArray) -> str:
    """Return what to do with a profile of another road than the one with this base profile."""
    if is_older_reading(stored.iteration().base_mps, base_mps):
        return (
            "it was probably learned on an older reading of this road: 'pldf profiles move' "
            "carries it over"
        )
    return "give the route of that drive or leave out --profile-in"


def _contradicted(
    recording: Recording, function: DrivingFunction, file: str, named: bool
) -> Iterator[Finding]:
    """Yield what speaks against a drive with the profile that ``function`` follows.

    Args:
        recording: as it was read.
        function: that follows a profile.
        file: of the recording.
        named: somebody named that profile; else it is the base profile.
    """
    if "profile_mps" in recording:
        profile = np.asarray(function.profile.learned_mps)
        followed = np.interp(recording["s_m"], np.arange(float(len(profile))), profile)
        off_kmh = KMH_PER_MPS * np.abs(recording["profile_mps"] - followed)
        if np.mean(off_kmh > OTHER_PROFILE_KMH) > OTHER_PROFILE_SHARE:
            taken = "the newest iteration of the profile named" if named else "the base profile"
            yield Finding(
                "warning", file, 0, "profile_mps",
                f"up to {np.max(off_kmh):.1f} km/h off {taken}: the drive followed another one",
                "what it followed is learned as if the driver wished it anew",
                "name what the drive followed with --profile-in",
            )  # fmt: skip
    elif not named and "set_speed_offset_mps" not in recording:
        yield Finding(
            "note", file, 0, "",
            "no profile named, so the drive counts as driven with the base profile",
            "an offset that had been learned before would count as set by the driver",
            "name what the drive followed with --profile-in",
        )  # fmt: skip


def _last_words(recording: Recording, file: str) -> Iterator[Finding]:
    """Yield that forgetting and undoing, as the function does it at once, is not repeated."""
    for column, word in (("teach_forget_here", "forget"), ("teach_undo", "undo")):
        pressed = recording["s_m"][recording[column] > 0.0] if column in recording else np.zeros(0)
        if len(pressed):
            yield Finding(
                "warning", file, 0, column,
                f"pressed at {pressed[0]:.0f} m, which is not repeated",
                "what the driver took back then is learned, and kept, here",
                f"the function keeps it in the profile itself; in a file: pldf profiles {word}",
            )  # fmt: skip


def explain(learned: Learned) -> dict[str, Any]:
    """Return what was learned where and why, ready for JSON; speeds in m/s.

    ``interventions`` are those by pedal, ``set_speeds`` the series of presses of the lever. Each
    has its ``outcome`` and the same ``told`` in words. ``held`` says where which bound cut it.
    ``evidence`` lists the places that gained or lost some, with learn = CONSISTENT.
    """
    st = learned.function.record
    outcomes = learned.function.outcomes()
    return {
        "iteration": learned.iteration.number,
        "rates": {
            "pedal": st.pedal_ns / st.total_ns,
            "set_speed": st.set_speed_ns / st.total_ns,
            "combined": st.combined_ns / st.total_ns,
        },
        "interventions": [_explain_pedal(learned, outcomes, pedal) for pedal in outcomes.pedals],
        "set_speeds": [_explain_set_speed(outcomes, series) for series in outcomes.set_speeds],
        "segments": _segments(learned),
        "offsets": _offsets(learned),
        "evidence": [_explain_place(outcomes, place) for place in outcomes.places],
        "plan_held": [_explain_hold(hold) for hold in outcomes.plan_holds],
    }


def _explain_pedal(learned: Learned, outcomes: Outcomes, pedal: PedalOutcome) -> dict[str, Any]:
    f = learned.function
    entry: dict[str, Any] = {
        "number": pedal.number,
        "start_m": pedal.start_m,
        "end_m": pedal.end_m,
        "truncated": pedal.truncated,
        "outcome": OUTCOME.items[pedal.outcome].lower(),
        "told": pedal_words(outcomes, pedal),
        "learned_m": pedal.learned_m,
    }
    if pedal.end_m > pedal.start_m:
        alpha = stretch_factor(f.record, f.route, f.trace, pedal.number - 1)
        entry["stretch_factor"] = alpha
        entry["stretched_start_m"] = stretched_position(pedal.start_m, pedal.end_m, alpha)
    if pedal.outcome == OUTCOME_LEARNED:
        for name in (
            "learned_from_m",
            "learned_to_m",
            "mean_change_mps",
            "largest_change_mps",
            "barred_m",
        ):
            entry[name] = getattr(pedal, name)
        entry["held"] = [_explain_hold(hold) for hold in pedal.holds]
    else:
        entry["why_not"] = entry["told"].removeprefix(TEXTS["TRUNCATED"]).removeprefix(NOT_LEARNED)
    if pedal.outcome == OUTCOME_HOLE:
        entry.update(hole_s=pedal.hole_s, hole_m=pedal.hole_m)
    return entry


def _explain_set_speed(outcomes: Outcomes, series: SetSpeedOutcome) -> dict[str, Any]:
    return {
        "from_m": series.from_m,
        "to_m": series.to_m,
        "wish_mps": series.wish_mps,
        "offset_mps": series.offset_mps,
        "barred_m": series.barred_m,
        "outcome": OUTCOME.items[series.outcome].lower(),
        "told": set_speed_words(outcomes, series),
        "held_by": BOUND.items[BOUND_LEGAL_LIMIT].lower() if series.is_cut else None,
    }


def _explain_place(outcomes: Outcomes, place: Place) -> dict[str, Any]:
    return {
        **place._asdict(),
        "by": EVIDENCE_BY.items[place.by].lower(),
        "sign": "faster" if place.sign > 0 else "slower",
        "change": EVIDENCE_CHANGE.items[place.change].lower(),
        "told": place_words(outcomes, place),
    }


def _explain_hold(hold: Hold) -> dict[str, Any]:
    return {**hold._asdict(), "bound": BOUND.items[hold.bound].lower()}


def _segments(learned: Learned) -> list[dict[str, Any]]:
    """Runs of nodes that this drive changed for the same reason."""
    new, profile = learned.iteration, learned.function.profile
    change = new.learned_mps - np.asarray(profile.learned_mps)
    touched = (new.drive == new.number) & (np.abs(change) > SAME_MPS)
    return [
        {
            "start_m": start,
            "end_m": end,
            "cause": f"intervention {cause:g}" if cause else "set speed",
            "mean_change_mps": float(change[start : end + 1].mean()),
            "largest_change_mps": float(max(change[start : end + 1], key=abs)),
        }
        for start, end, cause in equal_runs(np.where(touched, new.intervention, -1.0))
        if cause >= 0.0
    ]


def _offsets(learned: Learned) -> list[dict[str, Any]]:
    """Runs of cells with the same learned offset."""
    return [
        {"start_m": start, "end_m": end + 1, "offset_mps": value}
        for start, end, value in equal_runs(learned.iteration.offset_mps)
        if value != 0.0
    ]
