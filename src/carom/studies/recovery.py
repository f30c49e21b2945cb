"""Which values of a parameter leave only recovery: found by simulation, for any rotor, parameter and disturbances.

At each value tried, every kind of disturbance is drawn afresh, and once more with its size at the largest (on the wall, at full
speed), since these are lost first.  Disturbances lost at one value are tried again at the next, as they are and varied: the
share that is lost becomes very small before it vanishes.  Between a value that loses some and one that loses none, the end is
bisected.  This is evidence, not proof: each value has a number of disturbances tried, and the ends are no better than these.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import ClassVar

import numpy as np

from carom.arguments import Count, Seed, checked
from carom.attractors import MotionName
from carom.attractors.naming import name_motions
from carom.basins.shares import Population, Share
from carom.disturbances import Disturbance, Sample, Starts
from carom.disturbances.following import follow
from carom.models import Axis, Model, Subject, axis, model_of
from carom.models.axes import Ends, read_interval, usual_range
from carom.motions.ensembles import Endings
from carom.outcome import InputError
from carom.parameters.told import told_along
from carom.progress import Reporter, ShowProgress, shows_progress
from carom.results import Result
from carom.studies.ranges import Edge, Span

FIRST_LOOK = 200
"""Number of disturbances of a kind that are followed first; the others follow only if none of these is lost."""
AT_LARGEST = 96
"""Number of disturbances of a kind whose sizes are all at their largest."""
KEPT, VARIANTS = 24, 96
"""Lost disturbances of a kind that are tried again at the next value, and the number of variants of them."""
FINEST = 1e-5
"""Least change of a variant, as a share of the range of each coordinate; the greatest is one."""
FEWEST, MOST, STEP = 5, 16, 0.12
"""Values at which an interval is sampled: least and greatest number, and the relative step wanted."""
INSET = 1e-3
"""Distance of the outermost values from the ends of an interval, as a share of its logarithm."""
WIDTH = 2e-3
"""Relative width at which the bisection for an end stops."""


@dataclass(frozen=True)
class Lost:
    """A disturbance that did not come back.

    Attributes
    ----------
    model : Disturbance
    values : tuple of float
        Its coordinates, in the order of ``model.coordinates``.
    motion : MotionName or None
        Where it ended; ``None`` where the rotor cannot levitate.
    """

    model: Disturbance
    values: tuple[float, ...]
    motion: MotionName | None


@dataclass(frozen=True, repr=False)
class Check(Result):
    """Disturbances followed at one value of a parameter.

    Attributes
    ----------
    value : float
    returned : tuple of Share
        For each kind of disturbance, how many of those drawn came back.
    largest : tuple of Share
        The same for those at their largest size.
    example : Lost or None
        One that did not come back; ``None`` if all did.
    """

    shown: ClassVar[tuple[str, ...]] = ("value", "drawn", "recovers")

    value: float
    returned: tuple[Share, ...]
    largest: tuple[Share, ...]
    example: Lost | None

    @property
    def recovers(self) -> bool:
        """Whether every disturbance came back."""
        return self.example is None

    @property
    def drawn(self) -> Share:
        """Of the disturbances drawn, of all kinds, how many came back."""
        return _together(self.returned)

    @property
    def tried(self) -> int:
        """Number of disturbances followed."""
        return self.drawn.total + _together(self.largest).total


def _together(shares: tuple[Share, ...]) -> Share:
    return Share.of(sum(share.count for share in shares), sum(share.total for share in shares), drawn=True)


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
    searched : tuple of Span
        Where values were tried.
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


@checked
@shows_progress
def find_recovery(
    machine: Subject,
    along: str,
    disturbances: Sequence[Sample],
    *,
    within: Ends | Sequence[Span] | None = None,
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
    within : tuple of float or str, or sequence of Span, optional
        The range to search, in the unit of the parameter, or several; by default half to twice the present value.
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
    """
    rotor = model_of(machine)
    varied = axis(rotor, along)
    if not disturbances:
        raise InputError("disturbances", None, "at least one sample of a kind of disturbance")
    spans = _spans(rotor, varied, within)
    trial = _Trial(rotor, varied, tuple(disturbances), seed, threads)
    tell = Reporter.of(progress, f"disturbances along {varied.name}")
    found: list[Span] = []
    for place, span in enumerate(spans):
        found += _recovering(trial, span)
        tell((place + 1) / len(spans))
    checks = tuple(trial.checks[value] for value in sorted(trial.checks))
    return Recovery(rotor, varied, tuple(disturbances), spans, tuple(found), checks)


@checked
def check_recovery(
    machine: Subject,
    disturbances: Sequence[Sample],
    *,
    along: str = "gamma",
    value: float | None = None,
    seed: Seed = 0,
    threads: Count | None = None,
) -> Check:
    """Follow all disturbances at one value of a parameter, by default its present one.

    Parameters
    ----------
    machine, along, disturbances, seed, threads
        As for :func:`find_recovery`; ``seed`` draws all samples anew.
    value : float, optional
        In the unit of the parameter.
    """
    rotor = model_of(machine)
    varied = axis(rotor, along)
    there = varied.value(rotor) if value is None else value
    return _Trial(rotor, varied, tuple(disturbances), seed, threads).at(there)


def _spans(rotor: Model, varied: Axis, within: Ends | Sequence[Span] | None) -> tuple[Span, ...]:
    """The intervals to search."""
    if within is None:
        within = usual_range(varied, varied.value(rotor), "within")
    if all(isinstance(span, Span) for span in within):
        return tuple(span for span in within if isinstance(span, Span))
    low, high = read_interval(varied, within)  # type: ignore[arg-type]
    if not low > 0.0:
        raise InputError("within", f"{low:g} to {high:g}", "a range above 0")
    return (Span(Edge(low), Edge(high)),)


@dataclass(eq=False)
class _Trial:
    """Follows disturbances at one value after another, and tries those lost last again."""

    rotor: Model
    varied: Axis
    disturbances: tuple[Sample, ...]
    seed: int
    threads: int | None

    def __post_init__(self) -> None:
        self.checks: dict[float, Check] = {}
        self.last: dict[int, np.ndarray] = {}

    @cached_property
    def variation(self) -> np.random.Generator:
        """Random numbers of the variants: fresh samples do not depend on how many there were."""
        return np.random.default_rng([self.seed, 1])

    def recovers(self, value: float) -> bool:
        """Whether every disturbance comes back at a value; follows no more once some are lost."""
        if value not in self.checks:
            self.checks[value] = self.at(value, stop=True)
        return self.checks[value].recovers

    def at(self, value: float, stop: bool = False) -> Check:
        """Follow the disturbances at a value: all of them, or until some are lost."""
        rotor = self.varied.move(self.rotor, value)
        models = [sample.model.rescaled(self.rotor.scales, rotor.scales) for sample in self.disturbances]
        counts = np.zeros((2, len(models), 2), int)  # drawn or at the largest size, kind, came back and tried
        example: Lost | None = None
        for place, values, row in self._portions(value, again=stop):
            starts: Starts = models[place].starts(rotor, *values)
            ends = follow(models[place].machine_after(rotor), starts, threads=self.threads)
            gone = np.flatnonzero(~ends.recovered)
            if row is not None:
                counts[row, place] += ends.recovered.size - len(gone), ends.recovered.size
            if len(gone):
                self.last[place] = values[:, gone[:KEPT]]
                example = example or _lost(rotor, models[place], values[:, gone[0]], ends[gone[:1]])
                if stop:
                    break
        of = [Population.of_model(model, rotor.scales) for model in models]
        drawn, largest = (
            tuple(Share.of(*kind, drawn=True, population=each) for kind, each in zip(row, of, strict=True))
            for row in counts.tolist()
        )
        return Check(value, drawn, largest, example)

    def _portions(self, value: float, again: bool) -> Iterator[tuple[int, np.ndarray, int | None]]:
        """Disturbances of each kind for this value: the kind, coordinates (k, n), and the row in which they count.

        Those lost at other values come first ``again``, with their variants; they are not drawn and do not count.
        """
        if again:
            for place, lost in list(self.last.items()):
                yield place, np.hstack([lost, self._variants(place, lost)]), None
        random = np.random.default_rng([self.seed, 0, np.float64(value).view(np.uint64).item()])
        drawn = []
        for place, sample in enumerate(self.disturbances):
            yield place, _coordinates(sample, random, AT_LARGEST, largest=True), 1
            drawn.append(_coordinates(sample, random, sample.count))
        for place, values in enumerate(drawn):
            yield place, values[:, :FIRST_LOOK], 0
        for place, values in enumerate(drawn):
            if values.shape[1] > FIRST_LOOK:
                yield place, values[:, FIRST_LOOK:], 0

    def _variants(self, place: int, lost: np.ndarray) -> np.ndarray:
        """Variants of lost disturbances, coordinates (k, VARIANTS): changes of all sizes, within the ranges."""
        chosen = lost[:, self.variation.integers(lost.shape[1], size=VARIANTS)]
        sizes = np.exp(self.variation.uniform(math.log(FINEST), 0.0, VARIANTS))
        for row, along in zip(chosen, self.disturbances[place].model.coordinates, strict=True):
            row += sizes * self.variation.standard_normal(VARIANTS) * (along.high - along.low)
            if not along.periodic:
                np.clip(row, along.low, along.high, out=row)
        return chosen


def _lost(rotor: Model, model: Disturbance, values: np.ndarray, ends: Endings) -> Lost:
    """The one disturbance with these coordinates, which ended so."""
    _, names = name_motions(model.machine_after(rotor), ends)
    return Lost(model, tuple(values.tolist()), names[0] if names else None)


def _coordinates(sample: Sample, random: np.random.Generator, count: int, largest: bool = False) -> np.ndarray:
    """Coordinates (k, count) of disturbances drawn like a sample; all but angles at their upper end if ``largest``."""
    along = sample.model.coordinates
    shares = random.random((len(along), count))
    if largest:
        shares[[not each.periodic for each in along]] = 1.0
    return np.array([each.at(share) for each, share in zip(along, shares, strict=True)])


def coordinates_at_largest(sample: Sample, count: int) -> np.ndarray:
    """Coordinates (k, count) of disturbances of a kind at their largest size, in random directions."""
    return _coordinates(sample, np.random.default_rng(sample.seed), count, largest=True)


def _recovering(trial: _Trial, span: Span) -> list[Span]:
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
    return _joined(trial, span, sorted(marks))


def _joined(trial: _Trial, span: Span, marks: list[tuple[float, bool]]) -> list[Span]:
    """The spans between marks that recover; an end is the last value that did, and names the motion beyond it."""
    parts: list[Span] = []
    start: Edge | None = span.low if marks[0][1] else None
    for (value, here), (after, there) in pairwise(marks):
        if here == there:
            continue
        beyond, inside = (value, after) if there else (after, value)
        example = trial.checks[beyond].example
        edge = Edge(inside, "simulated", certified=False, motion=example.motion if example else None)
        if start is None:
            start = edge
        else:
            parts.append(Span(start, edge))
            start = None
    if start is not None:
        parts.append(Span(start, span.high))
    return parts


def in_all(disturbances: Sequence[Sample], count: int) -> tuple[Sample, ...]:
    """The same kinds of disturbances with about so many in all, in the same proportions."""
    total = sum(sample.count for sample in disturbances)
    return tuple(replace(sample, count=max(1, round(count * sample.count / total))) for sample in disturbances)
