"""Evidence (section 6) against a counter of a few lines, and that counter against its figures."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from laboratory import BASE, Array, after, function, plain, play_override, road

DRIVES = 10
PLACES = [(400.0 + 400.0 * k, 480.0 + 400.0 * k) for k in range(10)]
ROAD = road(4600.0)
INNER = slice(410, 450)  # of the first place: no bound of section 3.8 reaches it


class Counter:
    """One metre and sign: what waits, how sure it is, and whether it was accepted."""

    def __init__(self) -> None:
        self.evidence, self.waiting, self.accepted = 0.0, 0, False

    def passed(self, pressed: bool) -> bool:
        """Count one pass; return whether it teaches."""
        if pressed:
            self.evidence = min(self.evidence + 1.25, 2.2)
            self.waiting += 1
            self.accepted |= self.evidence == 2.2
            self.waiting *= not self.accepted
            return self.accepted
        if not self.accepted:
            self.evidence = max(self.evidence - 0.98, 0.0)
            self.waiting *= self.evidence > 0.0
        return False


def taught_after(presses: tuple[bool, ...]) -> int:
    """Return in which pass the first lesson is learned, from 1; 0 = in none."""
    counter = Counter()
    taught = [counter.passed(pressed) for pressed in presses]
    return taught.index(True) + 1 if any(taught) else 0


def share(presses: tuple[bool, ...], chance: float) -> float:
    return float(np.prod([chance if pressed else 1.0 - chance for pressed in presses]))


@pytest.mark.parametrize(
    ("chance", "wrong", "at_once"), [(0.02, 0.0035, 0.18), (0.05, 0.021, 0.40)]
)
def test_accidental_presses_teach_as_seldom_as_section_6_says(
    chance: float, wrong: float, at_once: float
) -> None:
    ways = list(product((False, True), repeat=DRIVES))
    taught = sum(share(way, chance) for way in ways if taught_after(way))
    assert taught == pytest.approx(wrong, rel=0.06)  # 0.35 % and 2.1 % are rounded
    assert 1.0 - (1.0 - chance) ** DRIVES == pytest.approx(at_once, abs=0.005)


def test_a_consistent_wish_is_learned_as_soon_as_section_6_says() -> None:
    ways = [(way, taught_after(way)) for way in product((False, True), repeat=14)]
    passes = sum(share(way, 0.9) * taught for way, taught in ways)
    assert passes == pytest.approx(2.3, abs=0.05)
    assert sum(share(way, 0.9) for way, taught in ways if taught) > 0.999
    at_once = sum(share(way, 0.9) * (way.index(True) + 1) for way, taught in ways if taught)
    assert at_once == pytest.approx(1.1, abs=0.02)  # FAITHFUL learns from the first press


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_every_metre_counts_as_the_counter_does(sign: float) -> None:
    rng = np.random.default_rng(8)
    counters = [Counter() for _ in PLACES]
    made = plain(function(ROAD, learn_consistent=1))
    column = {1.0: "faster", -1.0: "slower"}[sign]
    for _ in range(DRIVES):
        followed = np.array(made.profile.learned_mps)
        pressed = rng.random(len(PLACES)) < np.linspace(0.1, 0.9, len(PLACES))
        spans = [place for place, now in zip(PLACES, pressed, strict=True) if now]
        play_override(made, _wish(followed, spans, 4.0 * sign), spans)
        iteration = made.learn()
        for k, (a, b) in enumerate(PLACES):
            middle = int(0.5 * (a + b))
            teaches = counters[k].passed(bool(pressed[k]))
            assert (iteration.learned_mps[middle] != followed[middle]) == teaches
            assert getattr(iteration, f"pending_{column}")[middle] == counters[k].waiting
            if not counters[k].accepted:
                evidence = getattr(iteration, f"evidence_{column}")[middle]
                assert evidence == pytest.approx(counters[k].evidence, abs=1e-12)
        made = plain(function(ROAD, after(made, iteration), learn_consistent=1))
    assert any(c.accepted for c in counters) and not all(c.accepted for c in counters)


def _wish(followed: Array, spans: list[tuple[float, float]], more_mps: float):  # type: ignore[no-untyped-def]
    speed = followed.copy()
    for a, b in spans:
        speed[int(a) : int(b) + 1] = BASE + more_mps
    return lambda s_m: np.interp(s_m, np.arange(len(speed)), speed)


def test_what_is_accepted_is_the_mean_of_all_that_waited() -> None:
    """Eq. (3) is linear: two demonstrations teach the mean of what each alone would have taught."""
    at_once = []
    for more_mps in (4.0, 6.0):
        alone = plain(function(ROAD, learn_faithful=1))
        play_override(alone, _wish(np.array(alone.profile.learned_mps), PLACES[:1], more_mps),
                      PLACES[:1])  # fmt: skip
        at_once.append(alone.learn().learned_mps)
    made = plain(function(ROAD, learn_consistent=1))
    base = np.array(made.profile.learned_mps)
    for more_mps, lesson in zip((4.0, 6.0), at_once, strict=True):
        play_override(made, _wish(base, PLACES[:1], more_mps), PLACES[:1])
        iteration = made.learn()
        if more_mps == 4.0:
            np.testing.assert_array_equal(iteration.learned_mps, base)
            shown = iteration.pending_faster_mps - base
            np.testing.assert_allclose(shown[INNER], 2.0 * (lesson - base)[INNER], atol=1e-9)
        made = plain(function(ROAD, after(made, iteration), learn_consistent=1))
    learned = np.array(made.profile.learned_mps)
    np.testing.assert_allclose(learned[INNER], np.mean(at_once, 0)[INNER], atol=1e-9)
    assert np.all(learned[INNER] > base[INNER])


def _passes(presses: str, **settings: float) -> list[Array]:
    """Drive once per letter (f faster, s slower, - silent) over the first place.

    Returns the profile before the first drive and after each.
    """
    made = plain(function(ROAD, learn_consistent=1, **settings))
    profiles = [np.array(made.profile.learned_mps)]
    for press in presses:
        more_mps = {"f": 5.0, "s": -5.0, "-": 0.0}[press]
        followed = profiles[-1].copy()
        speed = followed.copy()
        speed[400:481] += more_mps
        spans = [] if press == "-" else PLACES[:1]
        play_override(made, lambda s_m, v=speed: np.interp(s_m, np.arange(len(v)), v), spans)
        iteration = made.learn()
        made = plain(function(ROAD, after(made, iteration), learn_consistent=1, **settings))
        profiles.append(np.array(made.profile.learned_mps))
    return profiles


def test_silence_takes_nothing_from_what_is_accepted_and_one_press_more_teaches() -> None:
    profiles = _passes("ff------f")
    np.testing.assert_array_equal(profiles[1], profiles[0])
    assert np.all(profiles[2][INNER] > profiles[0][INNER])
    for silent in profiles[3:9]:
        np.testing.assert_array_equal(silent, profiles[2])
    assert np.all(profiles[9][INNER] > profiles[2][INNER])


@pytest.mark.parametrize(("first", "other"), ["fs", "sf"])
def test_two_opposite_presses_in_a_row_put_the_base_profile_back(first: str, other: str) -> None:
    profiles = _passes(first * 2 + other * 2)
    assert np.all(profiles[2][INNER] != profiles[0][INNER])
    np.testing.assert_array_equal(profiles[3], profiles[2])
    np.testing.assert_allclose(profiles[4][INNER], profiles[0][INNER], atol=1e-9)


def test_a_single_opposite_press_is_a_slip() -> None:
    profiles = _passes("ffs--s--")
    for later in profiles[3:]:
        np.testing.assert_array_equal(later, profiles[2])


@pytest.mark.parametrize("seed", range(3))
def test_offsets_of_a_limit_count_as_the_counter_does(seed: int) -> None:
    """Two limits; the lever sets 1.5 km/h more in either, by chance: never 20 over the limit."""
    limits = [(0.0, BASE), (1200.0, BASE - 10.0 / 3.6)]
    rng = np.random.default_rng(seed)
    counters = [Counter(), Counter()]
    made = plain(function(road(2400.0, limits), learn_consistent=1))
    for _ in range(DRIVES):
        set_here = rng.random(2) < (0.35, 0.8)
        s_m = np.arange(0.0, len(made.route.limit_mps) - 0.75, 0.5)
        limit = np.array(made.route.limit_mps)[s_m.astype(int)]
        before = np.array(made.profile.offset_mps)
        automatic = limit + before[s_m.astype(int)]
        wish = automatic.copy()
        for k, (a, b) in enumerate(((300.0, 1200.0), (1500.0, 2400.0))):
            wish[(s_m >= a) & (s_m < b) & set_here[k]] += 1.5 / 3.6
        play_override(
            made,
            _wish(np.array(made.profile.learned_mps), [], 0.0),
            set_speed_mps=wish,
            set_speed_offset_mps=wish - automatic,
        )
        iteration = made.learn()
        for k, place in enumerate((700, 1900)):
            teaches = counters[k].passed(bool(set_here[k]))
            assert (iteration.offset_mps[place] != before[place]) == teaches
            if not counters[k].accepted:
                evidence = iteration.offset_evidence_faster[place]
                assert evidence == pytest.approx(counters[k].evidence, abs=1e-12)
        made = plain(function(road(2400.0, limits), after(made, iteration), learn_consistent=1))
    assert counters[1].accepted
