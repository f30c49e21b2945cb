"""Disturbances followed at one value of a parameter after another, for any rotor, parameter and disturbances.

At each value tried, every kind of disturbance is drawn afresh, and once more with its size at the largest (on the wall, at full
speed), since these are lost first.  Disturbances lost at one value are tried again at the next, as they are and varied: the
share that is lost becomes very small before it vanishes.  This is evidence, not proof.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from carom.attractors import MotionName
from carom.attractors.naming import name_endings
from carom.base.arguments import Seed, checked
from carom.base.results import Result
from carom.basins import Population, Share
from carom.disturbances import Coordinate, Disturbance, Sample, Starts
from carom.disturbances.following import follow
from carom.disturbances.plans import instants_words
from carom.models import Axis, Rotor, Subject, axis, rotor_of
from carom.motions.budget import NOT_FOLLOWED, BudgetSpentError

FIRST_LOOK = 200
"""Number of disturbances of a kind that are followed first; the others follow only if none of these is lost."""
AT_LARGEST, AT_LARGEST_SINGLY = 96, 48
"""Number of disturbances of a kind whose sizes are all at their largest, and that of rotors whose motions are followed one after another."""
KEPT, VARIANTS = 24, 96
"""Unrecovered disturbances of a kind that are tried again at the next value, and the number of variants of them."""
FINEST = 1e-5
"""Least change of a variant, as a share of the range of each coordinate; the greatest is one."""


@dataclass(frozen=True)
class Unrecovered:
    """A disturbance that did not come back.

    Attributes
    ----------
    model : Disturbance
    values : tuple of float
        Its coordinates, in the order of ``model.coordinates``; where it matters the instant is the last.
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
    example : Unrecovered or None
        One that did not come back; ``None`` if all did.
    asked : int
        Number of disturbances that were to be followed; shares are of those that the budget of a study sufficed for.
    """

    shown: ClassVar[tuple[str, ...]] = ("value", "drawn", "recovers")

    value: float
    returned: tuple[Share, ...]
    largest: tuple[Share, ...]
    example: Unrecovered | None
    asked: int

    @classmethod
    def joined(cls, checks: Sequence[Check]) -> Check:
        """Checks of several kinds of disturbances at one value as one."""
        returned, largest = (sum((getattr(each, name) for each in checks), ()) for name in ("returned", "largest"))
        example = next((each.example for each in checks if each.example), None)
        return cls(checks[0].value, returned, largest, example, sum(each.asked for each in checks))

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


@checked
def check_recovery(
    machine: Subject,
    disturbances: Sequence[Sample],
    *,
    along: str | None = None,
    value: float | None = None,
    seed: Seed = 0,
) -> Check:
    """Follow all disturbances at one value of a parameter, by default its present one.

    Parameters
    ----------
    machine, disturbances, seed
        As for :func:`find_recovery`; ``seed`` draws all samples anew.
    along : str, optional
        The parameter, by default the first of the model.
    value : float, optional
        In the unit of the parameter.
    """
    rotor = rotor_of(machine)
    varied = axis(rotor, along or next(iter(rotor.varied)))
    there = varied.value(rotor) if value is None else value
    return Trial(rotor, varied, tuple(disturbances), seed).at(there)


@dataclass(eq=False)
class Trial:
    """Follows disturbances at one value after another, and tries those lost last again."""

    rotor: Rotor
    varied: Axis
    disturbances: tuple[Sample, ...]
    seed: int
    threads: int | None = None

    def __post_init__(self) -> None:
        self.checks: dict[float, Check] = {}
        self.last: dict[int, np.ndarray] = {}
        # Random numbers of the variants: fresh samples do not depend on how many there were.
        self.variation = np.random.default_rng([self.seed, 1])

    def recovers(self, value: float) -> bool:
        """Whether every disturbance comes back at a value; follows no more once some are lost.

        Raises
        ------
        BudgetSpentError
            None is lost of those that were followed, and not all were.
        """
        if value not in self.checks:
            self.checks[value] = check = self.at(value, stop=True)
            if check.recovers and check.tried < check.asked:
                raise BudgetSpentError("the events of this question are spent")
        return self.checks[value].recovers

    def at(self, value: float, stop: bool = False) -> Check:
        """Follow the disturbances at a value: all of them, or until some are lost."""
        rotor = self.varied.move(self.rotor, value)
        models = [sample.model.rescaled(self.rotor.scales, rotor.scales) for sample in self.disturbances]
        counts = np.zeros((2, len(models), 2), int)  # drawn or at the largest size, kind, came back and tried
        example: Unrecovered | None = None
        asked = 0
        for place, values, row in self._portions(value, again=stop):
            starts: Starts = models[place].starts_on(rotor, *values)
            ends = follow(rotor, starts, threads=self.threads)
            followed = ends.outcomes != NOT_FOLLOWED
            gone = np.flatnonzero(followed & ~ends.recovered)
            if row is not None:
                asked += followed.size
                counts[row, place] += np.count_nonzero(ends.recovered), np.count_nonzero(followed)
            if len(gone):
                self.last[place] = values[:, gone[:KEPT]]
                if example is None:
                    _, names = name_endings(rotor, models[place], ends[gone[:1]])
                    example = Unrecovered(
                        models[place], tuple(values[:, gone[0]].tolist()), names[0] if names else None
                    )
                if stop:
                    break
        of = [Population.of_model(model, rotor.scales, instants_words(rotor)) for model in models]
        drawn, largest = (
            tuple(Share.of(*kind, drawn=True, population=each) for kind, each in zip(row, of, strict=True))
            for row in counts.tolist()
        )
        return Check(value, drawn, largest, example, asked)

    def _portions(self, value: float, again: bool) -> Iterator[tuple[int, np.ndarray, int | None]]:
        """Disturbances of each kind for this value: the kind, coordinates (k, n), and the row in which they count.

        Those lost at other values come first ``again``, with their variants; they are not drawn and do not count.
        """
        if again:
            for place, lost in list(self.last.items()):
                yield place, np.hstack([lost, self._variants(place, lost)]), None
        random = np.random.default_rng([self.seed, 0, np.float64(value).view(np.uint64).item()])
        drawn, largest = [], []
        at_largest = AT_LARGEST if self.rotor.system.is_planar else AT_LARGEST_SINGLY
        for place, sample in enumerate(self.disturbances):
            along = sample.model.coordinates_on(self.rotor)
            largest.append((place, _coordinates(along, random, at_largest, largest=True), 1))
            drawn.append(_coordinates(along, random, sample.count))
        first = [(place, values[:, :FIRST_LOOK], 0) for place, values in enumerate(drawn)]
        # What is largest is lost first; but a share takes some that are drawn, however many events those at the largest size would spend.
        yield from [*largest, *first] if again or self.rotor.system.is_planar else [*first, *largest]
        for place, values in enumerate(drawn):
            if values.shape[1] > FIRST_LOOK:
                yield place, values[:, FIRST_LOOK:], 0

    def _variants(self, place: int, lost: np.ndarray) -> np.ndarray:
        """Variants of lost disturbances, coordinates (k, VARIANTS): changes of all sizes, within the ranges."""
        chosen = lost[:, self.variation.integers(lost.shape[1], size=VARIANTS)]
        sizes = np.exp(self.variation.uniform(math.log(FINEST), 0.0, VARIANTS))
        for row, along in zip(chosen, self.disturbances[place].model.coordinates_on(self.rotor), strict=True):
            row += sizes * self.variation.standard_normal(VARIANTS) * (along.high - along.low)
            if not along.periodic:
                np.clip(row, along.low, along.high, out=row)
        return chosen


def _coordinates(
    along: Sequence[Coordinate], random: np.random.Generator, count: int, largest: bool = False
) -> np.ndarray:
    """Coordinates (k, count) of disturbances drawn like a sample; all but angles at their upper end if ``largest``."""
    shares = random.random((len(along), count))
    if largest:
        shares[[not each.periodic for each in along]] = 1.0
    return np.array([each.at(share) for each, share in zip(along, shares, strict=True)])


def in_all(disturbances: Sequence[Sample], count: int) -> tuple[Sample, ...]:
    """The same kinds of disturbances with about so many in all, in the same proportions."""
    total = sum(sample.count for sample in disturbances)
    return tuple(replace(sample, count=max(1, round(count * sample.count / total))) for sample in disturbances)
