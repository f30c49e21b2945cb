"""The word of an orbit: which segments follow one another in a period, and the condition at the end of each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
from typing import Annotated

import numpy as np

from carom.arguments import Count, Whole, checked, whole
from carom.core import segments
from carom.core.friction import BACKWARD, FORWARD, STOPPED
from carom.models import System
from carom.outcome import InputError, Phase


class Kind(IntEnum):
    """Kind of a segment: what happens at its beginning, and how the motion goes on."""

    IMPACT_FORWARD = segments.IMPACT_FORWARD
    IMPACT_BACKWARD = segments.IMPACT_BACKWARD
    IMPACT_STOPPED = segments.IMPACT_STOPPED
    LIFT = segments.LIFT
    LAND = segments.LAND
    SLIDE_FORWARD = segments.SLIDE_FORWARD
    SLIDE_BACKWARD = segments.SLIDE_BACKWARD
    ROLL = segments.ROLL
    FREE = segments.FREE

    @property
    def is_impact(self) -> bool:
        """Whether it is one impact and the flight that follows."""
        return self in IMPACTS

    @property
    def flies(self) -> bool:
        """Whether it is a flight, after an impact or from rest on the wall."""
        return self in IMPACTS or self is Kind.LIFT

    @property
    def lasts(self) -> bool:
        """Whether it is lasting contact."""
        return self in (Kind.SLIDE_FORWARD, Kind.SLIDE_BACKWARD, Kind.ROLL)

    @property
    def sense(self) -> int:
        """Sense of the slip after the impact or in lasting contact (:mod:`carom.core.friction`)."""
        if self in (Kind.IMPACT_STOPPED, Kind.ROLL):
            return STOPPED
        return BACKWARD if self in (Kind.IMPACT_BACKWARD, Kind.SLIDE_BACKWARD) else FORWARD

    @property
    def label(self) -> str:
        """Name in texts and JSON."""
        return _LABELS[self]

    @classmethod
    @checked
    def of_phase(cls, phase: Annotated[int, whole(min(Phase), max(Phase))]) -> Kind:
        """Kind of a segment that stays at its wall, or of the flight after it has left."""
        return {
            Phase.FLIGHT: cls.LIFT,
            Phase.FORWARD_SLIP: cls.SLIDE_FORWARD,
            Phase.BACKWARD_SLIP: cls.SLIDE_BACKWARD,
            Phase.ROLLING: cls.ROLL,
            Phase.SEPARATED: cls.FREE,
        }[Phase(phase)]


IMPACTS = Kind.IMPACT_FORWARD, Kind.IMPACT_BACKWARD, Kind.IMPACT_STOPPED
_LABELS = {
    Kind.IMPACT_FORWARD: "impact+",
    Kind.IMPACT_BACKWARD: "impact-",
    Kind.IMPACT_STOPPED: "impact0",
    Kind.LIFT: "lift",
    Kind.LAND: "land",
    Kind.SLIDE_FORWARD: "slide+",
    Kind.SLIDE_BACKWARD: "slide-",
    Kind.ROLL: "roll",
    Kind.FREE: "free",
}


@checked
@dataclass(frozen=True)
class Segment:
    """A part of an orbit.

    Attributes
    ----------
    kind : Kind
    plane : int
        Contact plane of the impact or of the lasting contact, or the plane that lifts off, from 0.  In text a touchdown bearing other than
        the first follows ``@``, counted from 1.
    """

    kind: Kind
    plane: Whole = 0

    def __str__(self) -> str:
        return f"{self.kind.label}@{self.plane + 1}" if self.plane else self.kind.label


@checked
@dataclass(frozen=True)
class Word(Sequence[Segment]):
    """The segments of one period, in their order.

    ``impact+``, ``impact-`` and ``impact0`` are one impact with forward slip, with backward slip, or one that stops the
    slip, and the flight after it.  ``land`` is a chatter, from its first impact to lasting contact; without restitution it is the
    impact that stays.  ``slide+``, ``slide-`` and ``roll`` are lasting contact at one plane while no other touches, and ``lift`` is the
    flight after it.  Sliding that is followed by the same sliding ends where the normal force is least: ``slide-`` alone never leaves
    the wall.

    Attributes
    ----------
    segments : tuple of Segment

    Raises
    ------
    InputError
        There are no segments, or one cannot follow another.
    """

    segments: tuple[Segment, ...]

    def __post_init__(self) -> None:
        if not len(self.segments):
            raise InputError("word", "()", "at least one segment")
        self.conditions  # noqa: B018  # raises where a segment cannot follow another

    @classmethod
    @checked
    def of(cls, *kinds: Kind, plane: Whole = 0) -> Word:
        """Word of segments at one plane."""
        return cls(tuple(Segment(kind, plane) for kind in kinds))

    def __len__(self) -> int:
        return len(self.segments)

    def __iter__(self) -> Iterator[Segment]:
        return iter(self.segments)

    def __getitem__(self, place):  # type: ignore[no-untyped-def]
        return self.segments[place]

    def __str__(self) -> str:
        return " ".join(map(str, self.segments))

    @property
    def impacts(self) -> int:
        """Number of arrivals at a wall in a period, without those of a chatter."""
        return int(self.arrives.sum())

    @cached_property
    def arrives(self) -> np.ndarray:
        """Which segments begin with an arrival at a wall; bool, shape (m,)."""
        return np.array(
            [
                segment.kind.is_impact or (segment.kind.lasts and before.kind.flies)
                for before, segment in zip((self.segments[-1], *self.segments[:-1]), self, strict=True)
            ]
        )

    @cached_property
    def flies(self) -> bool:
        """Whether all segments are impacts with the flight after them."""
        return all(segment.kind.is_impact for segment in self)

    @property
    def least(self) -> int:
        """Number of segments after which the word repeats."""
        m = len(self)
        return next(k for k in range(1, m + 1) if m % k == 0 and self.segments[k:] + self.segments[:k] == self.segments)

    @checked
    def repeated(self, times: Count) -> Word:
        """The word several times in a row."""
        return Word(self.segments * times)

    @checked
    def turned(self, places: int) -> Word:
        """The same cycle, beginning with another segment."""
        return Word(self.segments[places:] + self.segments[:places])

    def turns_to(self, other: Word) -> list[int]:
        """Places at which the cycle can begin to be another word; none if they differ."""
        return [k for k in range(len(self)) if len(self) == len(other) and self.turned(k) == other]

    @cached_property
    def kinds(self) -> np.ndarray:
        """Kinds as whole numbers, shape (m,)."""
        return np.fromiter((segment.kind for segment in self), np.int64, len(self))

    @cached_property
    def lands(self) -> np.ndarray:
        """Which segments are chatters, bool, shape (m,)."""
        chatters: np.ndarray = self.kinds == Kind.LAND
        return chatters

    @cached_property
    def landed(self) -> np.ndarray:
        """Which segments follow a chatter, bool, shape (m,)."""
        return np.roll(self.lands, 1)

    @cached_property
    def timed(self) -> np.ndarray:
        """Which segments are neither a chatter nor follow one, bool, shape (m,)."""
        timed: np.ndarray = ~(self.lands | self.landed)
        return timed

    @cached_property
    def timed_flights(self) -> np.ndarray:
        """Which of these are flights, bool, shape (m,)."""
        flights: np.ndarray = self.timed & [segment.kind.flies for segment in self]
        return flights

    def refuse_elsewhere(self, system: System) -> None:
        """Refuse the word for a rotor in whose rigid walls its segments cannot be.

        Raises
        ------
        InputError
            There is no such plane, or contact begins without an impact or a chatter.
        """
        for segment, arrives in zip(self, self.arrives.tolist(), strict=True):
            if segment.plane >= len(system.arrays.rows):
                raise InputError("word", segment, f"planes from 0 to {len(system.arrays.rows) - 1}")
            if arrives and not (segment.kind.is_impact or segment.kind is Kind.LAND):
                raise InputError("word", segment, "contact that begins with an impact or a chatter")

    @cached_property
    def planes(self) -> np.ndarray:
        """Contact planes, shape (m,)."""
        return np.fromiter((segment.plane for segment in self), np.int64, len(self))

    @cached_property
    def targets(self) -> np.ndarray:
        """Plane to which the condition at the end of each segment refers, shape (m,)."""
        return np.roll(self.planes, -1)

    @cached_property
    def conditions(self) -> np.ndarray:
        """Condition at the end of each segment (:mod:`carom.core.segments`), shape (m,)."""
        if self.flies:
            return np.full(len(self), segments.MEETS_WALL)
        return np.array(
            [_condition(*pair) for pair in zip(self, self.segments[1:] + self.segments[:1], strict=True)], np.int64
        )


def _condition(segment: Segment, following: Segment) -> int:
    """Condition at which a segment ends, from the one that follows."""
    kind, after = segment.kind, following.kind
    touches = after.is_impact or after is Kind.LAND
    enters = after.lasts and (kind is Kind.LIFT or segment.plane != following.plane)
    if kind.flies and (touches or enters):
        return segments.MEETS_WALL
    if segment.plane == following.plane and kind is Kind.LAND and after.lasts:
        return segments.NO_CONDITION
    if segment == following and kind.lasts and kind is not Kind.ROLL:
        return segments.LEAST_PUSH
    if segment.plane == following.plane and kind.lasts and kind is not after and not touches:
        if after is Kind.LIFT:
            return segments.LEAVES
        if kind is not Kind.ROLL:
            return segments.NO_SLIP
        return segments.CONE_FORWARD if after is Kind.SLIDE_FORWARD else segments.CONE_BACKWARD
    raise InputError("word", f"{segment} {following}", f"a segment that can follow {segment}")
