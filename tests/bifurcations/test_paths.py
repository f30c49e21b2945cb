"""Distances from the path of an orbit, against states of a simulation."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from machines import PAPER

from carom import simulate
from carom.bifurcations.neighbours import setting_out
from carom.bifurcations.paths import Path
from carom.models import jeffcott
from carom.motions import State
from carom.orbits import find_orbits, rubbing_orbits
from carom.orbits.orbit import Orbit
from tests.bifurcations.test_rubbing import CHATTERING

pytestmark = pytest.mark.jit_only


@cache
def orbits() -> tuple[Orbit, Orbit]:
    (rubbing,) = rubbing_orbits(CHATTERING)
    return find_orbits(PAPER)["B1,d"], rubbing


@pytest.mark.parametrize("which", [0, 1])
def test_states_of_a_simulated_period_are_on_the_path(which):
    orbit = orbits()[which]
    motion = simulate(orbit.rotor, setting_out(orbit), orbit.period)
    position, velocity = motion.at(np.random.default_rng(1).uniform(0.0, orbit.period, 300))
    states = np.stack([position, velocity], axis=1)
    # What rounding makes of a period of an orbit with a multiplier of 3 at most.
    assert Path.of(orbit).distances(states).max() < 1e-12


@pytest.mark.parametrize("which", [0, 1])
@pytest.mark.parametrize("size", [1e-9, 1e-6, 1e-3])
def test_states_beside_the_path_are_as_far_away_as_they_were_moved(which, size):
    orbit, rng = orbits()[which], np.random.default_rng(2)
    motion = simulate(orbit.rotor, setting_out(orbit), orbit.period)
    times = rng.uniform(0.0, orbit.period, 100)
    here, ahead = (np.stack(motion.at(times + step), axis=1) for step in (0.0, 1e-7))
    rate = (ahead - here) / 1e-7
    moved = rng.normal(size=here.shape) + 1j * rng.normal(size=here.shape)
    # Across the path, to the accuracy of the difference; where it ends at an impact that is not along another part of it.
    moved -= rate * ((rate.conj() * moved).real.sum(axis=1) / (np.abs(rate) ** 2).sum(axis=1))[:, None]
    moved /= np.abs(moved).max(axis=1)[:, None]
    smooth = np.abs(rate[:, 1]) < 1e3
    found = Path.of(orbit).distances(here + size * moved)[smooth]
    assert smooth.sum() > 90
    # The nearest point in the sum of squares is not quite that in the largest difference, and other parts may be nearer.
    assert found.max() <= size * (1.0 + 1e-3) + 1e-11
    assert np.median(found) > 0.9 * size
    assert found.min() > 0.2 * size


def test_a_motion_that_approaches_the_orbit_comes_ever_nearer_to_its_path():
    orbit = orbits()[0]
    before = orbit.departure
    motion = simulate(orbit.rotor, State(before.position, before.velocity * 1.001), 60 * orbit.period)
    found = Path.of(orbit).distances(jeffcott(PAPER).system.states_of(motion.arrivals))
    # Its multipliers bring it from 1e-3 to below 1e-9 in sixty impacts, and rounding stops it far below.
    assert found[0] > 1e-5
    assert found[-1] < 1e-3 * found[0]
