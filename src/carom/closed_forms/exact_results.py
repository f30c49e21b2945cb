"""Exact results on where motions end, for the models that have some: levitation apart, only the planar rotor.

General code asks :func:`exact_results` and does the same for every model; without exact results motions are followed until they settle.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from carom.closed_forms.absorbing import GIVEN_UP, RubNeighbourhood, neighbourhood_of
from carom.closed_forms.equilibria import Equilibrium, find_equilibria
from carom.closed_forms.thresholds import largest_response
from carom.closed_forms.whirl import Rolling, Runaway, fading_speed, hastening_speed, rolling, runaway_speed
from carom.models import Rotor, jeffcott
from carom.parameters import Parameters

ROTORS = 64
"""Size of the cache, one entry per rotor: there are many motions of few rotors."""


@dataclass(frozen=True)
class ExactResults:
    """Exact results of a model; the default values say that there are none."""

    rubs: bool = False
    """Whether all its synchronous rubs have closed forms."""
    orbits: bool = False
    """Whether all its orbits with one impact a period, and rolling, have closed forms."""
    rub: Equilibrium | None = None
    """The synchronous rub that attracts sliding, also for ``d = 1``, where it does not attract bouncing."""
    around: RubNeighbourhood | None = None
    """A neighbourhood of that rub which sliding never leaves."""
    runaway: float = np.inf
    """Backward whirl speed from which a sliding rotor goes over to rolling that lasts; infinite if there is none."""
    fading: float = 0.0
    """Rebound speed, after an impact that stops the slip, up to which the bounces die out in rolling that lasts; 0 if there is none."""
    hastening: float = np.inf
    """Whirl speed in the fixed frame from which a sliding rotor speeds up without bound; infinite if there is none."""
    rolls: Rolling | None = None
    """Rolling on the bearing in backward whirl; ``None`` without a closed form."""
    whirl: Runaway | None = None
    """Speeds from which backward whirl runs away; ``None`` without a closed form."""
    response: float | None = None
    """Largest deviation from levitation after a kick of speed 1; ``None`` without a closed form."""

    @property
    def rolling_force(self) -> float:
        """Largest normal force over a turn of rolling; 0 without a closed form."""
        return self.rolls.largest_force if self.rolls else 0.0


def exact_results(rotor: Rotor) -> ExactResults:
    """Exact results of a rotor."""
    return _of(rotor.planar) if rotor.has_closed_forms and rotor.planar is not None else NONE


NONE = ExactResults()


@lru_cache(maxsize=ROTORS)
def _of(parameters: Parameters) -> ExactResults:
    model = jeffcott(parameters)
    rub = next((rub for rub in find_equilibria(model) if rub.attracts_sliding), None)
    whirl = runaway_speed(model)
    rolls = rolling(model)
    return ExactResults(
        rubs=True,
        orbits=True,
        rub=rub,
        around=neighbourhood_of(model, rub) if rub else None,
        runaway=whirl.certain * (1.0 + GIVEN_UP) if whirl.reaches_rolling and rolls.holds else np.inf,
        fading=fading_speed(model),
        hastening=hastening_speed(model) * (1.0 + GIVEN_UP),
        rolls=rolls,
        whirl=whirl,
        response=largest_response(parameters.gamma, parameters.omega),
    )
