"""Simulated bouncing at one damping: its impacts, its exponents, how long it lasts and where it ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from carom.attractors import Lifetimes, measure_lifetimes
from carom.models import Rotor
from carom.motions.simulation import simulate
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory
from carom.orbits import find_orbits, lyapunov_exponents, orbit_exponents, orbit_of_motion
from carom.orbits.orbit import Orbit
from carom.outcome import CaromError, Outcome
from carom.results import Result

BESIDE = 1e-3
"""Relative change of the velocity at the starts beside the orbit."""
SHOWN = 150
"""Impacts of irregular bouncing that are kept."""
DISCARDED = 100
"""Impacts discarded at the beginning: until then a motion depends on its start."""
MEASURED, SHORTEST = 4000, 600
"""Impacts over which exponents are measured, and the fewest of a motion that ends."""
SEED = 1


@dataclass(frozen=True, eq=False, repr=False)
class BouncingSample(Result):
    """Motions started beside the orbit ``B1,d`` at one damping.

    Attributes
    ----------
    gamma : float
    speeds : ndarray
        Radial speeds just before impacts, in ``c_r Ω``: of one period, of the last impacts of irregular bouncing, or of a motion before
        it ends.
    orbit : Orbit or None
        The orbit on which it settled; ``None`` if it did not become periodic, or ended.
    ended : bool
        Whether this motion ended.
    exponent, error : float
        Its largest Lyapunov exponent across the motion, in ``Ω``, with its standard error (0 for a periodic orbit); ``nan`` where the
        motion ended too early.
    lifetimes : Lifetimes
        Lifetimes of all the motions.
    """

    gamma: float
    speeds: np.ndarray
    orbit: Orbit | None
    ended: bool
    exponent: float
    error: float
    lifetimes: Lifetimes

    @property
    def impacts(self) -> int:
        """Impacts per period; 0 without an orbit."""
        return self.orbit.impacts if self.orbit else 0


def sample_bouncing(rotor: Rotor, *, motions: int, impacts: int) -> BouncingSample:
    """Follow motions from beside ``B1,d``.

    Parameters
    ----------
    rotor : Rotor
        The machine at a damping where this orbit is a motion.
    motions : int
    impacts : int
        Impacts for which each is followed.
    """
    starts = _beside(find_orbits(rotor)["B1,d"], motions)
    lifetimes = measure_lifetimes(rotor, starts, impacts=impacts, discarded=DISCARDED)
    motion, start = _longest(rotor, starts, impacts)
    speeds = motion.contacts.radial_speed
    ended = motion.outcome not in (Outcome.BOUNCING, Outcome.MIXED)
    orbit = orbit_of_motion(motion) if motion.multiplicity else None
    if orbit is not None:
        speeds, exponent = orbit.impact_speeds, orbit_exponents(orbit).across
    else:
        # Before a motion ends in lasting contact, its last impacts are those of a chatter.
        speeds = speeds[DISCARDED : len(speeds) // 2] if ended else speeds
        exponent = _measured(rotor, start, min(MEASURED, len(motion.contacts) // 2))
    return BouncingSample(rotor.parameters.gamma, speeds[-SHOWN:], orbit, ended, *exponent, lifetimes)


def _beside(orbit: Orbit, motions: int) -> list[State]:
    random, before = np.random.default_rng(SEED), orbit.departure
    return [State(before.position, before.velocity * (1.0 + BESIDE * random.normal())) for _ in range(motions)]


def _longest(rotor: Rotor, starts: Sequence[State], impacts: int) -> tuple[Trajectory, State]:
    """The first motion that does not end early, or the longest of them, and its start."""
    found = []
    for start in starts:
        found.append((simulate(rotor, start, settle=True, patience=impacts), start))
        if len(found[-1][0].contacts) > 4 * SHORTEST or found[-1][0].multiplicity:
            return found[-1]
    return max(found, key=lambda pair: len(pair[0].contacts))


def _measured(rotor: Rotor, start: State, impacts: int) -> tuple[float, float]:
    """Largest exponent across the motion over so many impacts, and its error."""
    if impacts < SHORTEST:
        return np.nan, np.nan
    try:
        return lyapunov_exponents(rotor, start, impacts, transient=DISCARDED).across
    except CaromError:
        return np.nan, np.nan
