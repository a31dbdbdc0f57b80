"""The driving function as one running instance: route, store and kernel put together."""

from __future__ import annotations

import os
from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, fields
from pathlib import Path
from typing import cast

import numpy as np

from .bound_parameters import check_bounds
from .driver_words import WORD_TEXTS, Driven, answer, keep_words
from .errors import ModelError
from .function_words import KEPT_BESIDE, NO_STORE, OLDER_READING, WATCHES
from .hmi_texts import text_of
from .instance import Arrays, Instance, views, zeros
from .kernel import drive
from .kernel.arrays import NextArrays, ProfileArrays, RouteArrays, TraceArrays, Work
from .kernel.codes import (
    PROFILE_BASE,
    PROFILE_LOADED,
    PROFILE_NOT_PERSISTED,
    PROFILE_NOT_WRITABLE,
    PROFILE_REFUSED,
    XY,
)
from .kernel.learning import learn_drive
from .kernel.preparation import adopt_learned, start_drive
from .kernel.recorder import learns
from .kernel.signals import since, text_output, text_parameter
from .kernel.state import PldfState
from .outcome_words import lines_of
from .outcomes import Outcomes, outcomes_of
from .own_recording import WRITTEN, Drive, folder_of, save_drive, why_not_writable
from .profiles.learned_columns import fill, next_iteration
from .profiles.store import (
    STORE_VARIABLE,
    Iteration,
    ProfileConflict,
    ProfileRefused,
    ProfileStore,
    ProfileUnreadable,
    StoredProfile,
)
from .roads import Mark, Route, chosen_route, fingerprint, route_arrays


@dataclass(slots=True)
class Files:
    """Strings; everything works with no parameter set and no output read."""

    route_file: str = text_parameter("Route file (.xodr or .csv) in place of route_id")
    profile_store: str = text_parameter(
        "Folder of learned profiles; empty: environment variable PLDF_PROFILE_STORE",
        name="profile_store",
    )
    recording_folder: str = since(
        "0.3",
        text_parameter(
            "Folder for the function's own recording of each drive; empty: environment variable "
            "PLDF_RECORDING_FOLDER; neither: no recording"
        ),
    )
    hmi_text: str = since("0.3", text_output("What the instrument cluster says, one sentence"))


class DrivingFunction(Instance[PldfState]):
    """The adaptive PLDF: follows the profile of its driver and learns from every drive.

    Attributes:
        stored: what was known about this driver before the drive (None before ``initialize``).
        learned: what this drive taught, after ``finish``; None when nothing was to be learned.
        marks: places of the route that have names, for messages.
    """

    groups = (RouteArrays, ProfileArrays, TraceArrays)

    def __init__(self) -> None:
        super().__init__(PldfState(), Files())
        self.stored: StoredProfile | None = None
        self.learned: Iteration | None = None
        self.marks: tuple[Mark, ...] = ()
        self._store: ProfileStore | None = None
        self._recordings: Path | None = None
        self._reported = dict.fromkeys((watch.field for watch in WATCHES), 0)

    def initialize(self) -> None:
        """Read route and profile, plan, and make the outputs valid."""
        route = chosen_route(self.record.route_id, self.texts.route_file)
        self.tell(route.notes)
        self.prepare(route)
        self.follow(self._load(fingerprint(route)))
        self._open_recordings()
        self.refresh()

    def prepare(self, route: Route) -> None:
        """Start anew on ``route`` with its base profile."""
        self.check_parameters()
        check_bounds(self.record)
        self.clear_memory()
        if self.record.localization == XY and not route.has_line:
            raise ModelError(
                f"route {route.name} has no x_m and y_m, so localization must be ARC_LENGTH"
            )
        blank = (*zeros(ProfileArrays, route.nodes), *zeros(TraceArrays, route.nodes))
        self.attach(cast(Arrays, (*route_arrays(route), *blank)))
        self._reported = dict.fromkeys((watch.field for watch in WATCHES), 0)
        self.learned = None
        self.marks = route.marks
        start_drive(self.record, self.route, self.profile, self.work)

    def follow(self, stored: StoredProfile) -> None:
        """Build on ``stored``: drive its newest iteration, if ``apply_learned`` is set."""
        self.stored = stored
        self.record.profile_iteration = len(stored.iterations)
        if self.record.apply_learned and stored.iterations:
            fill(self.profile, stored.iteration())
            adopt_learned(self.record, self.route, self.profile, self.work)

    def attach(self, arrays: Arrays) -> None:
        """Name the arrays; work space is made anew, it holds nothing between steps."""
        super().attach(arrays)
        if not arrays:
            return
        nodes = len(arrays[0])
        profile_at = len(RouteArrays._fields)
        trace_at = profile_at + len(ProfileArrays._fields)
        self.route = views(RouteArrays(*arrays[:profile_at]))
        self.profile = views(ProfileArrays(*arrays[profile_at:trace_at]))
        self.trace = views(TraceArrays(*arrays[trace_at:]))
        self.work = views(zeros(Work, nodes))
        self.following = views(zeros(NextArrays, nodes))
        self.driven = Driven(self.route, self.profile, self.trace, self.work, self.following)

    def refresh(self) -> None:
        """Recompute the outputs from the inputs without advancing."""
        drive.refresh(self.record, self.route, self.profile)

    def step(self, step_s: float) -> None:
        """Advance by one communication step."""
        drive.drive_step(self.record, self.route, self.profile, self.trace, step_s)
        if self.record.teach_wanted:
            for text in answer(self.record, self.driven, self.stored):
                self.report("info", f"t = {1e-9 * self.record.time_ns:.3f} s: {text}")
        for watch in WATCHES:
            now = getattr(self.record, watch.field)
            if now != self._reported[watch.field]:
                self._reported[watch.field] = now
                self.report_watched(watch, now, self.record.time_ns)

    def say(self) -> None:
        """Put the sentence of the instrument cluster together."""
        self.texts.hmi_text = text_of(self.record)

    def finish(self) -> None:
        """Keep the driver's words, learn, save profile and recording; called once."""
        if self.stored is None:
            return
        self._save_recording()
        words = self.words_kept().iterations[len(self.stored.iterations) :]
        if learns(self.record) and self.record.nodes >= 2:
            iteration = self.learn()
            for line in lines_of(self.outcomes(), self.marks):
                self.report("info", line)
            self._save(
                self.stored,
                (*words, iteration),
                f"drive {iteration.number} learned from {iteration.interventions} pedal "
                "interventions",
            )
        elif words:
            self._save(self.stored, words, WORD_TEXTS["WORDS_SAVED"] % len(words))

    def learn(self, kind: str = "drive") -> Iteration:
        """Return what the drive so far leaves for the next one, as the next iteration."""
        kept = self.words_kept()
        learn_drive(self.record, self.route, self.profile, self.trace, self.work, self.following)
        self.learned = next_iteration(self.record, self.profile, self.following, kept, kind)
        return self.learned

    def words_kept(self) -> StoredProfile:
        """Return what was known before the drive with an iteration for each word of the driver."""
        if self.stored is None:
            raise ModelError("nothing to learn from before the instance was initialized")
        if self.record.words == 0:
            return self.stored
        at_the_end = copy(self.record)
        self.follow(self.stored)
        kept = keep_words(self.record, self.driven, self.stored)
        for f in fields(at_the_end):
            setattr(self.record, f.name, getattr(at_the_end, f.name))
        return kept

    def outcomes(self) -> Outcomes:
        """Return what became of each intervention, once ``learn`` was called."""
        return outcomes_of(self.record, self.trace, self.following)

    def _open_recordings(self) -> None:
        """Tell before the drive, not after it, that its recording could not be written."""
        self._recordings = folder_of(self.texts.recording_folder)
        if self._recordings is not None and (problem := why_not_writable(self._recordings)):
            self.report("warning", problem)

    def _save_recording(self) -> None:
        if self._recordings is None or self.record.nodes < 2 or self.stored is None:
            return
        st = self.record
        drive = Drive(st, self.route, self.profile, self.trace, self.stored.route)
        try:
            path = save_drive(self._recordings, drive)
        except ModelError as problem:
            self.report("error", str(problem))
            return
        self.report("info", WRITTEN % (st.nodes - 1, path))

    def _open_store(self) -> ProfileStore | None:
        folder = self.texts.profile_store or os.environ.get(STORE_VARIABLE, "")
        return ProfileStore(folder) if folder else None

    def _load(self, route: str) -> StoredProfile:
        """Return the stored profile, or a new one if there is none or it cannot be used."""
        st = self.record
        base = np.array(self.profile.base_mps)
        new = StoredProfile(st.driver_id, route, base)
        self._store = self._open_store()
        if self._store is None:
            st.profile_status = PROFILE_NOT_PERSISTED
            if learns(st) or st.apply_learned:
                self.report("warning", NO_STORE)
            return new
        stored, st.profile_status = None, PROFILE_REFUSED
        try:
            stored = self._store.load(st.driver_id, route, len(base))
            known = stored is not None and stored.iterations
            st.profile_status = PROFILE_LOADED if known else PROFILE_BASE
        except ProfileUnreadable as problem:
            self.report("warning", f"{problem}; {KEPT_BESIDE}")
        except ProfileRefused as refusal:
            self.report("warning", str(refusal))
        except ModelError as problem:  # it is no folder: nothing can be saved there, either
            self.report("warning", str(problem))
            return new
        if st.profile_status == PROFILE_BASE and stored is None:
            self._tell_older_reading(self._store, new)
        self._require_writable(self._store)
        if stored is None:
            return new
        return stored

    def _tell_older_reading(self, store: ProfileStore, new: StoredProfile) -> None:
        """Say so if the driver has a profile that this road, read otherwise, seems to hide."""
        if not (learns(self.record) or self.record.apply_learned):
            return
        older = store.older_reading(new.driver_id, new.route, new.base_mps)
        if older is not None:
            self.report("warning", OLDER_READING % (older.path, older.percent, older.path))

    def _require_writable(self, store: ProfileStore) -> None:
        """Tell before the drive, not after it, that what it teaches could not be saved."""
        if not learns(self.record):
            return
        try:
            store.require_writable()
        except ModelError as problem:
            self.record.profile_status = PROFILE_NOT_WRITABLE
            self.report("warning", f"what this drive teaches cannot be saved: {problem}")

    def _save(self, stored: StoredProfile, new: Sequence[Iteration], what: str) -> None:
        if self._store is None:
            return
        try:
            saved = self._store.append(stored, *new)
        except ProfileConflict as conflict:
            self.report("warning", str(conflict))
            return
        except ModelError as problem:
            self.report("error", f"profile not saved: {problem}")
            return
        if saved.warning:
            self.report("warning", saved.warning)
        self.report("info", f"{what}, saved in {saved.path}")
