"""What steel gives way by at least: against Hertz's line contact and against a mass on a spring."""

import math

import numpy as np
import pytest
from machines import PAPER, SCALES
from scipy.integrate import solve_ivp

from carom.parameters import Scales
from carom.parameters.indentation import LARGEST, STEEL, indentation_of_force, indentation_of_impact, is_compliant

MACHINE = PAPER.replace(scales=SCALES)
RADIUS = MACHINE.radius_ratio * SCALES.clearance


@pytest.mark.parametrize("clearance", [0.05e-3, 0.25e-3, 0.7e-3, 3e-3])
def test_a_shaft_pressed_into_a_bore_gives_way_by_more(clearance):
    """Hertz's half width of the contact, and the approach of both bodies (Johnson, 1985, sections 4.2 and 5.6)."""
    scales = Scales(mass=50.0, clearance=clearance, speed=184.2)
    machine = PAPER.replace(radius_ratio=RADIUS / clearance, scales=scales)
    ratios = []
    for force in np.geomspace(1e2, 1e9, 40):
        load, modulus = force / (2.0 * RADIUS), STEEL / (2.0 * (1.0 - 0.3**2))
        half = math.sqrt(4.0 * load * RADIUS * (RADIUS + clearance) / clearance / (math.pi * modulus))
        if half > RADIUS:
            break
        approach = 2.0 * load * (1.0 - 0.3**2) / (math.pi * STEEL) * (2.0 * math.log(4.0 * RADIUS / half) - 1.0)
        ratios.append(approach / (indentation_of_force(machine, force / scales.force) * clearance))
    assert len(ratios) > 10
    assert min(ratios) >= 1.0
    assert max(ratios) < 8.5


def test_a_hit_is_a_mass_on_a_spring():
    speed, stiffness = 0.3 * SCALES.velocity, 2.0 * RADIUS * STEEL
    span = math.pi * math.sqrt(SCALES.mass / stiffness)
    path = solve_ivp(
        lambda _, y: (y[1], -stiffness / SCALES.mass * y[0]),
        (0.0, span),
        (0.0, speed),
        rtol=1e-10,
        atol=1e-16,
        max_step=span / 100,
    )
    assert indentation_of_impact(MACHINE, 0.3) * SCALES.clearance == pytest.approx(path.y[0].max(), rel=1e-3)


def test_nothing_is_said_where_the_machine_is_not_known():
    assert math.isnan(indentation_of_force(PAPER, 1.0))
    assert math.isnan(indentation_of_impact(PAPER, 1.0))
    assert not is_compliant(math.nan)
    assert not is_compliant(LARGEST)
    assert is_compliant(1.001 * LARGEST)
