"""For which damping, and for which stiffness, a motion exists: exact for equilibria.

Damping and stiffness are the gains that a designer can change.  Each is varied alone, with all other parameters fixed,
and is written as ``gamma`` or ``omega`` here; the scales convert them to N s/m and N/m.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from carom.arguments import checked
from carom.attractors import MotionName
from carom.closed_forms.thresholds import Gain, Steady, ranges_of
from carom.parameters import Parameters

Motion = Steady | Literal["single-impact", "stable-single-impact"]

EVENTS = {
    "boundary-equilibrium": "levitation reaches the wall",
    "rub-fold": "a stable and an unstable rub meet (fold)",
    "fold": "two orbits meet (fold)",
    "speed-fold": "two orbits of one period meet (fold)",
    "grazing": "an orbit grazes the wall between its impacts",
    "non-smooth-hopf": "an orbit shrinks into levitation on the wall (non-smooth Hopf)",
    "slip-stop": "friction begins to stop the slip in the impacts of an orbit",
    "contact-onset": "an orbit begins to stay on the wall after its impact",
    "period-doubling": "an orbit loses its stability (period doubling)",
    "neimark-sacker": "an orbit loses its stability (Neimark-Sacker)",
    "vanishing-period": "the period of an orbit shrinks to zero",
    "rolling-limit": "friction just keeps the rotor rolling at every angle",
}
"""What happens at the ends of the ranges of motions."""


@dataclass(frozen=True)
class Edge:
    """End of a span.

    Attributes
    ----------
    value : float
        ``gamma`` or ``omega``; 0 and infinity are possible.
    kind : str
        What happens there: ``"boundary-equilibrium"``, ``"rub-fold"``, ``"rolling-limit"`` or ``"simulated"``; for
        orbits a kind of :class:`~carom.bifurcations.Bifurcation`, or ``"vanishing-period"``.  Empty if nothing happens
        there, at the end of the axis or of a search.
    period : float or None
        Period of the orbit that appears, vanishes or changes there, in ``1/Ω``.
    certified : bool
        Whether the edge is exact, or confirmed by the certified orbits close by on both sides.
    motion : MotionName or None
        For the kind ``"simulated"``: the motion in which a disturbance ended beyond the edge.
    """

    value: float
    kind: str = ""
    period: float | None = None
    certified: bool = True
    motion: MotionName | None = None


@dataclass(frozen=True)
class Span:
    """An interval of one gain."""

    low: Edge
    high: Edge

    def __contains__(self, value: float) -> bool:
        return self.low.value <= value <= self.high.value


@dataclass(frozen=True)
class Threshold:
    """A value of one gain at which a motion appears or vanishes.

    Attributes
    ----------
    motion : {"contact-free", "rub", "single-impact", "stable-single-impact", "rolling"}
    gain : {"gamma", "omega"}
    exists : {"above", "below"}
        On which side of the value the motion exists.
    """

    motion: Motion
    gain: Gain
    edge: Edge
    exists: Literal["above", "below"]


@dataclass(frozen=True)
class MotionRange:
    """The values of one gain for which a motion exists, all other parameters fixed.

    Attributes
    ----------
    motion : {"contact-free", "rub", "single-impact", "stable-single-impact", "rolling"}
    gain : {"gamma", "omega"}
    spans : tuple of Span
        Disjoint, in ascending order.
    searched : Span or None
        The range searched; ``None`` if the spans follow from a closed form for all values from zero on.
    step : float
        Relative step of the search; 0 for a closed form.
    """

    motion: Motion
    gain: Gain
    spans: tuple[Span, ...]
    searched: Span | None = None
    step: float = 0.0

    @property
    def thresholds(self) -> tuple[Threshold, ...]:
        """The edges at which the motion appears or vanishes."""
        found = []
        for span in self.spans:
            if span.low.kind:
                found.append(Threshold(self.motion, self.gain, span.low, "above"))
            if span.high.kind:
                found.append(Threshold(self.motion, self.gain, span.high, "below"))
        return tuple(found)

    def exists_at(self, value: float) -> bool:
        """Whether the motion exists for this value of the gain."""
        return any(value in span for span in self.spans)


def outside(spans: tuple[Span, ...], within: Span) -> tuple[Span, ...]:
    """Return the parts of ``within`` that no span covers."""
    gaps, start = [], within.low
    for span in spans:
        if span.low.value > start.value:
            gaps.append(Span(start, min(span.low, within.high, key=_value)))
        start = max(start, span.high, key=_value)
    if start.value < within.high.value:
        gaps.append(Span(start, within.high))
    return tuple(gap for gap in gaps if gap.low.value < gap.high.value)


def common(first: tuple[Span, ...], second: tuple[Span, ...]) -> tuple[Span, ...]:
    """Return the overlaps of two sets of spans."""
    overlaps = [
        Span(max(one.low, other.low, key=_value), min(one.high, other.high, key=_value))
        for one in first
        for other in second
    ]
    return tuple(sorted((span for span in overlaps if span.low.value < span.high.value), key=lambda s: s.low.value))


def _value(edge: Edge) -> float:
    return edge.value


@checked
def free_spans(ranges: tuple[MotionRange, ...], gain: Gain) -> tuple[Span, ...] | None:
    """Return where along one gain the contact-free motion exists, but neither a rub nor a single-impact orbit.

    The spans lie within the range searched for orbits; ``None`` if orbits were not searched.
    """
    here = {entry.motion: entry for entry in ranges if entry.gain == gain}
    orbits = here.get("single-impact")
    if orbits is None or orbits.searched is None or "rub" not in here:
        return None
    searched = orbits.searched
    quiet = common(outside(orbits.spans, searched), outside(here["rub"].spans, searched))
    return common(quiet, here["contact-free"].spans)


def levitating_spans(ranges: tuple[MotionRange, ...], gain: Gain) -> tuple[Span, ...] | None:
    """Return where along one gain the contact-free motion exists, within the range searched for orbits; ``None`` if none was."""
    here = {entry.motion: entry for entry in ranges if entry.gain == gain}
    orbits = here.get("single-impact")
    if orbits is None or orbits.searched is None:
        return None
    return common(here["contact-free"].spans, (orbits.searched,))


def steady_range(parameters: Parameters, motion: Steady, gain: Gain) -> MotionRange:
    """Return where a steady motion exists (:func:`~carom.closed_forms.thresholds.ranges_of`).

    Where a synchronous rub exists with positive damping, a stable one does too, unless the restitution is one.
    """
    spans = tuple(Span(Edge(*low), Edge(*high)) for low, high in ranges_of(motion, parameters, gain))
    return MotionRange(motion, gain, spans)
