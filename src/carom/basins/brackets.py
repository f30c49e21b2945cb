"""The bracket that a search for the smallest disturbance that is lost finds."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from carom.base.outcome import Outcome
from carom.base.results import Result
from carom.basins.shares import CONFIDENCE
from carom.disturbances.coordinates import TURN
from carom.motions.budget import NOT_FOLLOWED, BudgetSpentError
from carom.parameters import Scales

TOLERANCE = 1e-3
ROUND = 720
"""Directions over a full turn among the fresh starts, at the upper end of their sizes."""
NEIGHBOURS, BESIDE_LOST = 32, 1e-9
"""Disturbances beside the smallest lost one that are followed to see whether it is lost for itself, and how far from it relative to its size."""
MOST_CHECKS = 8
"""Number of times that fresh starts may reduce the smallest loss."""


@dataclass(frozen=True, repr=False)
class SmallestLoss(Result):
    """Bracket of the size at which disturbances begin to be lost.

    Attributes
    ----------
    kind : str
        Kind of the disturbance: ``"kick"``, ``"shock"``, ``"blade-loss"``, or that of
        another model; of a kick plane ``"kick"``.
    size : float or None
        Smallest lost size found: change of velocity in ``c_r Ω``, peak acceleration in ``c_r Ω²``, change of the
        unbalance as an eccentricity in ``c_r``, or first coordinate of another model.  ``None`` where none was found.
    angle : float or None
        Its direction in rad.  For a kick or shock as in :mod:`carom.disturbances`; for the loss of a blade the phase of the
        change relative to the unbalance before it.
    instant : float or None
        Angle in rad by which the shaft has turned when it comes, since the co-rotating frame coincided with the fixed one; ``None`` where
        the instant does not matter.
    outcome : Outcome or None
        Outcome of the motion after it.
    recovered : float
        A smaller size in this direction, within the tolerance, that comes back.
    all_back : float or None
        Largest size up to which all starts tried came back: those of the search and ``fresh`` ones.  ``None`` where the
        smallest starts are lost already.
    fresh : int
        Number of starts up to ``all_back`` that are independent of the search: ``drawn`` ones, and directions over a full turn at
        that size; where the instant matters each at one of its own.
    drawn : int
        How many of them were drawn uniformly over the area of the disc beyond the harmless size.
    neighbours_lost, neighbours : int
        Of so many disturbances beside the smallest lost one, up to ``beside`` of its size away in any direction, how many are lost too.
        Fewer than all: beside a basin boundary of fine structure, where rounding decides.
    harmless : float
        Size up to which contact is proven to be impossible in any direction; 0 where nothing is proven.
    largest : float
        Largest size searched.
    tolerance : float
        Relative width to which the smallest loss is bisected, and angle in rad between the last directions tried.
    tried : int
        Number of starts followed.
    complete : bool
        Whether the search came to its end.  Otherwise the budget of a study ended it (:mod:`carom.motions.budget`): smaller sizes may be
        lost, and ``all_back`` is that of the directions scanned alone.
    quantity : str
        Property of the scales by which sizes are converted to SI units.
    scales : Scales or None
        Those of the machine.
    """

    rests_on: ClassVar[tuple[str, ...]] = ("mora2014", "clopper1934")

    kind: str
    size: float | None
    angle: float | None
    instant: float | None
    outcome: Outcome | None
    recovered: float
    all_back: float | None
    fresh: int
    drawn: int
    harmless: float
    largest: float
    tolerance: float
    tried: int
    quantity: str = ""
    scales: Scales | None = None
    neighbours_lost: int = 0
    neighbours: int = 0
    complete: bool = True

    shown: ClassVar[tuple[str, ...]] = (
        "kind",
        "size",
        "angle",
        "instant",
        "outcome",
        "recovered",
        "all_back",
        "neighbours_lost",
        "neighbours",
        "fresh",
        "harmless",
        "largest",
        "tried",
    )

    @property
    def words(self) -> str:
        """The bracket in a line."""
        told = {name: self.line_of(name, getattr(self, name)) for name in ("size", "all_back", "harmless", "largest")}
        lost = f"none lost up to {told['largest']}" if self.complete else "none lost"
        lost = lost if self.size is None else f"smallest lost {told['size']}"
        lost += "" if self.instant is None else " at the worst instant of the turn"
        back = "" if self.all_back is None else f", all back up to {told['all_back']}"
        lost += f" ({self.sensitivity})" if self.sensitivity else ""
        ended = "" if self.complete else ", search not finished"
        return f"{lost}{back}, harmless up to {told['harmless']}{ended}"

    def kind_of(self, name: str) -> str:
        """Sizes are of one kind."""
        return (
            self.quantity if name in ("size", "recovered", "all_back", "harmless", "largest") else super().kind_of(name)
        )

    @property
    def sensitivity(self) -> str:
        """How many of its neighbours come back in spite of it; empty if none does."""
        back = self.neighbours - self.neighbours_lost
        return f"sensitive: {back} of {self.neighbours} within {BESIDE_LOST:.0e} of it come back" if back else ""

    @property
    def share_below(self) -> float:
        """Share of the disturbances beyond the harmless size and up to ``all_back``, by area, that may be lost: a bound at 95 %.

        ``1 − 0.05^{1/n}`` for ``n`` starts of which none is lost (Clopper and Pearson, one-sided).
        """
        return -math.expm1(math.log(1.0 - CONFIDENCE) / self.drawn) if self.drawn else 1.0


class Found(NamedTuple):
    """A bracket in one direction, and at one instant where that matters."""

    recovered: float
    size: float
    angle: float
    outcome: Outcome
    instant: float | None = None


class Bracket:
    """What a search has tried, and the best bracket: a recovered size, the smallest lost size, its direction and its outcome.

    Parameters
    ----------
    **given
        What the search is of: attributes of :class:`SmallestLoss`.
    """

    def __init__(self, **given: Any) -> None:
        self.given = given
        self.tried = 0
        self.best: Found | None = None
        self.back = 0.0  # up to here all directions scanned came back

    def unfinished(self) -> SmallestLoss:
        """Result of a search that was ended."""
        below = self.back > self.given["harmless"] and (self.best is None or self.best.size > self.back)
        return self.result(self.back if below else None, complete=False)

    def lost_at(self, sizes: np.ndarray, angles: np.ndarray) -> np.ndarray:
        """Which disturbances of these sizes and angles, at the instant of the best one, are lost."""
        raise NotImplementedError

    def _neighbours_lost(self) -> int:
        """How many of the neighbours of the best one are lost."""
        if self.best is None:
            return 0
        away = BESIDE_LOST * np.random.default_rng(NEIGHBOURS).uniform(-1.0, 1.0, (2, NEIGHBOURS))
        return int(np.count_nonzero(self.lost_at(self.best.size * (1.0 + away[0]), self.best.angle + away[1])))

    def result(self, all_back: float | None, fresh: int = 0, drawn: int = 0, *, complete: bool = True) -> SmallestLoss:
        """Result of the search so far; ``all_back`` is the largest size up to which all came back.

        The neighbours are followed only where the search came to its end: otherwise nothing is left to follow them with.
        """
        recovered, size, angle, outcome, instant = self.best or (all_back or 0.0, None, None, None, None)
        return SmallestLoss(
            **self.given,
            neighbours_lost=self._neighbours_lost() if complete else 0,
            neighbours=NEIGHBOURS if complete and self.best is not None else 0,
            size=size,
            angle=None if angle is None else math.remainder(angle, TURN),
            instant=None if instant is None else instant % TURN,
            outcome=outcome,
            recovered=recovered,
            all_back=all_back,
            fresh=fresh,
            drawn=drawn,
            tried=self.tried,
            complete=complete,
        )


def lost(outcomes: np.ndarray) -> np.ndarray:
    """Which outcomes are not levitation; those that double precision cannot decide do not count as lost.

    Raises
    ------
    BudgetSpentError
        Some were not followed.
    """
    if (outcomes == NOT_FOLLOWED).any():
        raise BudgetSpentError("the events of this question are spent")
    return (outcomes != Outcome.LEVITATED) & (outcomes != Outcome.GRAZING)
