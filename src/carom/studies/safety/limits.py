"""The least damping above which no contact motion survives, and the motion that determines it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import Decimal
from typing import Literal

from carom.attractors import DisturbanceSet, MotionName
from carom.basins.shares import CONFIDENCE
from carom.closed_forms.whirl import Runaway, runaway_speed
from carom.motions.settling import PATIENCE
from carom.outcome import Outcome
from carom.parameters import Parameters
from carom.results import Result
from carom.studies.endings import ending_phrase
from carom.studies.safety.losses import DampingCheck
from carom.studies.wording import Wording

MOST_CHECKS = 120
"""Largest number of fresh samples of a search; the confidence holds for all of them together."""

Evidence = Literal["closed form", "search", "simulation"]


@dataclass(frozen=True)
class DampingLimit:
    """A damping up to which a contact motion exists.

    Attributes
    ----------
    motion : MotionName
    gamma : float
        The largest damping at which the motion was found or is known to exist; for simulation, the largest damping at
        which a disturbance was lost.
    above : float
        A damping above which the motion does not exist, equal to ``gamma`` if that is exact; for simulation, the least
        damping checked at which no fresh disturbance was lost, infinite if there is none.
    evidence : {"closed form", "search", "simulation"}
        A closed form; a search over dampings with a complete list of motions at each; simulated disturbances.
    """

    motion: MotionName
    gamma: float
    above: float
    evidence: Evidence

    @property
    def digits(self) -> int:
        """Number of known digits of ``above``: two or three for a simulated limit, by the width of its bracket."""
        if self.evidence != "simulation":
            return 5
        return 3 if self.above <= 1.02 * self.gamma else 2

    @property
    def settles(self) -> bool:
        """Whether the motion has settled; it is not known whether irregular bouncing ever ends."""
        return self.motion.outcome.settled and not self.motion.irregular


@dataclass(frozen=True, eq=False, repr=False)
class SafeDamping(Result):
    """The damping above which no contact motion survives, the other parameters fixed.

    Attributes
    ----------
    parameters : Parameters
        Those of the machine; its own ``gamma`` only affects the range searched.
    rub : DampingLimit or None
        Stable synchronous rub; ``None`` if there is none with positive damping.
    orbits : DampingLimit or None
        Admissible orbits with one impact a period, stable or not.
    simulated : DampingLimit or None
        Any motion other than levitation in which simulated disturbances ended.
    rolling : DampingLimit or None
        Rolling in backward whirl, which only a fast start reaches.
    lowest, highest : float
        Range of ``gamma`` that was searched for orbits and by simulation.
    sample : DisturbanceSet
        Number and kinds of fresh disturbances tried at each damping checked.
    checks : tuple of DampingCheck
        Checks at dampings above the limit, in ascending order; none of their fresh disturbances was lost.
    faster : DampingCheck or None
        Disturbances up to twice as fast, tried at the first of these dampings.
    """

    parameters: Parameters
    rub: DampingLimit | None
    orbits: DampingLimit | None
    simulated: DampingLimit | None
    rolling: DampingLimit | None
    lowest: float
    highest: float
    sample: DisturbanceSet
    checks: tuple[DampingCheck, ...]
    faster: DampingCheck | None

    @property
    def within_reach(self) -> DampingLimit | None:
        """The limit for the disturbances tested; rolling counts only if they reached it.

        ``None`` if levitation is the only motion at any positive damping.
        """
        known = max((limit for limit in (self.rub, self.orbits) if limit), key=lambda limit: limit.above, default=None)
        if self.simulated and (known is None or self.simulated.gamma > known.above):
            return self.simulated
        return known

    @property
    def runaway(self) -> Runaway:
        """How fast backward whirl must be to run away to rolling, at the limit ``within_reach``."""
        limit = self.within_reach
        return runaway_speed(self.parameters.replace(gamma=limit.gamma) if limit else self.parameters)

    @property
    def at_all(self) -> DampingLimit | None:
        """The limit for any start, however fast; rolling is included."""
        limits = [limit for limit in (self.within_reach, self.rolling) if limit]
        return max(limits, key=lambda limit: limit.above, default=None)

    @property
    def share_below(self) -> float:
        """Largest share of disturbances that may be lost at any of the dampings checked, at 95 % confidence.

        If the share ``p`` is lost, none of ``n`` disturbances is lost with a probability of ``(1 − p)ⁿ``.  The returned
        share is so large that this happens in any of the samples that a search may take with a probability below 5 %.
        """
        return -math.expm1(math.log((1.0 - CONFIDENCE) / MOST_CHECKS) / self.sample.count)

    @property
    def words(self) -> str:
        """The last motion to vanish as the damping grows, the disturbances tried above it, and the confidence."""
        say = Wording(self.parameters.scales)
        name, checks = say.gain_name("gamma"), self.checks
        if not checks:
            return (
                f"Some disturbances of up to {say.velocity(self.sample.fastest)} did not come back even at the largest {name} "
                f"tried ({say.gain('gamma', self.highest)})."
            )
        ends = " to ".join(say.gain("gamma", check.gamma) for check in (checks[0], checks[-1]))
        tried = (
            f"None of {self.sample.count:,} fresh disturbances (kicks of the levitating rotor and starts within the clearance, of up "
            f"to {say.velocity(self.sample.fastest)}) was lost at any of {len(checks)} values of {name} from {ends}: with "
            f"{100 * CONFIDENCE:.0f} % confidence {share_words(self.share_below)} at any of these."
        )
        return " ".join(part for part in (self._limit_words(say), tried, self._faster_words(say)) if part)

    def _limit_words(self, say: Wording) -> str:
        """Say above which damping disturbances came back, and which motion vanished last.

        A simulated limit is written with its known digits only.
        """
        limit = self.within_reach
        if limit is None:
            return ""
        last = f"the {limit.motion}" if limit.motion.outcome is Outcome.FORWARD_RUB else limit.motion.words
        if limit.evidence != "simulation":
            return f"The last motion to vanish as the damping grows is {last}, at {say.gain('gamma', limit.above)}."
        factor = say.scales.damping if say.scales else 1.0
        above = _rounded_up(limit.above * factor, limit.digits) / factor
        return (
            f"All fresh disturbances came back above {say.gain('gamma', above)}; the last that was found to be lost, at "
            f"{say.gain('gamma', float(f'{limit.gamma * factor:.{limit.digits}g}') / factor)}, "
            f"{f'ended {ending_phrase(limit.motion)}' if limit.settles else f'was in {_unsettled_words(limit.motion)}'}."
        )

    def _faster_words(self, say: Wording) -> str:
        """Say how many of the faster disturbances were lost."""
        faster = self.faster
        if faster is None:
            return ""
        return (
            f"Of {faster.sample.count:,} of up to {say.velocity(faster.sample.fastest)}, {faster.lost or 'none'} "
            f"{'was' if faster.lost <= 1 else 'were'} lost at {say.gain('gamma', faster.gamma)}."
        )


def _unsettled_words(motion: MotionName) -> str:
    """Say why a disturbance that has not settled counts as lost."""
    if not motion.outcome.settled:
        return f"{motion}, not seen to come back"
    return f"{motion}, not seen to come back in {PATIENCE:,} impacts"


def _rounded_up(value: float, digits: int) -> float:
    """Round a positive number up to the given number of significant digits."""
    near = Decimal(f"{value:.{digits - 1}e}")
    exact = Decimal(value)
    if near < exact:
        near += Decimal(1).scaleb(near.adjusted() - digits + 1)
    return float(near)


def share_words(share: float) -> str:
    """Say that less than a share is lost, rounded to the larger share: ``fewer than 1 in 1,200 are lost``."""
    if share >= 0.1:
        return f"less than {math.ceil(100.0 * share)} % are lost"
    one_in = 1.0 / share
    unit = 10.0 ** (math.floor(math.log10(one_in)) - 1)
    return f"fewer than 1 in {int(unit * math.floor(one_in / unit)):,} are lost"
