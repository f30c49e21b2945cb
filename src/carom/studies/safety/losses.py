"""Search for disturbances that are lost at high damping, with fresh samples and with variants of starts lost before.

With growing damping the share of lost disturbances becomes very small before it vanishes, so a sample alone gives a
limit that is too low.  Lost starts are therefore varied, within the limits of the disturbances, and followed at higher
and higher damping until no variant is lost.  Starts that all end in motions whose end is known, the synchronous rub and
orbits with one impact a period, are varied just above that end at once.  Finally, fresh disturbances check the result.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from carom.attractors import DisturbanceSet, MotionName
from carom.attractors.naming import name_motions
from carom.basins.shares import CONFIDENCE, Share
from carom.disturbances.following import follow
from carom.models import Jeffcott, Subject, jeffcott_of
from carom.motions.ensembles import Endings, settle
from carom.motions.settling import PATIENCE
from carom.outcome import Outcome
from carom.parameters import Parameters
from carom.results import Result

FIRST_LOOK = 256
"""Number of disturbances of a sample that are followed first; the others follow only if none of these is lost."""
VARIANTS = 768
"""Number of variants of lost starts that are followed at each damping of the upward search."""
KEPT = 64
"""Largest number of lost starts that are varied."""
FINEST = 1e-5
"""Least size of a change, relative to the clearance and to the largest speed; the greatest is one."""
FIRST_STEP, GROWTH, LAST_STEP = 0.08, 1.5, 2e-3
"""Relative steps of damping in the upward search: the first, their factor of growth, and the least."""
SLOW = 4e-3
"""Relative distance above the fold of a motion: within it others stay near the vanished one for thousands of turns."""


@dataclass(frozen=True)
class DampingCheck:
    """A fresh sample of disturbances at one damping.

    Attributes
    ----------
    gamma : float
    lost : int
        Number of disturbances that did not come back to levitation.
    sample : DisturbanceSet
        The disturbances tried.
    """

    gamma: float
    lost: int
    sample: DisturbanceSet

    @property
    def share_below(self) -> float:
        """Largest share that may be lost at this damping, at 95 % confidence.

        If none is lost, this is the share at which that has a probability of 5 %, ``1 − 0.05^(1/n)``; otherwise the
        upper end of the interval of :class:`~carom.basins.Share`.
        """
        if self.lost:
            return Share.of(self.lost, self.sample.count, drawn=True).high
        return -math.expm1(math.log(1.0 - CONFIDENCE) / self.sample.count)


def try_disturbances(
    machine: Subject, sample: DisturbanceSet, threads: int | None = None, patience: int = PATIENCE
) -> DampingCheck:
    """Follow all disturbances of a sample, and count those that do not come back."""
    rotor = jeffcott_of(machine)
    endings = follow(rotor, sample.starts(rotor), patience=patience, threads=threads)
    return DampingCheck(rotor.parameters.gamma, sample.count - endings.count(Outcome.LEVITATED), sample)


@dataclass(frozen=True, eq=False, repr=False)
class Loss(Result):
    """Starts that were lost at one damping."""

    rotor: Jeffcott
    """The rotor with that damping."""
    kicked: np.ndarray
    """Which starts are kicks of the levitating rotor.  Shape (n,), bool."""
    positions: np.ndarray
    velocities: np.ndarray
    """The starts, co-rotating frame.  Shape (n,), complex."""
    endings: Endings

    @property
    def gamma(self) -> float:
        """The damping."""
        return self.rotor.parameters.gamma

    @property
    def motion(self) -> MotionName:
        """Name of the motion in which the first start ended."""
        _, names = name_motions(self.rotor, self.endings[:1])
        return names[0]

    def __len__(self) -> int:
        return len(self.kicked)

    def __getitem__(self, chosen: np.ndarray) -> Loss:
        """Return some of the starts."""
        kicked, positions, velocities = self.kicked[chosen], self.positions[chosen], self.velocities[chosen]
        return Loss(self.rotor, kicked, positions, velocities, self.endings[chosen])

    @property
    def ways(self) -> dict[tuple[Outcome, bool], Loss]:
        """The starts grouped by their outcome, and by whether they end on an orbit with one impact a period."""
        outcomes = self.endings.outcomes
        groups = [(code, once) for code in np.unique(outcomes).tolist() for once in (False, True)]
        found = {(Outcome(code), once): self[(outcomes == code) & (self.once == once)] for code, once in groups}
        return {way: loss for way, loss in found.items() if len(loss)}

    @property
    def once(self) -> np.ndarray:
        """Which starts end on an orbit with one impact a period."""
        once: np.ndarray = (self.endings.outcomes == Outcome.BOUNCING) & (self.endings.multiplicities == 1)
        return once

    def onward(self, fastest: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the starts, and those of their final states that are not faster than allowed, as further starts."""
        slow = np.abs(self.endings.velocities) <= fastest
        return (
            np.concatenate([self.kicked, np.zeros(slow.sum(), bool)]),
            np.concatenate([self.positions, self.endings.positions[slow]]),
            np.concatenate([self.velocities, self.endings.velocities[slow]]),
        )


class Losses:
    """Follows disturbances and variants of lost ones, at any damping of a machine.

    The sample has the number of disturbances at each damping, the seed of all random numbers, and the largest speed.
    ``rub_limit`` and ``orbit_limit`` are the dampings up to which a synchronous rub, and orbits with one impact a period,
    are known to exist; 0 if none is known.
    """

    def __init__(
        self,
        parameters: Parameters,
        sample: DisturbanceSet,
        rub_limit: float,
        orbit_limit: float,
        threads: int | None,
    ) -> None:
        self.parameters, self.sample, self.threads = parameters, sample, threads
        self.rub_limit, self.orbit_limit = rub_limit, orbit_limit
        # Fresh samples do not depend on how many variants were tried before.
        seeds = np.random.SeedSequence(sample.seed).spawn(2)
        self.random, self.variation = np.random.default_rng(seeds[0]), np.random.default_rng(seeds[1])

    def fresh(self, gamma: float, count: int) -> DampingCheck | Loss:
        """Follow a new sample; return the lost starts as soon as there are any, otherwise the check."""
        sample = DisturbanceSet(count, self._new_seed(), self.sample.fastest)
        rotor = self._rotor(gamma)
        starts = sample.starts(rotor)
        kicked = np.arange(count) < sample.kicks(rotor)
        order = self.random.permutation(count)
        for portion in (order[:FIRST_LOOK], order[FIRST_LOOK:]):
            found = self._lost(rotor, kicked[portion], starts.positions[portion], starts.velocities[portion])
            if found is not None:
                return found
        return DampingCheck(gamma, 0, sample)

    def faster(self, gamma: float, count: int, times: float) -> DampingCheck:
        """Follow disturbances that may be ``times`` as fast."""
        sample = DisturbanceSet(count, self._new_seed(), times * self.sample.fastest)
        return try_disturbances(self._rotor(gamma), sample, self.threads)

    def climb(self, lost: Loss, highest: float) -> Loss:
        """Vary lost starts at higher and higher damping; return those lost at the highest."""
        step = FIRST_STEP
        while step > LAST_STEP and lost.gamma < highest:
            gamma, end = lost.gamma * (1.0 + step), self._known_end(lost)
            if end > lost.gamma:
                gamma = end * (1.0 + SLOW)
            elif self.rub_limit < gamma < self.rub_limit * (1.0 + SLOW):
                gamma = self.rub_limit * (1.0 + SLOW)
            found = self.vary(lost, min(gamma, highest))
            if found is not None:
                lost, step = found, step * GROWTH
            elif end > lost.gamma:
                return lost
            else:
                step /= 2.0
        return lost

    def _known_end(self, lost: Loss) -> float:
        """Damping up to which the motions on which these starts end are known to exist; 0 unless known of all."""
        rubs = lost.endings.outcomes == Outcome.FORWARD_RUB
        if not (rubs | lost.once).all():
            return 0.0
        return max(self.rub_limit if rubs.any() else 0.0, self.orbit_limit if lost.once.any() else 0.0)

    def vary(self, lost: Loss, gamma: float) -> Loss | None:
        """Follow lost starts and their variants at another damping; return those that are lost there too.

        Starts that end in the synchronous rub where it is known to exist are left out: its limit is known in closed
        form.
        """
        rotor = self._rotor(gamma)
        kicked, positions, velocities = lost.onward(self.sample.fastest)
        kept = self.variation.permutation(len(kicked))[:KEPT]
        chosen = np.concatenate([kept, self.variation.choice(kept, VARIANTS)])
        sizes = np.exp(self.variation.uniform(math.log(FINEST), 0.0, len(chosen)))
        sizes[: len(kept)] = 0.0
        changes = self.variation.standard_normal((4, len(chosen))) * sizes
        kicked = kicked[chosen]
        positions = _within(positions[chosen] + (changes[0] + 1j * changes[1]), 1.0)
        fastest = self.sample.fastest
        velocities = _within(velocities[chosen] + fastest * (changes[2] + 1j * changes[3]), fastest)
        if abs(rotor.equilibrium) >= 1.0:
            kicked = np.zeros_like(kicked)
        return self._lost(rotor, kicked, np.where(kicked, rotor.equilibrium, positions), velocities, self.rub_limit)

    def _new_seed(self) -> int:
        return int(self.random.integers(2**32))

    def _rotor(self, gamma: float) -> Jeffcott:
        return Jeffcott(self.parameters.replace(gamma=gamma))

    def _lost(
        self, rotor: Jeffcott, kicked: np.ndarray, positions: np.ndarray, velocities: np.ndarray, explained: float = 0.0
    ) -> Loss | None:
        """Follow starts; return those that did not come back, or ``None``."""
        if not len(kicked):
            return None
        endings = settle(rotor, positions, velocities, threads=self.threads)
        lost = endings.outcomes != Outcome.LEVITATED
        gamma = rotor.parameters.gamma
        if gamma <= explained:
            lost &= endings.outcomes != Outcome.FORWARD_RUB
        if not lost.any():
            return None
        return Loss(rotor, kicked[lost], positions[lost], velocities[lost], endings[lost])


def _within(points: np.ndarray, radius: float) -> np.ndarray:
    """Move points outside a disc radially onto its edge."""
    sizes = np.abs(points) / radius
    return points / np.maximum(sizes * (1.0 + 1e-15), 1.0)
