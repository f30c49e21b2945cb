"""For which values of a parameter each simple motion exists, and which leave only recovery: for any rotor, parameter and disturbances.

Recovery is looked for where the rotor levitates, whether other motions can hold it there or not, for what must be survived may never reach them.
Simulation decides (:mod:`carom.studies.trials`): between a value that loses some disturbances and one that loses none, the end is
bisected; where a known motion of the planar rotor appears or vanishes there, that is the end: exact for steady ones, by search for orbits.  This
is evidence, not proof: each value has a number of disturbances tried, and the ends are no better than these.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import ClassVar, Literal, get_args

import numpy as np

from carom.base.arguments import Count, Positive, Seed, checked
from carom.base.outcome import CaromError, InputError
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import Result
from carom.bifurcations import orbit_windows
from carom.bifurcations.steady import steady_points
from carom.closed_forms import find_equilibria, rolling
from carom.closed_forms.thresholds import Gain, Steady, ranges_of
from carom.disturbances import Sample
from carom.models import Axis, Edge, Rotor, Span, Subject, axis, exact_rotor_of, rotor_of
from carom.models.axes import Ends, paired, read_interval, spans_where, usual_range
from carom.motions.budget import BudgetSpentError
from carom.orbits.single_impact import longest_within_reach
from carom.parameters import PHYSICAL_PARTNER
from carom.parameters.formats import format_along, own_entry
from carom.parameters.scaling import CONVERSIONS
from carom.studies.trials import Check, Trial

Motion = Steady | Literal["single-impact", "stable-single-impact"]

DAMPING_STEP, ORBIT_STEP = 0.1, 0.05
"""Relative steps between the values at which all orbits are computed: along damping, and along other parameters."""
_OWN: dict[str, str] = {there: own for own, there in PHYSICAL_PARTNER.items()}
FEWEST, MOST, STEP, STEP_SINGLY = 5, 16, 0.12, 0.25
"""Values at which an interval is sampled: least and greatest number, and the relative step wanted, a longer one of rotors whose motions are followed
one after another."""
INSET = 1e-3
"""Distance of the outermost values from the ends of an interval, as a share of its logarithm."""
WIDTH = 2e-3
"""Relative width at which the bisection for an end stops."""


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
    def thresholds(self) -> tuple[tuple[Edge, str], ...]:
        """The edges at which the motion appears or vanishes, each with the side on which it exists: ``"above"`` or ``"below"``."""
        sides = [(edge, side) for span in self.spans for edge, side in zip(span, ("above", "below"), strict=True)]
        return tuple((edge, side) for edge, side in sides if edge.kind)

    def exists_at(self, value: float) -> bool:
        """Whether the motion exists for this value."""
        return any(value in span for span in self.spans)


@dataclass(frozen=True, eq=False, repr=False)
class Recovery(Result):
    """The values of a parameter at which every disturbance tried came back.

    Attributes
    ----------
    rotor : Model
        The present machine.
    along : Axis
        The parameter.
    disturbances : tuple of Sample
        Kinds of disturbances, and how many of each were drawn at each value.
    motions : tuple of MotionRange
        For which values each simple motion of the planar rotor exists; empty for other rotors, and where a range was given.
    searched : tuple of Span
        Where values were tried; empty where the orbits of the planar rotor could not be searched.
    spans : tuple of Span
        Where every disturbance came back, disjoint, in ascending order.  Beyond an end of kind ``"simulated"`` one ended in the
        motion named there; at other ends a known motion of the planar rotor appears or vanishes, or the search ends.
    checks : tuple of Check
        Every value tried, in ascending order.  Where some are lost, the disturbances after the first losses were not followed.
    complete : bool
        Whether the search came to its end.  Otherwise the budget of a study ended it (:mod:`carom.motions.budget`): there are no spans, and
        nothing is known of values that were not tried.
    """

    shown: ClassVar[tuple[str, ...]] = ("rotor", "searched", "spans", "checks")

    rotor: Rotor
    along: Axis
    disturbances: tuple[Sample, ...]
    motions: tuple[MotionRange, ...]
    searched: tuple[Span, ...]
    spans: tuple[Span, ...]
    checks: tuple[Check, ...]
    complete: bool = True

    def line_of(self, name: str, value: object) -> str:
        """Spans are stated in the unit of the parameter."""
        if name not in ("searched", "spans"):
            return super().line_of(name, value)
        ranges = ((span.low.value, span.high.value) for span in getattr(self, name))
        return "; ".join(format_along(self.along.name, ends, self.known_scales) for ends in ranges) or "none"

    @property
    def clear(self) -> tuple[Check, ...]:
        """The values at which nothing was lost."""
        return tuple(check for check in self.checks if check.recovers)

    @checked
    def span_at(self, value: float) -> Span | None:
        """Return the span that holds a value."""
        return next((span for span in self.spans if value in span), None)

    def range_of(self, motion: Motion) -> MotionRange | None:
        """Return the range of a motion; ``None`` if it was not determined."""
        return next((entry for entry in self.motions if entry.motion == motion), None)


@checked
@shows_progress
def find_recovery(
    machine: Subject,
    along: str,
    disturbances: Sequence[Sample],
    *,
    within: Ends | None = None,
    factor: Positive | None = None,
    seed: Seed = 0,
    threads: Count | None = None,
    progress: ShowProgress = None,
) -> Recovery:
    """Find the values of a parameter for which every disturbance tried comes back to levitation.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    along : str
        The parameter; any of :func:`carom.models.axis`.
    disturbances : sequence of Sample
        Kinds of disturbances with the number drawn at each value.  Where the parameter changes the scales (shaft speed,
        clearance) they keep their size in SI units.
    within : tuple of float or str, optional
        The range to search, in the unit of the parameter; by default wherever the planar rotor levitates; for other rotors half to twice the
        present value.
    factor : float, optional
        Without ``within``: search only where the damping or the stiffness is at most so many times larger or smaller than now.
    seed : int
        Seed of all random numbers; each value has a sample of its own.
    threads : int, optional
        By default one for each core; the result does not depend on it.

    Returns
    -------
    Recovery

    Raises
    ------
    InputError
        An unknown parameter, a range that cannot be used, or no disturbances.

    See Also
    --------
    carom.map_gains : the share that comes back against two parameters
    carom.study : which disturbances a machine must survive

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> kicks = cm.disturbances.Sample(cm.disturbances.VelocityKick.of(machine, "50 mm/s"), 200)
    >>> found = cm.studies.find_recovery(machine, "damping", [kicks], within=("2000 N s/m", "8000 N s/m"))
    >>> len(found.spans), found.spans[0].low.motion
    (1, 'synchronous rub')
    >>> slower = cm.studies.find_recovery(machine, "speed", [kicks])
    >>> [(round(span.low.value), round(span.high.value), span.high.kind) for span in slower.spans]
    [(92, 120, 'boundary-equilibrium')]
    """
    rotor = rotor_of(machine)
    varied = axis(rotor, along)
    if not disturbances:
        raise InputError("disturbances", None, "at least one sample of a kind of disturbance")
    tell = Reporter.of(progress, f"disturbances along {varied.name}")
    motions = motion_ranges(rotor, varied, tell.part(0.0, 0.5)) if within is None else ()
    searched = _searched(rotor, varied, within, motions, factor)
    known = [edge for entry in motions for span in entry.spans for edge in span]
    trial = Trial(rotor, varied, tuple(disturbances), seed, threads)
    found: tuple[Span, ...] = ()
    complete = True
    try:
        found = tuple(part for span in searched for part in _recovering(trial, span, known))
    except BudgetSpentError:
        complete = False
    tell(1.0)
    checks = tuple(check for _, check in sorted(trial.checks.items()))
    return Recovery(rotor, varied, tuple(disturbances), motions, searched, found, checks, complete)


def power_of(along: Axis) -> int:
    """Power of a parameter that is proportional to what the machine has: the stiffness to that of ``ω``."""
    return CONVERSIONS[along.name].power if along.name in CONVERSIONS else 1


def _searched(
    rotor: Rotor, varied: Axis, within: Ends | None, motions: tuple[MotionRange, ...], factor: float | None
) -> tuple[Span, ...]:
    """The intervals to search."""
    present = varied.value(rotor)
    if not motions:
        low, high = read_interval(varied, within or usual_range(varied, present, "within"))
        if not low > 0.0:
            raise InputError("within", f"{low:g} to {high:g}", "a range above 0")
        return (Span(Edge(low), Edge(high)),)
    known = {entry.motion: entry for entry in motions}
    orbits = known.get("single-impact")
    if orbits is None or orbits.searched is None:
        return ()
    levitation, reach = known["contact-free"], orbits.searched
    edges = [*reach, *(edge for span in levitation.spans for edge in span if edge.value in reach)]
    if factor is not None and present > 0.0:
        times = factor ** (1.0 / power_of(varied))
        ends = max(present / times, reach.low.value), min(present * times, reach.high.value)
        reach = Span(*map(Edge, ends))
        edges += reach
    return spans_where(edges, lambda value: levitation.exists_at(value) and value in reach)


def changes(places: Sequence[float], what: Callable[[float], object], width: float) -> list[tuple[float, float]]:
    """Neighbours, at most a relative width apart, between which something changes that differs between neighbouring places, all above zero."""
    values, found = list(map(what, places)), []
    for (first, before), (last, after) in pairwise(zip(places, values, strict=True)):
        while before != after and abs(last - first) > width * min(first, last):
            middle = math.sqrt(first * last)
            first, last = (middle, last) if what(middle) == before else (first, middle)
        found += [(first, last)] if before != after else []
    return found


def _recovering(trial: Trial, span: Span, known: Sequence[Edge]) -> tuple[Span, ...]:
    """The parts of an interval in which every disturbance comes back; a known edge where they begin to is their end."""
    low, high = span.low.value, span.high.value
    inset = (high / low) ** INSET
    step = STEP if trial.rotor.system.is_planar else STEP_SINGLY
    count = int(np.clip(math.ceil(math.log(high / low) / math.log1p(step)), FEWEST, MOST))
    # Downward: what is lost at one value is likely to be lost at the next.
    values = np.geomspace(high / inset, low * inset, count).tolist()
    ends = [span.high] if trial.recovers(values[0]) else []
    for upper, lower in changes(values, trial.recovers, WIDTH):
        beyond, inside = (lower, upper) if trial.recovers(upper) else (upper, lower)
        lost = trial.checks[beyond].example
        here_lost = Edge(inside, "simulated", motion=lost.motion if lost else None)
        ends.append(next((edge for edge in known if edge.kind and lower <= edge.value <= upper), here_lost))
    return paired(([*ends, span.low] if trial.recovers(values[-1]) else ends)[::-1])


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
    step = DAMPING_STEP if along.name == "gamma" else ORBIT_STEP
    return np.geomspace(lowest, highest, math.ceil(math.log(highest / lowest) / math.log1p(step)) + 1).tolist()


def _can_search(rotor: Rotor) -> bool:
    return rotor.parameters.gamma > 0.0 and longest_within_reach(rotor) is None
