"""How hard a rotor strikes: impulses at a rigid wall, peak forces and depths in a compliant one."""

import numpy as np
from machines import PAPER, SCALES

import carom
from carom.explorer.computing.walls import RIGID, contact_peaks
from carom.models import jeffcott
from carom.parameters import Parameters, TouchdownBearing

PLANAR = Parameters(**{**PAPER.as_dict(), "gamma": 0.3}, scales=SCALES)
SOFT = jeffcott(PLANAR, TouchdownBearing("kelvin-voigt", 1e8, restitution=0.8))


def test_impacts_of_a_rigid_wall_are_those_of_its_log():
    motion = carom.simulate(jeffcott(PLANAR), carom.kick("160 mm/s"), settle=True)
    peaks, log = contact_peaks(motion), motion.contacts
    assert peaks.count == len(log.time) > 0
    np.testing.assert_array_equal(peaks.peak_load, log.normal_impulse)
    assert (peaks.hardest, peaks.deepest) == (log.normal_impulse.max(), 0.0)
    assert RIGID.stated(peaks, SCALES).startswith("hardest impulse ")
    assert RIGID.stated(peaks, SCALES).endswith(" N s")


def test_impact_states_at_a_wall_that_gives_way_have_the_force_and_the_depth_of_the_motion():
    motion = carom.simulate(SOFT, carom.kick("160 mm/s"), settle=True)
    peaks = contact_peaks(motion)
    assert peaks.count == len(motion.contacts) == len(peaks.time)
    # The motion itself, sampled around the hardest of its contacts: below the peak, and close to it.
    hardest = int(motion.contacts.peak_force.argmax())
    times = np.linspace(motion.contacts.time[hardest], motion.contacts.end[hardest], 2001)[1:-1]
    forces, _ = motion.forces(times)
    assert 0.999 * peaks.hardest < forces.max() <= peaks.hardest * (1.0 + 1e-9)
    depth = motion.radius(times).max() - 1.0
    assert 0.999 * peaks.deepest < depth <= peaks.deepest * (1.0 + 1e-9)


def test_a_contact_in_which_a_motion_begins_is_no_arrival_but_its_force_counts():
    start = carom.State(1.02 + 0j, 0j)
    motion = carom.simulate(SOFT, start, 0.05)
    peaks = contact_peaks(motion)
    assert (peaks.count, len(peaks.time)) == (1, 0)
    assert peaks.hardest > 0.0
