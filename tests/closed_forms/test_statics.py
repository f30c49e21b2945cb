"""Equilibria of any linear rotor: residuals in high precision, all of them against blind searches, and motions that end there."""

from itertools import combinations

import mpmath
import numpy as np
import pytest
from compilation import sized
from linear_rotors import random_rotor
from scipy.optimize import root

from carom import State, find_equilibria, settle
from carom.base.outcome import Outcome


def misses(model, at):
    """Largest residual of the equations of motion at rest, and of the walls, in 40 digits."""
    with mpmath.workdps(40):
        count = len(model.equations.planes)
        stiffness, planes = (
            mpmath.matrix(part.tolist()) for part in (model.equations.stiffness, model.equations.planes)
        )
        rest = mpmath.matrix(np.atleast_1d(at.position).tolist())
        places = planes * rest
        force = mpmath.matrix(model.equations.forcing.tolist()) - stiffness * rest
        size = (
            1
            + mpmath.norm(stiffness, 1) * mpmath.norm(rest)
            + mpmath.norm(mpmath.matrix(model.equations.forcing.tolist()))
        )
        for q in range(count):
            push = (
                mpmath.mpf(float(at.normal_forces[q]))
                * mpmath.mpc(1, float(model.equations.touchdowns[q].friction))
                * places[q]
            )
            force -= planes[q, :].H * push
            size += mpmath.norm(planes[q, :].H * push)
        walls = [abs(abs(places[q]) - 1) for q in at.planes]
        return float(mpmath.norm(force) / size), float(max(walls, default=0))


def test_each_balances_all_forces():
    seen = set()
    for seed in range(sized(25, 25, 2000)):
        model = random_rotor(seed)
        for at in find_equilibria(model):
            residual, wall = misses(model, at)
            # Newton's method stops at 1e-11 from the walls, and the position is a sum of modes.
            assert residual < 1e-12 * (10.0 + np.linalg.cond(model.system.basis))
            assert wall < 1e-10
            seen.add((len(at.planes), at.status))
    assert {(0, "admissible"), (1, "admissible"), (1, "virtual"), (2, "admissible"), (2, "virtual")} <= seen


def test_none_is_missed_at_one_and_two_planes():
    """Newton's method from random forces, in SciPy, finds no other."""
    found = 0
    for seed in range(sized(12, 12, 1000)):
        model = random_rotor(seed)
        random = np.random.default_rng(seed)
        static = model.equations.planes @ np.linalg.solve(model.equations.stiffness, model.equations.planes.conj().T)
        h = static * (1.0 + 1j * model.system.arrays.friction)
        rest = model.equations.planes @ np.linalg.solve(model.equations.stiffness, model.equations.forcing)
        every = find_equilibria(model)
        for count in (1, 2):
            for planes in combinations(range(len(h)), count):
                part, chosen = h[np.ix_(planes, planes)], list(planes)
                mine = [at.normal_forces[chosen] for at in every if at.planes == planes]

                def beyond(forces, part=part, free=rest[chosen]):
                    return np.abs(np.linalg.solve(np.eye(len(part)) + part * forces, free)) ** 2 - 1.0

                for _ in range(sized(8, 8, 60)):
                    size = random.choice([1.0, -1.0], count) * 10.0 ** random.uniform(-2.0, 1.5, count)
                    other = root(beyond, size / np.abs(part.diagonal()), tol=1e-13)
                    if not other.success or np.abs(beyond(other.x)).max() > 1e-9:
                        continue
                    found += 1
                    assert any(np.abs(other.x - one).max() < 1e-4 * np.abs(one).max() for one in mine), (seed, planes)
    assert found > 50


@pytest.mark.jit_only
def test_motions_come_to_rest_in_a_stable_rub_and_in_no_other():
    """Starts anywhere and next to each admissible rub."""
    ended, repelled = {1: 0, 2: 0}, 0
    for seed in range(sized(6, 2, 150)):
        random = np.random.default_rng(seed)
        model = random_rotor(seed, n=1 + seed % 2, planes=2, unbalance=3.0, damping=0.2, friction=0.1)
        n = len(model.equations.mass)
        every = [at for at in find_equilibria(model) if at.planes and at.status == "admissible"]
        starts = random.normal(size=(10, n)) + 1j * random.normal(size=(10, n))
        starts *= (0.9 * random.random(10) / np.abs(starts @ model.equations.planes.T).max(axis=1))[:, None]
        rates = random.normal(size=(10, n)) + 1j * random.normal(size=(10, n))
        near = np.array([np.atleast_1d(at.position) for at in every]).reshape(-1, n)
        nudge = 1e-4 * random.normal(size=near.shape)
        starts, rates = np.concatenate([starts, (1.0 - 1e-4) * near]), np.concatenate([rates, nudge])
        ends = settle(
            model,
            State(np.squeeze(starts, -1) if n == 1 else starts, np.squeeze(rates, -1) if n == 1 else rates),
            until=3000.0,
        )
        resting = np.abs(ends.velocities.reshape(-1, n)).max(axis=1) < 1e-6
        resting &= ends.outcomes == Outcome.FORWARD_RUB
        for position in ends.positions.reshape(-1, n)[resting]:
            (end,) = (at for at in every if np.abs(np.atleast_1d(at.position) - position).max() < 1e-5)
            assert end.stable
            ended[len(end.planes)] += 1
        for at, rests, position in zip(every, resting[10:], ends.positions.reshape(-1, n)[10:], strict=True):
            back = rests and np.abs(np.atleast_1d(at.position) - position).max() < 1e-5
            assert back == at.stable
            repelled += not back
    assert min(ended.values()) > 0
    assert repelled > 0
