"""The proven neighbourhood of the synchronous rub."""

import math

import numpy as np
import pytest
from machines import PAPER
from scipy.integrate import solve_ivp
from sliding_motions import ahead_of, assert_slides_to_the_rub

import carom
from carom.closed_forms.absorbing import rub_neighbourhood
from carom.motions.starts import State

pytestmark = pytest.mark.jit_only

SLENDER = PAPER.replace(radius_ratio=0.05)


def inside(found, count, seed):
    """Random sliding states of the neighbourhood."""
    rng = np.random.default_rng(seed)
    angles = found.angle + rng.uniform(-math.pi, math.pi, 40 * count)
    rates = rng.uniform(-1.0, 1.0, 40 * count)
    chosen = np.flatnonzero(found.contains(angles, rates))[:count]
    return angles[chosen], rates[chosen]


@pytest.mark.parametrize("gamma", [0.08, 0.2, 0.35])
def test_every_state_in_it_goes_over_to_the_rub(gamma):
    rotor = carom.models.jeffcott(PAPER.replace(gamma=gamma))
    found = rub_neighbourhood(rotor)
    angles, rates = inside(found, 60, seed=1)
    assert len(angles) > 20
    for position, rate in zip(np.exp(1j * angles), rates, strict=True):
        assert_slides_to_the_rub(rotor, found, State(position, 1j * rate * position))


@pytest.mark.parametrize("seed", range(12))
def test_the_function_falls_along_sliding(seed):
    """``V`` of a general solver's path along the wall falls as the derivation says, at random machines."""
    rng = np.random.default_rng(seed)
    machine = PAPER.replace(
        gamma=float(rng.uniform(0.02, 0.3)),
        mu=float(rng.choice([0.0, rng.uniform(0.0, 0.5)])),
        rho=float(rng.uniform(0.5, 1.2)),
    )
    found = rub_neighbourhood(carom.models.jeffcott(machine))
    assert found is not None

    def rate(_, state):
        x, w = state[0] - machine.phi, state[1]
        force = machine.rho * math.cos(x) + (1.0 + w) ** 2 - machine.omega**2
        assert force > 0.0
        return [w, -machine.gamma * (1.0 + w) - machine.rho * math.sin(x) - machine.mu * force]

    angles, rates = inside(found, 3, seed)
    for angle, speed in zip(angles, rates, strict=True):
        path = solve_ivp(rate, (0.0, 40.0), [angle, speed], rtol=1e-10, atol=1e-12, max_step=0.05)
        values = found.value(*path.y)
        assert (np.diff(values) <= 1e-10).all()
        assert (values < found.level).all()
        weight = np.exp(2.0 * machine.mu * np.asarray(ahead_of(found, path.y[0])))
        slope = -(machine.gamma + 2.0 * machine.mu) * path.y[1] ** 2 * weight
        expected = np.concatenate([[0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * np.diff(path.t))])
        assert values - values[0] == pytest.approx(expected, abs=2e-4)


def test_the_wall_pushes_and_slip_is_forward_all_over_it():
    for machine in (PAPER, PAPER.replace(gamma=0.3), SLENDER):
        found = rub_neighbourhood(carom.models.jeffcott(machine))
        angles, rates = np.meshgrid(found.angle + np.linspace(-math.pi, math.pi, 801), np.linspace(-2.0, 2.0, 801))
        held = found.contains(angles, rates)
        push = machine.rho * np.cos(angles - machine.phi) + (1.0 + rates) ** 2 - machine.omega**2
        slip = machine.radius_ratio + 1.0 + rates
        assert held.any()
        assert push[held].min() > 0.0
        assert slip[held].min() > 0.0


def test_it_is_as_large_as_its_limit_allows():
    """Just beyond the level something gives: here the wall stops pushing."""
    machine = PAPER.replace(gamma=0.2)
    found = rub_neighbourhood(carom.models.jeffcott(machine))
    assert found.limit == "lift-off"
    angles, rates = np.meshgrid(found.angle + np.linspace(-2.0, 2.0, 2001), np.linspace(-1.0, 0.0, 2001))
    beyond = found.value(angles, rates) < 1.01 * found.level
    push = machine.rho * np.cos(angles - machine.phi) + (1.0 + rates) ** 2 - machine.omega**2
    assert push[beyond].min() < 0.0
