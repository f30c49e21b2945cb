"""Periodic motions of rotors that weigh something: whole turns of the shaft, closed on the flow, and compared with other routes."""

import math

import numpy as np
import pytest
from compliant_reference import follow
from heavy_rotors import RIGID, SIX, SOFT, THREE, of_two_coordinates, settled

import carom as cm
from carom.models import KelvinVoigt, Rigid
from carom.orbits import find_orbits, lyapunov_exponents, orbit_exponents

pytestmark = pytest.mark.jit_only
FOUND = {"three": (3, 1), "one": (1, 1), "six": (6, 2), "landing": (0, 2), "plastic": (0, 2), "bouncing": (4, 2)}
"""Arrivals, and turns of the shaft, of the orbit on which a motion of each of these rotors settles."""
ROTORS = RIGID | {name: rotor for name, (rotor, _) in SOFT.items()}


@pytest.mark.parametrize("name", FOUND)
def test_a_settled_motion_is_closed_and_takes_whole_turns(name):
    orbit = settled(ROTORS[name])
    assert (orbit.impacts, orbit.turns) == FOUND[name]
    assert orbit.period == pytest.approx(math.tau * orbit.turns, rel=1e-13)
    assert orbit.stable
    # Nothing that stands in the fixed frame lets a delay be: all four multipliers count.
    assert len(orbit.multipliers.values) == 4
    motion = cm.simulate(ROTORS[name], orbit.departure, 20 * orbit.period)
    positions, velocities = motion.at(orbit.period * np.arange(20))
    assert positions == pytest.approx(positions[0], abs=1e-9)
    assert velocities == pytest.approx(velocities[0], abs=1e-9)


@pytest.mark.parametrize("name", SOFT)
def test_an_integrator_of_the_equations_of_motion_repeats_it(name):
    orbit, (_, reference) = settled(ROTORS[name]), SOFT[name]
    begin = orbit.departure
    # In the frame of the reference, weight points along the negative real axis at time zero.
    ahead = begin.position * -1j, begin.velocity * -1j
    motion = follow(reference, [ahead[0]], [ahead[1]], begin.time + orbit.period, begin.time)
    assert motion.position[0] == pytest.approx(ahead[0], abs=1e-8)
    assert motion.velocity[0] == pytest.approx(ahead[1], abs=1e-8)


@pytest.mark.parametrize("law", [Rigid(0.5), KelvinVoigt(1e3, 10.0)], ids=["rigid", "compliant"])
def test_rotors_of_several_coordinates_and_planes(law):
    orbit = settled(of_two_coordinates(law, 0.38), 0.1, 0.2)
    assert orbit.turns == 1
    assert {each.place for each in orbit.happenings} == {0, 1}
    assert len(orbit.multipliers.values) == 8


def test_measured_exponents_are_those_of_the_multipliers():
    orbit = settled(SIX)
    exact, motion = orbit_exponents(orbit), lyapunov_exponents(SIX, orbit.departure, 150, transient=30)
    assert motion.values[:3] == pytest.approx(exact.values[:3], abs=0.02)


def test_a_search_finds_orbits_and_says_how_many_turns_they_take():
    found = find_orbits(THREE, impacts=3, guesses=40)
    assert "turns" in dict(found[0].rows())
    (stable,) = [orbit for orbit in found if orbit.stable and orbit.impacts == 3 and orbit.turns == 1]
    assert stable.period == pytest.approx(settled(THREE).period)
    assert found.search.on_listed > 0
