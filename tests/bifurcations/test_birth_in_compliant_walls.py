"""Orbits born where levitation meets a compliant wall, against a piecewise linear system written down here.

Next to the boundary equilibrium, with the gap ``g`` as the unit of length, flight and contact with a spring and a damper are both linear:
``u'' + (γ + 2i)u' + (ω² − 1 + iγ)u = −(κδ + cδ')(1 + iμ)n`` with ``δ = Re n̄u − 1`` while that pushes.  Nothing else has a scale there.
"""

import numpy as np
import pytest
from linear_rotors import planar_rotor
from machines import PAPER
from scipy.linalg import expm
from scipy.optimize import root

import carom as cm
from carom.models import HuntCrossley, KelvinVoigt, Touchdown, jeffcott
from carom.orbits.closing import close
from carom.parameters.restitution import damping_ratio_of

STAR = cm.bifurcations.boundary_equilibria(jeffcott(PAPER))[0]


def rotor_in(law, gamma):
    return planar_rotor(
        gamma,
        PAPER.omega**2,
        PAPER.rho * np.exp(1j * PAPER.phi),
        [Touchdown([1.0], law, PAPER.mu, PAPER.radius_ratio + 1.0)],
    )


def voigt(stiffness):
    return KelvinVoigt(stiffness, 2.0 * damping_ratio_of(PAPER.d) * stiffness**0.5)


class Scaled:
    """The scaled motion next to the boundary equilibrium; states are real and imaginary parts of ``n̄u`` and of its rate, and one."""

    def __init__(self, law):
        self.law = law
        gamma, omega, friction = STAR.value, PAPER.omega, PAPER.mu
        position = -np.array([[omega**2 - 1.0, -gamma], [gamma, omega**2 - 1.0]])
        velocity = -np.array([[gamma, -2.0], [2.0, gamma]])
        self.flight = np.block([[np.zeros((2, 2)), np.eye(2)], [position, velocity]])
        self.flight = np.pad(self.flight, ((0, 1), (0, 1)))
        self.contact = self.flight.copy()
        self.force = np.array([law.stiffness, 0.0, law.damping, 0.0, -law.stiffness])
        self.contact[2] -= self.force
        self.contact[3] -= friction * self.force
        self.depth = np.array([1.0, 0.0, 0.0, 0.0, -1.0])

    def states(self, times):
        """The motion that repeats after these times, at its arrival, its parting from the wall, its leaving, and its end."""
        pressed, free, flown = (
            expm(matrix * time) for matrix, time in zip((self.contact, self.flight, self.flight), times, strict=True)
        )
        whole = flown @ free @ pressed
        start = np.append(np.linalg.solve(np.eye(4) - whole[:4, :4], whole[:4, 4]), 1.0)
        return start, pressed @ start, free @ pressed @ start

    def born(self, period):
        """Times of the orbit born there, near a period; conditions and unknowns are stated in the scale of a contact."""
        half = np.pi / self.law.stiffness**0.5

        def times_of(unknowns):
            return half * unknowns[0], half * unknowns[1], period - half * unknowns[2]

        def conditions(unknowns):
            arrival, parting, leaving = self.states(times_of(unknowns))
            return (
                np.array([self.depth @ arrival, self.force @ parting / self.law.stiffness, self.depth @ leaving]) / half
            )

        unknowns = np.array([1.0, 0.02, 1.0])
        for _ in range(20):
            steps = [conditions(unknowns + each) - conditions(unknowns - each) for each in 1e-5 * np.eye(3)]
            unknowns = unknowns - np.linalg.solve(np.array(steps).T / 2e-5, conditions(unknowns))
        assert np.abs(conditions(unknowns)).max() < 1e-9
        return times_of(unknowns)

    def orbit(self, times, gap):
        """The orbit of the rotor itself, closed from the middle of this one's flight, which it is to first order in the gap."""
        gamma = beside(gap)
        rest = PAPER.rho * np.exp(1j * PAPER.phi) / (PAPER.omega**2 - 1.0 + 1j * gamma)
        normal = rest / abs(rest)
        leaving = self.states(times)[2]
        aloft = expm(0.5 * times[2] * self.flight) @ leaving
        begin = cm.State(rest + gap * normal * complex(*aloft[:2]), gap * normal * complex(*aloft[2:4]))
        return close(cm.simulate(rotor_in(self.law, gamma), begin, 1.2 * sum(times)), 0.0, sum(times))


def beside(gap):
    """Damping at which levitation is that far from the wall."""
    low, high = 0.5 * STAR.value, 2.0 * STAR.value
    for _ in range(80):
        middle = 0.5 * (low + high)
        radius = PAPER.rho / abs(PAPER.omega**2 - 1.0 + 1j * middle)
        low, high = (middle, high) if 1.0 - radius < gap else (low, middle)
    return middle


@pytest.mark.jit_only
@pytest.mark.parametrize("stiffness", [1e3, 1e4])
@pytest.mark.parametrize("small", STAR.orbits, ids=lambda small: small.name)
def test_the_orbits_born_on_a_rigid_wall_are_born_on_a_spring_too(stiffness, small):
    law = voigt(stiffness)
    scaled = Scaled(law)
    times = scaled.born(small.period)
    arrival = scaled.states(times)[0]
    errors = []
    for gap in (1e-3, 1e-4):
        orbit = scaled.orbit(times, gap)
        assert orbit.segments == "slide+ free lift"
        assert not orbit.stable
        errors.append([orbit.period / sum(times) - 1.0, orbit.radial_speed / (gap * arrival[2]) - 1.0])
    first, second = np.abs(errors)
    assert second.max() < 1e-2
    # In proportion to the gap, but for its square: it shrinks into the boundary equilibrium.
    assert second == pytest.approx(0.1 * first, rel=0.15)


def test_the_stiffer_the_wall_the_nearer_is_the_birth_to_that_on_the_rigid_one():
    stiffnesses = np.array([1e4, 1e6, 1e8])
    for small in STAR.orbits:
        found = []
        for stiffness in stiffnesses:
            scaled = Scaled(voigt(stiffness))
            times = scaled.born(small.period)
            found.append([sum(times) - small.period, scaled.states(times)[0][2] - small.speed_rate])
        slopes = np.diff(np.log(np.abs(found)), axis=0) / np.diff(np.log(stiffnesses))[:, None]
        assert slopes[-1] == pytest.approx([-0.5, -0.5], abs=0.01)


@pytest.mark.jit_only
def test_the_shorter_orbit_ends_where_its_flight_has_no_time():
    """Followed by its time of flight down to the stiffness that the theory page states."""

    def conditions(unknowns, flight):
        scaled = Scaled(voigt(unknowns[2]))
        arrival, parting, leaving = scaled.states((*unknowns[:2], flight))
        return [scaled.depth @ arrival, scaled.force @ parting / unknowns[2], scaled.depth @ leaving]

    unknowns, stiffnesses, flights = np.array([0.79, 0.0054, 39.0]), [], np.arange(0.186, 0.03, -0.006)
    for flight in flights:
        unknowns = root(conditions, unknowns, (flight,), tol=1e-13).x
        assert np.abs(conditions(unknowns, flight)).max() < 1e-10
        stiffnesses.append(unknowns[2])
    assert (np.diff(stiffnesses) < 0.0).all()
    # Near its end the stiffness changes by the square of the time of flight.
    _, end = np.polyfit(flights[-3:] ** 2, stiffnesses[-3:], 1)
    assert end == pytest.approx(35.7, abs=0.05)  # three digits are stated of it


@pytest.mark.jit_only
@pytest.mark.parametrize(("small", "outside"), list(zip(STAR.orbits, (2, 1), strict=True)), ids=["shorter", "longer"])
def test_only_the_longer_orbit_parts_disturbances(small, outside):
    """One multiplier outside the unit circle: what tends to it has one dimension less than all motions; of the shorter one two are."""
    law = voigt(1e3)
    scaled = Scaled(law)
    orbit = scaled.orbit(scaled.born(small.period), 1e-3)
    rigid = cm.find_orbits(PAPER.replace(gamma=beside(1e-3)))[small.name]
    for each in (orbit, rigid):
        assert (np.abs(each.multipliers.values) > 1.0).sum() == outside


def test_without_stiffness_at_the_edge_levitation_goes_on_smoothly_until_it_folds():
    """At the depth ``(nκ|Re h|)^{−1/(n−1)}``, where ``|U*| = 1 + δ + Re(h)κδⁿ`` is largest to first order."""
    stiffness, exponent = 20.0, 1.5
    law = HuntCrossley(stiffness, 0.2, exponent)
    static = abs(((1.0 + 1j * PAPER.mu) / (PAPER.omega**2 - 1.0 + 1j * STAR.value)).real)
    depth = (exponent * stiffness * static) ** (-1.0 / (exponent - 1.0))
    outside = depth * (1.0 - 1.0 / exponent)

    def small_rubs(distance):
        found = cm.find_equilibria(rotor_in(law, beside(-distance)))
        return sorted(rub.radius - 1.0 for rub in found if rub.kind == "rub" and 0.0 < rub.radius - 1.0 < 10.0 * depth)

    below, above = small_rubs(0.999 * outside), small_rubs(1.001 * outside)
    assert len(below) == 2
    # They part by the root of 0.001, at which their mean stays the depth of the fold.
    assert below == pytest.approx([depth, depth], rel=0.03)
    assert np.mean(below) == pytest.approx(depth, rel=1e-3)
    assert not above
