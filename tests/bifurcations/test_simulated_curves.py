"""Curves in two parameters of orbits that are closed on the flow of the simulator, against those of the closed form."""

import numpy as np
import pytest
from linear_rotors import as_matrices
from machines import PAPER

import carom as cm
from carom.bifurcations.conditions import TESTS, conditions_at
from carom.models import jeffcott
from carom.parameters import Numbers

pytestmark = pytest.mark.jit_only
PLANE = cm.bifurcations.Plane("gamma", "omega", (0.06, 0.22), (0.75, 0.77))


@pytest.fixture(scope="module")
def branch():
    """Branch of the orbit B1,d of the same rotor from matrices, whose orbits have no closed form."""
    departure = cm.find_orbits(jeffcott(PAPER))["B1,d"].departure
    orbit = cm.orbits.orbit_of_motion(cm.simulate(as_matrices(jeffcott(PAPER)), departure, settle=True))
    return cm.continue_orbit(orbit, "gamma", (0.08, 0.19))


@pytest.mark.parametrize("kind", ["fold", "period-doubling"])
def test_curves_solve_the_equations_of_the_closed_form(branch, kind):
    (point,) = [each for each in branch.special if each.kind == kind]
    curve = cm.continue_curve(point, PLANE)
    assert curve.stops == ("edge of the plane", "edge of the plane")
    assert np.ptp(curve.points[:, 1]) == pytest.approx(0.02)
    for place, period, speed in zip(curve.points.tolist(), curve.periods, curve.radial_speeds, strict=True):
        numbers = PLANE.numbers_at(Numbers.of(PAPER), *place)
        at = conditions_at(numbers, period, speed)
        assert max(abs(at.closing), abs(at.balance), abs(TESTS[kind](numbers, period, speed))) < 1e-5
