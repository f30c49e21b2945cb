"""The reference for compliant walls against heyoka, which integrates the planar rotor in the fixed frame by Taylor series."""

import cmath

import numpy as np
import pytest
from compliant_reference import AWAY, BACKWARD, FORWARD, ROLLING, SEPARATED, KelvinVoigt, Plane, Rotor, follow

from carom.parameters import Parameters

PHASES = [AWAY, FORWARD, BACKWARD, ROLLING, SEPARATED]
"""In the order of heyoka's numbers."""


@pytest.mark.parametrize(
    ("parameters", "law", "position", "velocity", "until"),
    [
        (Parameters(0.1, 0.76, 3 / 7, 0.21, 0.15, 0.9, 400 / 7), KelvinVoigt(1e4, 6.0), 0.3 + 0.2j, 1.5 + 0.5j, 6.0),
        (Parameters(0.1, 0.76, 3 / 7, 0.21, 0.3, 0.9, 3.0), KelvinVoigt(1e4, 40.0), 0.9, 2.0 - 4.0j, 0.65),
    ],
    ids=["slides", "rolls"],
)
def test_motion_of_the_planar_rotor(parameters, law, position, velocity, until):
    pytest.importorskip("heyoka", reason="heyoka is not installed (it has no package for this platform)")
    from . import compliant_wall

    other = compliant_wall.follow(parameters, *law, position, velocity, np.array([until]))

    at = parameters
    plane = Plane((1.0,), law, at.mu, at.radius_ratio + 1.0)
    rotor = Rotor.planar(at.gamma, at.omega, at.rho, at.phi, plane)
    motion = follow(rotor, [position], [velocity - 1j * position], until)

    assert [event.phase for event in motion.events] == [PHASES[phase] for phase in other.phases[1:]]
    turn = cmath.exp(1j * until)
    # Some contacts, each with the tolerance of both integrators.
    assert motion.position[0] * turn == pytest.approx(other.position[-1], abs=1e-11)
    assert (motion.velocity[0] + 1j * motion.position[0]) * turn == pytest.approx(other.velocity[-1], abs=1e-11)
