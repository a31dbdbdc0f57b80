"""The cluster's sentences in random drives, read word by word by a judge of their own."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from faults.drivable import random_road
from faults.true_sentences import drives_on

# What no sentence may ever say: faster below the base profile, a limit that is not the next one, a
# lesson where nothing is learned or of a drive that taught nothing here.
NEVER = (
    "the request is below the base profile's",
    "the next limit is another",
    "nothing is learned here",
    "there was no such drive",
    "that drive taught nothing here",
    "the numbers say something else than the words",
)


@pytest.mark.parametrize("seed", range(2))
def test_sentences_are_true_as_their_words_are_read(seed: int) -> None:
    rng = np.random.default_rng(seed)
    found: Counter[str] = Counter()
    counts: Counter[str] = Counter()
    for _ in range(2):
        reader = drives_on(random_road(rng), rng, 1 + int(rng.integers(2)))
        found.update(reader.found)
        counts.update(reader.counts)
    assert counts["sentences"] > 100
    assert not [lie for lie in found if lie.endswith(NEVER)]
    # The moment in which a request turns, or a number changes by one, is no lie that anyone reads.
    assert sum(found.values()) <= counts["steps"] / 1000.0, found
    assert counts["replaced_early"] <= counts["sentences"] / 30.0
