"""Whether the sensors of a magnetic bearing see a whirl as its magnet moves it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.rotors.flexible_machine import FlexibleMachine
from carom.rotors.whirls import WhirlMode

HARDLY = 0.02
"""Displacement, as a share of the largest of the shaft, at its sensors or its actuator, below which a whirl has a node there."""


@dataclass(frozen=True)
class Collocation:
    """A whirl at a magnetic bearing.

    Attributes
    ----------
    bearing : int
        From 1.
    whirl : WhirlMode
    sensor, magnet : complex
        Displacement that the sensors measure, and at the magnet; the largest of the shaft is 1.
    """

    bearing: int
    whirl: WhirlMode
    sensor: complex
    magnet: complex

    @property
    def hardly(self) -> bool:
        """Whether a node of the whirl lies at the sensors or at the magnet."""
        return min(abs(self.sensor), abs(self.magnet)) < HARDLY

    @property
    def opposed(self) -> bool:
        """Whether a node lies between: sensors and magnet move against each other, so damping by the controller feeds the whirl."""
        return not self.hardly and (self.sensor * self.magnet.conjugate()).real < 0.0


def collocations(machine: FlexibleMachine, whirls: tuple[WhirlMode, ...]) -> tuple[Collocation, ...]:
    """How sensors and magnet of each bearing stand in each whirl, those of a bearing together."""
    rotor = machine.rotor

    def at(whirl: WhirlMode, node: int) -> complex:
        return complex(whirl.widest[rotor.place_of(node)])

    return tuple(
        Collocation(
            number,
            whirl,
            complex(np.mean([at(whirl, node) for node in bearing.sensor_nodes])),
            at(whirl, bearing.node),
        )
        for number, bearing in enumerate(machine.bearings, start=1)
        for whirl in whirls
    )
