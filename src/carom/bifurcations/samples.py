"""Attractors found by simulation along a parameter, including those that a diagram of known motions lacks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.attractors import Attractor, AttractorSet, DisturbanceSet, Survival, find_attractors
from carom.attractors.settled import seen_in_contact
from carom.base.arguments import Count, checked
from carom.base.outcome import IRREGULAR_BOUNCING, Outcome
from carom.base.progress import Reporter, ShowProgress
from carom.base.results import Result
from carom.disturbances import Plan
from carom.models import Rotor, Subject, rotor_of
from carom.models.axes import Ends, axis, read_interval
from carom.motions.settling import REPEATING
from carom.motions.simulation import simulate

VALUES = 31
"""Values of the parameter at which disturbances are followed."""
SHOWN_IMPACTS = 60
SHOWN_TIME = 400.0


@dataclass(frozen=True, eq=False, repr=False)
class AttractorSample(Result):
    """An attractor at one value of the parameter.

    Attributes
    ----------
    value : float
        Value of the parameter, in SI units if it is physical.
    name : str
        Name as in :class:`~carom.attractors.Attractor`: ``"levitation"``, ``"B1,d"``, ``"irregular bouncing"``,
        ``"rolling"``, …
    outcome : str
        Label of its :class:`~carom.base.outcome.Outcome`.
    whirl : str
        ``"forward"``, ``"backward"`` or ``"none"`` in the fixed frame.
    count : int
        Number of disturbances that end on it.
    share : float
        The same as a share of all disturbances followed at this value.
    known : int
        Number of starts next to a motion known in closed form that end on it; these are not disturbances.
    radial_speeds : ndarray
        Radial speeds of its impacts (at most 60), in ``c_r Ω``; empty without impacts.
    survival : Survival or None
        How long it lasts, if it is irregular bouncing.
    """

    value: float
    name: str
    outcome: str
    whirl: str
    count: int
    share: float
    known: int
    radial_speeds: np.ndarray
    survival: Survival | None = None

    @property
    def irregular(self) -> bool:
        """Whether it is irregular bouncing, with or without rub."""
        return self.survival is not None

    @property
    def transient(self) -> bool:
        """Whether it is not an attractor but irregular bouncing that ends."""
        return self.survival is not None and self.survival.transient

    @property
    def met(self) -> bool:
        """Whether a disturbance ends on it, not only a start next to it."""
        return self.count > 0


@checked
def sample_attractors(
    machine: Subject,
    parameter: str,
    interval: Ends,
    disturbances: DisturbanceSet | Plan,
    *,
    values: Count = VALUES,
    progress: ShowProgress = None,
) -> tuple[AttractorSample, ...]:
    """Follow disturbances until they settle, at evenly spaced values of a parameter.

    Parameters
    ----------
    disturbances : DisturbanceSet, Grid or Sample
        Disturbances of the machine, followed at each value; they keep their size in SI units.  Starts next to every known motion are followed too, but do not count for
        the shares.

    Returns
    -------
    tuple of AttractorSample
        In ascending order of the parameter.  Motions that were given up are left out.  Irregular bouncing that ends is
        ``"irregular bouncing"``, with the share of the disturbances that were in it for 1000 impacts or more.
    """
    model, tell = rotor_of(machine), Reporter.of(progress, "following disturbances")
    along = axis(model, parameter)
    found: list[AttractorSample] = []
    for done, value in enumerate(np.linspace(*read_interval(along, interval), values).tolist()):
        rotor = along.move(model, value)
        attractors = find_attractors(rotor, disturbances.rescaled(model.scales, rotor.scales))
        found += [_sample(value, rotor, each) for each in attractors if each.settled]
        found += _transient(value, attractors)
        tell((done + 1) / values)
    return tuple(found)


def _sample(value: float, rotor: Rotor, found: Attractor) -> AttractorSample:
    return AttractorSample(
        value,
        found.name,
        found.name.outcome.label,
        found.whirl,
        found.count,
        found.share_of_disturbances,
        found.known,
        _impacts(rotor, found),
        found.survival,
    )


def _transient(value: float, found: AttractorSet) -> list[AttractorSample]:
    """Irregular bouncing that was seen to end."""
    if found.transient is None:
        return []
    through = sum(ending.survival is not None for ending in found.disturbances)
    known = sum(ending.survival is not None for ending in found.endings) - through
    share = through / len(found.disturbances) if found.disturbances else 0.0
    label = Outcome.BOUNCING.label
    return [
        AttractorSample(value, IRREGULAR_BOUNCING, label, "none", through, share, known, np.empty(0), found.transient)
    ]


def _impacts(rotor: Rotor, attractor: Attractor) -> np.ndarray:
    """Radial speeds of the impacts on an attractor, or of arrivals at a compliant wall; for a periodic one those of one period."""
    if attractor.name.outcome not in REPEATING:
        return np.empty(0)
    motion = simulate(rotor, attractor.state, SHOWN_TIME, max_events=50 * SHOWN_IMPACTS)
    seen = seen_in_contact(motion)
    speeds = seen.contacts.radial_speed[:SHOWN_IMPACTS]
    return speeds[-attractor.name.multiplicity :] if attractor.name.multiplicity <= len(speeds) else speeds
