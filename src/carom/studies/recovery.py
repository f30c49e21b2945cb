"""Which values of a parameter leave only recovery: the one answer to this, for any rotor, parameter and disturbances.

Where the motions of the planar rotor are known along the parameter (:mod:`carom.studies.ranges`), it is looked for where the
rotor levitates and no other motion can hold it, and elsewhere only if nothing is found there.  Then simulation decides
(:mod:`carom.studies.trials`): between a value that loses some disturbances and one that loses none, the end is bisected.  This
is evidence, not proof: each value has a number of disturbances tried, and the ends are no better than these.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

import numpy as np

from carom.arguments import Count, Seed, checked
from carom.disturbances import Sample
from carom.models import Axis, Edge, Model, Span, Subject, axis, model_of
from carom.models.axes import Ends, read_interval, usual_range
from carom.models.spans import paired, spans_where
from carom.outcome import InputError
from carom.parameters.told import told_along
from carom.progress import Reporter, ShowProgress, shows_progress
from carom.results import Result
from carom.studies.ranges import Motion, MotionRange, motion_ranges
from carom.studies.trials import Check, Trial

FEWEST, MOST, STEP = 5, 16, 0.12
"""Values at which an interval is sampled: least and greatest number, and the relative step wanted."""
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
        motion named there; other ends are those of the range searched.
    checks : tuple of Check
        Every value tried, in ascending order.  Where some are lost, the disturbances after the first losses were not followed.
    """

    shown: ClassVar[tuple[str, ...]] = ("rotor", "searched", "spans", "checks")

    rotor: Model
    along: Axis
    disturbances: tuple[Sample, ...]
    motions: tuple[MotionRange, ...]
    searched: tuple[Span, ...]
    spans: tuple[Span, ...]
    checks: tuple[Check, ...]

    def line_of(self, name: str, value: object) -> str:
        """Spans are told in the unit of the parameter."""
        if name not in ("searched", "spans"):
            return super().line_of(name, value)
        ranges = ((span.low.value, span.high.value) for span in getattr(self, name))
        return "; ".join(told_along(self.along.name, ends, self.known_scales) for ends in ranges) or "none"

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
    present: Check | None = None,
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
        The range to search, in the unit of the parameter; by default where the planar rotor levitates and no other
        simple motion can hold it, or, if nothing is found there, wherever it levitates.  For other rotors half to twice the present
        value.
    present : Check, optional
        What came back at the present value (:func:`check_recovery`).  Where all did, the range around it is searched even if
        another motion can hold the rotor there.
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
    rotor = model_of(machine)
    varied = axis(rotor, along)
    if not disturbances:
        raise InputError("disturbances", None, "at least one sample of a kind of disturbance")
    tell = Reporter.of(progress, f"disturbances along {varied.name}")
    motions = motion_ranges(rotor, varied, tell.part(0.0, 0.5)) if within is None else ()
    for searched in _places(rotor, varied, within, motions, present):
        trial = Trial(rotor, varied, tuple(disturbances), seed, threads)
        found = tuple(part for span in searched for part in _recovering(trial, span))
        if found:
            break
    tell(1.0)
    checks = tuple(check for _, check in sorted(trial.checks.items()))
    return Recovery(rotor, varied, tuple(disturbances), motions, searched, found, checks)


def _places(
    rotor: Model, varied: Axis, within: Ends | None, motions: tuple[MotionRange, ...], present: Check | None
) -> list[tuple[Span, ...]]:
    """The intervals to search, and those to search if no value of these leaves only recovery."""
    if not motions:
        low, high = read_interval(varied, within or usual_range(varied, varied.value(rotor), "within"))
        if not low > 0.0:
            raise InputError("within", f"{low:g} to {high:g}", "a range above 0")
        return [(Span(Edge(low), Edge(high)),)]
    known = {entry.motion: entry for entry in motions}
    orbits = known.get("single-impact")
    if orbits is None or orbits.searched is None:
        return [()]
    levitation, others = known["contact-free"], (orbits, known["rub"])
    spans = [span for entry in (*others, levitation) for span in entry.spans]
    edges = [*orbits.searched, *(edge for span in spans for edge in span if edge.value in orbits.searched)]
    levitating = spans_where(edges, levitation.exists_at)
    alone = spans_where(
        edges, lambda value: levitation.exists_at(value) and not any(entry.exists_at(value) for entry in others)
    )
    if present is not None and present.recovers and not any(varied.value(rotor) in span for span in alone):
        return [levitating]
    return [alone, levitating] if alone != levitating else [alone]


def _recovering(trial: Trial, span: Span) -> tuple[Span, ...]:
    """The parts of an interval in which every disturbance comes back."""
    low, high = span.low.value, span.high.value
    inset = (high / low) ** INSET
    count = int(np.clip(math.ceil(math.log(high / low) / math.log1p(STEP)), FEWEST, MOST))
    # Downward: what is lost at one value is likely to be lost at the next.
    values = np.geomspace(high / inset, low * inset, count).tolist()
    marks = [(value, trial.recovers(value)) for value in values]
    for (upper, here), (lower, there) in list(pairwise(marks)):
        while here != there and upper - lower > WIDTH * lower:
            middle = math.sqrt(upper * lower)
            back = trial.recovers(middle)
            marks.append((middle, back))
            upper, lower = (middle, lower) if back == here else (upper, middle)
    marks.sort()
    ends = [span.low] if marks[0][1] else []
    for (value, here), (after, there) in pairwise(marks):
        if here != there:
            beyond, inside = (value, after) if there else (after, value)
            lost = trial.checks[beyond].example
            ends.append(Edge(inside, "simulated", certified=False, motion=lost.motion if lost else None))
    return paired([*ends, span.high] if marks[-1][1] else ends)
