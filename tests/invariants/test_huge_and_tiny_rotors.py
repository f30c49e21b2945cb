"""Radii far above and below the clearance, each a limit in which theory says what must happen.

Everywhere ``U`` is the position in the co-rotating frame, ``Z = Ue^{it}`` that in the fixed one, ``W = 1 + θ̇`` the whirl
speed in the fixed frame and ``x = θ − φ``.
"""

import math

import numpy as np
import pytest
from limiting_motions import START, on_wall, starts
from machines import PAPER

from carom.base.outcome import Phase
from carom.models import jeffcott
from carom.motions.simulation import simulate


def test_slip_of_a_huge_rotor_never_reverses():
    """Impacts are then ``U̇⁺ = U̇⁻ − qṙ⁻U`` with ``q = (1 + d)(1 + iμ)``, whatever ``s``."""
    q = (1.0 + PAPER.d) * complex(1.0, PAPER.mu)
    motions = [simulate(jeffcott(PAPER.replace(radius_ratio=ratio)), START, 30.0) for ratio in (1e3, 1e6, 1e9)]
    for motion in motions:
        before, after = (
            motion.rotor.system.state(motion.event_amplitudes),
            motion.rotor.system.state(motion.segment_amplitudes[1:]),
        )
        normal = before[0] / np.abs(before[0])
        expected = before[1] - q * (normal.conj() * before[1]).real * normal
        assert len(motion.contacts) > 10
        assert np.abs(after[1] - expected).max() < 1e-14
        assert not motion.contacts.sticks.any()
    assert np.array_equal(motions[0].segment_amplitudes, motions[1].segment_amplitudes)
    assert np.array_equal(motions[0].segment_amplitudes, motions[2].segment_amplitudes)


@pytest.mark.parametrize("ratio", [1e-3, 0.01, 0.1])
def test_a_tiny_rotor_is_held_by_the_wall(ratio):
    """Its surface hardly moves, so an impact that stops the slip leaves ``W = −s``: the centre all but stops along the wall."""
    rotor = jeffcott(PAPER.replace(mu=2.0, radius_ratio=ratio))
    sticking = 0
    for start in starts(8, 10):
        log = simulate(rotor, start, 20.0).contacts
        stuck = log.sticks
        sticking += int(stuck.sum())
        assert np.allclose(1.0 + log.angular_speed_after[stuck], -ratio, rtol=0, atol=1e-14)
        slipping = np.abs(log.slip_before) > 2.0 * (1.0 + PAPER.d) * log.radial_speed
        assert np.array_equal(stuck, ~slipping)
    assert sticking > 20


@pytest.mark.parametrize("ratio", [1e-3, 0.1, 0.3])
@pytest.mark.parametrize("mu", [0.2, 10.0])
def test_a_tiny_rotor_rolls_until_it_slips_or_leaves(ratio, mu):
    """Rolling is ``x = x₀ − (1 + s)t`` with ``N = s² − ω² + ρ cos x`` and the friction force ``F = ρ sin x − γs``.

    It ends where ``N = 0``, or before where ``|F| = μN``.  Starting where the unbalance points it runs towards
    negative ``x``, so the first is ``−F = μN``: ``−ρ sin x + γs = μ(s² − ω² + ρ cos x)``.
    """
    parameters = PAPER.replace(gamma=0.1, omega=0.3, radius_ratio=ratio, mu=mu)
    rho, drop = parameters.rho, ratio**2 - parameters.omega**2
    # ρ(sin x + μ cos x) = γs − μ(s² − ω²), and sin x + μ cos x = √(1 + μ²) sin(x + arctan μ).
    share = (parameters.gamma * ratio - mu * drop) / (rho * math.hypot(1.0, mu))
    end = math.asin(share) - math.atan(mu)
    assert end < 0.0
    motion = simulate(jeffcott(parameters), on_wall(parameters.phi, -ratio), 10.0)
    first = motion.lasting_contacts[0]
    assert first.phase is Phase.ROLLING
    assert first.end == pytest.approx(-end / (1.0 + ratio), rel=1e-12)
    times = np.linspace(0.0, first.end, 50, endpoint=False)
    position, velocity = motion.at(times)
    assert np.abs((position.conj() * velocity).imag + 1.0 + ratio).max() < 1e-14
    normal, friction = motion.forces(times)
    x = -(1.0 + ratio) * times
    assert np.abs(normal - (drop + rho * np.cos(x))).max() < 1e-13
    assert np.abs(friction - (rho * np.sin(x) - parameters.gamma * ratio)).max() < 1e-13
    following = motion.segment_phases[np.flatnonzero(motion.segment_phases[:, 0] != Phase.ROLLING)[-1], 0]
    assert following != Phase.ROLLING
