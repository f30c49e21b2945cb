"""Slides along the wall near the synchronous rub."""

import math

import numpy as np
import pytest

from carom.base.outcome import Outcome, Phase
from carom.motions.simulation import simulate


def ahead_of(found, angles):
    """Angles ahead of the rub, between the saddles."""
    low = -math.pi - 2.0 * found.phase
    return np.mod(angles - found.angle - low, 2.0 * math.pi) + low


def assert_slides_to_the_rub(rotor, found, start):
    """A motion converges to the rub without leaving the wall, by the criterion of its place and speed alone."""
    motion = simulate(rotor, start, 1e5, settle=True)
    assert motion.outcome is Outcome.FORWARD_RUB
    assert not motion.is_impact.any()
    assert set(motion.segment_phases[1:, 0]) == {Phase.FORWARD_SLIP}
    assert motion.final.position == pytest.approx(np.exp(1j * found.angle), abs=2e-9)
    assert abs(motion.final.velocity) < 1e-9
