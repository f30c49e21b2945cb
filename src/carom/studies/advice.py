"""The least change of one gain that leaves levitation alone, or brings back a wanted share; checked by simulation."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from carom.attractors import DisturbanceSet
from carom.basins import Share
from carom.disturbances import FASTEST
from carom.models import Jeffcott
from carom.motions.ensembles import settle
from carom.motions.settling import PATIENCE
from carom.parameters import Parameters
from carom.studies.alone import LevitationAlone
from carom.studies.ranges import Gain, MotionRange, Span

__all__ = ["WANTED", "Advice", "advise"]

MARGINS = (0.05, 0.1, 0.2, 0.4)
"""How far beyond the end of a range the advised damping or stiffness lies, relative to it; the next if the check fails."""
CHECKED = 2000
"""Disturbances of the check."""
SEED = 2
"""Of these; not that of any search, so that the check is a fresh sample."""
WANTED = 0.99
"""Share of the disturbances that must come back where no value leaves levitation alone."""
TRIED, TRIED_PATIENCE = 200, 2000
"""Disturbances at each value on the way there, and impacts after which one of them counts as lost."""
STEP = 1.15
"""Ratio of the values of ``γ`` or ``ω`` tried on the way."""


@dataclass(frozen=True)
class Advice:
    """A value of one gain, the other as it is, and the fresh sample it was checked with.

    Attributes
    ----------
    gain : {"gamma", "omega"}
    value : float
    change : float
        Ratio of the damping or stiffness to the machine's own; infinite where it has none.
    alone : bool
        Whether it lies where levitation is the only motion found.
    margin : float
        How far it lies beyond the end of that range, relative to the damping or stiffness; 0 where it is no such range.
    returned : Share
        Of the disturbances of the check that came back, with its interval.
    seed : int
    fastest : float
        Largest speed of these disturbances, in ``c_r Ω``.
    """

    gain: Gain
    value: float
    change: float
    alone: bool
    margin: float
    returned: Share
    seed: int = SEED
    fastest: float = FASTEST


def advise(
    parameters: Parameters,
    alone: tuple[LevitationAlone, ...],
    ranges: tuple[MotionRange, ...],
    lost_up_to: float = 0.0,
) -> tuple[Advice, ...]:
    """Advise a value of each gain, the least change first.

    Parameters
    ----------
    parameters : Parameters
    alone : tuple of LevitationAlone
    ranges : tuple of MotionRange
        Of the contact-free motion and of orbits, which tell where to look if no value leaves levitation alone.
    lost_up_to : float
        ``γ`` at which a disturbance is known to be lost: none up to it is said to leave levitation alone.

    Returns
    -------
    tuple of Advice
        None for a machine that needs no change, or where nothing was found.
    """
    if any(_own(parameters, found.gain) in span for found in alone for span in found.calm):
        return ()
    found = [_leaving_alone(parameters, entry, lost_up_to) for entry in alone]
    if not any(found):
        searched = {entry.gain: entry.searched for entry in ranges if entry.motion == "single-impact"}
        found = [_bringing_back(parameters, gain, span) for gain, span in searched.items() if span is not None]
    advised = [advice for advice in found if advice is not None]
    return tuple(sorted(advised, key=lambda advice: abs(math.log(advice.change))))


def _own(parameters: Parameters, gain: Gain) -> float:
    return float(getattr(parameters, gain))


def _power(gain: Gain) -> int:
    """Damping is proportional to ``γ``, stiffness to ``ω²``."""
    return 1 if gain == "gamma" else 2


def _leaving_alone(parameters: Parameters, found: LevitationAlone, lost_up_to: float) -> Advice | None:
    """Beyond the nearest end at which all disturbances of the check come back; else the best there is, if good enough."""
    best: Advice | None = None
    for value, margin in _beyond_ends(parameters, found):
        if found.gain == "gamma" and value <= lost_up_to:
            continue
        advice = _checked(parameters, found.gain, value, margin)
        if advice.returned.count == advice.returned.total:
            return advice
        if advice.returned.fraction >= WANTED and (best is None or advice.returned.count > best.returned.count):
            best = advice
    return best


def _beyond_ends(parameters: Parameters, found: LevitationAlone) -> Iterator[tuple[float, float]]:
    """Values inside the calm ranges with their margin, the nearest range first."""
    own, power = _own(parameters, found.gain), _power(found.gain)

    def ends(span: Span) -> tuple[float, float]:
        low, high = span.low.value, span.high.value
        return (low, high) if own < low else (high, low)

    for span in sorted(found.calm, key=lambda span: abs(math.log(ends(span)[0] / own)) if own > 0 else ends(span)[0]):
        near, far = ends(span)
        inward = math.copysign(1.0, far - near)
        middle = math.sqrt(near * far)
        for margin in MARGINS:
            value = near * (1.0 + margin) ** (inward / power)
            if inward * (middle - value) <= 0.0:
                yield middle, abs((middle / near) ** power - 1.0)
                break
            yield value, margin


def _checked(parameters: Parameters, gain: Gain, value: float, margin: float) -> Advice:
    own = _own(parameters, gain)
    change = (value / own) ** _power(gain) if own > 0 else math.inf
    returned = _returned(parameters.replace(**{gain: value}), CHECKED, SEED)
    return Advice(gain, value, change, margin > 0.0, margin, Share.of(returned, CHECKED, drawn=True))


def _returned(parameters: Parameters, count: int, seed: int, patience: int = PATIENCE) -> int:
    rotor = Jeffcott(parameters)
    ends = settle(rotor, *DisturbanceSet(count, seed).states(rotor), patience=patience)
    return int(np.count_nonzero(ends.recovered))


def _bringing_back(parameters: Parameters, gain: Gain, searched: Span) -> Advice | None:
    """The nearest value tried, within what was searched, that brings back the share that is wanted."""
    own, low, high = _own(parameters, gain), searched.low.value, searched.high.value
    steps = int(math.log(high / low) / math.log(STEP)) + 1
    begin = min(max(own, low), high)
    values = [begin * STEP**step for step in range(-steps, steps + 1) if low <= begin * STEP**step <= high]
    for value in sorted(values, key=lambda value: abs(math.log(value / begin))):
        there = parameters.replace(**{gain: value})
        if abs(Jeffcott(there).equilibrium) < 1.0 and _returned(there, TRIED, 0, TRIED_PATIENCE) >= WANTED * TRIED:
            if value == own:  # nothing needs to change for that share
                return None
            advice = _checked(parameters, gain, value, 0.0)
            if advice.returned.fraction >= WANTED:
                return advice
    return None
