"""
29. A disturbance of your own
=============================

A frozen dataclass with the coordinates of the disturbance and the states at which motions start can be used wherever a built-in disturbance can.
"""

from dataclasses import dataclass

import numpy as np

import carom as cm
from carom.disturbances import Coordinate, Disturbance, Starts


@dataclass(frozen=True)
class HeldAside(Disturbance):
    """The levitating rotor is held at some distance and let go."""

    farthest: float = 0.8
    measured_in = {"farthest": "length"}

    @property
    def coordinates(self):
        """Distance and direction."""
        return (
            Coordinate("distance", "distance from levitation", 0.0, self.farthest, scale="length"),
            Coordinate("direction", "direction", 0.0, 2 * np.pi, periodic=True),
        )

    def starts(self, rotor, distance, direction):
        """States at rest inside the wall; the others do not exist."""
        positions = rotor.equilibrium + distance * np.exp(1j * direction)
        inside = np.abs(positions) < 1.0
        return Starts.of(np.where(inside, positions, 0.0), 0.0, inside)


machine = cm.load("../keogh-cole.toml")
basin = cm.map_basins(machine, cm.Grid(HeldAside(), (40, 60)))
print(basin.share_recovered.words)

# %%
# What to see: released from the small green area around levitation the rotor comes back; from further away it rubs or bounces.  The white part lies
# beyond the wall.
figure = basin.plot()
