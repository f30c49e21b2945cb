"""How long irregular motion lasts: the numbers, their words, and motions whose life is known."""

import math

import numpy as np
import pytest
from machines import PAPER

from carom.attractors import Survival, follow_until_settled
from carom.attractors import following as module
from carom.attractors.following import measure_survival, still_irregular
from carom.base.outcome import Outcome
from carom.models import jeffcott
from carom.motions import Endings, State, settle


def ensemble(multiplicities, outcomes, impacts=0):
    count = len(multiplicities)
    ones = np.ones(count)
    return Endings(
        outcomes=np.array(outcomes, np.int8),
        times=ones,
        impacts=np.full(count, impacts),
        multiplicities=np.array(multiplicities),
        positions=ones.astype(complex),
        velocities=ones.astype(complex),
        begins=0.0 * ones,
    )


def mortal(half_life, seed):
    """Stands in for ``settle``: irregular motions that die by chance, each impact with one probability."""
    random = np.random.default_rng(seed)

    def settle(rotor, starts, *, patience, threads=None):
        dies = random.random(len(starts.position)) > 0.5 ** (patience / half_life)
        return ensemble(np.zeros(len(dies), int), np.where(dies, Outcome.ROLLING, Outcome.BOUNCING), patience)

    return settle


@pytest.mark.parametrize("half_life", [500.0, 1600.0, 20_000.0])
def test_the_interval_holds_the_half_life_as_often_as_it_says(monkeypatch, half_life):
    inside = 0
    for seed in range(100):
        monkeypatch.setattr(module, "settle", mortal(half_life, seed))
        found = measure_survival(None, np.ones(7, complex), np.ones(7, complex), impacts=20_000)
        assert found.transient
        low, high = found.interval
        assert low < found.half_life < high
        inside += low < half_life < high
    assert inside >= 90  # of 95 to be expected


def test_a_transient_is_named_only_if_it_was_followed_for_several_half_lives():
    for died, half_life, verdict in (
        (100, 19_000.0, "transient"),
        (99, 3000.0, "transient"),
        # One in a hundred should be left: ten of them are on something else.
        (90, 3000.0, "undecided"),
        (30, 40_000.0, "undecided"),
    ):
        found = Survival(100, 20_000, died, half_life, (0.5 * half_life, 2.0 * half_life))
        assert found.verdict == verdict
        assert found.words.startswith(
            "transient, " if verdict == "transient" else "transient or attractor, undecided, "
        )
    assert Survival(100, 20_000, 0, None, (4e5, math.inf)).verdict == "not seen to end"


@pytest.mark.jit_only
def test_motions_of_an_ensemble_are_followed_to_where_they_end():
    rotor = jeffcott(PAPER.replace(gamma=0.08))
    random = np.random.default_rng(0)
    points = np.sqrt(random.random((2, 80))) * np.exp(2j * np.pi * random.random((2, 80)))
    early = settle(rotor, State(points[0], 0.5 * points[1]), patience=1500)
    going = still_irregular(early)
    assert going.sum() > 20
    late, found = follow_until_settled(rotor, early, impacts=20_000)
    assert not still_irregular(late).any()
    assert found is not None
    assert found.transient
    np.testing.assert_array_equal(late.outcomes[~going], early.outcomes[~going])
    assert (late.impacts[going] > early.impacts[going]).all()
    # Half of those that last longer than the patience have gone after the half-life.
    lives = late.impacts[going] - early.impacts[going]
    assert 0.2 < (lives > found.half_life).mean() < 0.85
    assert follow_until_settled(rotor, late, impacts=20_000) == (late, None)
