"""Orbits of a flexible machine and their branches over a gain of its controllers, against motions simulated anew."""

import math

import numpy as np
import pytest

import carom as cm
from carom.base.outcome import Outcome
from carom.parameters import TouchdownBearing
from carom.rotors import (
    PID,
    FlexibleMachine,
    FlexibleRotor,
    MagneticBearing,
    Material,
    ProportionalDamping,
    ShaftSection,
    TouchdownPlane,
    Unbalance,
)

pytestmark = pytest.mark.jit_only

SPEED, GAIN, CLEARANCE = 605.3, 9000.0, 0.2e-3


def machine(gain):
    """A stiff shaft that turns with the speed, damping and unbalance of the source text, in one touchdown bearing in its middle."""
    steel = Material(2.1e11, 7800.0)
    shaft = [ShaftSection(length, 0.03, 0.0, steel) for length in (0.1, 0.2, 0.2, 0.1)]
    mass = 0.6 * math.pi * 0.015**2 * 7800.0
    return FlexibleMachine(
        rotor=FlexibleRotor(shaft, [], ProportionalDamping(0.1 * SPEED, 0.0)),
        speed=SPEED,
        clearance=CLEARANCE,
        bearings=[MagneticBearing(node, 50.0, -1e5, PID(gain)) for node in (1, 3)],
        touchdowns=[TouchdownPlane(2, TouchdownBearing("kelvin-voigt", stiffness=2e7, restitution=0.95), 0.015, 0.15)],
        unbalances=[Unbalance(2, 0.42 * CLEARANCE * mass)],
    )


def bouncing(gain):
    """Period, and radial speed into the wall, of the bouncing in which a kick ends, from its last contacts."""
    motion = cm.simulate(machine(gain).model, cm.kick(0.5, 0.0), max_events=20_000)
    assert motion.outcome is Outcome.BOUNCING
    longer = cm.simulate(motion.rotor, motion.final, 40.0 * math.tau)
    touches = longer.contacts
    return motion, float(np.diff(touches.time[-6:]).mean()), float(touches.radial_speed[-2])


@pytest.fixture(scope="module")
def found():
    motion, period, speed = bouncing(GAIN)
    return cm.orbits.orbit_of_motion(motion), motion, period, speed


def test_the_bouncing_in_which_a_kick_ends_is_an_orbit(found):
    orbit, _, period, speed = found
    assert orbit.stable
    assert orbit.period == pytest.approx(period, rel=1e-7)
    assert orbit.radial_speed == pytest.approx(speed, rel=1e-6)


def test_a_motion_comes_to_it_as_its_largest_multiplier_says(found):
    """Distance of the radial speed from that of the orbit, contact after contact, of the motion that settles on it."""
    orbit, motion, _, _ = found
    away = np.abs(motion.contacts.radial_speed - orbit.radial_speed)
    near = np.flatnonzero((away < 1e-4) & (away > 1e-7))
    rate = math.exp(np.polyfit(near, np.log(away[near]), 1)[0])
    assert rate == pytest.approx(np.abs(orbit.multipliers.values).max(), rel=3e-3)


def test_its_branch_over_a_gain_ends_where_fresh_motions_do(found):
    orbit = found[0]
    branch = cm.bifurcations.continue_orbit(orbit, "proportional", (GAIN, 9200.0))
    _, period, speed = bouncing(9200.0)
    last = int(np.argmax(branch.values))
    assert branch.values[last] == pytest.approx(9200.0)
    assert branch.period[last] == pytest.approx(period, rel=1e-6)
    assert branch.radial_speed[last] == pytest.approx(speed, rel=1e-5)
