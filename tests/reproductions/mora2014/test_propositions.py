"""What holds of Propositions 4.1 and 4.3 of the source paper."""

from itertools import pairwise

import numpy as np
import pytest
from machines import PAPER

from carom import find_orbits
from carom.base.outcome import InputError
from carom.models import jeffcott
from carom.reproductions.mora2014.propositions import cycles_at_wall, fixed_points, hopf_side

BOUNDARY = PAPER.replace(gamma=float(np.sqrt(PAPER.rho**2 - (1.0 - PAPER.omega**2) ** 2)))


@pytest.mark.parametrize("gamma", [0.03, 0.06, 0.1, 0.17, 0.2])
def test_four_fixed_points_a_pair(gamma):
    found = fixed_points(PAPER.replace(gamma=gamma))
    assert found.total == 4 * found.pairs
    assert found.outward == (4 if gamma > 0.0724686787 else 2) * found.pairs
    assert found.admissible <= found.outward
    assert (found.pairs == 0) == (gamma > 0.1780277257)


def test_outward_orbits_need_not_stay_inside():
    """Below the grazing of B1,d the text's claim that all outward orbits are admissible fails."""
    found = fixed_points(PAPER.replace(gamma=0.06))
    assert found.admissible < found.outward


def test_cycles_are_born_on_the_levitating_side():
    side = hopf_side(PAPER)
    assert side.gamma == pytest.approx(0.0724686787, abs=5e-11)
    assert {cycle.criticality for cycle in side.cycles} == {"subcritical"}
    for cycle in side.cycles:
        orbits = find_orbits(jeffcott(PAPER.replace(gamma=side.gamma + 1e-4)))
        near = min(orbits, key=lambda orbit: abs(orbit.period - cycle.period) + 10 * abs(orbit.radial_speed))
        assert near.admissible
        assert near.radial_speed == pytest.approx(1e-4 * cycle.radial_slope, rel=1e-2)
    with pytest.raises(InputError, match="above"):
        hopf_side(PAPER.replace(rho=0.4))


def test_the_side_is_a_result_not_a_constant():
    """Elsewhere the cycles live where the equilibrium is outside the wall, and exact orbits are found there."""
    random = np.random.default_rng(2)
    sides = set()
    for _ in range(60):
        omega = random.uniform(0.3, 1.8)
        rho = abs(1.0 - omega**2) + random.uniform(0.001, 0.3)
        machine = PAPER.replace(omega=omega, rho=rho)
        side = hopf_side(machine)
        for cycle in side.cycles:
            sides.add(cycle.criticality)
            shift = 1e-7 if cycle.criticality == "subcritical" else -1e-7
            orbits = find_orbits(jeffcott(machine.replace(gamma=side.gamma + shift)), 1.1 * cycle.period)
            small = [o for o in orbits if abs(o.period - cycle.period) < 1e-3 and abs(o.radial_speed) < 1e-2]
            assert any(orbit.radial_speed > 0.0 for orbit in small)
    assert sides == {"subcritical", "supercritical"}


@pytest.mark.parametrize("parameter", ["gamma", "rho", "omega"])
def test_slopes_are_those_of_the_exact_branches(parameter):
    """Derivatives of the exact branches by a parameter: central differences extrapolated twice, error of order h⁶."""
    stiffness = complex(BOUNDARY.omega**2 - 1.0, BOUNDARY.gamma)
    rates = {"gamma": -1j / stiffness, "rho": 1.0 / BOUNDARY.rho, "omega": -2.0 * BOUNDARY.omega / stiffness}
    cycles, here = cycles_at_wall(BOUNDARY, complex(rates[parameter])), getattr(BOUNDARY, parameter)
    assert len(cycles) == 2

    def state(name, value):
        orbit = find_orbits(jeffcott(BOUNDARY.replace(**{parameter: value})))[name]
        return np.array([orbit.radial_speed, orbit.angular_speed, orbit.angle])

    for name, cycle in zip(("B1,a", "B1,b"), cycles, strict=True):
        table = [(state(name, here + h) - state(name, here - h)) / (2 * h) for h in (4e-4, 2e-4, 1e-4)]
        first = [(4 * fine - coarse) / 3 for coarse, fine in pairwise(table)]
        got = cycle.radial_slope, cycle.angular_slope, cycle.angle_slope
        assert got == pytest.approx((16 * first[1] - first[0]) / 15, abs=1e-8)
