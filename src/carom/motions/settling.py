"""What a motion remembers of its way, what its rotor proves about where it ends, and the orbit it settles to."""

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
"""Impacts without recurrence after which bouncing counts as irregular wherever nothing else is said; irregular transients of
thousands are common."""
ROTORS = 64
"""Rotors whose rub is kept: motions are many, rotors few."""
LONG_FLIGHT = 3e4
"""Time of free flight, in ``1/Ω``, after which to look at the latest whether the rotor levitates."""
TIME_CONSTANTS = 40.0
SHORTEST_LIMIT, LONGEST_LIMIT = 2e5, 2e7
"""Time in ``1/Ω`` that a motion is given to settle in at least, and at most: seconds of computing."""
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
        Whether motions next to it approach it, as far as the derivative tells.
    """

    positions: np.ndarray
    velocities: np.ndarray
    period: float
    attracts: bool


def fresh_memory(rotor: Jeffcott, patience: int, stop_at_chatter: bool = False, *, absorb: bool = False) -> np.record:
    """Memory of a motion that is to begin, for :func:`~carom.motions.trajectories.follow`; with a ``patience`` of zero it settles to nothing.

    With ``absorb`` it ends where it is proven to go over to the synchronous rub or to rolling, not only when it is there.
    """
    rub = _attracting_rub(rotor) if patience > 0 else None
    around = _rub_neighbourhood(rotor) if rub and absorb else None
    return memory(
        len(rotor.system.exponents),
        rub_position=rub.position if rub else 0j,
        patience=patience,
        recheck=_recheck_time(rotor),
        stop_at_landing=stop_at_chatter,
        # Lower by the rounding error once more: whoever computes V of the end another way finds it inside too.
        rub_level=around.level - around.rounding if around else 0.0,
        rub_shape=(around.friction, around.strength, around.phase) if around else (0.0, 0.0, 0.0),
        runaway=_certain_runaway(rotor) if patience > 0 and absorb else np.inf,
    )


def multiplicity_of(rotor: Jeffcott, amplitudes: np.ndarray, recurred: int) -> int:
    """Impacts in the period of the orbit that a motion approaches which has recurred after so many impacts.

    Parameters
    ----------
    rotor : Jeffcott
    amplitudes : ndarray of complex, shape (N,)
        State just before an impact.
    recurred : int
        After how many impacts it came back to within :data:`~carom.core.fate.NEAR`; zero if it did not.

    Returns
    -------
    int
        See :func:`carom.core.closing.least_period`.
    """
    if not _can_close(rotor):
        return recurred
    return int(least_period(rotor.system.arrays, rotor.system.table, amplitudes, recurred, *_tools()))


def closed_orbit(rotor: Jeffcott, position: complex, velocity: complex, impacts: int) -> ClosedOrbit | None:
    """Find the periodic orbit with so many impacts next to a state just before one of them; ``None`` if there is none near."""
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
    """What the kernels that close orbits work with."""
    whole = np.empty((2, 1), np.int64)
    log = np.empty(1), whole[0], whole[1], *np.empty((2, 1, MODES), complex)
    return log, memory(MODES), workspace(MODES), rub_workspace(MODES)


@lru_cache(maxsize=ROTORS)
def _attracting_rub(rotor: Jeffcott) -> Equilibrium | None:
    """Return the synchronous rub that attracts sliding; with ``d = 1`` too, where it does not attract bounces."""
    return next((rub for rub in find_equilibria(rotor) if rub.attracts_sliding), None)


@lru_cache(maxsize=ROTORS)
def _rub_neighbourhood(rotor: Jeffcott) -> RubNeighbourhood | None:
    rub = _attracting_rub(rotor)
    return neighbourhood_of(rotor, rub) if rub else None


def _certain_runaway(rotor: Jeffcott) -> float:
    """Speed of backward whirl from which on sliding goes over to rolling that holds; infinite if there is none."""
    runaway = runaway_speed(rotor)
    return runaway.certain * (1.0 + GIVEN_UP) if runaway.reaches_rolling and rolling(rotor).holds else np.inf


def _recheck_time(rotor: Jeffcott) -> float:
    decay = -rotor.system.exponents.real.max()
    return min(1.0 / decay, LONG_FLIGHT) if decay > 0.0 else np.inf


def longest_time(rotor: Jeffcott) -> float:
    """Time in ``1/Ω`` after which a motion that has not settled is given up: TIME_CONSTANTS of free flight, within bounds."""
    decay = -float(rotor.system.exponents.real.max())
    return min(max(TIME_CONSTANTS / decay, SHORTEST_LIMIT), LONGEST_LIMIT) if decay > 0.0 else SHORTEST_LIMIT
