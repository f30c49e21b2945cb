"""The search for orbits with any number of impacts: what it finds is right, and what is known it finds."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from carom.motions import State, settle, simulate
from carom.orbits import find_orbits
from carom.orbits.orbit import Orbit, same_orbit
from carom.orbits.recognising import orbit_of_motion
from carom.outcome import InputError, Outcome
from tests.bouncing_machines import bouncing_parameters, disc_points
from tests.compilation import sized
from tests.machines import PAPER, random_parameters

DOUBLED = PAPER.replace(gamma=0.083)
STARTS = sized(40, 2, 200)
MANY = 10_000
"""Starts from which stable orbits are looked for by simulation alone."""


@pytest.mark.jit_only
def test_the_search_finds_the_orbits_that_are_proven_to_exist():
    for gamma, starts in ((0.083, 12), (0.15, 60)):
        machine = PAPER.replace(gamma=gamma)
        found = find_orbits(machine, impacts=1, starts=starts)
        proven = [orbit for orbit in find_orbits(machine) if orbit.admissible]
        assert len(found) == len(proven) == 4
        for orbit in proven:
            assert sum(same_orbit(orbit, other) for other in found) == 1


@pytest.mark.jit_only
def test_orbits_of_two_impacts():
    found = find_orbits(DOUBLED, impacts=2, starts=STARTS)
    assert [orbit.name for orbit in found] == [f"P2,{k + 1}" for k in range(len(found))]
    assert np.all(np.diff([orbit.period for orbit in found]) > 0.0)
    for orbit in found:
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
    assert 0 < found.last_new <= found.starts == STARTS
    assert found.guesses >= found.repeats + found.failures + len(found)
    assert str(STARTS) in found.argument
    assert "proves nothing" in repr(found)


@pytest.mark.jit_only
def test_an_orbit_that_attracts_one_start_in_a_thousand_is_found():
    machine = PAPER.replace(
        gamma=0.11188377394215625,
        omega=0.3837419376707885,
        rho=0.6854888858473782,
        mu=0.1762762731665836,
        d=0.7857939838097028,
    )
    found = find_orbits(machine, impacts=10)
    assert [orbit.stable for orbit in found] == [True]
    assert found.settled == 20_000
    assert f"{found.settled} motions were followed" in found.argument


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
    found = find_orbits(machine, impacts=1, starts=15)
    assert all(any(same_orbit(orbit, other) for other in proven) for orbit in found)


def test_the_same_seed_finds_the_same():
    first, second = (find_orbits(DOUBLED, impacts=2, starts=sized(4, 1), seed=3) for _ in range(2))
    assert [orbit.period for orbit in first] == [orbit.period for orbit in second]
    assert first.guesses == second.guesses


def test_bad_numbers_and_names():
    with pytest.raises(InputError, match="impacts"):
        find_orbits(DOUBLED, impacts=0)
    with pytest.raises(InputError, match="starts"):
        find_orbits(DOUBLED, impacts=2, starts=0)
    with pytest.raises(InputError, match="orbit"):
        find_orbits(DOUBLED, impacts=9, starts=1)["P9,77"]


def test_motions_without_an_orbit():
    assert orbit_of_motion(simulate(PAPER, State(0.1, 0.0), 5.0)) is None


@pytest.mark.deep
def test_stable_orbits_on_which_simulated_motions_end_are_found():
    """All that 10,000 starts end on, with up to 12 impacts: of the paper's machine, also where bouncing is irregular, and of others."""
    rng = np.random.default_rng(11)
    gammas = (*np.linspace(0.0805, 0.0834, 10), *np.linspace(0.085, 0.17, 10))
    machines = [PAPER.replace(gamma=float(gamma)) for gamma in gammas]
    machines += [bouncing_parameters(rng, 1 + number % 2) for number in range(30)]
    machines += [random_parameters(rng) for _ in range(10)]
    seen: Counter[int] = Counter()
    for machine in machines:
        positions, velocities = disc_points(rng, MANY), disc_points(rng, MANY)
        ends = settle(machine, 0.99 * positions, 1.5 * velocities, patience=3000)
        counts = np.where(ends.outcomes == Outcome.BOUNCING, ends.multiplicities, 0)
        for impacts in set(counts.tolist()) & set(range(1, 13)):
            ended: list[Orbit] = []
            for which in np.flatnonzero(counts == impacts)[:100]:
                start = State(0.99 * positions[which], 1.5 * velocities[which])
                orbit = orbit_of_motion(simulate(machine, start, settle=True, patience=3000))
                if orbit is None or not orbit.stable or orbit.impacts != impacts:
                    continue
                if not any(same_orbit(orbit, other) for other in ended):
                    ended.append(orbit)
            found = find_orbits(machine, impacts=impacts) if ended else ()
            for orbit in ended:
                seen[impacts] += 1
                assert any(same_orbit(orbit, other) for other in found), (machine, orbit)
    assert seen[1] >= 20
    assert seen.total() - seen[1] >= 20
