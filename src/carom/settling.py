"""What a motion remembers of its way, and what its rotor proves about where it ends."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from carom.absorbing import GIVEN_UP, RubNeighbourhood, neighbourhood_of
from carom.core.fate import memory
from carom.equilibria import Equilibrium, equilibria
from carom.rotors import Rotor
from carom.whirl import rolling, runaway_speed

__all__ = ["PATIENCE", "fresh_memory"]

PATIENCE = 20_000
"""Impacts without recurrence after which bouncing counts as irregular wherever nothing else is said; irregular transients of
thousands are common."""
ROTORS = 64
"""Rotors whose rub is kept: motions are many, rotors few."""


def fresh_memory(rotor: Rotor, patience: int, stop_at_chatter: bool = False, *, absorb: bool = False) -> np.record:
    """Memory of a motion that is to begin, for :func:`~carom.trajectories.follow`; with a ``patience`` of zero it settles to nothing.

    With ``absorb`` it ends where it is proven to go over to the synchronous rub or to rolling, not only when it is there.
    """
    rub = _attracting_rub(rotor) if patience > 0 else None
    around = _rub_neighbourhood(rotor) if rub and absorb else None
    return memory(
        len(rotor.eigenvalues),
        rub_position=rub.position if rub else 0j,
        patience=patience,
        recheck=_recheck_time(rotor),
        stop_at_landing=stop_at_chatter,
        # Lower by the rounding error once more: whoever computes V of the end another way finds it inside too.
        rub_level=around.level - around.rounding if around else 0.0,
        rub_shape=(around.friction, around.strength, around.phase) if around else (0.0, 0.0, 0.0),
        runaway=_certain_runaway(rotor) if patience > 0 and absorb else np.inf,
    )


@lru_cache(maxsize=ROTORS)
def _attracting_rub(rotor: Rotor) -> Equilibrium | None:
    """Return the synchronous rub that attracts sliding; with ``d = 1`` too, where it does not attract bounces."""
    return next((rub for rub in equilibria(rotor) if rub.attracts_sliding), None)


@lru_cache(maxsize=ROTORS)
def _rub_neighbourhood(rotor: Rotor) -> RubNeighbourhood | None:
    rub = _attracting_rub(rotor)
    return neighbourhood_of(rotor, rub) if rub else None


def _certain_runaway(rotor: Rotor) -> float:
    """Speed of backward whirl from which on sliding goes over to rolling that holds; infinite if there is none."""
    runaway = runaway_speed(rotor)
    return runaway.certain * (1.0 + GIVEN_UP) if runaway.reaches_rolling and rolling(rotor).holds else np.inf


def _recheck_time(rotor: Rotor) -> float:
    decay = -rotor.eigenvalues.real.max()
    return 1.0 / decay if decay > 0.0 else np.inf
