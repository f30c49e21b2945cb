"""The least change of one gain that leaves only levitation, or brings back a wanted share; checked by simulation."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from carom.attractors import DisturbanceSet
from carom.basins import Share
from carom.closed_forms.thresholds import Gain
from carom.disturbances import FASTEST
from carom.models import Jeffcott
from carom.parameters import Parameters
from carom.parameters.numbers import CONVERSIONS
from carom.studies.alone import LevitationAlone
from carom.studies.ranges import MotionRange, Span
from carom.studies.safety import try_disturbances

MARGINS = (0.05, 0.1, 0.2, 0.4)
"""Relative distances of the advised damping or stiffness from the end of a range, tried until a check passes."""
CHECKED = 2000
"""Number of disturbances of the check."""
SEED = 2
"""Seed of these disturbances.  No search uses it, so the check is a fresh sample."""
WANTED = 0.99
"""Share of the disturbances that must come back if no value leaves only levitation."""
TRIED, TRIED_PATIENCE = 200, 2000
"""Disturbances at each value of that search, and number of impacts after which one of them counts as lost."""
STEP = 1.15
"""Ratio of successive values of ``γ`` or ``ω`` in that search."""


@dataclass(frozen=True)
class Advice:
    """An advised value of one gain, with the other unchanged, and the fresh sample it was checked with.

    Attributes
    ----------
    gain : {"gamma", "omega"}
    change : float
        Ratio of the advised damping or stiffness to that of the machine; infinite if the machine has none.
    alone : bool
        Whether the value lies in a range in which levitation is the only motion found.
    margin : float
        Distance from the end of that range, relative to the damping or stiffness; 0 if there is no such range.
    returned : Share
        Share of the disturbances of the check that came back, with its confidence interval.
    seed : int
        Seed of these disturbances.
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
    parameters: Parameters, alone: tuple[LevitationAlone, ...], ranges: tuple[MotionRange, ...], lost_up_to: float = 0.0
) -> tuple[Advice, ...]:
    """Advise a value of each gain, sorted by the size of the change; none if the machine needs no change.

    The ranges of the contact-free motion and of orbits say where to search if no value leaves only levitation.  No
    ``γ`` up to ``lost_up_to``, at which a disturbance is known to be lost, is advised as leaving only levitation.
    """
    if any(parameters.value(found.gain) in span for found in alone for span in found.without_whirl):
        return ()
    found = [_advise_only_levitation(parameters, entry, lost_up_to) for entry in alone]
    if not any(found):
        searched = {entry.gain: entry.searched for entry in ranges if entry.motion == "single-impact"}
        found = [_advise_wanted_share(parameters, gain, span) for gain, span in searched.items() if span is not None]
    advised = [advice for advice in found if advice is not None]
    return tuple(sorted(advised, key=lambda advice: abs(math.log(advice.change))))


def _advise_only_levitation(parameters: Parameters, found: LevitationAlone, lost_up_to: float) -> Advice | None:
    """Advise the nearest value in a range without backward whirl at which all disturbances of the check come back.

    If there is none, the value with the largest share is advised, provided that this share reaches ``WANTED``.
    """
    best: Advice | None = None
    for value, margin in _values_without_whirl(parameters, found):
        if found.gain == "gamma" and value <= lost_up_to:
            continue
        advice = _checked(parameters, found.gain, value, margin)
        if advice.returned.count == advice.returned.total:
            return advice
        if advice.returned.fraction >= WANTED and (best is None or advice.returned.count > best.returned.count):
            best = advice
    return best


def _values_without_whirl(parameters: Parameters, found: LevitationAlone) -> Iterator[tuple[float, float]]:
    """Yield values inside the ranges without backward whirl, with their margins, nearest range first."""
    own, power = parameters.value(found.gain), CONVERSIONS[found.gain].power

    def ends(span: Span) -> tuple[float, float]:
        low, high = span.low.value, span.high.value
        return (low, high) if own < low else (high, low)

    for span in sorted(
        found.without_whirl, key=lambda span: abs(math.log(ends(span)[0] / own)) if own > 0 else ends(span)[0]
    ):
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
    own = parameters.value(gain)
    change = (value / own) ** CONVERSIONS[gain].power if own > 0 else math.inf
    check = try_disturbances(Jeffcott(parameters.replace(**{gain: value})), DisturbanceSet(CHECKED, SEED))
    returned = Share.of(CHECKED - check.lost, CHECKED, drawn=True)
    return Advice(gain, value, change, margin > 0.0, margin, returned)


def _advise_wanted_share(parameters: Parameters, gain: Gain, searched: Span) -> Advice | None:
    """Advise the nearest value tried in the searched range at which the wanted share comes back."""
    own, low, high = parameters.value(gain), searched.low.value, searched.high.value
    steps = int(math.log(high / low) / math.log(STEP)) + 1
    begin = min(max(own, low), high)
    values = [begin * STEP**step for step in range(-steps, steps + 1) if low <= begin * STEP**step <= high]
    for value in sorted(values, key=lambda value: abs(math.log(value / begin))):
        there = Jeffcott(parameters.replace(**{gain: value}))
        if abs(there.equilibrium) >= 1.0:
            continue
        if TRIED - try_disturbances(there, DisturbanceSet(TRIED), patience=TRIED_PATIENCE).lost >= WANTED * TRIED:
            if value == own:  # the machine itself reaches this share
                return None
            advice = _checked(parameters, gain, value, 0.0)
            if advice.returned.fraction >= WANTED:
                return advice
    return None
