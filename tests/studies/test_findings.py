"""What a study says of backward whirl: one limit of the damping or two, each for what it is."""

import math
from types import SimpleNamespace

import numpy as np
from machines import PAPER, SCALES

import carom
from carom.closed_forms.exact_results import exact_results
from carom.closed_forms.whirl import runaway_speed
from carom.studies import Wording
from carom.studies.findings import _backward_whirl

SOURCE = PAPER.replace(scales=SCALES)


def said_of(parameters: carom.parameters.Parameters) -> str:
    rotor = carom.models.jeffcott(parameters)
    study = SimpleNamespace(
        rotor=rotor,
        known=exact_results(rotor),
        wording=Wording(parameters.scales),
        case=SimpleNamespace(parameters=parameters),
    )
    return _backward_whirl(study)


def test_no_load_is_told_that_no_wall_bears():
    """3.88 MN on a shaft of 80 mm: the load at the point of no return is stated instead."""
    force = (SOURCE.radius_ratio**2 - SOURCE.omega**2 + SOURCE.rho) * SCALES.force
    share = force / (210e9 * 0.08) / 0.7e-3
    assert 0.1 < share < 1.0
    text = said_of(SOURCE)
    assert "in the final rolling backward whirl a force that the rigid model cannot predict" in text
    assert f"even solid steel is indented by at least {100 * share:.0f} % of the" in text
    assert "MN" not in text
    assert "The bearing then carries up to" in text
    # A rotor that turns slowly rolls with a force that steel bears; of a machine that is not known nothing is said.
    slow = SOURCE.replace(scales=carom.parameters.Scales(mass=50.0, clearance=0.7e-3, speed=20.0))
    assert "cannot predict" not in said_of(slow)
    assert "rigid wall" not in said_of(SOURCE.replace(scales=None))
    fast = SOURCE.replace(scales=carom.parameters.Scales(mass=50.0, clearance=0.7e-3, speed=3e4))
    assert "times the clearance" in said_of(fast)


def test_the_load_at_the_point_of_no_return_is_that_of_the_equations_of_motion():
    """Sliding at the runaway speed: the largest normal force over a turn, from the radial acceleration of the centre."""
    whirl = runaway_speed(carom.models.jeffcott(SOURCE)).certain
    angles = np.linspace(0.0, 2.0 * math.pi, 100_001)
    centre = SOURCE.rho * np.cos(angles - SOURCE.phi) + whirl**2 - SOURCE.omega**2
    force = Wording(SCALES).force(float(centre.max()))
    assert f"The bearing then carries up to {force} (" in said_of(SOURCE)
