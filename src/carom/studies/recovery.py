"""Which values of a parameter leave only recovery: the one answer to this, for any rotor, parameter and disturbances.

It is looked for where the rotor levitates, whether other motions can hold it there or not, for what must be survived may never reach them.
Simulation decides (:mod:`carom.studies.trials`): between a value that loses some disturbances and one that loses none, the end is
bisected; where a known motion of the planar rotor appears or vanishes there (:mod:`carom.studies.ranges`), that is the end.  This
is evidence, not proof: each value has a number of disturbances tried, and the ends are no better than these.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

import numpy as np

from carom.base.arguments import Count, Positive, Seed, checked
from carom.base.outcome import InputError
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import Result
from carom.disturbances import Sample
from carom.models import Axis, Edge, Rotor, Span, Subject, axis, rotor_of
from carom.models.axes import Ends, read_interval, usual_range
from carom.models.spans import paired, spans_where
from carom.motions.budget import BudgetSpentError
from carom.parameters.formats import format_along
from carom.parameters.scaling import CONVERSIONS
from carom.studies.ranges import Motion, MotionRange, motion_ranges
from carom.studies.trials import Check, Trial

FEWEST, MOST, STEP, STEP_SINGLY = 5, 16, 0.12, 0.25
"""Values at which an interval is sampled: least and greatest number, and the relative step wanted, a longer one of rotors whose motions are followed
one after another."""
INSET = 1e-3
"""Distance of the outermost values from the ends of an interval, as a share of its logarithm."""
WIDTH = 2e-3
"""Relative width at which the bisection for an end stops."""


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
