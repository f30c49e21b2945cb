"""Neimark–Sacker bifurcations: where a pair of complex multipliers leaves the unit circle and a torus is born."""

import numpy as np
import pytest
from machines import PAPER

from carom import State, continue_curve, continue_orbit, find_orbits, simulate
from carom.bifurcations import Bifurcation, Plane
from carom.models import jeffcott
from carom.orbits import Orbit

SOFT = PAPER.replace(omega=0.35, rho=0.2)
"""The source paper's rotor on a softer bearing and better balanced: B1,d loses stability through a pair at 80 degrees."""
PLANE = Plane("gamma", "omega", (0.02, 0.15), (0.15, 0.6))


def orbit_at(gamma: float) -> Orbit:
    return find_orbits(jeffcott(SOFT.replace(gamma=gamma)))["B1,d"]


@pytest.fixture(scope="module")
def torus() -> Bifurcation:
    branch = continue_orbit(orbit_at(0.1), "gamma", (0.05, 0.13))
    (point,) = [point for point in branch.special if point.kind == "neimark-sacker"]
    return point


def growth_an_impact(gamma: float) -> tuple[float, float]:
    """Modulus and angle by which a simulated disturbance of the orbit grows and turns from impact to impact.

    A linear recurrence over three terms is fitted to the radial speeds: its roots are the multipliers.
    """
    orbit = orbit_at(gamma)
    start = State(orbit.departure.position, orbit.departure.velocity * (1.0 + 1e-7))
    speeds = simulate(orbit.rotor, start, 90.0 * orbit.period).contacts.radial_speed
    # By then the third multiplier has died out.
    errors = speeds[25:80] - orbit.radial_speed
    rows = np.stack([errors[1:-1], errors[:-2]], axis=1)
    trace, product = np.linalg.lstsq(rows, errors[2:], rcond=None)[0]
    root = np.roots([1.0, -trace, -product])[0]
    return abs(root), abs(np.angle(root))


@pytest.mark.jit_only
def test_disturbances_spiral_out_before_and_in_after(torus):
    """By simulation alone: the disturbance turns by the angle of the pair, and grows on one side only."""
    for shift, grows in ((-0.002, True), (0.002, False)):
        modulus, turn = growth_an_impact(torus.value + shift)
        assert bool(modulus > 1.0) is grows
        multipliers = orbit_at(torus.value + shift).multipliers
        assert modulus == pytest.approx(multipliers.spectral_radius, abs=1e-6)
        assert turn == pytest.approx(abs(np.angle(multipliers.values[0])), abs=1e-5)
    # The modulus found by simulation passes 1 where the point was located.
    low, high = (growth_an_impact(torus.value + shift)[0] - 1.0 for shift in (-1e-4, 1e-4))
    assert torus.value - 1e-4 + 2e-4 * low / (low - high) == pytest.approx(torus.value, abs=2e-6)


def test_curve_ends_in_a_resonance_or_at_the_edge(torus):
    curve = continue_curve(torus, PLANE)
    assert set(curve.stops) <= {"edge of the plane", "resonance-1:2"}
    for kind, angle in (("1:3", 120.0), ("1:4", 90.0), ("1:2", 180.0)):
        for point in curve.codimension2:
            if point.kind.endswith(kind):
                x, y = point.value
                orbits = find_orbits(jeffcott(SOFT.replace(gamma=x, omega=y)))
                near = min(orbits, key=lambda orbit: np.abs(np.abs(orbit.multipliers.values[:2]) - 1.0).max())
                leader = np.exp(1j * np.radians(angle))
                # Two multipliers that meet at −1 are a square root apart from what rounding makes of the place.
                assert np.abs(near.multipliers.values - leader).min() < (1e-3 if kind == "1:2" else 1e-7)
    assert any("1:4" in point.kind for point in curve.codimension2)
