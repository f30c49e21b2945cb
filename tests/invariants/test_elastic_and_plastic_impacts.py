"""Restitution of one and of none, each a limit in which theory says what must happen.

Everywhere ``U`` is the position in the co-rotating frame, ``Z = Ue^{it}`` that in the fixed one, ``W = 1 + θ̇`` the whirl
speed in the fixed frame and ``x = θ − φ``.
"""

import cmath
import math

import numpy as np
import pytest
from limiting_motions import (
    EPSILON,
    EVENTS,
    LONG,
    MANY,
    START,
    angular_momentum,
    jacobi_integral,
    on_wall,
    segment_states,
    starts,
)
from machines import PAPER

from carom.models import jeffcott
from carom.motions import State, simulate

# ------------------------------------------------------------------------------------------------ d → 1: elastic

IDEAL = PAPER.replace(gamma=0.0, mu=0.0, d=1.0)


@pytest.mark.parametrize("omega", [0.3, 0.76, 1.7])
def test_an_ideal_rotor_keeps_its_jacobi_integral(omega):
    """With ``d = 1`` and ``μ = 0`` an impact turns ``ṙ`` round and leaves ``θ̇``, so ``|U̇|`` stays and ``J`` with it."""
    parameters = IDEAL.replace(omega=omega)
    motion = simulate(jeffcott(parameters), State(0.3 + 0.1j, 1.8 - 0.8j), LONG)
    impacts = len(motion.contacts)
    assert impacts > 0.1 * LONG
    integral = jacobi_integral(parameters, *segment_states(motion))
    # The rounding errors of an impact are some spacings of the energies.
    assert np.abs(integral - integral[0]).max() < 8 * EPSILON * impacts * (1.0 + abs(integral[0]))


def test_an_ideal_balanced_rotor_keeps_energy_and_angular_momentum():
    """Without unbalance the bearing's force points to its centre in the fixed frame, in flight and in impacts."""
    parameters = IDEAL.replace(rho=0.0)
    motion = simulate(jeffcott(parameters), State(0.3 + 0.1j, 1.4j), LONG)
    impacts = len(motion.contacts)
    position, velocity = segment_states(motion)
    energy = 0.5 * np.abs(velocity + 1j * position) ** 2 + 0.5 * parameters.omega**2 * np.abs(position) ** 2
    momentum = angular_momentum(position, velocity)
    assert impacts > 0.1 * LONG
    assert np.abs(energy / energy[0] - 1.0).max() < 8 * EPSILON * impacts
    assert np.abs(momentum / momentum[0] - 1.0).max() < 8 * EPSILON * impacts
    # So all impacts are alike: ṙ² = 2E − ω² − L².
    radial = math.sqrt(2.0 * energy[0] - parameters.omega**2 - momentum[0] ** 2)
    assert np.allclose(motion.contacts.radial_speed, radial, rtol=1e-9, atol=0)


@pytest.mark.parametrize("loss", [1e-2, 1e-4, 1e-6])
def test_nearly_elastic_impacts_cost_what_they_must(loss):
    """Without damping and friction ``J`` falls by ``(1 − d²)ṙ²/2`` in each impact, and nowhere else."""
    parameters = IDEAL.replace(d=1.0 - loss)
    motion = simulate(jeffcott(parameters), START, 0.1 * LONG)
    integral = jacobi_integral(parameters, *segment_states(motion))
    lost = np.zeros(len(integral))
    lost[1:][motion.is_impact] = 0.5 * (1.0 - parameters.d**2) * motion.contacts.radial_speed**2
    # Sliding costs nothing without friction, and a landing the energy of bounces lower than 1e-13.
    assert len(motion.contacts) > 0.01 * LONG
    assert np.abs(integral + np.cumsum(lost) - integral[0]).max() < 8 * EPSILON * len(integral) + 1e-13


def test_elastic_contact_takes_no_energy_along_the_normal():
    """With ``d = 1`` all work of contact is that of friction, its impulse times the mean slip; without friction none."""
    for mu in (0.0, 0.15):
        for start in starts(1, 5):
            log = simulate(jeffcott(PAPER.replace(d=1.0, mu=mu)), start, 100.0, max_events=EVENTS).contacts
            assert len(log) > 3
            friction = 0.5 * log.friction_impulse * (log.slip_before + log.slip_after)
            speed = 1.0 + log.radial_speed + np.abs(log.angular_speed)
            assert np.all(np.abs(log.contact_work - friction) <= 8 * EPSILON * speed**2)
            limited = np.minimum(mu * log.normal_impulse, np.abs(log.slip_before))
            assert np.all(np.abs(np.abs(log.friction_impulse) - limited) <= 8 * EPSILON * speed)


@pytest.mark.parametrize("gamma", [0.0, 0.1, 0.3])
def test_elastic_impacts_do_not_accumulate(gamma):
    """Bounces under a push ``N`` last ``2ṙ/N``, the next ``d`` times as long: with ``d = 1`` they do not come to an end.

    Not even in backward whirl, where ``N`` grows to ``s²`` and there are thousands of them in a turn.
    """
    for start in starts(2, 10):
        motion = simulate(jeffcott(PAPER.replace(gamma=gamma, d=1.0)), start, 500.0, max_events=EVENTS)
        assert motion.lasting_contacts == ()
        assert not motion.is_landing.any()


# ------------------------------------------------------------------------------------------------ d = 0: plastic


def test_a_plastic_impact_ends_on_the_wall_or_leaves_it_along_the_wall():
    """``ṙ⁺ = 0``.  Then ``N = ρ cos x + W² − ω²`` decides at once: pressed the rotor slides, else it flies off."""
    random = np.random.default_rng(3)
    pressed_count = 0
    for _ in range(10 * MANY):
        parameters = PAPER.replace(
            d=0.0, mu=random.uniform(0.0, 0.5), rho=random.uniform(0.0, 1.0), omega=random.uniform(0.5, 1.5)
        )
        start = on_wall(random.uniform(-3.0, 3.0), random.uniform(-2.0, 2.0), random.uniform(0.1, 1.0))
        motion = simulate(jeffcott(parameters), start, 1e-3)
        log = motion.contacts
        whirl = 1.0 + log.angular_speed_after[0]
        push = parameters.rho * math.cos(log.angle[0] - parameters.phi) + whirl**2 - parameters.omega**2
        assert abs(log.radial_speed_after[0]) <= 8 * EPSILON * (1.0 + log.radial_speed[0])
        if abs(push) < 0.01:
            continue  # within 1e-3 the push may change its sign
        pressed_count += push > 0.0
        assert bool(motion.lasting_contacts) == (push > 0.0)
        if push > 0.0:
            (contact,) = motion.lasting_contacts
            assert (contact.start, contact.end) == (0.0, motion.time)
            assert motion.forces(np.array(0.0))[0] == pytest.approx(push, rel=1e-12)
        else:
            assert abs(motion.final.position) == pytest.approx(1.0 + 0.5 * push * 1e-6, abs=1e-8)
    assert 2 * MANY < pressed_count < 8 * MANY


def test_a_plastic_contact_takes_all_energy_along_the_normal():
    log = simulate(jeffcott(PAPER.replace(d=0.0, mu=0.0)), START, 50.0).contacts
    assert len(log) > 0
    assert np.allclose(log.contact_work, -0.5 * log.radial_speed**2, rtol=1e-12, atol=0)


def test_less_and_less_restitution_leads_to_none():
    """What the bounces after a first impact change goes with the third power of ``d``.

    Pressed by ``N`` they bounce off at ``v = dṙ`` at first, to a height ``h = v²/(2N)``, and have the same impulse in all as
    the impact without restitution and the push that follows it.  Only the angle differs, by
    ``8(1 + μ²)W h v/(3N(1 − d³))`` to leading order in ``v``: friction comes at other times, and the normal has turned.
    """
    radial, mu = 0.3, 0.1
    parameters = PAPER.replace(gamma=0.0, mu=mu, rho=0.4, omega=0.5)
    whirl = 1.0 - mu * radial  # after the impact without restitution
    push = parameters.rho + whirl**2 - parameters.omega**2

    def angle(restitution: float) -> float:
        rotor = jeffcott(parameters.replace(d=restitution))
        return cmath.phase(simulate(rotor, on_wall(parameters.phi, 1.0, radial), 0.02).final.position)

    for restitution in (0.03, 0.01):
        speed = restitution * radial
        expected = 4.0 * (1.0 + mu**2) * whirl * speed**3 / (3.0 * push**2 * (1.0 - restitution**3))
        assert angle(restitution) - angle(0.0) == pytest.approx(expected, rel=0.01)
