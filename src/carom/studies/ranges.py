"""For which damping, and for which stiffness, a motion exists: exact for equilibria.

Damping and stiffness are the gains that a designer can change.  Each is varied alone, with all other parameters fixed,
and is written as ``gamma`` or ``omega`` here; the scales convert them to N s/m and N/m.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from carom.attractors import MotionName
from carom.bifurcations.boundary import boundary_values
from carom.closed_forms.whirl import rolling, rub_limit
from carom.models import Jeffcott
from carom.parameters import Parameters

__all__ = [
    "Edge",
    "Gain",
    "Motion",
    "MotionRange",
    "Span",
    "Threshold",
    "common",
    "contact_free_range",
    "free_spans",
    "outside",
    "rolling_range",
    "rub_range",
]

Gain = Literal["gamma", "omega"]
Motion = Literal["contact-free", "rub", "single-impact", "stable-single-impact", "rolling"]


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
    edge : Edge
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


def free_spans(ranges: tuple[MotionRange, ...], gain: Gain) -> tuple[Span, ...] | None:
    """Return where along one gain the contact-free motion exists, but neither a rub nor a single-impact orbit.

    Parameters
    ----------
    ranges : tuple of MotionRange
    gain : {"gamma", "omega"}

    Returns
    -------
    tuple of Span, or None
        Within the range searched for orbits; ``None`` if orbits were not searched.
    """
    here = {entry.motion: entry for entry in ranges if entry.gain == gain}
    orbits = here.get("single-impact")
    if orbits is None or orbits.searched is None or "rub" not in here:
        return None
    searched = orbits.searched
    quiet = common(outside(orbits.spans, searched), outside(here["rub"].spans, searched))
    return common(quiet, here["contact-free"].spans)


ZERO, INFINITE = Edge(0.0), Edge(math.inf)


def contact_free_range(parameters: Parameters, gain: Gain) -> MotionRange:
    """Return where the contact-free equilibrium lies inside the wall.

    ``|U*| < 1`` is ``ρ² < (1 − ω²)² + γ²``, from (3.7) of the source paper; the ends of the range are
    :func:`~carom.bifurcations.boundary.boundary_values`.

    Parameters
    ----------
    parameters : Parameters
    gain : {"gamma", "omega"}
        The gain that is varied, from zero on.

    Returns
    -------
    MotionRange
    """
    spans = []
    for value, side in boundary_values(parameters, gain):
        edge = Edge(value, "boundary-equilibrium")
        spans.append(Span(edge, INFINITE) if side == "above" else Span(ZERO, edge))
    return MotionRange("contact-free", gain, tuple(spans) or (Span(ZERO, INFINITE),))


def rub_range(parameters: Parameters, gain: Gain) -> MotionRange:
    """Return where a synchronous rub exists in which the wall pushes the rotor and does not pull it.

    In the plane of ``γ`` and ``κ = 1 − ω²`` this region is a disc and an adjacent wedge, derived in
    :func:`~carom.closed_forms.whirl.rub_limit`.  Its edges are a fold and a circle; on the circle the contact-free
    equilibrium lies on the wall.  The rub with the larger normal force is always the stable one,
    ``ρ(cos x − μ sin x) = (1 + μ²)N − κ + μγ > 0``.  So where a rub exists, a stable one exists.

    Parameters
    ----------
    parameters : Parameters
        Parameters of the rigid rotor; ``gamma >= 0`` if the stiffness is varied.
    gain : {"gamma", "omega"}
        The gain that is varied, from zero on.

    Returns
    -------
    MotionRange
    """
    rho, mu, gamma = parameters.rho, parameters.mu, parameters.gamma
    slope = math.hypot(1.0, mu)
    if gain == "gamma":
        folds = (1.0 - parameters.omega**2) * slope >= rho * mu
        end = Edge(rub_limit(Jeffcott(parameters)), "rub-fold" if folds else "boundary-equilibrium")
        return MotionRange("rub", gain, (Span(ZERO, end),) if end.value > 0 else ())
    half_width = _leg(rho, gamma)
    if half_width == 0:
        return MotionRange("rub", gain, ())
    if gamma * slope <= rho:
        softest = 1.0 - (rho * slope - gamma) / mu if mu > 0 else -math.inf
        kind = "rub-fold"
    else:
        softest, kind = 1.0 - half_width, "boundary-equilibrium"
    start = Edge(math.sqrt(softest), kind) if softest > 0 else ZERO
    end = Edge(math.sqrt(1.0 + half_width), "boundary-equilibrium")
    return MotionRange("rub", gain, (Span(start, end),))


def rolling_range(parameters: Parameters, gain: Gain) -> MotionRange:
    """Return where a rotor that rolls around the bearing in backward whirl keeps rolling at every angle.

    ``|γ|s + ρ√(1 + μ²) ≤ μ(s² − ω²)``, derived in :mod:`carom.closed_forms.whirl`.

    Parameters
    ----------
    parameters : Parameters
        With ``gamma >= 0`` if the stiffness is varied.
    gain : {"gamma", "omega"}
        The gain that is varied, from zero on.

    Returns
    -------
    MotionRange
    """
    roll = rolling(Jeffcott(parameters))
    limit = roll.largest_damping if gain == "gamma" else roll.largest_stiffness
    return MotionRange("rolling", gain, (Span(ZERO, Edge(limit, "rolling-limit")),) if limit > 0 else ())


def _leg(hypotenuse: float, leg: float) -> float:
    """Return the other leg of a right-angled triangle, zero if there is none."""
    square = (hypotenuse - leg) * (hypotenuse + leg)
    return math.sqrt(square) if square > 0 else 0.0
