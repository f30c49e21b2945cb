"""A disc of disturbances out of levitation, and what is proven of its cells one by one."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any, NamedTuple, TypeVar

import numpy as np
from flint import arb

from carom.models import Jeffcott
from carom.motions import settle
from carom.outcome import Outcome
from carom.proofs.balls import rational
from carom.proofs.evidence import NotShownError
from carom.proofs.families import FAMILIES, Family, Scale
from carom.proofs.hypotheses import Hypotheses
from carom.proofs.kick_cells import BY_ANGLE, BY_SPEED, IMPACTS, LOST, REFUTED, Cell
from carom.proofs.passages import GRAZE, LeftOpenError
from carom.proofs.patches import Held, Patch
from carom.proofs.recoveries import disturbed, impacts_of, show_in_rub
from carom.proofs.rotor import Rotor
from carom.proofs.seeds import doubles_of

DiscData = tuple[str, str, str, int]
_Result = TypeVar("_Result")


class Found(NamedTuple):
    """What was found of a cell.

    Attributes
    ----------
    letter : str
        Of the cell if it is proven, else of its halves.
    by : str
        By what it should be halved, if it is not proven.
    """

    letter: str
    by: str = ""


@dataclass(frozen=True)
class Disc:
    """A disc of disturbances out of levitation by size and direction, in the fixed frame.

    Attributes
    ----------
    family : Family
        What they are.
    hypotheses : Hypotheses
    largest : str
        The largest of them: with units for a machine, without for a dimensionless one.
    most_impacts : int
        A disturbance that may have more of them is left open.

    Raises
    ------
    InputError
        The largest size is none.
    """

    family: Family
    hypotheses: Hypotheses
    largest: str
    most_impacts: int

    def __post_init__(self) -> None:
        self._scale  # noqa: B018  (raises if it is no size)

    @property
    def physical(self) -> bool:
        """Whether its sizes have a unit."""
        return self.hypotheses.table == "machine"

    @cached_property
    def _scale(self) -> Scale:
        return self.family.reads(self.largest, self.hypotheses)

    @property
    def exact(self) -> tuple[Fraction, int]:
        """Its largest size in the SI unit, or dimensionless: a rational number, times π to a power."""
        return self._scale.largest.low, self._scale.largest.turns

    def size(self, share: Fraction) -> Any:
        """Ball of a share of the largest size, dimensionless."""
        return rational(self.exact[0] * share) * arb.pi() ** self.exact[1] * self._scale.one()

    def _reach(self, share: Fraction) -> Any:
        """Ball of ``v`` for a share of the largest size."""
        return rational(self.exact[0] * share) * self._unit

    @cached_property
    def _unit(self) -> Any:
        """``v`` of what the rational part of the largest size counts."""
        return arb.pi() ** self.exact[1] * self._scale.one() * self._scale.gain(self.held.numbers)

    @cached_property
    def held(self) -> Held:
        """The rotor, at the precision of its first use; :class:`NotShownError` if it may not levitate inside the wall."""
        held = Held(Rotor(self.hypotheses).numbers, self._scale.start())
        if not (held.room > 0 and held.numbers.gamma > 0):
            raise NotShownError("the rotor must levitate inside the wall, with damping above 0, for it to come back")
        return held

    @cached_property
    def _doubles(self) -> tuple[Jeffcott, complex, float]:
        """The rotor, the direction in which it levitates, and the largest ``v``, in double precision."""
        rotor = Jeffcott(doubles_of(self.hypotheses))
        place = rotor.equilibrium
        return rotor, place / abs(place) if place else 1.0, float(self._reach(Fraction(1)).mid())

    def show(self, cell: Cell, most: int) -> int:
        """Impacts after which all of a cell return at most; :class:`LeftOpenError` if this is not shown."""
        return self._followed(cell, lambda patch: impacts_of(self.held, patch, most))

    def refute(self, cell: Cell) -> None:
        """Show that all of a cell decay to the stable rub; :class:`LeftOpenError` if this is not shown."""
        self._followed(cell, lambda patch: show_in_rub(self.held, patch))

    def _followed(self, cell: Cell, follow: Callable[[Patch], _Result]) -> _Result:
        slow, fast = (self._reach(share) for share in cell.speeds)
        angles = tuple(2 * arb.pi() * rational(share) for share in cell.angles)
        try:
            return follow(disturbed((slow, fast), (angles[0], angles[1])))
        except (ArithmeticError, ValueError):
            # Balls of a wide cell that hold everything: numbers in double precision fail then.
            raise LeftOpenError(GRAZE) from None

    def try_(self, cell: Cell, returns: bool) -> Found:
        """What can be proven of a cell, the disturbance in the middle of which returns or does not."""
        try:
            if returns:
                return Found(IMPACTS[self.show(cell, self.most_impacts)])
            if not self.held.rub.exists:
                return Found(LOST, self._wider(cell))
            self.refute(cell)
            return Found(REFUTED)
        except LeftOpenError as problem:
            by_speed, by_angle = problem.weights
            return Found(problem.reason[0] if returns else LOST, BY_SPEED if by_speed >= by_angle else BY_ANGLE)

    def come_back(self, cells: list[Cell]) -> list[bool]:
        """Whether the disturbance in the middle of each cell returns, in double precision: it decides what is tried."""
        rotor, ahead, largest = self._doubles
        middles = [(float(sum(cell.speeds)) / 2, float(sum(cell.angles)) / 2) for cell in cells]
        sizes = np.array([largest * size * np.exp(2j * np.pi * angle) * ahead for size, angle in middles])
        busy = float(self.held.start.lasts.mid())
        place, rate, _ = self.held.start.plain_response(self.held, busy)
        back = np.exp(-1j * busy)
        starts, velocities = rotor.equilibrium + sizes * place * back, sizes * (rate - 1j * place) * back
        # What is outside by then is tried, to be told why it is open.
        outside = np.abs(starts) >= 1
        starts[outside], velocities[outside] = rotor.equilibrium, 0
        endings = settle(rotor, starts, velocities, threads=1, progress=False)
        returned: list[bool] = (endings.outcomes == Outcome.LEVITATED).tolist()
        return returned

    def tried(self, cells: list[Cell]) -> list[Found]:
        """What is found of some cells."""
        return [self.try_(cell, returns) for cell, returns in zip(cells, self.come_back(cells), strict=True)]

    def _wider(self, cell: Cell) -> str:
        """In which of the two a cell is the wider."""
        (slow, fast), turn = cell.speeds, cell.angles[1] - cell.angles[0]
        around = 2 * np.pi * float(turn) * min(float(fast) * self._doubles[2], float(self.held.radius.mid()))
        return BY_SPEED if float(fast - slow) * self._doubles[2] >= around else BY_ANGLE

    def data(self) -> DiscData:
        """Plain data of it, from which :func:`disc_of` makes it again in another process."""
        return self.family.about, json.dumps(self.hypotheses.document()), self.largest, self.most_impacts


@lru_cache(maxsize=2)
def disc_of(data: DiscData) -> Disc:
    """A disc from plain data, once for all cells that a process looks at."""
    about, document, largest, most = data
    return Disc(FAMILIES[about], Hypotheses.from_document(json.loads(document)), largest, most)
