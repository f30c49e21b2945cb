"""How a machine levitates: the closed form of the sensitivity against a scan of the loop, and whirls against the equation of motion."""

import numpy as np
import pytest

import carom as cm
from carom.models import rotor_of
from carom.studies.levitating import levitating


@pytest.mark.parametrize("settings", [(), ("proportional_gain=60000 A/m",), ("derivative_gain=200 A s/m",)])
def test_the_largest_sensitivity_is_that_of_a_scan(settings):
    case = cm.load("examples/tum-test-rig.toml", settings)
    found, machine = levitating(case, rotor_of(case)), case.machine
    pull = machine.magnetic_bearings * machine.negative_stiffness
    s = 1j * np.concatenate([[0.0], np.geomspace(1e-2, 1e7, 400_001)])
    sizes = np.abs((machine.mass * s**2 - pull) / (machine.mass * s**2 + machine.damping * s + machine.stiffness))
    (loop,) = found.loops
    assert loop.peak == pytest.approx(sizes.max(), rel=1e-6)
    own = np.roots([machine.mass, machine.damping, machine.stiffness])
    for whirl in found.whirls:
        assert np.abs(own - whirl.exponent).min() < 1e-6 * abs(whirl.exponent)
