"""Disturbances followed to where they end, many at once, of one machine or of several."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from carom.disturbances.coordinates import Starts
from carom.models import Jeffcott
from carom.motions.ensembles import Endings, settle
from carom.outcome import InputError, Outcome

__all__ = ["NO_START", "follow", "require_start"]

NO_START = -1
"""Outcome of a disturbance without a start: it lies outside the wall, or the rotor could not levitate before."""


def follow(
    machine: Jeffcott | Sequence[Jeffcott], starts: Starts, *, which: np.ndarray | None = None, **limits: Any
) -> Endings:
    """Follow all starts that exist and are decided; see :func:`~carom.motions.ensembles.settle`.

    Parameters
    ----------
    machine : Jeffcott or sequence of Jeffcott
    starts : Starts
    which : ndarray of int, optional
        With a sequence: the index of the machine of each start, of their shape.
    **limits
        Of :func:`~carom.motions.ensembles.settle`.

    Returns
    -------
    Endings
        Of the shape of the starts.  Outcomes are ``NO_START`` where there is no start, and ``GRAZING`` where it is
        undecided; all other numbers are zero there.
    """
    chosen = starts.exists & ~starts.undecided
    machines = None if which is None else which[chosen]
    found = settle(machine, starts.positions[chosen], starts.velocities[chosen], which=machines, **limits)
    whole = {}
    for name, values in vars(found).items():
        whole[name] = np.zeros(chosen.shape, values.dtype)
        whole[name][chosen] = values
    whole["outcomes"][starts.undecided] = Outcome.GRAZING
    whole["outcomes"][~starts.exists] = NO_START
    return Endings(**whole)


def require_start(rotor: Jeffcott, starts: Starts) -> None:
    """Refuse disturbances of which none is possible.

    Raises
    ------
    InputError
        None of the starts exists.
    """
    if not starts.exists.any():
        raise InputError(
            "disturbance",
            f"|U*| = {abs(rotor.equilibrium):.6g}",
            "one that is possible: out of levitation inside the wall (|U*| < 1), or a start inside the wall",
        )
