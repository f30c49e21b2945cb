"""Follow starts until they settle, irregular ones with growing patience; how long irregular motion lasts, and what a sample says of a probability.

Many irregular motions are followed, and those that leave it are counted.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np

from carom.attractors.naming import MotionName
from carom.attractors.starts import Start
from carom.base.arguments import Count, Reals, Whole, checked
from carom.base.outcome import InputError, Outcome
from carom.base.progress import Reporter
from carom.base.results import Result, record
from carom.disturbances import Starts
from carom.disturbances.following import follow
from carom.models import Rotor, Subject, rotor_of
from carom.motions import Endings, State, settle, simulate
from carom.motions.budget import NOT_FOLLOWED
from carom.motions.ensembles import MOST_EVENTS
from carom.motions.settling import REPEATING

CONFIDENCE = 0.95
MOTIONS = 200
"""Number of irregular motions that are followed."""
LOOK = 1000
"""Impacts between two looks, at which the motions that have left are counted.

The first look is not counted: until then the motions depend on their starts.
"""
LOOKS_LOW = 4
"""Looks in a row at which a motion was low on the wall, until it has left irregular bouncing: a chatter is seldom longer."""
APART = 1e-6
"""Relative change of velocity that makes several motions of one: irregular motions diverge within a look."""
ENOUGH = 5.0
"""Half-lives after which the motions that are left are taken for late ones, not for an attractor: 1 in 32 lasts longer."""
SEED = 0
HALF_LIVES = 40
"""Number of half-lives for which transient motions are followed: one in 10¹² lasts longer."""
AFFORDABLE = 20_000_000
"""Largest cost of following all irregular motions of a basin for one half-life, in impacts: seconds."""
FIRST_PATIENCE = 1000
"""Impacts for which a motion is followed at first."""

AFFORDABLE_SINGLY = 2_000_000
"""Largest cost of following all irregular motions for one half-life, in impacts.

Less than for basins: single motions are simulated once more where their impulses are asked for.
"""

SLOWER = 10
"""For rotors whose motions are followed one after another: divisor of this cost, of the number of irregular motions followed, and
of the number of events after which a motion is given up."""


@checked
def exact_interval(count: Whole, total: Whole) -> tuple[float, float]:
    """Interval that contains a probability with at least 95 % confidence, from ``count`` successes in ``total`` trials.

    C. J. Clopper, E. S. Pearson, Biometrika 26, 404 (1934): with a probability outside it so many successes, or so few, would
    be seen in less than 2.5 % of all samples.  So it covers whatever the probability is.  Wilson's interval (1927), which
    covers 95 % on average over all probabilities, covers 84 % of the samples where nearly all or nearly none succeed.
    """
    if count > total:
        raise InputError("count", count, f"at most {total}, the number of trials")
    from scipy.special import betaincinv  # type: ignore[import-untyped]

    rare = 0.5 * (1.0 - CONFIDENCE)
    low = float(betaincinv(count, total - count + 1, rare)) if count else 0.0
    high = 1.0 - float(betaincinv(total - count, count + 1, rare)) if count < total else 1.0
    return low, high


@dataclass(frozen=True)
class Survival:
    """Survival statistics of irregular motions of one machine.

    Attributes
    ----------
    motions : int
        Number of motions followed.
    impacts : int
        Number of impacts for which each was followed, unless it left before.
    died : int
        Number of motions that left for another motion.
    half_life : float or None
        Number of impacts within which half of the remaining motions leave; ``None`` if none died.
    interval : tuple of float
        Interval of the half-life with a confidence of 95 %; if none died, its lower limit and infinity.
    """

    motions: int
    impacts: int
    died: int
    half_life: float | None
    interval: tuple[float, float]

    @classmethod
    @checked
    def of(cls, motions: Whole, impacts: Whole, died: Whole, looks: Whole, left: Whole, span: Count = LOOK) -> Survival:
        """Estimate from the number of looks at motions that had not left before, and how many of these had then left.

        A motion that no longer depends on its start leaves between two looks, ``span`` impacts apart, with a probability
        ``h`` that does not depend on its age.  The interval of ``h`` is that of Clopper and Pearson (1934); the half-life
        is ``−span ln 2/ln(1 − h)``.
        """
        if left == 0:
            longest = math.inf if looks == 0 else 1.0 - (1.0 - CONFIDENCE) ** (1.0 / looks)
            return cls(motions, impacts, died, None, (_half_life(longest, span) if looks else 0.0, math.inf))
        low, high = exact_interval(left, looks)
        share = left / looks if left < looks else 1.0 - 0.5 / looks
        return cls(motions, impacts, died, _half_life(share, span), (_half_life(high, span), _half_life(low, span)))

    @property
    def transient(self) -> bool:
        """Whether the irregular motion ends, so that it is not an attractor."""
        return self.died > 0

    @property
    def verdict(self) -> Literal["not seen to end", "transient", "undecided"]:
        """What follows: a transient only if all motions ended, or if the fit explains those left after five half-lives."""
        if self.half_life is None:
            return "not seen to end"
        left = self.motions - self.died
        late = self.impacts >= ENOUGH * self.half_life and left <= self.most_left(self.impacts)
        return "transient" if left == 0 or late else "undecided"

    @checked
    def most_left(self, impacts: Count) -> float:
        """Most motions that may be left after so many impacts if all end at the rate of the fit: three deviations above the mean."""
        if self.half_life is None:
            return math.inf
        expected = self.motions * 0.5 ** (impacts / max(self.half_life, 1e-9))
        return expected + 3.0 * math.sqrt(expected)

    @property
    def words(self) -> str:
        """Summary in words: ``transient, half-life 1,600 impacts (1,300 to 2,000)``."""
        low, high = self.interval
        if self.half_life is None:
            died = f"{self.died or 'none'} of {self.motions} ended within {self.impacts:,} impacts"
            return f"{died} (half-life above {_rounded(low)} impacts at {100.0 * CONFIDENCE:.0f} %)"
        lasting = "transient" if self.verdict == "transient" else "transient or attractor, undecided"
        return f"{lasting}, half-life {_rounded(self.half_life)} impacts ({_rounded(low)} to {_rounded(high)})"


def _half_life(share: float, span: int) -> float:
    """Number of impacts within which half of the motions leave, if this share leaves between two looks."""
    return 0.0 if share >= 1.0 else -span * math.log(2.0) / math.log1p(-share)


def _rounded(number: float) -> str:
    """Format a number with two significant digits and commas between thousands."""
    if not 0.0 < number < math.inf:
        return f"{number:g}"
    unit = 10.0 ** (math.floor(math.log10(number)) - 1)
    return f"{round(number / unit) * unit:,.0f}"


def still_irregular(endings: Endings) -> np.ndarray:
    """Which motions still bounce and have not become periodic."""
    return np.isin(endings.outcomes, REPEATING) & (endings.multiplicities == 0)


def stay_low(endings: Endings) -> np.ndarray:
    """Which motions stay at the wall in low bounces: in a chatter, or in bounces that hardly fade."""
    return endings.outcomes == Outcome.LOW_BOUNCES


def measure_survival(
    rotor: Rotor,
    positions: np.ndarray,
    velocities: np.ndarray,
    *,
    begins: Reals | None = None,
    impacts: int,
    threads: int | None = None,
    motions: int = MOTIONS,
) -> Survival:
    """Follow irregular motions for a number of impacts further, and count those that leave.

    The states, shape (M,), are those just before an impact, co-rotating frame, at the times ``begins``.  If there are more than ``motions``, a random
    part is followed; if fewer, copies with slightly changed velocities are added.  A motion that only bounces low along the wall
    for longer than a chatter has left too, wherever it ends.
    """
    random = np.random.default_rng(SEED)
    places = np.resize(random.permutation(len(positions)), motions)
    change = APART * np.exp(2j * np.pi * random.random(motions))
    change = change.reshape(-1, *np.ones(velocities.ndim - 1, int))
    times = np.zeros(motions) if begins is None else np.asarray(begins)[places]
    positions, velocities = positions[places], velocities[places] * (1.0 + change)
    looks, left, low_for = [], [], np.zeros(motions, int)
    for _ in range(1 + max(1, impacts // LOOK)):
        ends = settle(rotor, State(positions, velocities, time=times), patience=LOOK, threads=threads)
        low = stay_low(ends)
        low_for = np.where(low, low_for + 1, 0)
        alive = still_irregular(ends) | (low & (low_for < LOOKS_LOW))
        # A motion that was given up has not left, but it cannot be followed any further.
        lost = int(np.count_nonzero((ends.outcomes < Outcome.LEVITATED) & ~low))
        looks.append(len(positions) - lost)
        left.append(len(positions) - lost - int(alive.sum()))
        positions, velocities, low_for = ends.positions[alive], ends.velocities[alive], low_for[alive]
        times = (ends.begins + ends.times)[alive]
        if not len(positions):
            break
    if len(looks) == 1:
        return Survival.of(looks[0], LOOK, left[0], looks[0], left[0])
    return Survival.of(looks[1], LOOK * (len(looks) - 1), sum(left[1:]), sum(looks[1:]), sum(left[1:]))


def follow_further(rotor: Rotor, endings: Endings, chosen: np.ndarray, **limits: Any) -> Endings:
    """Follow chosen motions of an ensemble, bool of its shape, from where they are; times and impacts are added up.

    Those that the events of a question do not suffice for stay as they are.
    """
    before = endings[chosen]
    reached = before.begins + before.times
    further = settle(rotor, State(before.positions, before.velocities, time=reached), **limits)
    whole = {name: values.copy() for name, values in vars(endings).items()}
    followed = further.outcomes != NOT_FOLLOWED
    places, further = tuple(each[followed] for each in np.nonzero(chosen)), further[followed]
    for name, values in vars(further).items():
        whole[name][places] = values + (whole[name][places] if name in ("times", "impacts") else 0)
    whole["begins"] = endings.begins.copy()
    return Endings(**whole)


@checked
def follow_until_settled(
    machine: Subject,
    endings: Endings,
    *,
    impacts: Count,
    threads: Count | None = None,
    earlier: Endings | None = None,
    affordable: Whole = AFFORDABLE,
    motions: Count = MOTIONS,
) -> tuple[Endings, Survival | None]:
    """Follow irregular motions of an ensemble until they settle, if they do.

    Parameters
    ----------
    impacts : int
        Number of impacts for which irregular motions are followed to measure how long they last.
    threads : int, optional
        By default the number of available cores; the result does not depend on it.
    earlier : Endings, optional
        The same motions at an earlier time, from which the survival is measured if none is irregular now.
    affordable : int
        Largest cost of following all irregular motions for one half-life, in impacts.
    motions : int
        Number of motions from which the survival is measured.

    Returns
    -------
    Endings
        Updated for every motion that was followed further; those that would take too long to follow are unchanged.
    Survival or None
        ``None`` if none of the motions is irregular.
    """
    rotor, irregular = rotor_of(machine), still_irregular(endings)
    met, at = (irregular, endings) if irregular.any() or earlier is None else (still_irregular(earlier), earlier)
    if not met.any():
        return endings, None
    met_at = at[met]
    survival = measure_survival(
        rotor,
        met_at.positions,
        met_at.velocities,
        begins=met_at.begins + met_at.times,
        impacts=impacts,
        threads=threads,
        motions=motions,
    )
    if survival.half_life is None:
        return endings, survival
    span = max(LOOK, int(survival.half_life))
    for _ in range(HALF_LIVES):
        if not irregular.any() or np.count_nonzero(irregular) * span > affordable:
            break
        endings = follow_further(rotor, endings, irregular, patience=span, threads=threads)
        irregular = still_irregular(endings)
    return endings, survival


@checked
def document_of(survival: Survival | None) -> dict[str, object]:
    """Document of the survival for JSON; without a survival the motion is not irregular."""
    if survival is None:
        return {"transient": False, "half_life_impacts": None}
    half_life = record(survival, "half_life_impacts=half_life half_life_interval_impacts=interval")
    return {"transient": survival.transient, **half_life, "survival": survival.words}


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
    most = MOST_EVENTS // divisor
    first = follow(rotor, starts, patience=seen, threads=threads, max_events=most, progress=tell.part(0.0, 0.8))
    endings, lasted = first, still_irregular(first)
    unsettled = lasted | stay_low(first)
    while unsettled.any() and seen < patience:
        span = min(seen, patience - seen)
        endings = follow_further(rotor, endings, unsettled, patience=span, threads=threads, max_events=most)
        unsettled = still_irregular(endings) | stay_low(endings)
        seen += span
        tell(0.8 + 0.1 * min(seen / patience, 1.0))
    affordable, motions = AFFORDABLE_SINGLY // divisor, MOTIONS // divisor
    endings, survival = follow_until_settled(
        rotor, endings, impacts=patience, threads=threads, earlier=first, affordable=affordable, motions=motions
    )
    tell(1.0)
    return endings, lasted, survival
