"""Random drivers on random roads, and a judge who reads every sentence of the cluster."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from laboratory import KMH, PointMass, function
from pldf.function import DrivingFunction
from pldf.kernel.codes import MODE
from pldf.roads import Route

from faults.experiment import Counts
from faults.sentence_judge import MPH as MPH_MPS
from faults.sentence_judge import Moment, Past, Road, lies

STEP_S: Final = 0.05
DRIVES: Final = 3
TIME_MAX_S: Final = 150.0
HOLD_S: Final = 1.0
LASTS_S: Final = 0.6
LATELY_S: Final = 2.0
SEEN_S: Final = 0.1  # a step late is no lie
NEARLY_MPS2: Final = -0.1
ACTIONS: Final = frozenset(
    {
        "it speeds up",
        "it slows down",
        "it brakes",
        "the car is far below the limit",
        "the car is still slowing down to the limit",
        "the car drives another speed",
        "the car is slower than that",
        "the car is faster than that",
        "something else is slower",
        "the car drives",
    }
)
URGENT: Final = ("Brake now!", "Fault: please drive yourself")


class Person:
    """Presses pedals, lever and buttons when chance says so, and has cars and signs put ahead."""

    def __init__(self, rng: np.random.Generator, *, traffic: bool) -> None:
        self.rng, self.traffic = rng, traffic
        self.left: dict[str, float] = {}  # seconds
        self.value: dict[str, float] = {}
        self.gap_m = self.lead_mps = self.lead_wish_mps = 0.0

    def inputs(self, speed_mps: float, mode: str) -> dict[str, Any]:
        """Return the inputs of the next step."""
        self.left = {name: left - STEP_S for name, left in self.left.items() if left > STEP_S}
        self._begin("driver_gas_pedal", 0.03, (1.0, 8.0), (0.1, 0.6))
        self._begin("driver_brake_pedal", 0.015 * (speed_mps > 6.0), (0.5, 2.5), (0.05, 0.3))
        for lever in ("lever_up", "lever_down", "lever_up_long", "lever_down_long"):
            self._begin(lever, 0.015, (0.1, 0.3), (1, 1))
        self._begin("teach_forget_here", 0.01, (0.1, 0.5), (1, 1))
        self._begin("teach_undo", 0.005, (0.1, 0.5), (1, 1))
        self._begin("teach_pause", 0.01, (2.0, 8.0), (1, 1))
        self._begin("lever_resume", 0.4 * (mode == "STANDBY"), (0.1, 0.3), (1, 1))
        if self.traffic:
            self._begin("limit_override_mps", 0.01, (4.0, 15.0), (20.0 * KMH, 90.0 * KMH))
        held = {name: self.value[name] for name in self.left}
        ahead = self._car_ahead(speed_mps) if self.traffic else {}
        names = ("driver_gas_pedal", "driver_brake_pedal", "limit_override_mps")
        flags = ("lever_up", "lever_down", "lever_up_long", "lever_down_long", "lever_resume",
                 "teach_forget_here", "teach_undo", "teach_pause")  # fmt: skip
        return {
            **{name: float(held.get(name, 0.0)) for name in names},
            **{name: int(name in held) for name in flags},
            **ahead,
        }

    def _begin(
        self, name: str, per_s: float, held_s: tuple[float, float], value: tuple[float, float]
    ) -> None:
        if name not in self.left and self.rng.random() < per_s * STEP_S:
            self.left[name] = self.rng.uniform(*held_s)
            self.value[name] = self.rng.uniform(*value)

    def _car_ahead(self, speed_mps: float) -> dict[str, Any]:
        if "car" not in self.left:
            self._begin("car", 0.05, (3.0, 30.0), (1, 1))
            self.gap_m = self.rng.uniform(10.0, 80.0)
            self.lead_mps = max(speed_mps + self.rng.uniform(-8.0, 4.0), 0.0)
            self.lead_wish_mps = max(self.rng.uniform(-5.0, 30.0), 0.0)
        wish = self.lead_wish_mps - self.lead_mps
        before = self.lead_mps
        self.lead_mps = max(before + STEP_S * float(np.clip(wish, -2.5, 1.5)), 0.0)
        self.gap_m += STEP_S * (0.5 * (before + self.lead_mps) - speed_mps)
        if "car" in self.left and self.gap_m > 0.5:
            return {"lead_present": 1, "lead_gap_m": self.gap_m, "lead_speed_mps": self.lead_mps}
        self.left.pop("car", None)
        return {"lead_present": 0, "lead_gap_m": np.nan, "lead_speed_mps": np.nan}


class Reader:
    """Reads the cluster all the time, and remembers since when a sentence stands there."""

    def __init__(self, unit_mps: float) -> None:
        self.unit_mps = unit_mps
        self.text, self.steps = "", 0
        self.lasting: dict[tuple[str, str], int] = {}
        self.counts: Counts = {"sentences": 0, "steps": 0, "replaced_early": 0}
        self.found: dict[str, int] = {}

    def begin(self) -> None:
        """Begin a drive: what stood there at the end of the last one has no second to stay."""
        self.text, self.steps, self.lasting = "", 0, {}

    def read(self, text: str, now: Moment, road: Road) -> None:
        """Judge what stands there at the end of a step."""
        self.counts["steps"] += 1
        told = {(text, lie) for lie in lies(text, now, road, self.unit_mps)}
        # The car needs a moment to do what was decided, so what it does has to last to be a lie.
        self.lasting = {one: self.lasting.get(one, 0) + 1 for one in told}
        for (_, lie), steps in self.lasting.items():
            if steps * STEP_S >= (LASTS_S if lie in ACTIONS else SEEN_S):
                self._note(f"{_form(text)}: {lie}")
        self.steps += 1
        if text == self.text:
            return
        short = self.steps * STEP_S < HOLD_S - 1e-9 and self.text
        strictly = now._replace(
            targets=(now.target_mps, now.target_mps),
            bases=(now.base_mps, now.base_mps),
            steady_mps2=NEARLY_MPS2,
        )
        if short and text not in URGENT and not lies(self.text, strictly, road, self.unit_mps):
            self.counts["replaced_early"] += 1
        self.text, self.steps = text, 0
        self.counts["sentences"] += 1

    def _note(self, what: str) -> None:
        self.found[what] = self.found.get(what, 0) + 1


def _form(text: str) -> str:
    return "".join("N" if letter.isdigit() else letter for letter in text)


def moment(
    car: PointMass, inputs: dict[str, Any], aims: Sequence[tuple[float, float]], lately: bool
) -> Moment:
    """Return what is so at the end of the step that was given ``inputs``.

    ``aims`` are the target and the base speeds of the last second, ``lately`` tells whether there
    was a temporary limit in the last two.
    """
    st = car.made.record
    present = bool(st.lead_present)
    return Moment(
        s_m=car.s_m,
        speed_mps=car.speed_mps,
        acceleration_mps2=car.acceleration_mps2,
        request_mps2=st.acceleration_request_mps2,
        mode=MODE.items[st.mode],
        target_mps=st.target_speed_mps,
        targets=(min(aims)[0], max(aims)[0]),
        bases=(min(base for _, base in aims), max(base for _, base in aims)),
        base_mps=st.base_speed_mps,
        manual_mps=st.manual_set_mps if car.s_m < st.manual_end_m else 0.0,
        lead_m=st.lead_gap_m if present else 0.0,
        lead_mps=st.lead_speed_mps if present else 0.0,
        limits=bool(st.following_limits),
        take_over=bool(st.hmi_take_over),
        temporary_mps=float(inputs.get("limit_override_mps", 0.0)),
        temporary_lately=lately,
        paused=bool(inputs.get("teach_pause", 0)),
    )


def road_of(made: DrivingFunction, past: tuple[Past, ...]) -> Road:
    """Return what the judge knows of the road; the learned columns follow the function's."""
    route, profile = made.route, made.profile
    columns = (route.limit_mps, route.curvature_per_m, profile.base_mps)
    return Road(
        *(np.array(column) for column in columns),
        np.asarray(profile.learned_mps),
        np.asarray(profile.offset_mps),
        past,
    )


def drive(made: DrivingFunction, person: Person, reader: Reader, past: tuple[Past, ...]) -> None:
    """Drive once to the end of the road, reading all the way."""
    car = PointMass(made, float(made.profile.base_mps[0]) * person.rng.uniform(0.3, 1.1), 0.2)
    road = road_of(made, past)
    reader.begin()
    end_m = len(made.route.limit_mps) - 2.0
    temporary_s = 0.0
    aims: deque[tuple[float, float]] = deque(maxlen=round(HOLD_S / STEP_S) + 1)
    for _ in range(round(TIME_MAX_S / STEP_S)):
        inputs = person.inputs(car.speed_mps, MODE.items[made.record.mode])
        car.step(STEP_S, **inputs)
        if car.s_m >= end_m:
            break
        aims.append((made.record.target_speed_mps, made.record.base_speed_mps))
        temporary_s = LATELY_S if inputs["limit_override_mps"] > 0.0 else temporary_s - STEP_S
        now = moment(car, inputs, aims, temporary_s > 0.0)
        reader.read(text_of(made), now, road)


def text_of(made: DrivingFunction) -> str:
    """Return what stands in the cluster."""
    made.say()
    return made.texts.hmi_text


def drives_on(route: Route, rng: np.random.Generator, learn: int) -> Reader:
    """Drive three times on ``route``, learning after each; return who read."""
    miles = bool(rng.random() < 0.3)
    reader = Reader(MPH_MPS if miles else KMH)
    settings = {"learn": learn, "hmi_unit": int(miles)}
    made = function(route, **settings)
    past: tuple[Past, ...] = ()
    for _ in range(DRIVES):
        followed = np.array(made.profile.learned_mps)
        drive(made, Person(rng, traffic=bool(rng.random() < 0.5)), reader, past)
        kept = made.words_kept()
        iteration = made.learn()
        taught = iteration.learned_mps - followed
        taught = np.where(iteration.drive == iteration.number, taught, 0.0)
        past = (*past, Past(iteration.number, taught > 0.0, taught < 0.0, taught != 0.0))
        made = function(route, kept.with_iteration(iteration), **settings)
    return reader
