"""Follow starts until they settle, irregular ones with growing patience."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from carom.attractors.names import MotionName
from carom.attractors.starts import Start
from carom.attractors.survival import MOTIONS, Survival, follow_further, follow_until_settled, stay_low, still_irregular
from carom.base.outcome import Outcome
from carom.base.progress import Reporter
from carom.base.results import Result
from carom.disturbances import Starts
from carom.disturbances.following import follow
from carom.models import Rotor
from carom.motions.ensembles import MOST_EVENTS, Endings
from carom.motions.simulation import simulate

FIRST_PATIENCE = 1000
"""Impacts for which a motion is followed at first."""

AFFORDABLE = 2_000_000
"""Largest cost of following all irregular motions for one half-life, in impacts.

Less than for basins: single motions are simulated once more where their impulses are asked for.
"""

SLOWER = 10
"""For rotors whose motions are followed one after another: divisor of this cost, of the number of irregular motions followed, and
of the number of events after which a motion is given up."""


@dataclass(frozen=True, repr=False)
class Ending(Result):
    """Where one start ended.

    Attributes
    ----------
    attractor : MotionName
        Name of the :class:`Attractor`.
    time : float
        Time at which the outcome was known, in ``1/Ω``.
    impacts : int
        Impacts until then.
    touched : bool
        Whether the rotor met the wall, even if only during a shock or because it started there.
    survival : Survival or None
        How long irregular bouncing lasts, if the motion is irregular or was so after 1000 impacts; otherwise ``None``.
    """

    rotor: Rotor
    start: Start
    attractor: MotionName
    time: float
    impacts: int
    touched: bool
    survival: Survival | None = None

    @property
    def recovered(self) -> bool:
        """Whether it came back to levitation."""
        return self.attractor.outcome is Outcome.LEVITATED

    @cached_property
    def hardest_impulse(self) -> float:
        """Largest normal impulse until then, in ``m c_r Ω``; in a compliant wall that of a contact.

        The motion is simulated again to find it; one that is irregular for long may then take another course.
        """
        if not self.impacts:
            return 0.0
        motion = simulate(self.rotor, self.start.state, self.time)
        return max(float(seen.contacts.normal_impulse.max(initial=0.0)) for seen in motion.at_each)


def follow_in_stages(
    rotor: Rotor, starts: Starts, patience: int, threads: int | None, tell: Reporter, divisor: int = 1
) -> tuple[Endings, np.ndarray, Survival | None]:
    """Follow all starts, one-dimensional: first each for a short time, then for longer those that are still irregular.

    The lifetime of irregular motion is measured.  If it is transient, the irregular motions are followed until they
    leave it, unless that takes too long; ``divisor`` divides the effort for it.  Return the endings, which motions were
    irregular after 1000 impacts, and how long irregular motion lasts (``None`` if there was none).
    """
    seen = min(FIRST_PATIENCE, patience)
    bounded: dict[str, Any] = {"max_events": MOST_EVENTS // divisor} if divisor > 1 else {}
    first = follow(rotor, starts, patience=seen, threads=threads, progress=tell.part(0.0, 0.8), **bounded)
    endings, lasted = first, still_irregular(first)
    unsettled = lasted | stay_low(first)
    while unsettled.any() and seen < patience:
        span = min(seen, patience - seen)
        endings = follow_further(rotor, endings, unsettled, patience=span, threads=threads, **bounded)
        unsettled = still_irregular(endings) | stay_low(endings)
        seen += span
        tell(0.8 + 0.1 * min(seen / patience, 1.0))
    effort: dict[str, int] = {"affordable": AFFORDABLE // divisor, "motions": MOTIONS // divisor}
    endings, survival = follow_until_settled(rotor, endings, impacts=patience, threads=threads, earlier=first, **effort)
    tell(1.0)
    return endings, lasted, survival
