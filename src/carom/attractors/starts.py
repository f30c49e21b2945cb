"""Starts that are followed to where they settle."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from carom.equilibria import equilibria
from carom.orbits import Orbit
from carom.rotors import Rotor
from carom.trajectories import State, kick
from carom.whirl import runaway_speed

__all__ = ["DISTURBANCES", "FASTEST", "Kind", "Start", "disturbances", "known_starts"]

Kind = Literal["kick", "start", "orbit", "rub", "whirl"]

DISTURBANCES = 200
FASTEST = 2.0
"""Largest kick and largest start speed in ``c_r Ω``, twice the speed of a whirl that fills the clearance."""
SLOWEST = 0.01
DIRECTIONS = 12
KICKS_SHARE = 0.6
NUDGE, PUSH = 1e-6, 1e-3
"""Disturbance of a known motion relative to its speed, stable and unstable.

The first is small beside any basin worth the name, the second so large that the motion does not pass for periodic before
it has left.
"""


@dataclass(frozen=True)
class Start:
    """A start, and where it comes from.

    Attributes
    ----------
    kind : {"kick", "start", "orbit", "rub", "whirl"}
        A velocity kick out of contact-free levitation; a start anywhere within the clearance; a start next to an orbit
        or a synchronous rub that is known in closed form; one in backward whirl along the wall.
    state : State
    words : str
        The same in words.
    """

    kind: Kind
    state: State
    words: str

    @property
    def disturbance(self) -> bool:
        """Whether it belongs to the sample of disturbances, and not next to a known motion."""
        return self.kind in ("kick", "start")

    @property
    def speed(self) -> float:
        """Speed in the co-rotating frame in ``c_r Ω``; of a kick its size."""
        return abs(self.state.velocity)

    @property
    def angle(self) -> float:
        """Direction of the velocity in rad."""
        return cmath.phase(self.state.velocity)


def disturbances(rotor: Rotor, count: int = DISTURBANCES, seed: int = 0, fastest: float = FASTEST) -> tuple[Start, ...]:
    """Seeded sample of disturbances: the same for the same arguments.

    Parameters
    ----------
    rotor : Rotor
    count : int
        Three in five are velocity kicks of the levitating rotor, in 12 directions each of growing sizes; the rest start
        within the clearance, positions even over its disc and velocities over a disc.  Where the rotor cannot levitate
        all of them do.
    seed : int
    fastest : float
        Largest kick and largest speed of the starts, in ``c_r Ω``.

    Returns
    -------
    tuple of Start
    """
    random = np.random.default_rng(seed)
    sizes = int(KICKS_SHARE * count) // DIRECTIONS if abs(rotor.equilibrium) < 1.0 else 0
    starts = []
    for size in np.geomspace(min(SLOWEST, fastest), fastest, sizes):
        turn = random.random()
        for direction in range(DIRECTIONS):
            blow = kick(float(size), 2.0 * math.pi * (direction + turn) / DIRECTIONS)
            starts.append(Start("kick", blow.state(rotor), f"a kick of {size:.3g} c_r Omega"))
    radii = np.sqrt(random.random((count - len(starts), 2)))
    points = radii * np.exp(2j * math.pi * random.random(radii.shape))
    starts += [
        Start("start", State(complex(place), fastest * complex(velocity)), "a start within the clearance")
        for place, velocity in points
    ]
    return tuple(starts)


def known_starts(rotor: Rotor, orbits: Sequence[Orbit]) -> tuple[Start, ...]:
    """Starts next to every motion known in closed form, so that none is missed for a small basin.

    Parameters
    ----------
    rotor : Rotor
    orbits : sequence of Orbit
        Virtual ones are left out.

    Returns
    -------
    tuple of Start
        To both sides of every admissible orbit and synchronous rub, stable or not; in backward whirl just beyond the
        certain runaway speed, if there is one, and rolling.
    """
    starts = []
    for orbit in orbits:
        if orbit.admissible:
            leaving = orbit.departure
            for change in (-NUDGE, NUDGE) if orbit.stable else (-PUSH, PUSH):
                state = State(leaving.position, (1.0 + change) * leaving.velocity)
                starts.append(Start("orbit", state, f"a start next to {orbit.name}"))
    for rub in equilibria(rotor)[1:]:
        if rub.status == "admissible":
            words = f"a start next to the {'stable' if rub.stable else 'unstable'} synchronous rub"
            speeds = (-NUDGE, NUDGE) if rub.stable else (-PUSH, PUSH)
            starts += [Start("rub", State(rub.position, 1j * speed * rub.position), words) for speed in speeds]
    runaway = runaway_speed(rotor)
    if runaway.reaches_rolling:
        starts.append(_whirling(min(1.001 * runaway.certain, runaway.rolling_speed), "beyond the runaway speed"))
    if rotor.parameters.mu > 0.0:
        starts.append(_whirling(runaway.rolling_speed, "rolling"))
    return tuple(starts)


def _whirling(speed: float, words: str) -> Start:
    """On the wall, in backward whirl at a speed in the fixed frame."""
    return Start("whirl", State(1.0 + 0j, complex(0.0, -1.0 - speed)), f"a start in backward whirl, {words}")
