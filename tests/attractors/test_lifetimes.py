"""Lifetimes of irregular motion: statistics of lives that are known, and the verdicts drawn from them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from carom.attractors.lifetimes import Lifetimes, measure_lifetimes
from carom.outcome import InputError
from tests.compilation import sized
from tests.machines import PAPER


def lived(lives, followed=20_000, discarded=100, end="rolling") -> Lifetimes:
    """Lifetimes of motions that die after these numbers of impacts, unless they are followed for fewer."""
    lives = np.sort(lives)
    ended = lives < followed
    ends = tuple(end if one else "irregular" for one in ended.tolist())
    return Lifetimes(PAPER, np.minimum(lives, followed).astype(int), ended, ends, followed, discarded)


def exponential(seed, half_life, count=300):
    return np.random.default_rng(seed).exponential(half_life / math.log(2.0), count)


@pytest.mark.parametrize("half_life", [60.0, 2000.0, 50_000.0])
def test_the_interval_holds_the_half_life_as_often_as_it_says(half_life):
    inside = even = verdicts = 0
    for seed in range(100):
        found = lived(exponential(seed, half_life))
        low, high = found.survival.interval
        assert low < found.survival.half_life < high
        inside += low < half_life < high
        even += found.evenness >= 0.01
        verdicts += found.verdict == ("undecided" if half_life > 20_000 else "transient")
    assert inside >= 89  # of 95 to be expected
    assert even >= 95  # of 98
    assert verdicts >= 95


def test_shares_left_are_those_of_the_law():
    found = lived(exponential(0, 2000.0, 20_000), discarded=0)
    ages = np.array([0, 500, 2000, 8000])
    np.testing.assert_allclose(found.share(ages), 0.5 ** (ages / 2000.0), atol=0.015)


def test_shares_count_motions_that_were_given_up_as_long_as_they_were_followed():
    impacts, ended = np.array([10, 20, 30, 40]), np.array([True, False, True, False])
    found = Lifetimes(PAPER, impacts, ended, ("rolling", "grazing", "rolling", "irregular"), 40, 0)
    np.testing.assert_allclose(found.share(np.array([5, 10, 25, 30, 39])), [1.0, 0.75, 0.75, 0.375, 0.375])
    assert found.destinations == {"rolling": 2, "grazing": 1, "irregular": 1}


def test_a_transient_beside_an_attractor_is_not_called_one():
    """Some of the motions stay for ever, whatever the deaths of the others say."""
    for share in (0.02, 0.5):
        lives = np.concatenate([exponential(1, 300.0), np.full(int(300 * share / (1.0 - share)), math.inf)])
        found = lived(lives)
        assert found.verdict == "undecided"
        assert "not at a constant rate" in found.words
        assert found.half_life is None


def test_ends_that_all_come_at_one_age_have_no_half_life():
    """A transient, because all ended; but a chatter or a slow spiral does not end by chance."""
    found = lived(np.random.default_rng(0).normal(2000.0, 100.0, 300))
    assert found.verdict == "transient"
    assert found.half_life is None
    assert "so there is no half-life; half of them lasted longer than 1,990 impacts" in found.words
    # Motions that approach an orbit slowly are all found to be periodic at the end.
    assert lived(np.full(30, 19_999.0), end="2-impact bouncing").half_life is None


def test_motions_followed_for_less_than_some_half_lives_are_undecided():
    found = lived(exponential(2, 10_000.0))
    assert found.verdict == "undecided"
    assert "transient or attractor, undecided" in found.words
    assert lived(exponential(2, 2000.0)).verdict == "transient"


def test_what_is_not_seen_to_end_is_not_called_an_attractor():
    found = lived(np.full(200, math.inf))
    assert found.verdict == "not seen to end"
    assert found.half_life is None
    assert found.survival.interval[0] == pytest.approx(200 * 19_900 * math.log(2.0) / math.log(20.0), rel=1e-3)
    assert "If it is a transient" in found.words
    assert "attractor" not in found.words
    assert lived(np.full(3, math.inf)).verdict == "not seen to end"


def test_short_lives_and_periodic_ends_have_words_of_their_own():
    assert lived(np.full(50, 20.0)).verdict == "too few"
    assert "None of 50 motions bounced irregularly for more than 100 impacts" in lived(np.full(50, 20.0)).words
    assert lived(np.array([20.0] * 50 + [300.0] * 9)).verdict == "too few"
    periodic = lived(exponential(3, 500.0), end="2-impact bouncing")
    assert periodic.verdict == "periodic"
    assert "to periodic bouncing" in periodic.words
    assert lived([150.0]).evenness == 1.0


@pytest.mark.jit_only
def test_bouncing_of_the_machine_of_the_paper_dies_the_faster_the_lower_its_damping():
    halves = []
    for gamma in (0.08, 0.079, 0.077):
        found = measure_lifetimes(PAPER.replace(gamma=gamma), count=sized(400, 40, 2000))
        assert set(found.destinations) <= {"rolling", "forward-rub", "irregular"}
        halves.append(found.half_life)
        assert len(found) == sized(400, 40, 2000)
    # Two at a time, because a window of periodic motion may lie between.
    assert halves[0] > 2.0 * halves[2]
    assert found.verdict == "transient"
    assert measure_lifetimes(PAPER.replace(gamma=0.081), count=60, impacts=4000).verdict == "not seen to end"


@pytest.mark.jit_only
def test_the_discarded_impacts_do_not_change_the_half_life():
    """The law has no memory: the tail of 300 lives, from any age on, tells the same."""
    rotor = PAPER.replace(gamma=0.079)
    found = [measure_lifetimes(rotor, count=1000, discarded=discarded).survival for discarded in (400, 800)]
    assert found[0].interval[0] < found[1].interval[1]
    assert found[1].interval[0] < found[0].interval[1]


def test_limits_that_make_no_sense_are_refused():
    with pytest.raises(InputError, match="discarded"):
        measure_lifetimes(PAPER, impacts=100, discarded=100)
    with pytest.raises(InputError, match="impacts"):
        measure_lifetimes(PAPER, impacts=1)
