"""Limits of magnetic bearings in the motion of the planar rotor, against a general integrator that clips what the axes get."""

import dataclasses

import numpy as np
import pytest
from limited_reference import clipped, follow, struck

import carom as cm
from carom.base.outcome import Phase
from carom.loading import load
from carom.models import jeffcott, rotor_of
from carom.motions import State, energy_ledger
from carom.parameters import ControlLimit, TouchdownBearing

KEOGH = "examples/keogh-cole.toml"
YIELDING = TouchdownBearing(law="kelvin-voigt", stiffness="200 N/um", damping="5 kN s/m")


def keogh_cole(*settings, wall=None):
    rotor = rotor_of(load(KEOGH, list(settings)))
    return jeffcott(rotor.parameters, wall) if wall else rotor


def limited(rotor, bound, pull=0.0):
    """With a bound in ``m c_r Ω²`` and a negative stiffness in ``m Ω²``."""
    return dataclasses.replace(rotor, limits=ControlLimit(bound * rotor.scales.force, pull * rotor.scales.stiffness))


def in_fixed_frame(state, time):
    turn = np.exp(1j * time)
    return np.array([state.position * turn, (state.velocity + 1j * state.position) * turn])


def unlimited_force(parameters, bound, pull):
    """Acceleration by the magnets and the unbalance, in the fixed frame."""

    def force(time, place, speed):
        asked = (parameters.omega**2 + pull) * place + parameters.gamma * speed
        turning = parameters.rho * np.exp(1j * (time + parameters.phi))
        return turning - clipped(asked, bound) + pull * place

    return force


@pytest.mark.parametrize(("bound", "pull"), [(0.55, 0.0), (0.3, 0.2), (0.7, 0.5)])
@pytest.mark.parametrize("start", [State(0.2 + 0.1j, 1.1 - 0.3j), State(-0.5j, 0.4 + 1.2j)])
def test_motions_with_rigid_impacts_are_those_of_a_general_integrator(bound, pull, start):
    rotor = keogh_cole()
    at = rotor.parameters
    force = unlimited_force(at, bound, pull)

    motion = cm.simulate(limited(rotor, bound, pull), start, 8.0)
    final, impacts = follow(
        lambda time, state: np.array([state[1], force(time, *state)]),
        in_fixed_frame(start, 0.0),
        8.0,
        ends=lambda time, state: abs(state[0]) ** 2 - 1.0,
        after=lambda time, state: np.array([state[0] / abs(state[0]), struck(*state, at.d, at.mu, at.radius_ratio)]),
    )

    assert {1, 2, 3} & set(motion.segment_limits.ravel().tolist())
    # The integrator finds an impact to 1e-13, and each of four or five impacts magnifies an error up to ten times.
    assert motion.contacts.time == pytest.approx(impacts, abs=1e-9)
    assert in_fixed_frame(motion.final, 8.0) == pytest.approx(final, abs=1e-9)


@pytest.mark.parametrize("bound", [0.5, 0.3])
def test_motions_in_a_wall_that_gives_way_are_those_of_a_general_integrator(bound):
    rotor = keogh_cole(wall=YIELDING)
    at, pull = rotor.parameters, 0.3
    wall = rotor.system.contacts[0].wall
    force = unlimited_force(at, bound, pull)

    def rates(time, state):
        place, speed = state
        radius = abs(place)
        local = speed * place.conjugate() / radius
        push = max(wall.stiffness * (radius - 1.0) + wall.loss * local.real, 0.0) if radius > 1.0 else 0.0
        # The surface of the rotor is so fast that it always slips forward.
        return np.array([speed, force(time, place, speed) - (1.0 + 1j * at.mu) * push * place / radius])

    start = State(0.3, 0.9 + 0.8j)
    motion = cm.simulate(limited(rotor, bound, pull), start, 8.0)
    final, _ = follow(rates, in_fixed_frame(start, 0.0), 8.0, longest=0.002)

    assert len(motion.contacts) >= 3
    assert {2, 3} & set(motion.segment_limits.ravel().tolist())
    # Each of the contacts begins with a kink, which the integrator does not stop at.
    assert in_fixed_frame(motion.final, 8.0) == pytest.approx(final, abs=1e-9)


def test_lasting_contact_at_a_limit_is_that_of_a_general_integrator():
    """Sliding on a rigid wall: one angle, whose acceleration follows from the forces along the wall."""
    rotor = keogh_cole("restitution=0", "damping=1 kN s/m")
    at, bound, pull = rotor.parameters, 0.4, 0.3
    force = unlimited_force(at, bound, pull)
    motion = cm.simulate(limited(rotor, bound, pull), State(np.exp(0.5j), 0.1j * np.exp(0.5j)), 6.0)
    assert set(motion.segment_phases.ravel().tolist()) == {Phase.FORWARD_SLIP, Phase.FLIGHT}
    (stay,) = motion.lasting_contacts

    def rates(time, state):
        angle, speed = state.real
        place = np.exp(1j * angle)
        local = force(time, place, 1j * speed * place) * place.conjugate()
        push = local.real + speed**2
        return np.array([speed, local.imag - at.mu * push])

    final, _ = follow(rates, np.array([0.5, 1.1]), stay.end)
    place, turning = motion.at(stay.end * (1.0 - 1e-15))

    assert {2, 3} & set(motion.segment_limits.ravel().tolist())
    assert np.exp(1j * (final[0].real - stay.end)) == pytest.approx(complex(place), abs=1e-11)
    assert final[1].real - 1.0 == pytest.approx((place.conjugate() * turning).imag, abs=1e-11)


@pytest.mark.parametrize("wall", [None, YIELDING])
def test_a_limit_that_is_never_met_changes_nothing(wall):
    rotor, start = keogh_cole(wall=wall), State(0.1, 0.9 + 0.5j)

    held, linear = (cm.simulate(each, start, 60.0) for each in (limited(rotor, 50.0, 0.4), rotor))

    assert len(linear.segment_starts) > 20
    assert not held.segment_limits.any()
    assert held.segment_starts.tolist() == linear.segment_starts.tolist()
    assert held.segment_amplitudes.tolist() == linear.segment_amplitudes.tolist()


@pytest.mark.parametrize(
    ("settings", "wall"), [([], None), ([], YIELDING), (["restitution=0.3"], None), (["gravity=9.81"], None)]
)
def test_the_energy_ledger_closes(settings, wall):
    rotor = keogh_cole(*settings, wall=wall)
    heavy = bool(rotor.forces)
    held = limited(rotor.unforced, 0.4, 0.2)
    held = held.under(*rotor.forces) if heavy else held

    motion = cm.simulate(held, State(0.3, 0.8 + 0.6j), 30.0)
    ledger = energy_ledger(motion)

    assert {2, 3} & set(motion.segment_limits.ravel().tolist())
    assert np.abs(ledger.limits).max() > 0.01
    # Rounding of a few hundred terms.
    assert ledger.imbalance < 1e-13


def test_bearings_that_can_give_nothing_let_the_rotor_fly():
    rotor = keogh_cole("damping=0 N s/m")
    flying = cm.models.from_matrices(
        mass=[[1.0]],
        damping=[[0.0]],
        stiffness=[[0.0]],
        forcing=rotor.matrices.forcing,
        touchdowns=[cm.models.Touchdown((1.0,), cm.models.Rigid(rotor.parameters.d), rotor.parameters.mu, 58.0)],
    )
    start, bound = State(0.1, 0.2), 1e-9

    held, free = (cm.simulate(each, start, 2.0).final for each in (limited(rotor, bound), flying))

    # A force of up to √2 times the bound for a time of 2.
    assert abs(held.position - free.position) < 4 * bound
    assert abs(held.velocity - free.velocity) < 10 * bound
