"""What is proven of kicks and of states, tried on motions of a simulator that shares nothing with carom."""

from functools import cache

import numpy as np
import pytest
from machines import PAPER

from carom import kick, simulate
from carom.base.outcome import Outcome
from carom.models import jeffcott
from carom.proofs import prove_kicks, prove_states

from . import plain_rotor
from .plain_rotor import RETURNED, RUBS, Flock, Machine

TWO_IMPACTS = Machine(gamma=0.246, omega=1.633, rho=0.0, mu=0.0795, d=0.681, s=17.9)
UNBALANCED = Machine(gamma=0.667, omega=1.094, rho=0.1906, mu=0.387, d=0.175, s=21.3)
DAMPED = Machine(gamma=1.0, omega=0.9, rho=0.05, mu=0.2, d=0.5, s=20.0)
LARGEST = {TWO_IMPACTS: 3.6566, UNBALANCED: 1.2488}
SPEED = 1.0


def values(machine):
    """Numbers of the hypotheses."""
    names = ("gamma", "omega", "rho", "mu", "d", "radius_ratio")
    return dict(zip(names, map(repr, vars(machine).values()), strict=True)) | {"phi": "0.7"}


@cache
def proven_cells(machine):
    """Edges of the cells in the units of the equations (n, 4), and the impacts allowed."""
    proof = prove_kicks(values(machine), repr(LARGEST[machine]), most_impacts=2, time_limit=None, workers=1)
    assert proof["kicks all recover"].status == "proven"
    edges, letters = plain_rotor.cells("".join(proof.document()["evidence"]["cells"]))
    size = LARGEST[machine]
    return edges * [size, size, 2 * np.pi, 2 * np.pi], letters.astype(int)


def inside(edges, count, rng):
    """Kicks in each cell (n, count): its corners, its edges and what lies between."""
    along, across = rng.random((2, len(edges), count))
    along[:, :4], across[:, :4] = [0, 1, 0, 1], [0, 0, 1, 1]
    along[:, 4:8], across[:, 8:12] = [0, 0, 1, 1], [0, 0, 1, 1]
    low, high, first, last = edges.T[:, :, None]
    return low + along * (high - low), first + across * (last - first)


def fly(machine, speeds, angles):
    """Outcomes and numbers of impacts, as the speeds are shaped."""
    flock = plain_rotor.kicks(machine, speeds.ravel(), angles.ravel()).follow()
    return flock.mode.reshape(speeds.shape), flock.impacts.reshape(speeds.shape)


@pytest.mark.parametrize("machine", LARGEST, ids=("two impacts", "unbalanced"))
def test_kicks_in_proven_cells_return_with_the_stated_impacts(machine):
    edges, allowed = proven_cells(machine)
    modes, impacts = fly(machine, *inside(edges, 40, np.random.default_rng(1)))
    assert np.all(modes == RETURNED)
    assert np.all(impacts <= allowed[:, None])
    # The bounds are not loose: nearly each cell has a kick with as many.
    assert np.mean(impacts.max(axis=1) == allowed) > 0.9


def test_kicks_next_to_grazes_return_with_the_stated_impacts():
    edges, allowed = proven_cells(UNBALANCED)
    speeds, angles = inside(edges, 40, np.random.default_rng(2))
    _, impacts = fly(UNBALANCED, speeds, angles)
    cell, kick = np.nonzero(np.diff(impacts, axis=1))
    assert len(cell) > 20
    few = impacts[cell, kick]
    here, there = (np.array([speeds[cell, k], angles[cell, k]]) for k in (kick, kick + 1))
    for _ in range(40):
        middle = (here + there) / 2
        modes, found = fly(UNBALANCED, *middle)
        assert np.all(modes == RETURNED)
        assert np.all(found <= allowed[cell])
        here, there = np.where(found == few, middle, here), np.where(found == few, there, middle)


def test_states_up_to_the_proven_speed_return():
    proof = prove_states(values(DAMPED), repr(SPEED))
    assert proof["states all recover"].status == "proven"
    rng = np.random.default_rng(3)
    count = 300
    radius = np.where(rng.random(count) < 0.6, 1.0, np.sqrt(rng.random(count)))
    turn, phase = 2 * np.pi * rng.random((2, count))
    turn[: count // 3] = rng.choice([-0.5, 0.5], count // 3) * np.pi
    motions = Flock(DAMPED, phase, radius, SPEED * np.exp(1j * turn)).follow()
    assert np.all(motions.mode == RETURNED)
    assert np.any(motions.chattered)


def test_it_agrees_with_carom_on_single_kicks():
    paper = PAPER.replace(gamma=0.3)
    machine = Machine(paper.gamma, paper.omega, paper.rho, paper.mu, paper.d, paper.radius_ratio)
    rotor = jeffcott(paper)
    speeds, angles = (grid.ravel() for grid in np.meshgrid([0.2, 0.3], np.linspace(0, 6, 9)))
    modes, impacts = fly(machine, speeds, angles)
    assert set(modes) == {RETURNED, RUBS}
    for speed, angle, mode, count in zip(speeds, angles, modes, impacts, strict=True):
        motion = simulate(rotor, kick(speed, angle + np.angle(rotor.equilibrium)), settle=True)
        assert (motion.outcome == Outcome.LEVITATED) == (mode == RETURNED)
        assert mode == RUBS or np.count_nonzero(motion.is_impact) == count
