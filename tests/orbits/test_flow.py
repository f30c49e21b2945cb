"""Derivatives of the flow: exact through impacts, by differences elsewhere, and none where a motion has none."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from boundary_rotors import touching
from heavy_rotors import BOUNCING, ONE, PLASTIC, STICKING

from carom.models import Rigid
from carom.motions.starts import State
from carom.orbits.flow import Flow

STENCIL = ((3.0, 1 / 60), (2.0, -9 / 60), (1.0, 45 / 60), (-1.0, -45 / 60), (-2.0, 9 / 60), (-3.0, -1 / 60))
STEP = 1e-5


def difference(flow, vector, duration, direction):
    """Derivative of the end along a direction, by a central difference of order six."""
    return sum(weight * flow.end(vector + share * STEP * direction, duration) for share, weight in STENCIL) / STEP


def begun(rotor, velocity):
    """The flow from the centre of the clearance, with a velocity there."""
    speed = velocity * rotor.system.translated
    return Flow(rotor), Flow.vector(State(0.0 * speed, speed) if len(speed) > 1 else State(0j, speed[0]))


@pytest.mark.parametrize("rotor", [touching(Rigid(0.8), seed, -0.3) for seed in (1, 6)] + [ONE, PLASTIC])
def test_derivatives_through_impacts_are_exact(rotor):
    flow, vector = begun(rotor, 1.3 + 0.4j)
    for duration in (2.0, 5.0, 9.0):
        motion = flow.follow(vector, duration)
        found = flow.derivative(vector, motion)
        assert motion.is_impact.any()
        expected = [difference(flow, vector, duration, each) for each in np.eye(len(vector))]
        assert np.allclose(found, np.array(expected).T, rtol=0, atol=1e-7 * (1.0 + np.abs(found).max()))


@pytest.mark.parametrize("rotor", [BOUNCING[0], STICKING[0]])
def test_derivatives_through_compliant_contact_are_those_of_the_motion(rotor):
    flow, vector = begun(rotor, 1.3 + 0.4j)
    motion = flow.follow(vector, 4.0)
    found = flow.derivative(vector, motion)
    expected = [difference(flow, vector, 4.0, each) for each in np.eye(len(vector))]
    assert np.allclose(found, np.array(expected).T, rtol=0, atol=1e-4 * (1.0 + np.abs(found).max()))


@dataclass(frozen=True)
class Kinked(Flow):
    """A flow whose slope on one side is another than on the other, by a share."""

    share: float = 0.0

    def end(self, vector, duration):
        return vector + self.share * np.abs(vector)


@pytest.mark.parametrize(("share", "known"), [(0.0, True), (1e-4, True), (0.1, False)])
def test_there_is_no_derivative_where_both_sides_differ(share, known):
    flow, _ = begun(ONE, 0.1)
    vector = np.zeros(4)
    motion = flow.follow(vector, 1.0)
    motion = replace(motion, final=flow.state(vector))
    found = Kinked(ONE, share=share).change(vector, np.eye(4)[0], motion)
    assert bool(np.isfinite(found).all()) is known
