"""How hard a rotor strikes: impulses at a rigid wall, peak forces and depths in a compliant one."""

import numpy as np
import pytest
from machines import PAPER, SCALES

import carom
from carom.explorer.computing.walls import COMPLIANT, RIGID, hardest_load, peak_loads
from carom.models import jeffcott
from carom.parameters import Parameters, TouchdownBearing

PLANAR = Parameters(**{**PAPER.as_dict(), "gamma": 0.3}, scales=SCALES)
SOFT = jeffcott(PLANAR, TouchdownBearing("kelvin-voigt", 1e8, restitution=0.8))


def test_impacts_of_a_rigid_wall_are_those_of_its_log():
    motion = carom.simulate(jeffcott(PLANAR), carom.kick("160 mm/s"), settle=True)
    log = motion.contacts
    assert len(log.time) > 0
    np.testing.assert_array_equal(peak_loads(log), log.normal_impulse)
    assert hardest_load(log) == log.normal_impulse.max()
    assert RIGID.stated(log).startswith("hardest impulse ")
    assert RIGID.stated(log).endswith(" N s")


def test_impact_states_at_a_wall_that_gives_way_have_the_force_and_the_depth_of_the_motion():
    motion = carom.simulate(SOFT, carom.kick("160 mm/s"), settle=True)
    log = motion.contacts
    assert log.entered.all()
    # The motion itself, sampled around the hardest of its contacts: below the peak, and close to it.
    hardest = int(log.peak_force.argmax())
    times = np.linspace(log.time[hardest], log.end[hardest], 2001)[1:-1]
    forces, _ = motion.forces(times)
    assert 0.999 * hardest_load(log) < forces.max() <= hardest_load(log) * (1.0 + 1e-9)
    depth = motion.radius(times).max() - 1.0
    assert 0.999 * log.deepest.max() < depth <= log.deepest.max() * (1.0 + 1e-9)
    percent = float(COMPLIANT.stated(log).rpartition(", ")[2].partition(" %")[0])
    assert percent == pytest.approx(100.0 * log.deepest.max(), rel=0.05)


def test_a_contact_in_which_a_motion_begins_is_no_arrival_but_its_force_counts():
    start = carom.State(1.02 + 0j, 0j)
    motion = carom.simulate(SOFT, start, 0.05)
    assert (len(motion.contacts), motion.contacts.entered.sum()) == (1, 0)
    assert hardest_load(motion.contacts) > 0.0
