"""A budget of events, so that how much of a long question is followed does not depend on the computer.

A study asks many questions, each of many motions, and one motion may touch a million times.  So each question has a fixed number of
events, and :func:`~carom.motions.ensembles.settle` follows the motions that are asked for in a fixed order until these are spent: what a
motion costs counts against those after it alone, so the same ones are followed by any number of threads.  The others have the outcome
:data:`NOT_FOLLOWED`.  Only a time limit, where one is set, depends on the clock.

Motions of planar rotors on a rigid wall, which are followed side by side, cost next to nothing and are all followed.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from carom.base.outcome import CaromError

NOT_FOLLOWED = -2
"""Outcome of a motion that the events of its question did not suffice for."""
LONGEST = 20_000
"""Events after which one motion of a question with a budget is given up."""
START = 60
"""Events that cost as much as one motion without contact."""


class BudgetSpentError(CaromError):
    """The events of a question, or the time of a study, are spent."""


class Purse(NamedTuple):
    """What the motions of an ensemble may cost together, and what each of them has cost: 0 where it was not followed."""

    costs: np.ndarray
    left: float
    longest: int
    deadline: float

    def suffices(self, number: int) -> bool:
        """Whether a motion is to be followed, for all that those before it are known to have cost."""
        return bool(self.costs[:number].sum() < self.left) and time.monotonic() < self.deadline

    @property
    def followed(self) -> np.ndarray:
        """Which motions were followed: up to the one that spent what was left, whatever other threads have followed besides."""
        return (self.costs > 0) & (np.cumsum(self.costs) - self.costs < self.left)


@dataclass
class Question:
    """A question of a study: the events that it has left, and of how many motions that were asked for it has followed how many."""

    words: str = ""
    left: float = math.inf
    deadline: float = math.inf
    asked: int = 0
    followed: int = 0

    @property
    def longest(self) -> int:
        """Events after which one motion is given up."""
        return LONGEST if self.left < math.inf else sys.maxsize

    @property
    def unfinished(self) -> bool:
        """Whether some of the motions that were asked for were not followed."""
        return self.followed < self.asked

    def purse(self, count: int) -> Purse:
        """What is left, for so many motions."""
        return Purse(np.zeros(count, np.int64), self.left, self.longest, self.deadline)

    def pay(self, purse: Purse) -> None:
        """Take what motions have cost from what is left."""
        self.left -= int(purse.costs[purse.followed].sum())

    def count(self, outcomes: np.ndarray) -> None:
        """Count motions that were asked for, and those of them that were followed."""
        self.asked += outcomes.size
        self.followed += int(np.count_nonzero(outcomes != NOT_FOLLOWED))

    def affords(self) -> bool:
        """Whether something is left for one more motion, followed apart from others; otherwise it is counted as asked for."""
        affords = self.left > 0 and time.monotonic() < self.deadline
        self.asked += not affords
        return affords

    def follow(self, events: int) -> None:
        """Count one motion that was followed apart from others."""
        self.asked, self.followed, self.left = self.asked + 1, self.followed + 1, self.left - START - events


_PRESENT: ContextVar[Question | None] = ContextVar("carom_question", default=None)


def present_question() -> Question:
    """The question that is being followed; without a study one that may take any number of events."""
    return _PRESENT.get() or Question()


@dataclass
class Budget:
    """What a study spends.

    Attributes
    ----------
    seconds : float
        Time after which it follows no further motions.
    questions : list of Question
        Those asked so far.
    """

    seconds: float = math.inf
    questions: list[Question] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.deadline = time.monotonic() + self.seconds

    @contextmanager
    def question(self, words: str, events: int) -> Iterator[Question]:
        """Follow motions for a question that has so many events."""
        asked = Question(words, events, self.deadline)
        self.questions.append(asked)
        token = _PRESENT.set(asked)
        try:
            yield asked
        finally:
            _PRESENT.reset(token)

    @property
    def unfinished(self) -> tuple[Question, ...]:
        """The questions that were not followed to their end."""
        return tuple(each for each in self.questions if each.unfinished)
