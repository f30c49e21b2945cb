"""The values of a gain for which levitation is the only motion found: no orbit, no rub, and no other simulated ending.

The ranges without orbits with one impact a period and without synchronous rubs are known (:mod:`carom.studies.ranges`,
:mod:`carom.studies.orbit_ranges`).  Motions with several impacts, irregular bouncing and the like are known from
simulation only.  In each range disturbances are followed at several values.  Where some of them end in such a motion,
the range is cut back to the values at which none does.  Backward whirl is treated separately, because it exists nearly
everywhere and needs a fast start.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Literal

import numpy as np

from carom.attractors import DisturbanceSet, MotionName
from carom.attractors.naming import name_motions
from carom.closed_forms.thresholds import Gain
from carom.disturbances import FASTEST
from carom.models import Jeffcott
from carom.motions.ensembles import Endings, settle
from carom.outcome import Outcome
from carom.parameters import Parameters
from carom.studies.ranges import Edge, MotionRange, Span, free_spans, outside

SEED = 1
"""Seed of the disturbances, different from that of the study's own sample."""
COUNT = 1000
FEW = 100
"""Number of disturbances tried first: enough to find a motion that attracts many of them."""
RIM_PLACES, RIM_DIRECTIONS = 12, 8
"""Starts on the wall at the largest speed: number of places around it, and of directions at each place."""
FEWEST, MOST, STEP = 5, 16, 0.12
"""Values at which a range is sampled: least and greatest number, and the relative step wanted."""
INSET = 1e-3
"""Distance of the outermost values from the ends, as a fraction of the logarithm of the range."""
WIDTH = 1e-3
"""Relative width at which the bisection for the end of a simulated motion stops."""
REMEMBERED = 16
"""Number of starts lost last that are tried again at the next value."""

Kind = Literal["levitation", "whirl", "other"]
WHIRL = (Outcome.BACKWARD_WHIRL, Outcome.ROLLING)


@dataclass(frozen=True)
class OtherMotion:
    """A motion other than levitation in which a disturbance ended, at a value where no orbit and no rub is known.

    Attributes
    ----------
    value : float
        Value of the gain.
    position, velocity : complex
        A start from which the motion is reached, co-rotating frame.
    """

    motion: MotionName
    value: float
    position: complex
    velocity: complex


@dataclass(frozen=True)
class LevitationAlone:
    """The values of one gain for which levitation is the only motion found, apart from backward whirl.

    Attributes
    ----------
    gain : {"gamma", "omega"}
    spans : tuple of Span
        Disjoint, in ascending order.  Beyond an end of kind ``"simulated"`` a disturbance ended in the motion named
        there.
    whirl : tuple of Span
        The parts of them in which a disturbance ended in backward whirl.
    met : tuple of OtherMotion
        At each end of kind ``"simulated"``, the motion just beyond it, in the order of the ends; then backward whirl.
    values : tuple of float
        Values at which disturbances were followed and all ended in levitation or backward whirl.
    disturbances, rim : int
        Numbers of disturbances followed at each value: of the seeded sample, and on the wall at the largest speed.
    seed : int
        Seed of the sample.
    fastest : float
        Largest speed of the disturbances, in ``c_r Ω``.
    """

    gain: Gain
    spans: tuple[Span, ...]
    whirl: tuple[Span, ...]
    met: tuple[OtherMotion, ...]
    values: tuple[float, ...]
    disturbances: int = COUNT
    rim: int = RIM_PLACES * RIM_DIRECTIONS
    seed: int = SEED
    fastest: float = FASTEST

    @property
    def without_whirl(self) -> tuple[Span, ...]:
        """The parts of the spans in which every disturbance came back."""
        return tuple(part for span in self.spans for part in outside(self.whirl, span))


def levitation_alone(
    parameters: Parameters, gain: Gain, ranges: tuple[MotionRange, ...], count: int = COUNT
) -> LevitationAlone | None:
    """Find the values of a gain for which levitation is the only motion, by closed forms, search and simulation.

    The ranges are those of the contact-free motion, of rubs and of orbits along this gain; ``None`` if orbits were not
    searched.  ``count`` disturbances are followed at each value.
    """
    free = free_spans(ranges, gain)
    if free is None:
        return None
    trial = _Trial(parameters, gain, count)
    spans: list[Span] = []
    whirl: list[Span] = []
    for span in free:
        quiet, whirling = _sample_span(trial, span)
        spans += quiet
        whirl += whirling
    return LevitationAlone(
        gain, tuple(spans), tuple(whirl), tuple(trial.met.values()), tuple(sorted(trial.clear)), count
    )


@dataclass(eq=False)
class _Trial:
    """Follows disturbances at one value after another; starts that were lost last are tried again first."""

    parameters: Parameters
    gain: Gain
    count: int
    met: dict[tuple[MotionName, float], OtherMotion] = field(default_factory=dict)
    clear: list[float] = field(default_factory=list)
    last: dict[Kind, list[tuple[complex, complex]]] = field(default_factory=dict)
    seen: dict[float, OtherMotion] = field(default_factory=dict)

    def at(self, value: float) -> Kind:
        """Return the worst kind of motion in which the disturbances end at a value."""
        rotor = Jeffcott(self.parameters.replace(**{self.gain: value}))
        places, speeds = _starts(rotor, self.count)
        again = [state for kind in ("other", "whirl") for state in self.last.get(kind, ())]
        first = (
            np.array([place for place, _ in again] + [*places[:FEW]]),
            np.array([v for _, v in again] + [*speeds[:FEW]]),
        )
        worst: Kind = "levitation"
        for positions, velocities in (first, (places[FEW:], speeds[FEW:])):
            worst = max(worst, self._follow(rotor, value, positions, velocities), key=_ORDER.index)
            if worst == "other":
                return worst
        self.clear.append(value)
        return worst

    def _follow(self, rotor: Jeffcott, value: float, positions: np.ndarray, velocities: np.ndarray) -> Kind:
        ends = settle(rotor, positions, velocities)
        whirls = np.isin(ends.outcomes, WHIRL)
        lost_to: dict[Kind, np.ndarray] = {"other": ~ends.recovered & ~whirls, "whirl": whirls}
        for kind, chosen in lost_to.items():
            lost = np.flatnonzero(chosen)
            if len(lost):
                _, (name,) = name_motions(rotor, ends[lost[:1]])
                start = complex(positions[lost[0]]), complex(velocities[lost[0]])
                self.seen[value] = OtherMotion(name, value, *start)
                self._remember(kind, ends, positions, velocities, lost[:REMEMBERED])
                return kind
        return "levitation"

    def _remember(
        self, kind: Kind, ends: Endings, positions: np.ndarray, velocities: np.ndarray, lost: np.ndarray
    ) -> None:
        """Keep lost starts and their final states, which reach the motion again as long as it exists.

        Final states of backward whirl are not kept: it exists nearly everywhere, and only whether starts reach it
        matters.
        """
        states = list(zip(positions[lost].tolist(), velocities[lost].tolist(), strict=True))
        if kind == "other":
            inside = ends.positions[lost] / np.maximum(1.0, np.abs(ends.positions[lost]))
            states += zip(inside.tolist(), ends.velocities[lost].tolist(), strict=True)
        self.last[kind] = states


_ORDER: tuple[Kind, ...] = ("levitation", "whirl", "other")


def _starts(rotor: Jeffcott, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the starts on the wall at the largest speed, followed by the seeded sample, fastest first."""
    places, speeds, *_ = DisturbanceSet(count, SEED).starts(rotor)
    order = np.argsort(-np.abs(speeds), kind="stable")
    wall, turns = (np.exp(2j * math.pi * np.arange(number) / number) for number in (RIM_PLACES, RIM_DIRECTIONS))
    rim_places = np.repeat(wall, RIM_DIRECTIONS)
    rim_speeds = FASTEST * rim_places * np.tile(turns, RIM_PLACES)
    return np.concatenate([rim_places, places[order]]), np.concatenate([rim_speeds, speeds[order]])


def _sample_span(trial: _Trial, span: Span) -> tuple[list[Span], list[Span]]:
    """Return the parts of a range without other motions in simulation, and the parts of these with backward whirl."""
    low, high = span.low.value, span.high.value
    inset = (high / low) ** INSET
    count = int(np.clip(math.ceil(math.log(high / low) / math.log1p(STEP)), FEWEST, MOST))
    # Downward: motions found last are followed to lower values, and upward again by bisection.
    values = np.geomspace(high / inset, low * inset, count).tolist()
    kinds = [trial.at(value) for value in values]
    marks = [(value, kind) for value, kind in zip(values, kinds, strict=True)]
    for (value, kind), (other, other_kind) in list(pairwise(marks)):
        marks += _changes(trial, value, kind, other, other_kind)
    marks.sort(key=lambda mark: mark[0])
    return _parts(trial, span, marks, ("levitation", "whirl")), _parts(trial, span, marks, ("whirl",))


def _changes(trial: _Trial, high: float, kind: Kind, low: float, other: Kind) -> list[tuple[float, Kind]]:
    """Bisect each change between two values; return all values sampled with their kinds."""
    found: list[tuple[float, Kind]] = []
    while kind != other and high - low > WIDTH * low:
        middle = math.sqrt(high * low)
        here = trial.at(middle)
        found.append((middle, here))
        if here == kind:
            high = middle
        elif here == other:
            low = middle
        else:
            return found + _changes(trial, high, kind, middle, here) + _changes(trial, middle, here, low, other)
    return found


def _parts(trial: _Trial, span: Span, marks: list[tuple[float, Kind]], wanted: tuple[Kind, ...]) -> list[Span]:
    """Return the spans between marks of the wanted kinds; their ends name the motion found beyond."""
    parts: list[Span] = []
    start: Edge | None = span.low if marks[0][1] in wanted else None
    for (value, kind), (after, next_kind) in pairwise(marks):
        if (kind in wanted) == (next_kind in wanted):
            continue
        beyond, inside = (value, after) if next_kind in wanted else (after, value)
        seen = trial.seen.get(beyond) or trial.seen.get(inside)
        if seen:
            trial.met[seen.motion, seen.value] = seen
        edge = Edge(inside, "simulated", certified=False, motion=seen.motion if seen else None)
        if start is None:
            start = edge
        else:
            parts.append(Span(start, edge))
            start = None
    if start is not None:
        parts.append(Span(start, span.high))
    return parts
