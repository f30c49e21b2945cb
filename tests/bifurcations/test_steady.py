"""Special points of steady motions: folds of rubs that the wall can hold, and those it cannot."""

from __future__ import annotations

import math

import numpy as np
import pytest

from carom.bifurcations.axes import Numbers
from carom.bifurcations.steady import happens_to_rubs
from carom.closed_forms import find_equilibria
from carom.outcome import InputError
from carom.parameters import Parameters


def at_fold(random, side):
    """Random parameters on a fold of rubs, ``γ + μ(1 − ω²) = ± ρ√(1 + μ²)``; damping may be negative."""
    rho, mu, omega = random.uniform(0.05, 0.8), random.uniform(0.02, 1.0), random.uniform(0.1, 1.6)
    gamma = side * rho * math.hypot(1.0, mu) - mu * (1.0 - omega**2)
    return Parameters(gamma=gamma, omega=omega, rho=rho, phi=0.3, mu=mu, d=0.9, radius_ratio=50.0)


@pytest.mark.parametrize("side", [1, -1])
def test_a_fold_happens_to_rubs_where_the_wall_pushes_them(side):
    """Against the rubs just inside the fold, for both signs of the damping."""
    random = np.random.default_rng(side + 3)
    answers = []
    for _ in range(200):
        parameters = at_fold(random, side)
        try:
            rubs = find_equilibria(parameters.replace(gamma=parameters.gamma - side * 1e-9))[1:]
        except InputError:  # undamped resonance
            continue
        forces = [rub.normal_force for rub in rubs]
        assert len(forces) == 2
        if min(map(abs, forces)) < 1e-3:
            continue
        assert forces[0] * forces[1] > 0.0
        answers.append(happens_to_rubs(Numbers.of(parameters)))
        assert answers[-1] == (forces[0] > 0.0), parameters
    assert 20 < sum(answers) < len(answers)
