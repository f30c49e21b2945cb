"""What is known exactly about where motions of a model end: asked for here, so that general code need not ask which it is.

Nothing is known of a model that is not registered; its motions are followed until they have settled.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache, singledispatch

import numpy as np

from carom.closed_forms.absorbing import GIVEN_UP, RubNeighbourhood, neighbourhood_of
from carom.closed_forms.equilibria import Equilibrium, find_equilibria
from carom.closed_forms.fading import fading_speed
from carom.closed_forms.whirl import hastening_speed, rolling, runaway_speed
from carom.models import Jeffcott, Model

ROTORS = 64
"""Size of the cache, one entry per rotor: there are many motions of few rotors."""


@dataclass(frozen=True)
class Known:
    """What is known of a model."""

    rubs: bool = False
    """Whether its synchronous rubs are known."""
    rub: Equilibrium | None = None
    """The synchronous rub that attracts sliding, also for ``d = 1``, where it does not attract bouncing."""
    around: RubNeighbourhood | None = None
    """A neighbourhood of that rub which sliding never leaves."""
    runaway: float = np.inf
    """Speed of backward whirl beyond which sliding is certain to run away to lasting rolling; infinite if there is none."""
    fading: float = 0.0
    """Speed after an impact that has stopped the slip up to which bounces are certain to fade to lasting rolling; 0 if there is none."""
    hastening: float = np.inf
    """Speed of whirl in the fixed frame beyond which sliding is certain to gain speed for ever; infinite if there is none."""
    rolling_force: float = 0.0
    """Largest normal force over a turn of rolling; 0 where that is not known."""


@singledispatch
def known_of(model: Model) -> Known:
    """What is known of a model."""
    return Known()


@known_of.register
@lru_cache(maxsize=ROTORS)
def _of_planar_rotor(model: Jeffcott) -> Known:
    rub = next((rub for rub in find_equilibria(model) if rub.attracts_sliding), None)
    whirl = runaway_speed(model)
    rolls = rolling(model)
    return Known(
        rubs=True,
        rub=rub,
        around=neighbourhood_of(model, rub) if rub else None,
        runaway=whirl.certain * (1.0 + GIVEN_UP) if whirl.reaches_rolling and rolls.holds else np.inf,
        fading=fading_speed(model),
        hastening=hastening_speed(model) * (1.0 + GIVEN_UP),
        rolling_force=rolls.largest_force,
    )
