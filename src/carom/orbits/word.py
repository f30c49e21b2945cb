"""The word of an orbit: which impacts follow one another in a period."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property

import numpy as np

from carom.base.arguments import Count, checked
from carom.base.outcome import InputError
from carom.core import segments
from carom.core.friction import BACKWARD, FORWARD, STOPPED


class Kind(IntEnum):
    """Kind of a segment: an impact, by the slip after it, and the flight that follows."""

    IMPACT_FORWARD = segments.IMPACT_FORWARD
    IMPACT_BACKWARD = segments.IMPACT_BACKWARD
    IMPACT_STOPPED = segments.IMPACT_STOPPED

    @property
    def sense(self) -> int:
        """Sense of the slip after the impact (:mod:`carom.core.friction`)."""
        return (FORWARD, BACKWARD, STOPPED)[self]

    @property
    def label(self) -> str:
        """Name in texts and JSON."""
        return ("impact+", "impact-", "impact0")[self]


@checked
@dataclass(frozen=True)
class Word(Sequence[Kind]):
    """The segments of one period of the planar rotor, in their order.

    ``impact+``, ``impact-`` and ``impact0`` are one impact with forward slip, with backward slip, or one that stops the
    slip, and the flight after it.

    Attributes
    ----------
    segments : tuple of Kind

    Raises
    ------
    InputError
        There are no segments.
    """

    segments: tuple[Kind, ...]

    def __post_init__(self) -> None:
        if not len(self.segments):
            raise InputError("word", "()", "at least one segment")

    @classmethod
    @checked
    def of(cls, *kinds: Kind) -> Word:
        """Word of some segments."""
        return cls(kinds)

    def __len__(self) -> int:
        return len(self.segments)

    def __iter__(self) -> Iterator[Kind]:
        return iter(self.segments)

    def __getitem__(self, place):  # type: ignore[no-untyped-def]
        return self.segments[place]

    def __str__(self) -> str:
        return " ".join(kind.label for kind in self)

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
        return np.array(self.segments, np.int64)

    @cached_property
    def planes(self) -> np.ndarray:
        """Contact plane of each impact, for kernels that know several: the only one, shape (m,)."""
        return np.zeros(len(self), np.int64)
