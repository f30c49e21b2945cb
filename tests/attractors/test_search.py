"""Attractors of the source paper's machine and what becomes of its disturbances."""

import numpy as np
import pytest
from machines import PAPER

from carom import State, find_attractors, find_equilibria, find_orbits, kick
from carom.base.outcome import Outcome
from carom.models import jeffcott
from carom.motions import settling


def random_starts(count, fastest, seed=0):
    """Positions even over the clearance, velocities even over a disc."""
    random = np.random.default_rng(seed)
    points = np.sqrt(random.random((count, 2))) * np.exp(2j * np.pi * random.random((count, 2)))
    return [State(complex(place), fastest * complex(velocity)) for place, velocity in points]


def shares(rotor, starts):
    found = find_attractors(rotor, starts, known=False)
    return {member.name: member.share_of_disturbances for member in found}


# ------------------------------------------------------------------------------------------------ the source's machine


@pytest.mark.jit_only
def test_all_attractors_of_the_source_machine():
    found = find_attractors(jeffcott(PAPER))
    orbit = find_orbits(found.rotor)["B1,d"]
    rub = find_equilibria(found.rotor)[1]

    assert {member.name for member in found} == {"levitation", "B1,d", "synchronous rub", "rolling backward whirl"}
    bouncing = found["B1,d"]
    assert (bouncing.name.outcome, bouncing.name.multiplicity) == (Outcome.BOUNCING, 1)
    assert bouncing.period == pytest.approx(orbit.period, rel=1e-7)
    assert bouncing.largest_impulse == pytest.approx(1.95 * orbit.radial_speed, rel=1e-7)
    assert found["synchronous rub"].largest_force == pytest.approx(rub.normal_force, rel=1e-8)
    assert found["rolling backward whirl"].whirl == "backward"
    assert found["levitation"].whirl == found["synchronous rub"].whirl == "forward"


@pytest.mark.jit_only
@pytest.mark.parametrize("seed", [0, 1])
def test_all_random_starts_end_in_synchronous_rub_with_twice_the_damping(seed):
    rotor = jeffcott(PAPER.replace(gamma=0.2))

    assert find_equilibria(rotor)[0].stable
    assert shares(rotor, random_starts(100, 1.0, seed)) == {"synchronous rub": 1.0}


@pytest.mark.jit_only
@pytest.mark.parametrize("gamma", [0.05, 0.077])
@pytest.mark.parametrize("fastest", [0.5, 1.0])
def test_nearly_all_random_starts_roll_with_little_damping(gamma, fastest):
    ends = shares(jeffcott(PAPER.replace(gamma=gamma)), random_starts(100, fastest))

    assert set(ends) <= {"rolling backward whirl", "synchronous rub"}
    assert ends["rolling backward whirl"] > 0.9


@pytest.mark.jit_only
def test_irregular_bouncing_at_gamma_0_08_is_a_long_transient():
    found = find_attractors(jeffcott(PAPER.replace(gamma=0.08)), random_starts(40, 0.5), known=False)

    impacts = np.array([ending.impacts for ending in found.endings])
    assert {member.name for member in found} == {"rolling backward whirl", "synchronous rub"}
    assert 0.4 < (impacts > 1000).mean() < 0.9
    assert impacts.max() > 3000


@pytest.mark.jit_only
def test_irregular_bouncing_at_gamma_0_082_lasts():
    found = find_attractors(jeffcott(PAPER.replace(gamma=0.082)), random_starts(30, 0.5), known=False)
    irregular = found["irregular bouncing"]
    followed = [ending.impacts for ending in found.ending_on("irregular bouncing")]

    assert irregular.share_of_disturbances > 0.8
    assert (irregular.name.multiplicity, irregular.period) == (0, None)
    # A look ends just before its last impact.
    assert min(followed) >= 0.999 * found.patience
    assert irregular.survival is not None
    assert irregular.survival.died == 0
    assert irregular.settled
    assert "None of 200 ended within 20,000 impacts" in irregular.words
    assert found.transient is None


@pytest.mark.jit_only
@pytest.mark.parametrize(("gamma", "half_life"), [(0.079, 640.0), (0.080, 1880.0)])
def test_irregular_bouncing_that_dies_is_no_attractor_however_short_the_patience(gamma, half_life):
    """Half-lives counted over 1500 fresh starts every 250 impacts, to 4 %; one interval of 95 % in twenty misses them."""
    intervals = []
    for seed in range(3):
        found = find_attractors(jeffcott(PAPER.replace(gamma=gamma)), count=60, patience=4000, seed=seed)
        assert {member.name for member in found} == {"levitation", "synchronous rub", "rolling backward whirl"}
        transient = found.transient
        assert transient is not None
        low, high = transient.interval
        assert low < transient.half_life < high
        intervals.append((low, high))

    assert sum(low < half_life < high for low, high in intervals) >= 2


# ------------------------------------------------------------------------------------------------ bookkeeping


def test_motion_given_up_is_listed_last_with_its_reason(monkeypatch):
    monkeypatch.setattr(settling, "longest_time", lambda rotor: 5.0)
    found = find_attractors(jeffcott(PAPER), [kick(0.001), kick(0.3), kick(0.4)], known=False)
    last = found.members[-1]

    assert last.name == "unresolved: time-reached"
    assert (last.count, last.settled) == (2, False)
    assert found.members[0].name == "levitation"


# ------------------------------------------------------------------------------------------------ growing patience
