"""The smallest lost kick, and the speed below which no kick reaches the wall."""

from __future__ import annotations

import math

import numpy as np
import pytest
from machines import PAPER, path, rest_position
from scipy.integrate import solve_ivp

import carom
from carom.basins import harmless_kick, harmless_shock, smallest_unrecovered_kick
from carom.outcome import InputError, Outcome

pytestmark = pytest.mark.jit_only

MACHINE = PAPER.replace(gamma=0.15, rho=0.3)


@pytest.mark.parametrize("gamma", [0.0, 0.02, 0.15, 1.0, 1.6, 4.0])
def test_harmless_kicks_move_the_rotor_at_most_to_the_wall(gamma):
    """The largest deviation is that of the flight itself, whatever the direction; the bound is not wasteful."""
    machine = PAPER.replace(gamma=gamma, rho=0.2)
    rest = rest_position(machine)
    speed = harmless_kick(carom.jeffcott(machine))
    times = np.linspace(0.0, 12.0, 4001)
    farthest = 0.0
    for angle in np.linspace(0.0, 2.0 * math.pi, 61):
        flown = path(machine, rest, speed * np.exp(1j * angle), times)
        assert np.abs(flown).max() <= 1.0
        farthest = max(farthest, float(np.abs(flown - rest).max()))
    assert farthest == pytest.approx(1.0 - abs(rest), rel=1e-5)


def test_critical_damping_is_the_limit_of_both_sides():
    speeds = [
        harmless_kick(carom.jeffcott(PAPER.replace(rho=0.1, gamma=2.0 * 0.76 * factor)))
        for factor in (1 - 1e-7, 1, 1 + 1e-7)
    ]
    assert speeds == pytest.approx([speeds[1]] * 3, rel=1e-6)


@pytest.mark.parametrize("changes", [{"gamma": -0.01, "rho": 0.1}, {"gamma": 0.05}])
def test_nothing_is_harmless_without_damped_levitation(changes):
    assert harmless_kick(carom.jeffcott(PAPER.replace(**changes))) == 0.0


def test_the_smallest_kick_is_lost_and_a_smaller_one_is_not():
    rotor = carom.jeffcott(MACHINE)
    found = smallest_unrecovered_kick(rotor, 1.0)
    assert found.harmless < found.recovered < found.speed
    assert found.speed - found.recovered <= 1.001e-3 * found.speed
    lost = carom.simulate(rotor, carom.kick(found.speed, found.angle), 2e5, settle=True)
    back = carom.simulate(rotor, carom.kick(found.recovered, found.angle), 2e5, settle=True)
    assert lost.outcome is found.outcome
    assert lost.outcome is not Outcome.LEVITATED
    assert back.outcome is Outcome.LEVITATED
    assert len(back.contacts) == 0 or found.recovered > found.harmless


def test_no_kick_of_an_independent_sample_below_it_is_lost():
    rotor = carom.jeffcott(MACHINE)
    found = smallest_unrecovered_kick(rotor, 1.0)
    rng = np.random.default_rng(8)
    speeds = found.speed * 0.998 * np.sqrt(rng.random(4000))
    starts = carom.VelocityKick().starts(rotor, speeds, rng.uniform(0.0, 2.0 * math.pi, 4000))
    assert carom.settle_all(rotor, starts.positions, starts.velocities).recovered.all()


def test_a_finer_scan_finds_no_smaller_one():
    rotor = carom.jeffcott(MACHINE)
    found, finer = (smallest_unrecovered_kick(rotor, 1.0, directions=count, speeds=count) for count in (48, 200))
    assert found.speed == pytest.approx(finer.speed, rel=3e-3)


def test_a_machine_that_always_comes_back():
    assert smallest_unrecovered_kick(carom.jeffcott(PAPER.replace(gamma=0.6, rho=0.1)), 0.5) is None


@pytest.mark.parametrize("duration", [0.02, 0.7, 4.0])
def test_harmless_shocks_do_not_bring_the_rotor_to_the_wall(duration):
    """Followed in the fixed frame by a general solver through the pulse and after it, in many directions."""
    peak = harmless_shock(carom.jeffcott(MACHINE), duration)
    gamma, omega, rest = MACHINE.gamma, MACHINE.omega, abs(rest_position(MACHINE))

    def rate(time, state):
        push = peak * math.sin(math.pi * time / duration) if time < duration else 0.0
        return [state[1], -push - gamma * state[1] - omega**2 * state[0]]

    # The coefficients are real: the deviation stays on a line, and adds to the levitation at worst.
    during = solve_ivp(rate, (0.0, duration), [0.0, 0.0], rtol=1e-10, atol=1e-12, max_step=duration / 50)
    after = solve_ivp(rate, (duration, duration + 12.0), during.y[:, -1], rtol=1e-10, atol=1e-12, max_step=0.02)
    farthest = max(np.abs(during.y[0]).max(), np.abs(after.y[0]).max())
    assert farthest <= 1.0 - rest
    if duration < 0.1:
        assert farthest == pytest.approx(1.0 - rest, rel=1e-3)


@pytest.mark.parametrize("fastest", [0.0, -1.0, math.nan, math.inf])
def test_speeds_that_make_no_sense(fastest):
    with pytest.raises(InputError, match="fastest"):
        smallest_unrecovered_kick(carom.jeffcott(MACHINE), fastest)


def test_no_levitation():
    with pytest.raises(InputError, match="levitation"):
        smallest_unrecovered_kick(carom.jeffcott(PAPER.replace(gamma=0.05)))


def test_unstable_levitation():
    with pytest.raises(InputError, match="gamma"):
        smallest_unrecovered_kick(carom.jeffcott(PAPER.replace(gamma=-0.01, rho=0.1)))
