"""The figures of the source paper, and which version of its misprinted formulas is right.

Mora, Budd, Glendinning, Keogh: Non-smooth Hopf-type bifurcations arising from impact–friction contact events in rotating
machinery, Proc. R. Soc. A 470 (2014).  Numbers that the paper prints are named with their place; the others are its numbers
with more digits, each of them computed here from public functions and compared to half a unit of the last digit.
"""

from decimal import Decimal

import numpy as np
import pytest
from machines import PAPER
from scipy.optimize import bisect, brentq, minimize_scalar

from carom import find_equilibria, find_orbits
from carom.closed_forms.periods import PeriodCondition
from carom.models import jeffcott
from carom.orbits import Orbit, OrbitSet, period_condition

FINE = {"xtol": 1e-15, "rtol": 1e-14}


def assert_prints(value: float, printed: str) -> None:
    """The value, rounded to the digits printed, is what was printed."""
    half_a_unit = 0.5 * 10.0 ** Decimal(printed).as_tuple().exponent
    assert abs(value - float(printed)) <= 1.001 * half_a_unit, (value, printed)


def orbits_at(gamma: float, omega: float = PAPER.omega) -> OrbitSet:
    longest = None if gamma > 0 else 3.0
    return find_orbits(jeffcott(PAPER.replace(gamma=gamma, omega=omega)), longest)


# --------------------------------------------------------------------------------------------- where things happen


def boundary_damping(omega: float = PAPER.omega) -> float:
    """``γ*``, at which the contact-free equilibrium lies on the wall."""

    def beyond(gamma: float) -> float:
        return find_equilibria(jeffcott(PAPER.replace(gamma=gamma, omega=omega)))[0].radius - 1.0

    return brentq(beyond, 1e-3, 0.45, **FINE)


def dip(gamma: float, omega: float = PAPER.omega) -> tuple[float, float]:
    """Minimum of ``F₁`` near ``T = 1.6``: its value and place."""
    condition = PeriodCondition.of(jeffcott(PAPER.replace(gamma=gamma, omega=omega)).system)
    place = brentq(lambda period: float(condition.slope(np.asarray(period))), 1.2, 2.2, **FINE)
    return float(condition.value(np.asarray(place))), place


def fold_damping(omega: float = PAPER.omega) -> float:
    """``γ_F1``, at which the two roots of the first pair meet."""
    return brentq(lambda gamma: dip(gamma, omega)[0], 0.15, 0.2, **FINE)


def test_fold_of_the_first_pair():
    """Figure 3: ``γ_F1 ≈ 0.178``.  The period there is the root of the slope: a minimum's place hardly shows in values."""
    gamma = fold_damping()
    assert_prints(gamma, "0.178")
    assert_prints(gamma, "0.1780277257")
    assert_prints(dip(gamma)[1], "1.6408219835")
    # Both pairs of orbits end there: B1,a meets B1,b and B1,c meets B1,d (Proposition 4.2).
    below = orbits_at(gamma - 1e-9)
    assert below["B1,a"].radial_speed == pytest.approx(below["B1,b"].radial_speed, rel=1e-3)
    assert below["B1,c"].radial_speed == pytest.approx(below["B1,d"].radial_speed, rel=1e-3)
    assert len(orbits_at(gamma + 1e-9)) == 0


def highest_bounce(orbit: Orbit) -> float:
    """Largest local maximum of the radius strictly inside the period."""

    def depth(time: float) -> float:
        return -float(np.abs(orbit.path(time)))

    times = np.linspace(0.0, orbit.period, 400)
    radii = np.abs(orbit.path(times))[:-1]
    tops = np.flatnonzero((radii[1:-1] > radii[:-2]) & (radii[1:-1] > radii[2:])) + 1
    brackets = [(times[top - 1], times[top], times[top + 1]) for top in tops]
    return max(-minimize_scalar(depth, bracket=bracket, tol=1e-9).fun for bracket in brackets)


def test_grazing():
    """Figure 5b: B1,d grazes at ``γ ≈ 0.0636``."""
    gamma = brentq(lambda gamma: highest_bounce(orbits_at(gamma)["B1,d"]) - 1.0, 0.062, 0.065, **FINE)
    assert_prints(gamma, "0.0636")
    assert_prints(gamma, "0.0636105609")
    assert orbits_at(gamma + 1e-9)["B1,d"].admissible
    assert not orbits_at(gamma - 1e-9)["B1,d"].admissible


def test_period_doubling():
    """Figure 6a: B1,d is stable above ``γ ≈ 0.0834``; what happens there is a multiplier −1, not a torus."""

    def at_minus_one(gamma: float) -> float:
        values = orbits_at(gamma)["B1,d"].multipliers.values
        return float(np.prod(-1.0 - values).real)

    gamma = brentq(at_minus_one, 0.08, 0.09, **FINE)
    assert_prints(gamma, "0.0834")
    assert_prints(gamma, "0.0833814175")
    below, above = (orbits_at(gamma + step)["B1,d"].multipliers for step in (-1e-6, 1e-6))
    assert above.stable
    assert not below.stable
    assert below.values[0].imag == 0.0
    assert below.values[0].real < -1.0


def test_codimension_two_point():
    """Section 4b: the fold and the non-smooth Hopf curve meet at ``γ ≈ 0.178``, ``ω ≈ 0.781``."""
    omega = brentq(lambda omega: fold_damping(omega) - boundary_damping(omega), 0.77, 0.79, xtol=1e-12)
    assert_prints(omega, "0.781")
    assert_prints(omega, "0.7811076")
    assert_prints(boundary_damping(omega), "0.1779723")


def test_fold_of_the_rubs():
    """``γ = ρ√(1 + μ²) − μ(1 − ω²)``: beyond it no synchronous rub exists."""
    gamma = bisect(
        lambda gamma: len(find_equilibria(jeffcott(PAPER.replace(gamma=gamma)))) - 2.0, 0.36, 0.38, xtol=1e-14
    )
    assert_prints(gamma, "0.3700060")


# -------------------------------------------------------------------------------------------------- at γ = 0.1


def test_orbits_in_the_middle_of_the_range():
    """At ``γ = 0.1`` (figures 2 to 4): the roots of ``F₁``, and B1,d."""
    orbits = orbits_at(0.1)
    assert len(orbits.periods) == 2
    assert_prints(orbits.periods[0], "0.7611785497")
    assert_prints(orbits.periods[1], "2.8635671446")
    orbit = orbits["B1,d"]
    assert_prints(orbit.radial_speed, "0.7332305341")
    assert_prints(orbit.angular_speed, "-1.3682985853")
    for value, printed in zip(orbit.multipliers.values, ("0.84003604", "0.77841555", "0.77841555"), strict=True):
        assert_prints(abs(value), printed)
    np.testing.assert_allclose(period_condition(orbits.rotor, orbits.periods), 0.0, atol=1e-14)


@pytest.mark.parametrize("gamma", [0.02, 0.05, 0.0725, 0.1, 0.14, 0.178])
def test_stability_of_the_four_branches(gamma):
    """Figure 6a: B1,a, B1,b and B1,c are unstable at any damping."""
    orbits = orbits_at(gamma)
    assert not any(orbits[f"B1,{letter}"].stable for letter in "abc")
    assert orbits["B1,d"].stable == (gamma > 0.0834)


# --------------------------------------------------------------------------------------------------- misprints
