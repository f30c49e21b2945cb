"""Random machines that bounce, and random starts."""

from __future__ import annotations

import numpy as np

from carom.base.outcome import Outcome
from carom.motions import settle
from carom.parameters import Parameters
from tests.machines import PAPER


def bouncing_parameters(random: np.random.Generator, impacts: int = 1) -> Parameters:
    """Parameters of a lightly damped machine of which some motions end on periodic bouncing with at least so many impacts."""
    while True:
        machine = PAPER.replace(
            gamma=float(10 ** random.uniform(-1.7, -0.4)),
            omega=float(random.uniform(0.2, 1.4)),
            rho=float(10 ** random.uniform(-1.0, 0.3)),
            mu=float(random.uniform(0.0, 0.4)),
            d=float(random.uniform(0.3, 1.0)),
        )
        places, speeds = disc_points(random, 300), disc_points(random, 300)
        ends = settle(machine, 0.99 * places, 1.5 * speeds, patience=3000)
        if ends.multiplicities[ends.outcomes == Outcome.BOUNCING].max(initial=0) >= impacts:
            return machine


def disc_points(random: np.random.Generator, count: int) -> np.ndarray:
    """Random points of the unit disc, complex."""
    points: np.ndarray = np.sqrt(random.uniform(size=count)) * np.exp(2j * np.pi * random.uniform(size=count))
    return points
