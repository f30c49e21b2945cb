"""Attractors found by simulation along a parameter: what a diagram of known motions leaves out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from carom.attractors import Attractor, DisturbanceSet, find_attractors
from carom.bifurcations.axes import vary
from carom.outcome import Outcome
from carom.parameters import Parameters
from carom.rotors import Rotor, jeffcott
from carom.trajectories import simulate

__all__ = ["VALUES", "AttractorSample", "sample_attractors"]

VALUES = 31
"""Values of the parameter at which disturbances are followed."""
SHOWN_IMPACTS = 60
LONGEST = 400.0
BOUNCES = (Outcome.BOUNCING, Outcome.MIXED)


@dataclass(frozen=True, eq=False)
class AttractorSample:
    """An attractor at one value of the parameter.

    Attributes
    ----------
    value : float
        Of the parameter, in SI units if it is physical.
    name : str
        That of :class:`~carom.attractors.Attractor`: ``"levitation"``, ``"B1,d"``, ``"irregular bouncing"``, ``"rolling"``, …
    outcome : str
        Label of its :class:`~carom.outcome.Outcome`.
    whirl : str
        ``"forward"``, ``"backward"`` or ``"none"`` in the fixed frame.
    count : int
        Disturbances that end on it.
    share : float
        The same as a share of all disturbances followed at this value.
    known : int
        Starts next to a motion known in closed form that end on it; they are no disturbances.
    radial_speeds : ndarray
        Of its impacts (at most 60), in ``c_r Ω``; empty without impacts.
    """

    value: float
    name: str
    outcome: str
    whirl: str
    count: int
    share: float
    known: int
    radial_speeds: np.ndarray

    @property
    def met(self) -> bool:
        """Whether a disturbance ends on it, not only a start next to it."""
        return self.count > 0


def sample_attractors(
    parameters: Parameters,
    parameter: str,
    interval: tuple[float, float],
    disturbances: DisturbanceSet,
    *,
    values: int = VALUES,
    progress: Callable[[float], None] | None = None,
) -> tuple[AttractorSample, ...]:
    """Follow disturbances to where they settle, at evenly spaced values of a parameter.

    Parameters
    ----------
    parameters : Parameters
    parameter : str
    interval : tuple of float
    disturbances : DisturbanceSet
        Those followed at each value.  Starts next to every known motion are followed besides; they count for no share.
    values : int
    progress : callable, optional
        Called with the share done.

    Returns
    -------
    tuple of AttractorSample
        In growing order of the parameter.  Motions that were given up are left out.
    """
    tell = progress or (lambda _: None)
    found: list[AttractorSample] = []
    for done, value in enumerate(np.linspace(*interval, values).tolist()):
        rotor = jeffcott(vary(parameters, parameter, value))
        attractors = find_attractors(
            rotor, seed=disturbances.seed, count=disturbances.count, fastest=disturbances.fastest
        )
        found += [_sample(value, rotor, each) for each in attractors if each.settled]
        tell((done + 1) / values)
    return tuple(found)


def _sample(value: float, rotor: Rotor, found: Attractor) -> AttractorSample:
    return AttractorSample(
        value,
        found.name,
        found.outcome.label,
        found.whirl,
        found.count,
        found.share,
        found.known,
        _impacts(rotor, found),
    )


def _impacts(rotor: Rotor, attractor: Attractor) -> np.ndarray:
    """Radial speeds of the impacts on an attractor, one period's of a periodic one."""
    if attractor.outcome not in BOUNCES:
        return np.empty(0)
    log = simulate(rotor, attractor.state, LONGEST, max_events=50 * SHOWN_IMPACTS).contacts
    speeds = log.radial_speed[:SHOWN_IMPACTS]
    return speeds[-attractor.multiplicity :] if 0 < attractor.multiplicity <= len(speeds) else speeds
