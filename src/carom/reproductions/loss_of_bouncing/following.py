"""All that the figure shows: branches of orbits, and simulated bouncing at many dampings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from carom.bifurcations import Diagram, OrbitBranch, find_bifurcations
from carom.bifurcations.several import lies_on
from carom.bifurcations.words import continue_orbit
from carom.models import jeffcott
from carom.progress import Reporter, ShowProgress, shows_progress
from carom.reproductions.loss_of_bouncing.samples import BouncingSample, sample_bouncing
from carom.reproductions.mora2014 import machine_at
from carom.results import Result

RANGE = (0.0785, 0.095)
"""Damping: from bouncing that ends after a few hundred impacts up to where ``B1,d`` is stable."""
MOST_IMPACTS = 12
"""Most impacts a period of the branches on which motions settled."""
CLOSE = (0.0795, 0.0836)
"""Part of it that is looked at closely: from the loss of bouncing up to the period doubling."""


@dataclass(frozen=True, eq=False, repr=False)
class LossOfBouncing(Result):
    """The loss of bouncing of the source paper's machine along the damping.

    Attributes
    ----------
    diagram : Diagram
        Orbits with up to some impacts a period.
    windows : tuple of OrbitBranch
        Branches of orbits with more impacts, up to 12, on which simulated motions settled.
    samples : tuple of BouncingSample
        Over the whole range, in ascending order.
    close : tuple of BouncingSample
        Over the part looked at closely.
    """

    shown: ClassVar[tuple[str, ...]] = ("diagram", "lost")

    diagram: Diagram
    windows: tuple[OrbitBranch, ...]
    samples: tuple[BouncingSample, ...]
    close: tuple[BouncingSample, ...]

    @property
    def every(self) -> list[BouncingSample]:
        """All samples, in ascending order of the damping."""
        return sorted((*self.samples, *self.close), key=lambda sample: sample.gamma)

    @property
    def lost(self) -> tuple[float, float]:
        """Dampings between which bouncing was lost: the largest sampled at which motions ended, the next at which none did."""
        ending = [sample.gamma for sample in self.every if _ends(sample)]
        low = max(ending, default=float("nan"))
        return low, min((sample.gamma for sample in self.every if sample.gamma > low), default=float("nan"))


def _ends(sample: BouncingSample) -> bool:
    """Whether motions stopped bouncing, and did not only become periodic."""
    ends = sample.lifetimes.destinations
    return any("bouncing" not in end and end in _OTHERS for end in ends)


_OTHERS = ("rolling", "levitated", "forward-rub", "backward-whirl")


@shows_progress
def follow_loss(
    *,
    impacts: int = 4,
    values: int = 100,
    close: int = 206,
    motions: int = 40,
    patience: int = 20_000,
    progress: ShowProgress = None,
) -> LossOfBouncing:
    """Compute what the figure shows.

    Parameters
    ----------
    impacts : int
        Largest number of impacts a period of the orbits searched and followed.
    values, close : int
        Numbers of dampings over the whole range, and over the part looked at closely.
    motions, patience : int
        Number of motions simulated at each, and impacts for which each is followed.
    """
    tell = Reporter.of(progress, "following orbits")
    diagram = find_bifurcations(machine_at(0.1), "gamma", RANGE, impacts=impacts)
    tell(0.2)
    found: list[tuple[BouncingSample, ...]] = []
    for part, limits, count in ((tell.part(0.2, 0.5), RANGE, values), (tell.part(0.5, 1.0), CLOSE, close)):
        samples = []
        for done, gamma in enumerate(np.linspace(*limits, count).tolist()):
            samples.append(sample_bouncing(jeffcott(machine_at(gamma)), motions=motions, impacts=patience))
            part((done + 1) / count, "simulating")
        found.append(tuple(samples))
    return LossOfBouncing(diagram, _windows((*found[0], *found[1]), impacts), *found)


def _windows(samples: tuple[BouncingSample, ...], impacts: int) -> tuple[OrbitBranch, ...]:
    """Branches through the orbits on which motions settled and that have too many impacts for the search."""
    branches: list[OrbitBranch] = []
    for sample in samples:
        orbit = sample.orbit
        if orbit is None or not max(impacts, 1) < orbit.impacts <= MOST_IMPACTS:
            continue
        if not any(lies_on(orbit, sample.gamma, branch) for branch in branches):
            branches.append(continue_orbit(orbit, "gamma", RANGE, virtual=False))
    return tuple(branches)
