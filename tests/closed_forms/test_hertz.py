"""Pressure of balls: against the half-space integrated with many digits, the circle, and a printed example."""

import mpmath
import pytest

from carom.closed_forms import ball_pressure, point_contact
from carom.parameters import TouchdownBearing

STEEL = {"law": "kelvin-voigt", "stiffness": 1e8, "damping": 100.0}


def displacement(contact, x, y):
    """Place (x, y) of a half-space with ``E* = 1`` under the pressure of a contact: the potential of the pressure, in polar coordinates.

    On a ray from the place the root of the pressure is that of a quadratic, between the two ends of the ellipse on its line: the
    integral over a whole chord is ``π/2`` of half its length times the largest pressure on it.
    """
    a, b, p = map(mpmath.mpf, (contact.longer, contact.shorter, contact.pressure))

    def chord(angle):
        along, across = mpmath.cos(angle), mpmath.sin(angle)
        square = (along / a) ** 2 + (across / b) ** 2
        slope = x * along / a**2 + y * across / b**2
        inside = 1 - (x / a) ** 2 - (y / b) ** 2 + slope**2 / square
        return mpmath.pi / 2 * inside / mpmath.sqrt(square)

    flat = b / a  # the integrand is narrow there: the angle at which its size changes
    return p / mpmath.pi * mpmath.quad(chord, [0, flat, mpmath.pi / 2, mpmath.pi - flat, mpmath.pi])


@pytest.mark.parametrize("curvatures", [(1.0, 1.0), (1.0, 1.3), (3.0, 0.5), (4.0, 0.07), (200.0, 0.5)])
def test_the_surface_is_flattened_by_a_pressure_that_sums_up_to_the_force(curvatures):
    contact = point_contact(2.5, curvatures, 1.0)
    assert contact.pressure * contact.longer * contact.shorter * 2 * mpmath.pi / 3 == pytest.approx(2.5, rel=1e-14)
    middle = displacement(contact, 0, 0)
    x, y = 0.6 * contact.longer, 0.7 * contact.shorter
    for place, lifted in (((x, 0), min(curvatures) * x**2), ((0, y), max(curvatures) * y**2)):
        # Both bodies together move by what their curvatures leave open between them.
        assert float(middle - displacement(contact, *place)) == pytest.approx(0.5 * lifted, rel=1e-11)


def test_a_printed_example():
    """3,600 N on 12 balls with a radius of 4.9 mm, race 25 mm, groove 5 mm: 2,193.6 MPa, 2.101 mm and 0.156 mm.

    Contact stresses in a steel ball bearing, amesweb.info, by tables of coefficients.  It has Poisson's ratio 0.29; only ``E/(1 − ν²)`` counts.
    """
    modulus = 210e9 * (1 - 0.3**2) / (1 - 0.29**2)
    bearing = TouchdownBearing(
        **STEEL,
        balls=12,
        ball_diameter=9.8e-3,
        race_diameter=50e-3,
        conformity=5.0 / 9.8,
        ball_modulus=modulus,
        race_modulus=modulus,
    )
    # The printed pressure is by 0.4 % not 3F/(2πab) of the printed axes, one of which has three digits.
    assert ball_pressure(bearing, 3600.0) == pytest.approx(2193.6e6, rel=5e-3)
    contact = point_contact(1500.0, (1 / 4.9e-3 + 1 / 25e-3, 1 / 4.9e-3 - 1 / 5e-3), 0.5 * 210e9 / (1 - 0.29**2))
    assert (1e3 * contact.longer, 1e3 * contact.shorter) == pytest.approx((2.101, 0.156), rel=5e-3)
