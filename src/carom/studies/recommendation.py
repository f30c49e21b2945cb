"""What a study recommends: the least change of one gain, its margin, and how sure each number is.

A change is checked by a sample of disturbances, so nothing here is proven.  The *evidence* of a number says where it comes
from: a closed form, a search with a complete list of orbits at each value, or a sample of disturbances.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from carom.closed_forms.thresholds import FOLD, ROLLING, WALL, Gain
from carom.closed_forms.whirl import Runaway, rolling, runaway_speed
from carom.models import Jeffcott
from carom.parameters.numbers import CONVERSIONS
from carom.studies.advice import Advice
from carom.studies.ranges import Edge, Span

if TYPE_CHECKING:
    from carom.studies.assembly import Study

Kind = Literal["change", "no-change-needed", "no-change-found"]
Bound = Literal["at least", "at most", "about"]
Evidence = Literal["closed form", "searched", "sampled"]

_SAME = 1e-8
"""Relative distance up to which two edges are one."""
_CLOSED_FORMS = (WALL, FOLD, ROLLING)


@dataclass(frozen=True)
class Margin:
    """How far a value lies from the end of a range in which levitation is the only motion found.

    Attributes
    ----------
    edge : Edge
        The end of the range.
    share : float
        Distance of the value from it, relative to the damping or stiffness there.
    """

    edge: Edge
    share: float


@dataclass(frozen=True)
class Tried:
    """Values beyond the recommended one at which every disturbance of a sample came back."""

    values: tuple[float, ...]
    """In the order of their distance from the recommended value."""
    disturbances: int
    """Number of disturbances at each."""


@dataclass(frozen=True)
class Change:
    """A recommended change of one gain.

    Attributes
    ----------
    present : float
        ``gamma`` or ``omega`` of the machine; the recommended value is that of the advice.
    bound : {"at least", "at most", "about"}
        Whether larger or smaller values were tried too, up to the end of the search, and nothing was lost there.
    margin : Margin or None
        Distance from the near end of the range; ``None`` if the value only brings back a wanted share.
    far : Edge or None
        The other end of the range, if some motion appears there.
    tried : tuple of Tried
        The values beyond it that were tried.
    radius, zone : float, str
        Radius of levitation at the value, and its zone.
    whirl : Runaway or None
        Speeds from which backward whirl runs away to rolling at the value; ``None`` if rolling does not sustain itself.
    """

    advice: Advice
    present: float
    bound: Bound
    margin: Margin | None
    far: Edge | None
    tried: tuple[Tried, ...]
    radius: float
    zone: str
    whirl: Runaway | None

    @property
    def gain(self) -> Gain:
        """``gamma`` or ``omega``."""
        return self.advice.gain


@dataclass(frozen=True)
class Recommendation:
    """The recommendation of a study.

    Attributes
    ----------
    kind : {"change", "no-change-needed", "no-change-found"}
    changes : tuple of Change
        Alternatives, the least change first.
    margins : tuple of (gain, Margin)
        If no change is needed: how far the present values lie from where another motion begins.
    """

    kind: Kind
    changes: tuple[Change, ...]
    margins: tuple[tuple[Gain, Margin], ...]


def recommend(study: Study) -> Recommendation:
    """Return the recommendation of a study."""
    changes = tuple(_change(study, advice) for advice in study.advice)
    if changes:
        return Recommendation("change", changes, ())
    if study.verdict.level != "all-tried-came-back":
        return Recommendation("no-change-found", (), ())
    margins = [
        (entry.gain, margin)
        for entry in study.alone
        for span in entry.without_whirl
        if (present := study.case.parameters.value(entry.gain)) in span
        and (margin := _nearest(entry.gain, present, span))
    ]
    return Recommendation("no-change-needed", (), tuple(margins))


def evidence_of(edge: Edge) -> Evidence:
    """How the end of a range is known."""
    if edge.kind == "simulated":
        return "sampled"
    return "closed form" if edge.kind in _CLOSED_FORMS else "searched"


def _distance(gain: Gain, value: float, end: float) -> float:
    """Return the distance of two values relative to the damping or stiffness at the end."""
    return abs((value / end) ** CONVERSIONS[gain].power - 1.0)


def _happens(edge: Edge) -> bool:
    """Whether a motion appears or vanishes at an edge; otherwise the search ends there."""
    return bool(edge.kind) and 0.0 < edge.value < math.inf


def _nearest(gain: Gain, value: float, span: Span) -> Margin | None:
    margins = [Margin(edge, _distance(gain, value, edge.value)) for edge in (span.low, span.high) if _happens(edge)]
    return min(margins, key=lambda margin: margin.share, default=None)


def _change(study: Study, advice: Advice) -> Change:
    gain, value, parameters = advice.gain, advice.value, study.case.parameters
    rotor, present = Jeffcott(parameters.replace(**{gain: value})), parameters.value(gain)
    radius = abs(rotor.equilibrium)
    within = next((span for span in _without_whirl(study, gain) if value in span), None) if advice.alone else None
    margin: Margin | None = None
    far: Edge | None = None
    bound: Bound = "about"
    tried: tuple[Tried, ...] = ()
    if within is not None:
        upward = present < value
        near, end = (within.low, within.high) if upward else (within.high, within.low)
        margin, far = Margin(_best_known(study, gain, near), advice.margin), end if _happens(end) else None
        tried = _tried(study, gain, value, end.value)
        if far is None and tried and advice.returned.count == advice.returned.total:
            bound = "at least" if upward else "at most"
    zone = study.case.zones.zone(min(radius, 1.0))
    whirl = runaway_speed(rotor) if rolling(rotor).holds else None
    return Change(advice, present, bound, margin, far, tried, radius, zone, whirl)


def _best_known(study: Study, gain: Gain, edge: Edge) -> Edge:
    """Return the closed form of an edge, if several motions end there and one of them has a closed form."""
    exact = [
        other
        for entry in study.ranges
        if entry.gain == gain
        for span in entry.spans
        for other in (span.low, span.high)
        if other.kind in _CLOSED_FORMS and math.isclose(other.value, edge.value, rel_tol=_SAME)
    ]
    return exact[0] if exact and edge.kind != "simulated" else edge


def _without_whirl(study: Study, gain: Gain) -> tuple[Span, ...]:
    found = study.alone_along(gain)
    return found.without_whirl if found else ()


def _tried(study: Study, gain: Gain, value: float, end: float) -> tuple[Tried, ...]:
    """Return the values from the recommended one to the end of its range that were tried, all without a loss."""
    found = study.alone_along(gain)
    samples = [(found.values, found.disturbances + found.rim)] if found else []
    if gain == "gamma":
        checks = study.safe_damping.checks
        samples.append((tuple(check.gamma for check in checks), study.safe_damping.sample.count))
    low, high = min(value, end), max(value, end)
    beyond = [
        (sorted((at for at in values if low < at < high), key=lambda at: abs(at - value)), n) for values, n in samples
    ]
    return tuple(Tried(tuple(values), count) for values, count in beyond if values)
