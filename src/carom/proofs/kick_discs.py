"""A disc of kick velocities out of levitation, and what is proven of its cells one by one."""

from __future__ import annotations

import json
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np
from flint import arb

from carom.models import Jeffcott
from carom.motions import settle
from carom.outcome import Outcome
from carom.parameters import Field
from carom.proofs.balls import rational
from carom.proofs.evidence import NotShownError
from carom.proofs.hypotheses import Hypotheses
from carom.proofs.kick_cells import BY_ANGLE, BY_SPEED, IMPACTS, LOST, Cell
from carom.proofs.passages import GRAZE, LeftOpenError
from carom.proofs.patches import Held
from carom.proofs.recoveries import impacts_of, kicked
from carom.proofs.rotor import Rotor
from carom.proofs.seeds import doubles_of
from carom.proofs.speeds import LargestSpeed

_SPEED = Field("kicks_up_to", "V", "largest kick out of levitation", "a velocity", "m/s", 1e-9, 1e9, '"100 mm/s"')


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
    """A disc of kick velocities out of levitation, in the fixed frame.

    Attributes
    ----------
    hypotheses : Hypotheses
    largest : str
        Speed of its rim: with a unit for a machine, in ``c_r Ω`` for a dimensionless one.
    most_impacts : int
        A kick that may have more of them is left open.

    Raises
    ------
    InputError
        The speed is none.
    """

    hypotheses: Hypotheses
    largest: str
    most_impacts: int

    def __post_init__(self) -> None:
        self._limit  # noqa: B018  (raises if it is no speed)

    @cached_property
    def _limit(self) -> LargestSpeed:
        return LargestSpeed(self.hypotheses, self.largest, _SPEED)

    @property
    def physical(self) -> bool:
        """Whether its speed has a unit."""
        return self._limit.physical

    @property
    def exact(self) -> tuple[Fraction, int]:
        """Its largest speed in m/s, or in ``c_r Ω``: a rational number, times π to a power."""
        return self._limit.exact

    def speed(self, share: Fraction) -> Any:
        """Ball of a share of the largest speed, in ``c_r Ω``."""
        return self._limit.share(share)

    @cached_property
    def held(self) -> Held:
        """The rotor, at the precision of its first use; :class:`NotShownError` if it may not levitate inside the wall."""
        held = Held(Rotor(self.hypotheses).numbers)
        if not (held.room > 0 and held.numbers.gamma > 0):
            raise NotShownError("the rotor must levitate inside the wall, with damping above 0, for kicks to come back")
        return held

    @cached_property
    def _doubles(self) -> tuple[Jeffcott, complex, float]:
        """The rotor, the direction in which it levitates, and the largest speed, in double precision."""
        rotor = Jeffcott(doubles_of(self.hypotheses))
        place = rotor.equilibrium
        return rotor, place / abs(place) if place else 1.0, float(self.speed(Fraction(1)).mid())

    def show(self, cell: Cell, most: int) -> int:
        """Impacts after which all kicks of a cell return at most; :class:`LeftOpenError` if this is not shown."""
        slow, fast = (self.speed(share) for share in cell.speeds)
        angles = tuple(2 * arb.pi() * rational(share) for share in cell.angles)
        try:
            return impacts_of(self.held, kicked((slow, fast), (angles[0], angles[1])), most)
        except (ArithmeticError, ValueError):
            # Balls of a wide cell that hold everything: numbers in double precision fail then.
            raise LeftOpenError(GRAZE) from None

    def try_(self, cell: Cell) -> Found:
        """What can be proven of a cell of which the kick in the middle returns."""
        try:
            return Found(IMPACTS[self.show(cell, self.most_impacts)])
        except LeftOpenError as problem:
            by_speed, by_angle = problem.weights
            return Found(problem.reason[0], BY_SPEED if by_speed >= by_angle else BY_ANGLE)

    def come_back(self, cells: list[Cell]) -> list[bool]:
        """Whether the kick in the middle of each cell returns, in double precision: it decides what is tried."""
        rotor, ahead, largest = self._doubles
        middles = [(float(sum(cell.speeds)) / 2, float(sum(cell.angles)) / 2) for cell in cells]
        kicks = [largest * speed * np.exp(2j * np.pi * angle) * ahead for speed, angle in middles]
        starts = np.full(len(cells), rotor.equilibrium)
        endings = settle(rotor, starts, np.array(kicks), threads=1, progress=False)
        returned: list[bool] = (endings.outcomes == Outcome.LEVITATED).tolist()
        return returned

    def tried(self, cells: list[Cell]) -> list[Found]:
        """What is found of some cells."""
        return [
            self.try_(cell) if returns else Found(LOST, self._wider(cell))
            for cell, returns in zip(cells, self.come_back(cells), strict=True)
        ]

    def _wider(self, cell: Cell) -> str:
        """In which of the two a cell is the wider."""
        (slow, fast), turn = cell.speeds, cell.angles[1] - cell.angles[0]
        around = 2 * np.pi * float(turn) * min(float(fast) * self._doubles[2], float(self.held.radius.mid()))
        return BY_SPEED if float(fast - slow) * self._doubles[2] >= around else BY_ANGLE

    def data(self) -> tuple[str, str, int]:
        """Plain data of it, from which :func:`disc_of` makes it again in another process."""
        return json.dumps(self.hypotheses.document()), self.largest, self.most_impacts


@lru_cache(maxsize=2)
def disc_of(data: tuple[str, str, int]) -> Disc:
    """A disc from plain data, once for all cells that a process looks at."""
    document, largest, most = data
    return Disc(Hypotheses.from_document(json.loads(document)), largest, most)
