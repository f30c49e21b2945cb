"""How fast disturbed motions return to an attractor, or separate on it."""

from __future__ import annotations

import math

import numpy as np

from carom.attractors.groups import Attractor
from carom.base.arguments import Count, checked
from carom.base.outcome import CaromError, Outcome
from carom.closed_forms.equilibria import find_equilibria
from carom.models import Rotor, Subject, rotor_of
from carom.orbits.exponents import LyapunovExponents, lyapunov_exponents, orbit_exponents

MEASURED = 20_000
"""Impacts from which exponents of irregular bouncing are measured."""
APPROACHED = 1e-6
"""Distance from a synchronous rub below which a motion is at it."""


@checked
def exponents_of(machine: Subject, attractor: Attractor, impacts: Count = MEASURED) -> LyapunovExponents | None:
    """Lyapunov exponents of an attractor: from the modes of levitation, the eigenvalues of a rub, or the multipliers of its orbit.

    Those of irregular bouncing are measured on one motion, with standard errors.  ``None`` where they are not known.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        That of :func:`~carom.attractors.find_attractors`.
    attractor : Attractor
    impacts : int
        Impacts from which exponents of irregular bouncing are measured.
    """
    rotor, name = rotor_of(machine), attractor.name
    if name.outcome is Outcome.LEVITATED:
        return _exact(np.repeat(rotor.system.exponents.real, 2))
    if name.irregular:
        try:
            return lyapunov_exponents(rotor, attractor.state, impacts)
        except CaromError:
            return None
    if attractor.orbit is not None:
        return orbit_exponents(attractor.orbit) if attractor.orbit.admissible else None
    if name.outcome is Outcome.ROLLING:
        return _rolling(rotor, attractor)
    return _rubbing(rotor, attractor) if name.outcome is Outcome.FORWARD_RUB and not name.drifting else None


def _exact(rates: np.ndarray, along: float = math.nan, time: float = math.inf) -> LyapunovExponents:
    return LyapunovExponents(np.sort(rates)[::-1], np.zeros(len(rates)), along, float(rates.sum()), 0, 0, time)


def _rolling(rotor: Rotor, attractor: Attractor) -> LyapunovExponents | None:
    """Exponents of rolling that leaves nothing of a disturbance but a delay, as that of the planar rotor on a rigid wall does."""
    # On an elastic wall bounces fade at a finite rate.
    if not rotor.has_closed_forms or attractor.period is None or rotor.system.arrays.restitution[0] == 1.0:
        return None
    return _exact(np.array([0.0, -np.inf, -np.inf, -np.inf]), 0.0, attractor.period)


def _rubbing(rotor: Rotor, attractor: Attractor) -> LyapunovExponents | None:
    """Exponents of sliding next to a synchronous rub; the directions off the wall have none."""
    for rub in find_equilibria(rotor)[1:] if rotor.system.forced is None else ():
        if np.abs(np.atleast_1d(rub.position) - np.atleast_1d(attractor.state.position)).max() < APPROACHED:
            rates = np.array([complex(value).real for value in rub.eigenvalues])
            return _exact(np.append(rates, np.full(2 * len(rotor.system.exponents) - len(rates), -np.inf)))
    return None
