"""For which values of a parameter each simple motion exists: exact for steady ones, by search for orbits.

One parameter is varied alone, with all others fixed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np

from carom.base.outcome import CaromError
from carom.base.progress import ShowProgress
from carom.bifurcations import orbit_windows
from carom.bifurcations.steady import steady_points
from carom.closed_forms.equilibria import find_equilibria
from carom.closed_forms.thresholds import Gain, Steady, ranges_of
from carom.closed_forms.whirl import rolling
from carom.models import Axis, Edge, Rotor, Span, axis, exact_rotor_of
from carom.models.axes import usual_range
from carom.models.spans import spans_where
from carom.orbits.single_impact import longest_within_reach
from carom.parameters import PHYSICAL_PARTNER
from carom.parameters.formats import own_entry

Motion = Steady | Literal["single-impact", "stable-single-impact"]

EVENTS = {
    "boundary-equilibrium": "levitation reaches the wall",
    "rub-fold": "a stable and an unstable rub meet (fold)",
    "fold": "two orbits meet (fold)",
    "speed-fold": "two orbits of one period meet (fold)",
    "grazing": "an orbit grazes the wall between two impacts",
    "non-smooth-hopf": "an orbit shrinks to levitation at the wall (non-smooth Hopf)",
    "slip-stop": "friction begins to stop the slip during impacts of an orbit",
    "contact-onset": "an orbit begins to stay on the wall after an impact",
    "period-doubling": "an orbit loses its stability (period doubling)",
    "neimark-sacker": "an orbit loses its stability (Neimark-Sacker)",
    "vanishing-period": "the period of an orbit shrinks to zero",
    "rolling-limit": "friction is just enough to keep the rotor rolling at every angle",
    "simulated": "the rotor can no longer levitate",
}
"""What happens at the ends of the ranges of motions."""
DAMPING_STEP, STEP = 0.1, 0.05
"""Relative steps between the values at which all orbits are computed: along damping, and along other parameters."""
_OWN: dict[str, str] = {there: own for own, there in PHYSICAL_PARTNER.items()}


def event_words(edge: Edge) -> str:
    """What happens at the end of a range, in words."""
    return EVENTS.get(edge.kind, f"an orbit ends ({edge.kind})")


@dataclass(frozen=True)
class Threshold:
    """A value of a parameter at which a motion appears or vanishes.

    Attributes
    ----------
    motion : {"contact-free", "rub", "single-impact", "stable-single-impact", "rolling"}
    parameter : str
    exists : {"above", "below"}
        On which side of the value the motion exists.
    """

    motion: Motion
    parameter: str
    edge: Edge
    exists: Literal["above", "below"]


@dataclass(frozen=True)
class MotionRange:
    """The values of a parameter for which a motion exists, all other parameters fixed.

    Attributes
    ----------
    motion : {"contact-free", "rub", "single-impact", "stable-single-impact", "rolling"}
    parameter : str
    spans : tuple of Span
        Disjoint, in ascending order.
    searched : Span or None
        The range searched; ``None`` if the spans follow from a closed form for all values from zero on.
    step : float
        Relative step of the search; 0 for a closed form.
    """

    motion: Motion
    parameter: str
    spans: tuple[Span, ...]
    searched: Span | None = None
    step: float = 0.0

    @property
    def thresholds(self) -> tuple[Threshold, ...]:
        """The edges at which the motion appears or vanishes."""
        sides = [(edge, side) for span in self.spans for edge, side in zip(span, ("above", "below"), strict=True)]
        return tuple(Threshold(self.motion, self.parameter, edge, side) for edge, side in sides if edge.kind)  # type: ignore[arg-type]

    def exists_at(self, value: float) -> bool:
        """Whether the motion exists for this value."""
        return any(value in span for span in self.spans)


def motion_ranges(rotor: Rotor, along: Axis, progress: ShowProgress = None) -> tuple[MotionRange, ...]:
    """Return the values of a parameter for which each simple motion of the planar rotor exists; none for other rotors.

    Where a synchronous rub exists with positive damping, a stable one does too, unless the restitution is one.  Orbits with one
    impact a period are searched (:func:`~carom.bifurcations.orbit_windows`): along damping from a fraction of the machine's own to
    where the rotor is far overdamped, else from half to twice the machine's own value.  There are ranges of all admissible orbits,
    and of the stable ones; none where no search is possible: without damping, or with so little that there are too many orbits to list.
    """
    if not rotor.has_closed_forms:
        return ()
    rotor = exact_rotor_of(rotor)
    own = _OWN.get(along.name, along.name)
    varied = axis(rotor, own)
    values = _values(rotor, varied)
    found = (*_steady_ranges(rotor, varied, values), *_orbit_ranges(rotor, varied, values, progress))
    return found if own == along.name else tuple(_of_the_machine(rotor, along, entry) for entry in found)


def _of_the_machine(rotor: Rotor, along: Axis, entry: MotionRange) -> MotionRange:
    """The same range of what a machine has in place of a dimensionless parameter."""

    def shown(span: Span) -> Span:
        return Span(*(replace(edge, value=own_entry(entry.parameter, edge.value, rotor.scales)[1]) for edge in span))

    searched = shown(entry.searched) if entry.searched else None
    return replace(entry, parameter=along.name, spans=tuple(map(shown, entry.spans)), searched=searched)


def _steady_ranges(rotor: Rotor, along: Axis, values: Sequence[float]) -> list[MotionRange]:
    """By closed forms along damping and stiffness; along other parameters between the special points of steady motions."""
    if along.name in get_args(Gain):
        gain: Gain = along.name  # type: ignore[assignment]
        return [MotionRange(motion, gain, ranges_of(motion, rotor.parameters, gain)) for motion in get_args(Steady)]
    if not values:
        return []
    searched = Span(Edge(values[0]), Edge(values[-1]))
    points = steady_points(rotor.parameters, along, (values[0], values[-1]))
    edges = [*searched, *(Edge(point.value, point.kind) for point in points)]

    def where(motion: Steady) -> tuple[Span, ...]:
        return spans_where(edges, lambda value: motion in _steady_at(along.move(rotor, value)))

    return [MotionRange(motion, along.name, where(motion), searched) for motion in get_args(Steady)]


def _steady_at(rotor: Rotor) -> set[str]:
    """The steady motions that exist."""
    found: set[str] = {each.kind for each in find_equilibria(rotor) if each.status == "admissible"}
    return found | {"rolling"} if rolling(rotor).holds else found


def _orbit_ranges(rotor: Rotor, along: Axis, values: Sequence[float], progress: ShowProgress) -> list[MotionRange]:
    """All orbits and the stable ones."""
    if not values:
        return []
    found: dict[Motion, tuple[Span, ...]] = {"single-impact": (), "stable-single-impact": ()}
    if rotor.parameters.rho > 0.0:  # a balanced rotor has no such orbit
        try:
            windows = orbit_windows(rotor, along.name, values, progress)
        except CaromError:
            return []
        found = {"single-impact": windows.possible, "stable-single-impact": windows.stable}
    searched, step = Span(Edge(values[0]), Edge(values[-1])), values[1] / values[0] - 1.0
    return [MotionRange(motion, along.name, spans, searched, step) for motion, spans in found.items()]


def _values(rotor: Rotor, along: Axis) -> list[float]:
    """Return the values to search, in geometric progression; the list of orbits is complete at each of them.

    Empty where it is at none.
    """
    at, limits = rotor.parameters, along.field
    if along.name == "gamma":
        lowest = min(0.02 * max(1.0, at.omega), 0.5 * at.gamma if at.gamma > 0 else 1.0)
        highest = 8.0 * max(1.0, at.omega, at.gamma)
        while lowest < 0.1 * highest and not _can_search(along.move(rotor, lowest)):
            lowest *= 2.0
        highest = min(highest, limits.highest)
        # A soft rotor is so strongly overdamped there that one of its exponents decays very slowly.
        while highest > 4.0 * max(lowest, at.gamma) and not _can_search(along.move(rotor, highest)):
            highest *= 0.5
    else:
        lowest, highest = usual_range(along, along.value(rotor), "within")
    lowest, highest = max(lowest, limits.lowest), min(highest, limits.highest)
    if lowest >= highest or not all(_can_search(along.move(rotor, value)) for value in (lowest, highest)):
        return []
    step = DAMPING_STEP if along.name == "gamma" else STEP
    return np.geomspace(lowest, highest, math.ceil(math.log(highest / lowest) / math.log1p(step)) + 1).tolist()


def _can_search(rotor: Rotor) -> bool:
    return rotor.parameters.gamma > 0.0 and longest_within_reach(rotor) is None
