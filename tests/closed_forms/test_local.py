"""Local theory of the non-smooth Hopf bifurcation against exact orbits and matrix exponentials."""

from __future__ import annotations

import cmath
import itertools
from types import SimpleNamespace

import numpy as np
import pytest
from machines import PAPER
from scipy.linalg import expm

from carom import find_orbits
from carom.closed_forms.local import ContactSystem, cycle_determinant, non_smooth_hopf
from carom.closed_forms.periods import PeriodCondition
from carom.core.layout import rotor_record
from carom.models import System, jeffcott

BOUNDARY = PAPER.replace(gamma=float(np.sqrt(PAPER.rho**2 - (1.0 - PAPER.omega**2) ** 2)))


def slopes(name: str, parameter: str, at: float) -> np.ndarray:
    """Derivatives of (ṙ, θ̇, θ) by a parameter: central differences extrapolated twice, error of order h⁶."""

    def state(value):
        orbit = find_orbits(jeffcott(BOUNDARY.replace(**{parameter: value})))[name]
        return np.array([orbit.radial_speed, orbit.angular_speed, orbit.angle])

    table = [(state(at + h) - state(at - h)) / (2 * h) for h in (4e-4, 2e-4, 1e-4)]
    first = [(4 * fine - coarse) / 3 for coarse, fine in itertools.pairwise(table)]
    return (16 * first[1] - first[0]) / 15


@pytest.mark.parametrize("parameter", ["gamma", "rho", "omega"])
def test_slopes_of_the_exact_branches(parameter):
    system = ContactSystem.of_rotor(BOUNDARY)
    rest, stiffness = system.equilibrium, system.stiffness
    rates = {
        "gamma": -1j * rest / stiffness,
        "rho": rest / BOUNDARY.rho,
        "omega": -2.0 * BOUNDARY.omega * rest / stiffness,
    }
    hopf = non_smooth_hopf(system, rates[parameter])
    assert len(hopf.cycles) == 2
    for cycle in hopf.cycles:
        # Orbits of vanishing speed are a, b where the lever is negative.
        orbits = find_orbits(jeffcott(BOUNDARY.replace(gamma=BOUNDARY.gamma + 1e-9)))
        orbit = min(orbits, key=lambda orbit: abs(orbit.period - cycle.period) + abs(orbit.radial_speed))
        got = (cycle.radial_slope, cycle.angular_slope, cycle.angle_slope)
        assert got == pytest.approx(slopes(orbit.name, parameter, getattr(BOUNDARY, parameter)), abs=1e-8)


def test_criticality_is_the_side_on_which_the_exact_orbits_live():
    """Proposition 4.3: the cycles of the source paper's machine live where the rotor levitates."""
    system = ContactSystem.of_rotor(BOUNDARY)
    hopf = non_smooth_hopf(system, -1j * system.equilibrium / system.stiffness)
    assert hopf.leaving < 0.0
    for cycle in hopf.cycles:
        found = {}
        for shift in (-1e-5, 1e-5):
            orbits = find_orbits(jeffcott(BOUNDARY.replace(gamma=BOUNDARY.gamma + shift)))
            found[shift] = [
                orbit for orbit in orbits if 0 < orbit.radial_speed < 1e-3 and abs(orbit.period - cycle.period) < 1e-2
            ]
        assert cycle.criticality == "subcritical"
        assert (len(found[-1e-5]), len(found[1e-5])) == (0, 1)


def four_modes() -> SimpleNamespace:
    """A rotor of four modes, two of them a pair, whose impulse does not move the contact at once."""
    random = np.random.default_rng(8)
    exponents = np.array([-0.3 - 1.9j, -0.2 - 0.4j, -0.1 + 0.7j, -0.05 - 2.2j])
    row, column = random.normal(size=(2, 4)) + 1j * random.normal(size=(2, 4))
    column[3] -= (row @ column) / row[3]
    arrays = rotor_record(
        exponents=exponents,
        driven=np.array([False, True, False, False]),
        offsets=np.array([1.0 + 0j]),
        rows=np.array([row]),
        columns=column[:, None].copy(),
        friction=np.array([0.2]),
        restitution=np.array([0.8]),
        surface_speed=np.array([50.0]),
    )
    return System(arrays, arrays.offsets, arrays.rows, np.zeros((4, 2)))


def test_determinant_of_a_rotor_with_four_modes():
    """Against the matrix exponential of the modes and the reset written as real matrices."""
    system = four_modes()
    row, column = system.arrays.rows[0], system.arrays.columns[:, 0]
    generator = np.diag(system.arrays.exponents)
    generator[1, 0] = 1.0

    def real(matrix):
        return np.block([[matrix.real, -matrix.imag], [matrix.imag, matrix.real]])

    direction = cmath.exp(0.9j)
    reader = np.conj(direction) * (row @ generator)
    speed = np.concatenate([reader.real, -reader.imag])
    kick = column * 1.8 * (1 + 0.2j) * direction
    reset = np.eye(8) - np.outer(np.concatenate([kick.real, kick.imag]), speed)
    condition = PeriodCondition.of(system)
    for period in (0.3, 1.1, 4.0):
        flown = real(expm(generator * period))
        expected = np.linalg.det(reset @ flown - np.eye(8))
        assert cycle_determinant(system, period, direction) == pytest.approx(expected, rel=1e-10)
        free = np.linalg.det(flown - np.eye(8))
        assert expected == pytest.approx(free * float(condition.value(np.asarray(period))), rel=1e-9)


def test_cycles_of_a_rotor_with_four_modes():
    """At the roots the determinant changes sign, and the linearised motion returns to its start after the impact.

    The velocity along the wall's normal changes sign in the flight, so the impact is one: it comes in outward.
    """
    system = four_modes()
    row, column = system.arrays.rows[0], system.arrays.columns[:, 0]
    generator = np.diag(system.arrays.exponents)
    generator[1, 0] = 1.0
    periods = PeriodCondition.of(system).roots(20.0).periods
    assert len(periods) >= 2
    for period in periods:
        low, high = (cycle_determinant(system, period * (1.0 + shift)) for shift in (-1e-8, 1e-8))
        assert low * high < 0.0
        # The state before the impact c solves c = e^{MT}(c − b): an impact of unit speed.
        flown = expm(generator * period)
        kick = column * 1.8 * (1.0 + 0.2j)
        before = np.linalg.solve(np.eye(4) - flown, -flown @ kick)
        assert (row @ generator @ before).real == pytest.approx(1.0, abs=1e-9)
