"""Where along a gain levitation is the only motion found: no orbit, no rub, and nothing else in simulated disturbances.

That no orbit with one impact a period and no synchronous rub exists is known for whole ranges (:mod:`carom.studies.ranges`,
:mod:`carom.studies.orbit_ranges`).  Motions with several impacts, irregular bouncing and the like are known from
simulation only: in each range disturbances are followed at several values, and where some end in such a motion, the
range is cut back to where they do not.  Backward whirl is told apart, as it exists nearly everywhere and takes a fast
start to get into.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Literal

import numpy as np

from carom.attractors import DisturbanceSet, motion_name
from carom.disturbances import FASTEST
from carom.models import Jeffcott
from carom.motions.ensembles import Endings, settle
from carom.outcome import Outcome
from carom.parameters import Parameters
from carom.studies.ranges import Edge, Gain, MotionRange, Span, free_spans, outside

__all__ = ["LevitationAlone", "Met", "levitation_alone"]

SEED = 1
"""Of the disturbances; not that of the study's own sample."""
COUNT = 1000
FEW = 100
"""Disturbances tried before all of them: enough to meet a motion that attracts many."""
RIM_PLACES, RIM_DIRECTIONS = 12, 8
"""Starts on the wall at the largest speed: places round it, and directions at each."""
FEWEST, MOST, STEP = 5, 16, 0.12
"""Values at which a range is looked at: how many, and their relative distance between these limits."""
INSET = 1e-3
"""Distance of the outermost of them from the ends, in shares of the range (of its logarithm)."""
WIDTH = 1e-3
"""Relative width to which the end of a simulated motion is bisected."""
REMEMBERED = 16
"""Motions found last that are tried again at the next value."""

Kind = Literal["levitation", "whirl", "other"]
WHIRL = (Outcome.BACKWARD_WHIRL, Outcome.ROLLING)


@dataclass(frozen=True)
class Met:
    """A motion other than levitation that a disturbance ended in where no orbit and no rub is known.

    Attributes
    ----------
    motion : str
        Its name, as in :class:`~carom.attractors.Attractor`.
    value : float
        Of the gain.
    position, velocity : complex
        A state from which it is reached, co-rotating frame.
    """

    motion: str
    value: float
    position: complex
    velocity: complex


@dataclass(frozen=True)
class LevitationAlone:
    """Where along one gain levitation is the only motion that was found, backward whirl aside.

    Attributes
    ----------
    gain : {"gamma", "omega"}
    spans : tuple of Span
        Disjoint, in growing order.  An end of kind ``"simulated"`` is one beyond which a disturbance ended in the motion
        named there.
    whirl : tuple of Span
        The parts in which a disturbance got into backward whirl.
    met : tuple of Met
        At each end of kind ``"simulated"``, the motion just beyond it, in the order of the ends; then backward whirl.
    values : tuple of float
        At which disturbances were followed and no motion but levitation, or backward whirl, was met.
    disturbances, rim : int
        Followed at each value: of the seeded sample, and on the wall at the largest speed.
    seed : int
    fastest : float
        Largest speed of the disturbances, in ``c_r Ω``.
    """

    gain: Gain
    spans: tuple[Span, ...]
    whirl: tuple[Span, ...]
    met: tuple[Met, ...]
    values: tuple[float, ...]
    disturbances: int = COUNT
    rim: int = RIM_PLACES * RIM_DIRECTIONS
    seed: int = SEED
    fastest: float = FASTEST

    @property
    def calm(self) -> tuple[Span, ...]:
        """The parts in which every disturbance came back."""
        return tuple(part for span in self.spans for part in outside(_inside(self.whirl, span), span))


def levitation_alone(
    parameters: Parameters, gain: Gain, ranges: tuple[MotionRange, ...], count: int = COUNT
) -> LevitationAlone | None:
    """Find where along a gain levitation is the only motion, by closed forms, search and simulation.

    Parameters
    ----------
    parameters : Parameters
    gain : {"gamma", "omega"}
    ranges : tuple of MotionRange
        Of the contact-free motion, of rubs and of orbits along this gain.
    count : int
        Disturbances followed at each value.

    Returns
    -------
    LevitationAlone or None
        ``None`` where orbits were not searched.
    """
    free = free_spans(ranges, gain)
    if free is None:
        return None
    trial = _Trial(parameters, gain, count)
    spans: list[Span] = []
    whirl: list[Span] = []
    for span in free:
        quiet, whirling = _looked_at(trial, span)
        spans += quiet
        whirl += whirling
    return LevitationAlone(
        gain, tuple(spans), tuple(whirl), tuple(trial.met.values()), tuple(sorted(trial.clear)), count
    )


@dataclass(eq=False)
class _Trial:
    """Follows disturbances at one value after the other, and tries the motions found last again."""

    parameters: Parameters
    gain: Gain
    count: int
    met: dict[tuple[str, float], Met] = field(default_factory=dict)
    clear: list[float] = field(default_factory=list)
    last: dict[Kind, list[tuple[complex, complex]]] = field(default_factory=dict)
    seen: dict[float, Met] = field(default_factory=dict)

    def at(self, value: float) -> Kind:
        """What the disturbances come to at a value: the worst of it."""
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
                name = motion_name(Outcome(int(ends.outcomes[lost[0]])), int(ends.multiplicities[lost[0]]))
                start = complex(positions[lost[0]]), complex(velocities[lost[0]])
                self.seen[value] = Met(name, value, *start)
                self._remember(kind, ends, positions, velocities, lost[:REMEMBERED])
                return kind
        return "levitation"

    def _remember(
        self, kind: Kind, ends: Endings, positions: np.ndarray, velocities: np.ndarray, lost: np.ndarray
    ) -> None:
        """Keep the starts, and where they ended: there the motion is met again as long as it exists.

        Not so for backward whirl, which exists nearly everywhere: that it is reached is what counts.
        """
        states = list(zip(positions[lost].tolist(), velocities[lost].tolist(), strict=True))
        if kind == "other":
            inside = ends.positions[lost] / np.maximum(1.0, np.abs(ends.positions[lost]))
            states += zip(inside.tolist(), ends.velocities[lost].tolist(), strict=True)
        self.last[kind] = states


_ORDER: tuple[Kind, ...] = ("levitation", "whirl", "other")


def _starts(rotor: Jeffcott, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Starts on the wall at the largest speed, and the seeded sample, the fastest first."""
    places, speeds = DisturbanceSet(count, SEED).states(rotor)
    order = np.argsort(-np.abs(speeds), kind="stable")
    wall = np.exp(2j * math.pi * np.arange(RIM_PLACES) / RIM_PLACES)
    turns = np.exp(2j * math.pi * np.arange(RIM_DIRECTIONS) / RIM_DIRECTIONS)
    rim_places = np.repeat(wall, RIM_DIRECTIONS)
    rim_speeds = FASTEST * rim_places * np.tile(turns, RIM_PLACES)
    return np.concatenate([rim_places, places[order]]), np.concatenate([rim_speeds, speeds[order]])


def _looked_at(trial: _Trial, span: Span) -> tuple[list[Span], list[Span]]:
    """The parts of a range that simulation leaves to levitation alone, and those of them with backward whirl."""
    low, high = span.low.value, span.high.value
    inset = (high / low) ** INSET
    count = int(np.clip(math.ceil(math.log(high / low) / math.log1p(STEP)), FEWEST, MOST))
    # From above: motions found last are followed down, and up again by bisection.
    values = np.geomspace(high / inset, low * inset, count).tolist()
    kinds = [trial.at(value) for value in values]
    marks = [(value, kind) for value, kind in zip(values, kinds, strict=True)]
    for (value, kind), (other, other_kind) in list(pairwise(marks)):
        marks += _changes(trial, value, kind, other, other_kind)
    marks.sort(key=lambda mark: mark[0])
    return _parts(trial, span, marks, ("levitation", "whirl")), _parts(trial, span, marks, ("whirl",))


def _changes(trial: _Trial, high: float, kind: Kind, low: float, other: Kind) -> list[tuple[float, Kind]]:
    """Bisect each change between two values; what was found on the way."""
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
    """Stretches between marks of the wanted kinds; at their ends the motion that was met beyond."""
    parts: list[Span] = []
    start: Edge | None = span.low if marks[0][1] in wanted else None
    for (value, kind), (after, next_kind) in pairwise(marks):
        if (kind in wanted) == (next_kind in wanted):
            continue
        beyond, inside = (value, after) if next_kind in wanted else (after, value)
        seen = trial.seen.get(beyond) or trial.seen.get(inside)
        name = seen.motion if seen else ""
        if seen:
            trial.met[seen.motion, seen.value] = seen
        edge = Edge(inside, "simulated", certified=False, motion=name)
        if start is None:
            start = edge
        else:
            parts.append(Span(start, edge))
            start = None
    if start is not None:
        parts.append(Span(start, span.high))
    return parts


def _inside(spans: tuple[Span, ...], within: Span) -> tuple[Span, ...]:
    return tuple(span for span in spans if within.low.value <= span.low.value <= within.high.value)
