"""Machines at the ends of their ranges: motions end with a stated outcome, finite numbers and inside the wall."""

from __future__ import annotations

import math

import numpy as np
import pytest
from compilation import sized
from drawn_motions import EVENTS

from carom.base.outcome import Outcome
from carom.models import jeffcott
from carom.motions.simulation import simulate
from carom.motions.starts import State
from carom.parameters import Parameters

MACHINES = sized(40, 2, 150)
STOPPED = {Outcome.TIME_REACHED, Outcome.EVENT_LIMIT, Outcome.GRAZING}


def limit_cases(rng):
    """Parameters over many decades, often at the ends of what they can be."""
    omega = 10.0 ** rng.uniform(-2.5, 2.5)
    drawn = {
        "gamma": rng.choice([0.0, 2.0 * omega, 10.0 ** rng.uniform(-4.0, 2.5), 10.0 ** rng.uniform(-4.0, 2.5)]),
        "omega": omega,
        "rho": rng.choice([0.0, 10.0 ** rng.uniform(-3.0, 2.5), 10.0 ** rng.uniform(-3.0, 0.0)]),
        "phi": rng.uniform(-math.pi, math.pi),
        "mu": rng.choice([0.0, 10.0 ** rng.uniform(-3.0, 1.0), rng.uniform(0.0, 0.6)]),
        "d": rng.choice([0.0, 1.0, 1.0 - 10.0 ** rng.uniform(-12.0, -1.0), rng.uniform()]),
        "radius_ratio": 10.0 ** rng.uniform(-2.0, 4.0),
    }
    return Parameters(**{name: float(value) for name, value in drawn.items()})


def limit_starts(rng):
    """Inside and on the wall: striking, leaving slowly, running along it, at rest."""
    turn = np.exp(2j * math.pi * rng.uniform(size=2))
    speed = 10.0 ** rng.uniform(-3.0, 1.0)
    yield State(math.sqrt(rng.uniform()) * turn[0], speed * turn[1])
    yield State(turn[0], speed * turn[1])
    yield State(turn[0], speed * 1j * turn[0])
    yield State(turn[0], turn[0] * complex(-(10.0 ** rng.uniform(-9.0, -2.0)), rng.normal()))
    yield State(turn[0])


@pytest.mark.parametrize("settle", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_every_motion_ends(seed, settle):
    rng = np.random.default_rng([seed, settle])
    for _ in range(MACHINES):
        rotor = jeffcott(limit_cases(rng))
        until = float(rng.choice([1.0, 20.0, 200.0]))
        for start in limit_starts(rng):
            motion = simulate(rotor, start, until, settle=settle, max_events=20 * EVENTS)
            assert motion.outcome in STOPPED or (settle and motion.outcome.settled)
            assert len(motion.segment_starts) <= 20 * EVENTS + 1
            assert np.isfinite(motion.segment_amplitudes).all()
            assert np.isfinite([motion.final.position, motion.final.velocity]).all()
            assert np.all(np.diff(motion.segment_starts) >= 0.0)
            assert motion.segment_starts[-1] <= motion.time <= until
            # A position is known to the rounding error of the terms it is summed from.
            rounding = 1e-12 * max(1.0, abs(rotor.equilibrium) / 1e3)
            assert motion.radius(motion.sample(50)[: 2 * EVENTS]).max() <= 1.0 + rounding
