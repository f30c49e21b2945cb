"""The search for orbits with any number of impacts: what it finds is right, and what is known it finds."""

import copy
import math

import numpy as np
import pytest

import carom as cm
from carom import State, find_orbits, settle, simulate
from carom.base.outcome import Outcome, Phase
from carom.base.progress import Reporter
from carom.models import rotor_of
from carom.orbits import Orbit, orbit_of_motion
from carom.orbits.closing import close
from carom.orbits.orbit import all_numbered, same_orbit
from carom.orbits.search import OrbitSearch
from carom.orbits.searched import random_starts
from carom.orbits.simulated_search import periodic_of
from carom.parameters import Parameters
from tests.compilation import sized
from tests.machines import PAPER

DOUBLED = PAPER.replace(gamma=0.083)
LANDING = Parameters(0.0274, 1.0566, 0.42048, 0.0, 0.35408, 0.0269, 1.0477)
"""Bounces that chatter into a stretch of sliding twice a turn or so."""
GUESSES = sized(400, 5, 1500)

UNSTABLE = {
    2: {2.843591999: (0.80548417, 0.28268084), 2.881753133: (0.60463283, 0.43951141)},
    3: {2.894323656: (0.51188824, 0.44243417, 0.14936132), 2.904396048: (0.4202626, 0.39906107, 0.26642659)},
}
"""Periods and radial speeds of all orbits with 2 and 3 impacts of the source paper's machine at γ = 0.1: from 200,000 random guesses each
for Newton's method, by a program of its own with the closed form of a flight, which found each of them some hundred times and no other."""


def searched_alone(machine, impacts: int, guesses: int) -> list[Orbit]:
    """What the search finds without any known orbit."""
    search = OrbitSearch(rotor_of(machine), impacts)
    search.run(2000, guesses, 10, [0], Reporter())
    return [orbit for orbit in search.found if orbit.admissible]


@pytest.mark.jit_only
def test_the_search_finds_the_orbits_that_are_proven_to_exist():
    for gamma in (0.083, 0.1, 0.15):
        machine = PAPER.replace(gamma=gamma)
        found = searched_alone(machine, 1, 1500)
        proven = [orbit for orbit in find_orbits(machine) if orbit.admissible]
        assert len(found) == len(proven) == 4
        for orbit in proven:
            assert sum(same_orbit(orbit, other) for other in found) == 1


@pytest.mark.jit_only
@pytest.mark.parametrize("seed", range(sized(2, 1, 10)))
def test_unstable_orbits_that_attract_no_motion_are_found(seed):
    machine = PAPER.replace(gamma=0.1)
    found = find_orbits(machine, impacts=3, seed=seed)
    assert [orbit.name for orbit in found if orbit.impacts == 1] == ["B1,a", "B1,b", "B1,c", "B1,d"]
    for impacts, known in UNSTABLE.items():
        orbits = [orbit for orbit in found if orbit.impacts == impacts]
        assert [orbit.name for orbit in orbits] == [f"P{impacts},{k + 1}" for k in range(len(known))]
        for orbit, (period, speeds) in zip(orbits, known.items(), strict=True):
            assert not orbit.stable
            assert orbit.period == pytest.approx(period, abs=1e-9)
            assert [section.radial_speed for section in orbit.sections] == pytest.approx(speeds, abs=1e-8)


@pytest.mark.jit_only
def test_an_orbit_with_lasting_contact_is_found():
    """Its period is the time between the lift-offs of a motion that has settled; two directions do not survive the contact."""
    (orbit,) = [each for each in find_orbits(LANDING, impacts=1, guesses=1) if not each.impacts]
    assert (orbit.name, orbit.segments) == ("rubbing 1", "land slide+ lift")
    assert np.abs(orbit.multipliers.values[1:]).max() < 1e-6
    motion = simulate(LANDING, orbit.departure, 60.0 * orbit.period)
    flying = motion.segment_phases[:, 0] == Phase.FLIGHT
    lifts = motion.segment_starts[1:][~flying[:-1] & flying[1:]]
    assert np.diff(lifts)[-5:] == pytest.approx(orbit.period, abs=1e-8)


def _on_the_wall(friction, damping=0.05):
    """One mass on a rigid wall, without unbalance."""
    end = cm.models.Touchdown([1.0], cm.models.Rigid(0.9), friction=friction, surface_speed=21.0)
    parts = {"stiffness": [[0.3]], "forcing": [0.0], "touchdowns": [end], "translation": [1.0]}
    return cm.models.from_matrices(mass=[[1.0]], damping=[[damping]], **parts)


@pytest.mark.jit_only
def test_orbits_that_never_leave_the_wall_are_called_what_they_are():
    """Rolling at 21 times the shaft, and whirl that slides where friction balances damping: ``μ(w² − k) = γw``."""
    rolling = periodic_of(simulate(_on_the_wall(0.5), State(0.999, -22j), settle=True))
    assert (rolling.name, rolling.segments) == ("rolling 1", "rolls throughout")
    speed = 2.0 + math.sqrt(4.0 + 0.3)
    sliding = simulate(_on_the_wall(0.25, 1.0), State(1.0, -1j * (speed + 1.0)), 3.0, settle=False)
    whirl = close(sliding, 0.2, 2.0 * np.pi / (speed + 1.0), None)
    assert (whirl.name, whirl.segments) == ("whirl 1", "slides forward throughout")
    assert whirl.period == pytest.approx(2.0 * np.pi / (speed + 1.0), rel=1e-12)
    names = [str(each.name) for each in all_numbered([rolling, whirl, rolling])]
    assert sorted(names) == ["rolling 1", "rolling 2", "whirl 1"]
    assert copy.deepcopy(whirl.name).kind == "whirl"
    under_weight = find_orbits(cm.load("tests/machines/gravity.toml"))["rolling 1"]  # at any angle, which it keeps
    assert (under_weight.multipliers.stability, under_weight.stable) == ("neutral", False)


@pytest.mark.jit_only
def test_the_share_of_fresh_motions_that_end_on_a_listed_orbit():
    """It is that of motions followed here, within five standard deviations of both samples."""
    found = find_orbits(PAPER.replace(gamma=0.1), impacts=2)
    random = np.random.default_rng(99)
    ends = settle(found.rotor, State(*random_starts(found.rotor, random, 4000)))
    share = np.mean((ends.outcomes == Outcome.BOUNCING) & np.isin(ends.multiplicities, (1, 2)))
    assert found.search.share_on_listed == pytest.approx(share, abs=5 * np.sqrt(0.25 / found.search.fresh))
    assert 0.5 < share < 1.0
    assert found.search.on_others == 0
    listed, others, _ = OrbitSearch(found.rotor, 2).measured(500, random)  # of a search that has found nothing
    assert listed == 0
    assert others / 500 == pytest.approx(share, abs=5 * np.sqrt(0.25 / 500))


@pytest.mark.jit_only
def test_orbits_of_two_impacts():
    found = find_orbits(DOUBLED, impacts=2, guesses=GUESSES)
    several = [orbit for orbit in found if orbit.impacts == 2]
    assert [orbit.name for orbit in several] == [f"P2,{k + 1}" for k in range(len(several))]
    assert np.all(np.diff([orbit.period for orbit in several]) > 0.0)
    for orbit in several:
        assert orbit.admissible
        assert orbit.links.size < 1e-12
        # The simulation makes the same impacts.
        motion = simulate(DOUBLED, orbit.departure, 1.001 * orbit.period)
        assert len(motion.contacts) == 2
        assert np.abs(motion.contacts.time - np.cumsum(orbit.durations)).max() < 1e-8
    (stable,) = [orbit for orbit in found if orbit.stable]
    one = find_orbits(DOUBLED)["B1,d"]
    settled = simulate(DOUBLED, State(0.999 * one.position, 1.001 * one.departure.velocity), settle=True)
    assert settled.outcome is Outcome.BOUNCING
    assert same_orbit(orbit_of_motion(settled), stable)
    assert found[stable.name] is stable
    search = found.search
    assert 0 < search.last_new <= search.guesses == 2 * GUESSES
    assert search.guesses >= search.repeats + search.failures
    assert f"{search.guesses} initial guesses" in found.argument
    assert "may be incomplete" in repr(found)


@pytest.mark.jit_only
def test_an_orbit_that_attracts_one_start_in_a_thousand_is_found():
    machine = PAPER.replace(
        gamma=0.11188377394215625,
        omega=0.3837419376707885,
        rho=0.6854888858473782,
        mu=0.1762762731665836,
        d=0.7857939838097028,
    )
    found = find_orbits(machine, impacts=10, guesses=20)
    assert [orbit.stable for orbit in found if orbit.impacts == 10] == [True]
    assert f"{found.search.settled} motions were followed" in found.argument


@pytest.mark.jit_only
def test_bounces_lower_than_rounding_are_no_orbit():
    machine = PAPER.replace(
        gamma=0.03720271908029623,
        omega=0.5477059666138558,
        rho=0.42143003654730754,
        phi=1.6680640870879264,
        mu=0.07864579382234652,
        d=0.8719818046776144,
        radius_ratio=75.45770866643024,
    )
    proven = [orbit for orbit in find_orbits(machine) if orbit.admissible]
    found = searched_alone(machine, 1, 100)
    assert all(any(same_orbit(orbit, other) for other in proven) for orbit in found)


def test_the_same_seed_finds_the_same():
    first, second = (find_orbits(DOUBLED, impacts=2, guesses=sized(40, 1), seed=3) for _ in range(2))
    assert [orbit.period for orbit in first] == [orbit.period for orbit in second]
    assert first.search == second.search
