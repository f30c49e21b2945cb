"""After how many impacts motions stop bouncing irregularly, and whether that shows a transient."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar, Literal

import numpy as np

from carom.arguments import Count, Seed, Whole, checked, whole
from carom.attractors.names import MotionName
from carom.attractors.starts import DisturbanceSet, disturbances_of
from carom.attractors.survival import ENOUGH, Survival, still_irregular
from carom.disturbances import Plan
from carom.models import Rotor, Subject, rotor_of
from carom.motions.ensembles import settle
from carom.motions.settling import CHATTER, PATIENCE, REPEATING
from carom.motions.starts import Kick, State
from carom.outcome import InputError, Outcome
from carom.results import Result

Verdict = Literal["too few", "periodic", "not seen to end", "undecided", "transient"]

COUNT = 200
DISCARDED = 100
"""Impacts at the beginning that are discarded: until then the motions depend on their starts.

Added to these is the length of a chatter, whose bounces are counted too: about ``CHATTER/|ln d|``.
"""
FEWEST = 10
"""Motions from which on a half-life means something."""
UNEVEN = 0.01
"""Probability below which early and late deaths are not those of one constant rate."""


@dataclass(frozen=True, eq=False, repr=False)
class Lifetimes(Result):
    """How long motions of one machine kept bouncing irregularly.

    Attributes
    ----------
    rotor : Model
    impacts : ndarray of int, shape (M,)
        Impacts of each motion until its end was known, or as far as it was followed; the shortest first.
    ended : ndarray of bool, shape (M,)
        Whether it ended: it stopped bouncing or became periodic.  The others were still irregular, or were given up.
    ends : tuple of str, M
        Where it ended: ``"rolling"``, ``"2-impact bouncing"``, …; ``"irregular"`` if it did not; ``"grazing"``,
        ``"time-reached"`` or ``"event-limit"`` if it was given up.
    followed : int
        Largest number of impacts for which a motion was followed.
    discarded : int
        Impacts at the beginning that the statistics discard.
    """

    rests_on: ClassVar[tuple[str, ...]] = ("mora2014", "clopper1934")

    shown: ClassVar[tuple[str, ...]] = ("rotor", "destinations", "followed", "discarded", "verdict", "words")

    rotor: Rotor
    impacts: np.ndarray
    ended: np.ndarray
    ends: tuple[str, ...]
    followed: int
    discarded: int

    def __len__(self) -> int:
        return len(self.impacts)

    @property
    def destinations(self) -> dict[str, int]:
        """Where the motions ended, the most frequent first."""
        return dict(Counter(self.ends).most_common())

    @checked
    def share(self, impacts: np.ndarray) -> np.ndarray:
        """Share of the motions that still bounced irregularly after numbers of impacts, of those followed that far.

        The estimate of Kaplan and Meier (1958), from the beginning on.
        """
        left = np.arange(len(self), 0, -1)
        kept = np.where(self.ended, 1.0 - 1.0 / left, 1.0)
        shares = np.concatenate([[1.0], np.cumprod(kept)])
        found: np.ndarray = shares[np.searchsorted(self.impacts, impacts, side="right")]
        return found

    @cached_property
    def survival(self) -> Survival:
        """Exponential fit after the discarded impacts: half-life in impacts, with an interval of 95 %."""
        exposure, died = self._after(self.discarded, self.followed)
        among = int((self.impacts > self.discarded).sum())
        return Survival.of(among, self.followed, died, exposure, died, span=1)

    def _after(self, begin: float, end: float) -> tuple[int, int]:
        """Impacts of all motions between two ages, and how many motions ended there."""
        within = np.clip(self.impacts, begin, end) - begin
        died = self.ended & (self.impacts > begin) & (self.impacts <= end)
        return int(within.sum()), int(died.sum())

    @property
    def half_life(self) -> float | None:
        """In impacts; ``None`` if no motion ended after the discarded impacts, or if they did not at a constant rate."""
        return self.survival.half_life if self.constant_rate else None

    @property
    def constant_rate(self) -> bool:
        """Whether the ends agree with a rate that does not depend on the age, so that a half-life tells how long motions last."""
        return self.evenness >= UNEVEN and not self.too_many_left

    @cached_property
    def evenness(self) -> float:
        """Probability that a constant rate divides the deaths between early and late ages at least as unevenly.

        The ages are divided once where half of the deaths have occurred, and once where half of the time has been spent; the smaller
        probability counts twice.  A small value says that the fit does not hold: for example, some of the motions are on an
        attractor and others on a transient, or all approach an attractor at the same pace.
        """
        late = np.sort(self.impacts[self.ended & (self.impacts > self.discarded)])
        if len(late) < 2:
            return 1.0
        ages = np.unique(np.clip(self.impacts, self.discarded, self.followed))
        spent = [self._after(self.discarded, age)[0] for age in ages.tolist()]
        half = float(np.interp(0.5 * spent[-1], [0, *spent], [self.discarded, *ages]))
        divisions = float(late[(len(late) - 1) // 2]), half
        return min(1.0, 2.0 * min(self._chance_of_division(late, age) for age in divisions))

    def _chance_of_division(self, deaths: np.ndarray, age: float) -> float:
        """Probability that a constant rate divides the deaths at an age at least as unevenly.

        The number of deaths is given: that of early ones has a binomial distribution.
        """
        share = self._after(self.discarded, age)[0] / self._after(self.discarded, self.followed)[0]
        ways = np.array([_chance(len(deaths), k, share) for k in range(len(deaths) + 1)])
        found = ways[int((deaths <= age).sum())]
        return float(ways[ways <= found * (1.0 + 1e-9)].sum())

    @property
    def too_many_left(self) -> bool:
        """Whether more motions are left at the end than the fit explains: some may be on an attractor."""
        left = sum(end == "irregular" for end in self.ends)
        return left > self.survival.most_left(self.followed - self.discarded)

    @property
    def verdict(self) -> Verdict:
        """What the statistics say of irregular bouncing.

        Only motions that were irregular for longer than the discarded impacts count.  ``"too few"``: fewer than ten, and
        some ended.  ``"periodic"``: all became periodic.  ``"not seen to end"``: none ended; this is no proof that none
        does.  ``"transient"``: all ended, or they were followed for more than five half-lives and ended at a constant
        rate.  ``"undecided"``: transient or attractor.
        """
        among = self.impacts > self.discarded
        if among.any() and not (self.ended & among).any():
            return "not seen to end"
        if np.count_nonzero(among) < FEWEST:
            return "too few"
        if self.ended[among].all():
            bouncing = all(Outcome.BOUNCING.words in end for end, one in zip(self.ends, among, strict=True) if one)
            return "periodic" if bouncing else "transient"
        long_enough = self.followed - self.discarded >= ENOUGH * (self.half_life or math.inf)
        return "transient" if long_enough else "undecided"

    @property
    def words(self) -> str:
        """The verdict, and the numbers behind it, in a sentence or two."""
        survival, verdict = self.survival, self.verdict
        low, high = (_impacts(bound) for bound in survival.interval)
        if verdict == "too few":
            return (
                f"{survival.motions or 'None'} of {len(self)} motions bounced irregularly for more than {self.discarded} impacts: "
                "too few to tell how long such motion lasts."
            )
        told = f"{survival.died} of {survival.motions} motions ended within {self.followed:,} impacts"
        if survival.half_life is None:
            return f"{told}: not seen to end. If it is a transient, its half-life is above {low} impacts (95 %)."
        fitted = f"half-life {_impacts(survival.half_life)} impacts ({low} to {high}, 95 %)"
        if not self.constant_rate:
            middle = np.median(self.impacts[self.impacts > self.discarded])
            fitted = f"not at a constant rate, so there is no half-life; half of them lasted longer than {_impacts(float(middle))} impacts"
        names = {"undecided": "transient or attractor, undecided", "transient": "a transient"}
        return f"{told}: {names.get(verdict, f'a transient to periodic {Outcome.BOUNCING.words}')}; {fitted}."


def _chance(count: int, chosen: int, share: float) -> float:
    """Probability of so many of a count, each with a probability."""
    ways = math.lgamma(count + 1) - math.lgamma(chosen + 1) - math.lgamma(count - chosen + 1)
    return math.exp(
        ways + chosen * math.log(max(share, 1e-300)) + (count - chosen) * math.log(max(1.0 - share, 1e-300))
    )


@checked
def measure_lifetimes(
    machine: Subject,
    starts: DisturbanceSet | Plan | Sequence[State | Kick] | None = None,
    *,
    impacts: Annotated[int, whole(2)] = PATIENCE,
    discarded: Whole | None = None,
    count: Count = COUNT,
    seed: Seed = 0,
    threads: Count | None = None,
) -> Lifetimes:
    """Follow many motions and note after how many impacts they stop bouncing irregularly.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    starts : DisturbanceSet, Plan or sequence of State or Kick, optional
        By default the standard set of disturbances.  To measure how long one irregular motion lasts, give starts on it.
    impacts : int
        Impacts for which each motion is followed.
    discarded : int, optional
        Impacts at the beginning to discard; by default 100 and those of a chatter.
    count, seed : int
        Size and seed of the standard set.
    threads : int, optional
        By default the number of available cores; the result does not depend on it.

    Returns
    -------
    Lifetimes
        ``.survival`` has the half-life and its interval, ``.share(n)`` the share left after ``n`` impacts,
        ``.destinations`` where the motions ended, ``.verdict`` and ``.words`` what follows.

    Raises
    ------
    InputError
        A number is out of range, or a start is not possible.
    """
    rotor = rotor_of(machine)
    if discarded is None:
        discarded = min(_discarded(rotor), impacts // 2)
    if discarded >= impacts:
        raise InputError("discarded", discarded, f"less than the impacts followed, {impacts}")
    _, whole = disturbances_of(rotor, DisturbanceSet.of(rotor, count, seed) if starts is None else starts)
    ends = settle(rotor, whole.positions, whole.velocities, begins=whole.begins, patience=impacts, threads=threads)
    ends = ends.reshaped(ends.outcomes.size)
    order = np.argsort(ends.impacts, kind="stable")
    ended = ~still_irregular(ends) & (ends.outcomes >= Outcome.LEVITATED)
    named = [_label(*each) for each in zip(ends.outcomes.tolist(), ends.multiplicities.tolist(), strict=True)]
    labels = tuple(named[place] for place in order.tolist())
    return Lifetimes(rotor, ends.impacts[order], ended[order], labels, impacts, discarded)


def _discarded(rotor: Rotor) -> int:
    """Impacts after which the motions no longer depend on their starts, plus those of a chatter, which a motion may still complete."""
    restitution = rotor.system.arrays.restitution
    lossy = restitution[(restitution > 0.0) & (restitution < 1.0)]
    return DISCARDED + int((CHATTER / -np.log(lossy)).max(initial=0.0))


def _label(outcome: int, multiplicity: int) -> str:
    if outcome in REPEATING and not multiplicity:
        return "irregular"
    if outcome in REPEATING:
        return str(MotionName(Outcome(outcome), multiplicity))
    return Outcome(outcome).label


def _impacts(count: float) -> str:
    """Write a number of impacts with three digits: ``670``, ``17,300``; beyond a million as a power of ten."""
    return f"{float(f'{count:.3g}'):,.0f}" if 10.0 <= count < 1e6 else f"{count:,.3g}"
