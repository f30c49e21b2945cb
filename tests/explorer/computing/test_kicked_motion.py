"""The motion after a kick: that of the library, sampled."""

import numpy as np
import pytest
from machines import PAPER

import carom
from carom.explorer.computing.kicked_motion import LONGEST, follow_kick
from carom.explorer.computing.planes import DisturbancePlane, planes_of
from carom.explorer.computing.rest import rest_of
from carom.models import jeffcott, rotor_of

ROTOR = jeffcott(PAPER.replace(gamma=0.2))
BOUNCING = jeffcott(PAPER)
KICKS = DisturbancePlane("kick", "velocity", 1.0, 1.0)
SINGLE = 1e-6
"""Rounding of numbers of single precision of the order of one, with a margin."""


@pytest.mark.parametrize(
    ("rotor", "radial", "tangential"), [(ROTOR, 0.4, 0.2), (ROTOR, -1.2, 0.3), (BOUNCING, 0.6, 0.1)]
)
def test_it_is_the_motion(rotor, radial, tangential):
    rest = rest_of(rotor)
    kicked = follow_kick(rotor, KICKS, radial, tangential)
    seen = kicked["planes"][0]
    motion = carom.simulate(rotor, rest.kicked(radial, tangential), settle=True)
    assert kicked["outcome"] == motion.outcome.label
    positions, _ = carom.simulate(rotor, rest.kicked(radial, tangential), LONGEST).at(kicked["times"].astype(float))
    # Times of single precision at speeds of the order of one.
    np.testing.assert_allclose(seen["x"] + 1j * seen["y"], positions, atol=LONGEST * SINGLE)
    count = len(seen["impact_times"])
    known = min(count, len(motion.contacts.time))
    np.testing.assert_allclose(seen["impact_times"][:known], motion.contacts.time[:known], rtol=SINGLE)
    assert seen["hardest"] == motion.contacts.normal_impulse.max()
    assert np.hypot(seen["x"], seen["y"]).max() <= 1.0 + SINGLE


def test_every_impact_is_on_the_wall_at_its_instant():
    kicked = follow_kick(BOUNCING, KICKS, 0.6, 0.1)
    seen = kicked["planes"][0]
    places = np.searchsorted(kicked["times"], seen["impact_times"])
    np.testing.assert_allclose(np.hypot(seen["x"], seen["y"])[places], 1.0, atol=SINGLE)
    angles = np.angle(seen["x"] + 1j * seen["y"])[places]
    np.testing.assert_allclose(np.exp(1j * angles), np.exp(1j * seen["impact_angles"]), atol=LONGEST * SINGLE)


@pytest.mark.jit_only
def test_a_flexible_machine_is_followed_at_each_touchdown_bearing():
    case = carom.load("examples/tum-flexible-rotor.toml")
    rotor = rotor_of(case)
    kicks = planes_of(case)[0]
    size = kicks.own(0.3, rotor.scales)
    kicked = follow_kick(rotor, kicks, size, 0.0)
    motion = carom.simulate(rotor, rest_of(rotor).kicked(size, 0.0), settle=True)
    assert kicked["outcome"] == motion.outcome.label
    for place, found in enumerate(kicked["planes"]):
        touches = motion.seen_at(place).contacts
        assert found["hardest"] == touches.peak_force.max()
        assert found["words"].startswith(f"{len(touches)} contact")
        assert 0.5 < found["force"].max() / (found["hardest"] * motion.seen_at(place).scales.force) <= 1.0 + SINGLE
    assert "touchdown bearings 1 and 2" in kicked["words"]
