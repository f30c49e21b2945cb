"""No friction and any amount of it, each a limit in which theory says what must happen.

Everywhere ``U`` is the position in the co-rotating frame, ``Z = Ue^{it}`` that in the fixed one, ``W = 1 + θ̇`` the whirl
speed in the fixed frame and ``x = θ − φ``.
"""

import cmath
import math

import numpy as np
import pytest
from compilation import sized
from limiting_motions import EPSILON, on_wall, starts
from machines import PAPER
from scipy.special import ellipj, ellipk

from carom.base.outcome import Outcome, Phase
from carom.models import jeffcott
from carom.motions import energy_ledger, simulate

# ------------------------------------------------------------------------------------------------ μ = 0: smooth wall


def test_a_smooth_wall_leaves_the_angular_momentum():
    """Its force points to the centre, so ``Im(Z̄Ż)`` stays in an impact; and no drive feeds in."""
    for start in starts(4, 10):
        motion = simulate(jeffcott(PAPER.replace(mu=0.0)), start, sized(100, 20))
        log = motion.contacts
        assert len(log) > 3
        assert np.all(log.angular_speed_after - log.angular_speed == log.friction_impulse)
        assert np.all(
            np.abs(log.friction_impulse) <= 8 * EPSILON * (1.0 + log.radial_speed + np.abs(log.angular_speed))
        )
        assert not log.sticks.any() or np.all(log.slip_before[log.sticks] == 0.0)


@pytest.mark.jit_only
def test_a_smooth_wall_never_stops_the_slip():
    """``W' = −ρ sin x`` whatever the slip ``s + W``: here it swings through zero in every turn, and nothing rolls."""
    parameters = PAPER.replace(gamma=0.0, mu=0.0, omega=0.3, rho=0.6, radius_ratio=1.5)
    motion = simulate(jeffcott(parameters), on_wall(parameters.phi + math.pi, -1.3), 20.0)
    assert len(motion.lasting_contacts) > 10
    assert {contact.phase for contact in motion.lasting_contacts} == {Phase.FORWARD_SLIP, Phase.BACKWARD_SLIP}
    assert not motion.forces(np.linspace(0.0, 20.0, 300))[1].any()
    position, velocity = motion.at(np.array([contact.start for contact in motion.lasting_contacts[1:]]))
    assert np.abs(1.0 + parameters.radius_ratio + (position.conj() * velocity).imag).max() < 1e-13
    assert energy_ledger(motion).drive[-1] == 0.0


def pendulum(rho: float, amplitude: float, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Angle and speed of ``ẍ = −ρ sin x`` from rest at an amplitude: ``sin(x/2) = k cd(√ρ t)``, ``k = sin(amplitude/2)``."""
    k = math.sin(0.5 * amplitude)
    sn, cn, dn, _ = ellipj(math.sqrt(rho) * times, k * k)
    sine = k * cn / dn
    # d(cd u)/du = −(1 − k²) sn/dn².
    rate = -k * (1.0 - k * k) * math.sqrt(rho) * sn / dn**2
    return 2.0 * np.arcsin(sine), 2.0 * rate / np.sqrt(1.0 - sine**2)


@pytest.mark.parametrize("amplitude", [1e-3, 0.5, 1.5])
def test_sliding_on_a_smooth_wall_is_a_pendulum(amplitude):
    """A bead in a turning hoop: without damping and friction ``ẍ = −ρ sin x``, its period ``4K(k)/√ρ``."""
    parameters = PAPER.replace(gamma=0.0, mu=0.0, omega=0.3, rho=0.2)
    period = 4.0 * ellipk(math.sin(0.5 * amplitude) ** 2) / math.sqrt(parameters.rho)
    motion = simulate(jeffcott(parameters), on_wall(parameters.phi + amplitude, 1.0), 3.0 * period)
    assert [contact.phase for contact in motion.lasting_contacts] == [Phase.FORWARD_SLIP]
    times = np.linspace(0.0, motion.time, sized(500, 20))
    position, velocity = motion.at(times)
    angle, speed = pendulum(parameters.rho, amplitude, times)
    assert np.abs(np.angle(position * cmath.exp(-1j * parameters.phi)) - angle).max() < 1e-12
    assert np.abs((position.conj() * velocity).imag - speed).max() < 1e-12
    normal, friction = motion.forces(times)
    expected = parameters.rho * np.cos(angle) + (1.0 + speed) ** 2 - parameters.omega**2
    assert np.abs(normal - expected).max() < 1e-12
    assert not friction.any()
    # It swings for ever, and settles nowhere.
    assert simulate(motion.rotor, motion.start, motion.time, settle=True).outcome is Outcome.TIME_REACHED


@pytest.mark.jit_only
@pytest.mark.parametrize("gamma", [0.1, 1e-2, 1e-3])
def test_a_slide_along_a_smooth_wall_lasts_as_long_as_damping_is_weak(gamma):
    """Without unbalance ``W' = −γW``, and ``N = W² − ω²`` vanishes after ``ln(W₀/ω)/γ``."""
    parameters = PAPER.replace(gamma=gamma, mu=0.0, rho=0.0)
    rotor, start = jeffcott(parameters), on_wall(0.3, 2.5)
    motion = simulate(rotor, start, 1e3 / gamma, settle=True)
    (contact,) = motion.lasting_contacts
    # The whirl is a product of as many factors as there are steps, each with its rounding error.
    steps = len(motion.segment_starts)
    assert contact.end == pytest.approx(math.log(2.5 / parameters.omega) / gamma, rel=4 * EPSILON * steps + 1e-12)
    assert motion.outcome is Outcome.LEVITATED
    assert simulate(rotor, start, 1e3 / gamma, settle=True, max_events=steps // 2).outcome is Outcome.EVENT_LIMIT


# ------------------------------------------------------------------------------------------------ μ → ∞: rough wall


@pytest.mark.jit_only
@pytest.mark.parametrize("ratio", [0.5, 5.0])
def test_a_rough_wall_stops_the_slip_in_every_impact(ratio):
    """Every impact with ``μ(1 + d)ṙ > |v|`` does; with ``μ = 10`` all but glancing ones."""
    rotor = jeffcott(PAPER.replace(mu=10.0, radius_ratio=ratio))
    count = 0
    for start in starts(9, 10):
        log = simulate(rotor, start, 20.0).contacts
        steep = 10.0 * (1.0 + PAPER.d) * log.radial_speed > np.abs(log.slip_before)
        count += int(steep.sum())
        assert np.array_equal(log.sticks, steep)
        assert np.abs(log.slip_after[steep]).max(initial=0.0) < 1e-13
        # After the first the rotor keeps near rolling: friction turns the rest of its motion to rolling too.
        assert np.all(np.abs(log.slip_after) <= np.abs(log.slip_before))
    assert count > 20
