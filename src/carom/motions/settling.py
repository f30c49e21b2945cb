"""How a motion is recognised as settled: its memory, the proofs about its end, and the orbit it settles to."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from carom.closed_forms.absorbing import GIVEN_UP, RubNeighbourhood, neighbourhood_of
from carom.closed_forms.equilibria import Equilibrium, find_equilibria
from carom.closed_forms.whirl import rolling, runaway_speed
from carom.core.closing import ATTRACTS, OPEN, close, least_period
from carom.core.fate import memory
from carom.core.layout import rub_workspace, workspace
from carom.models import Jeffcott
from carom.results import Result

__all__ = ["PATIENCE", "ClosedOrbit", "closed_orbit", "fresh_memory", "longest_time", "multiplicity_of"]

PATIENCE = 20_000
"""Default number of impacts without recurrence after which bouncing counts as irregular.

Irregular transients of thousands of impacts are common.
"""
ROTORS = 64
"""Size of the caches of rubs, one entry per rotor: there are many motions of few rotors."""
LONG_FLIGHT = 3e4
"""Longest free flight, in ``1/Ω``, before it is checked whether the rotor levitates."""
TIME_CONSTANTS = 40.0
SHORTEST_LIMIT, LONGEST_LIMIT = 2e5, 2e7
"""Smallest and largest time, in ``1/Ω``, that a motion is given to settle: seconds of computing."""
MODES = 2
"""Modes of the rotors whose orbits are closed here."""


@dataclass(frozen=True, eq=False, repr=False)
class ClosedOrbit(Result):
    """A periodic orbit, closed to rounding.

    Attributes
    ----------
    positions, velocities : ndarray of complex, shape (p,)
        States just before the impacts of one period, co-rotating frame.
    period : float
        In ``1/Ω``.
    attracts : bool
        Whether nearby motions approach it, judged by the derivative of the return map.
    """

    positions: np.ndarray
    velocities: np.ndarray
    period: float
    attracts: bool


def fresh_memory(rotor: Jeffcott, patience: int, stop_at_chatter: bool = False, *, absorb: bool = False) -> np.record:
    """Memory of a motion at its start, for :func:`~carom.motions.trajectories.follow`.

    With a ``patience`` of zero the motion never counts as settled.  With ``absorb`` it ends as soon as it is proven to
    go over to the synchronous rub or to rolling, otherwise when it has reached them.
    """
    rub = _attracting_rub(rotor) if patience > 0 else None
    around = _rub_neighbourhood(rotor) if rub and absorb else None
    return memory(
        len(rotor.system.exponents),
        rub_position=rub.position if rub else 0j,
        patience=patience,
        recheck=_recheck_time(rotor),
        stop_at_landing=stop_at_chatter,
        # Lowered by the rounding error once more, so that the end lies inside even if V is computed another way.
        rub_level=around.level - around.rounding if around else 0.0,
        rub_shape=(around.friction, around.strength, around.phase) if around else (0.0, 0.0, 0.0),
        runaway=_certain_runaway(rotor) if patience > 0 and absorb else np.inf,
    )


def multiplicity_of(rotor: Jeffcott, amplitudes: np.ndarray, recurred: int) -> int:
    """Number of impacts per period of the orbit that a recurring motion approaches.

    Parameters
    ----------
    rotor : Jeffcott
    amplitudes : ndarray of complex, shape (N,)
        State just before an impact.
    recurred : int
        Number of impacts after which it came back to within :data:`~carom.core.fate.NEAR`; zero if it did not.

    Returns
    -------
    int
        See :func:`carom.core.closing.least_period`.
    """
    if not _can_close(rotor):
        return recurred
    return int(least_period(rotor.system.arrays, rotor.system.table, amplitudes, recurred, *_tools()))


def closed_orbit(rotor: Jeffcott, position: complex, velocity: complex, impacts: int) -> ClosedOrbit | None:
    """Find the periodic orbit of a given number of impacts near a state just before an impact, or ``None``."""
    if not _can_close(rotor):
        return None
    states, durations = np.empty((impacts + 1, MODES), complex), np.empty(impacts)
    states[0] = rotor.system.amplitudes(position, velocity)
    found = close(rotor.system.arrays, rotor.system.table, states, durations, *_tools())
    if found == OPEN:
        return None
    return ClosedOrbit(*rotor.system.state(states[:-1]), float(durations.sum()), found == ATTRACTS)


def _can_close(rotor: Jeffcott) -> bool:
    return len(rotor.system.exponents) == MODES and len(rotor.system.arrays.rows) == 1


def _tools() -> tuple[tuple[np.ndarray, ...], np.record, np.record, np.record]:
    """Log, memory and scratch arrays for the kernels that close orbits."""
    whole = np.empty((2, 1), np.int64)
    log = np.empty(1), whole[0], whole[1], *np.empty((2, 1, MODES), complex)
    return log, memory(MODES), workspace(MODES), rub_workspace(MODES)


@lru_cache(maxsize=ROTORS)
def _attracting_rub(rotor: Jeffcott) -> Equilibrium | None:
    """Return the synchronous rub that attracts sliding, also for ``d = 1``, where it does not attract bouncing."""
    return next((rub for rub in find_equilibria(rotor) if rub.attracts_sliding), None)


@lru_cache(maxsize=ROTORS)
def _rub_neighbourhood(rotor: Jeffcott) -> RubNeighbourhood | None:
    rub = _attracting_rub(rotor)
    return neighbourhood_of(rotor, rub) if rub else None


def _certain_runaway(rotor: Jeffcott) -> float:
    """Speed of backward whirl beyond which sliding provably goes over to lasting rolling; infinite if there is none."""
    runaway = runaway_speed(rotor)
    return runaway.certain * (1.0 + GIVEN_UP) if runaway.reaches_rolling and rolling(rotor).holds else np.inf


def _recheck_time(rotor: Jeffcott) -> float:
    decay = -rotor.system.exponents.real.max()
    return min(1.0 / decay, LONG_FLIGHT) if decay > 0.0 else np.inf


def longest_time(rotor: Jeffcott) -> float:
    """Time limit in ``1/Ω`` for a motion to settle: TIME_CONSTANTS time constants of free flight, within bounds."""
    decay = -float(rotor.system.exponents.real.max())
    return min(max(TIME_CONSTANTS / decay, SHORTEST_LIMIT), LONGEST_LIMIT) if decay > 0.0 else SHORTEST_LIMIT
