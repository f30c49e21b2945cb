"""A disc of kick velocities out of levitation, of one machine or of a box of them, and what is proven of its cells one by one."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np
from flint import arb, arb_series

from carom.models import Jeffcott
from carom.motions import settle
from carom.outcome import Outcome
from carom.parameters import DIMENSIONLESS_FIELDS, Field
from carom.parameters.terms import set_by
from carom.proofs.balls import ball_of, rational
from carom.proofs.boxes import Box, Part, box_of
from carom.proofs.evidence import NotShownError
from carom.proofs.hypotheses import Hypotheses
from carom.proofs.kick_cells import CUTS, IMPACTS, LOST, Cell, whole
from carom.proofs.passages import GRAZE, LeftOpenError
from carom.proofs.patches import Held
from carom.proofs.recoveries import impacts_of, kicked
from carom.proofs.seeds import doubles_at
from carom.proofs.series import terms
from carom.proofs.speeds import LargestSpeed

_SPEED = Field("kicks_up_to", "V", "largest kick out of levitation", "a velocity", "m/s", 1e-9, 1e9, '"100 mm/s"')
_KEPT = 4096
"""Parts of a box that are kept."""


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
    along : tuple of tuples of str
        Parameters of a box of machines, each with both ends of its interval.

    Raises
    ------
    InputError
        The speed is none, or a parameter is not.
    """

    hypotheses: Hypotheses
    largest: str
    most_impacts: int
    along: tuple[tuple[str, ...], ...] = ()

    def __post_init__(self) -> None:
        self._limit, self.box  # noqa: B018  (raise if the speed or a parameter is none)

    @cached_property
    def _limit(self) -> LargestSpeed:
        return LargestSpeed(self.hypotheses, self.largest, _SPEED)

    @cached_property
    def box(self) -> Box:
        """Its machines."""
        return box_of(self.hypotheses, self.along)

    @property
    def whole(self) -> Cell:
        """The cell that is all of it."""
        return whole(len(self.along))

    @property
    def physical(self) -> bool:
        """Whether its speed has a unit."""
        return self._limit.physical

    @property
    def exact(self) -> tuple[Fraction, int]:
        """Its largest speed in m/s, or in ``c_r Ω``: a rational number, times π to a power."""
        return self._limit.exact

    def speed(self, share: Fraction) -> Any:
        """Ball of a share of the largest speed, in ``c_r Ω``, for all its machines."""
        return rational(share) * self._part(self.whole.parts).units[1]

    @property
    def shares_unit(self) -> bool:
        """Whether ``c_r Ω`` is the same velocity for all its machines."""
        return not self.physical or not {"speed", "clearance"} & {set_by(name) for name, *_ in self.along}

    def check_levitation(self) -> None:
        """Check that one machine of it, that in the middle, levitates inside the wall, with damping; :class:`NotShownError` if not."""
        held = self._part(self.whole.parts).held.middle
        if not (held.room > 0 and held.numbers.gamma > 0):
            raise NotShownError("the rotor must levitate inside the wall, with damping above 0, for kicks to come back")

    def _part(self, parts: tuple[Part, ...]) -> BoxPart:
        """The machines of a part of the box, kept for the cells that share it."""
        if parts not in self._known:
            if len(self._known) >= _KEPT:
                self._known.clear()
            self._known[parts] = BoxPart.of(self, parts)
        return self._known[parts]

    @cached_property
    def _known(self) -> dict[tuple[Part, ...], BoxPart]:
        return {}

    def unit(self, moved: Mapping[str, Any]) -> Any:
        """The largest speed in ``c_r Ω`` at values of the parameters: a ball or a power series."""
        speed: Any = rational(self.exact[0]) * arb.pi() ** self.exact[1]
        if not self.physical:
            return speed
        table = self.box.machines.table(
            {name: value for name, value in moved.items() if name not in DIMENSIONLESS_FIELDS}
        )
        return speed / (table["clearance"] * table["speed"])

    def show(self, cell: Cell, most: int) -> int:
        """Impacts after which all kicks of a cell return at most; :class:`LeftOpenError` if this is not shown."""
        part = self._part(cell.parts)
        low, high = (rational(share) for share in cell.speeds)
        first, last = (2 * arb.pi() * rational(share) for share in cell.angles)
        try:
            if not (part.held.room > 0 and part.held.numbers.gamma > 0):
                raise LeftOpenError(GRAZE, self._sizes(cell))
            return impacts_of(part.held, kicked((low, high), (first, last), part.units, part.moves), most)
        except (ArithmeticError, ValueError):
            # Balls of a wide cell that hold everything: numbers in double precision fail then.
            raise LeftOpenError(GRAZE, self._sizes(cell)) from None

    def try_(self, cell: Cell) -> Found:
        """What can be proven of a cell of which the kick in the middle returns."""
        try:
            return Found(IMPACTS[self.show(cell, self.most_impacts)])
        except LeftOpenError as problem:
            weights = problem.weights if len(problem.weights) == len(self._sizes(cell)) else self._sizes(cell)
            return Found(problem.reason[0], CUTS[max(range(len(weights)), key=weights.__getitem__)])

    def come_back(self, cells: list[Cell]) -> list[bool]:
        """Whether the kick in the middle of each cell returns, in double precision: it decides what is tried."""
        returned = dict.fromkeys(cells, False)
        for parts in {cell.parts for cell in cells}:
            rotor, ahead, largest = self._part(parts).doubles
            alike = [cell for cell in cells if cell.parts == parts]
            middles = [(float(sum(cell.speeds)) / 2, float(sum(cell.angles)) / 2) for cell in alike]
            kicks = [largest * speed * np.exp(2j * np.pi * angle) * ahead for speed, angle in middles]
            endings = settle(rotor, np.full(len(alike), rotor.equilibrium), np.array(kicks), threads=1, progress=False)
            returned |= zip(alike, (endings.outcomes == Outcome.LEVITATED).tolist(), strict=True)
        return [returned[cell] for cell in cells]

    def tried(self, cells: list[Cell]) -> list[Found]:
        """What is found of some cells."""
        return [
            self.try_(cell) if returns else Found(LOST, CUTS[int(np.argmax(self._sizes(cell)))])
            for cell, returns in zip(cells, self.come_back(cells), strict=True)
        ]

    def _sizes(self, cell: Cell) -> tuple[float, ...]:
        """How wide a cell is in each of its coordinates, in ``c_r Ω``: about by how much they move a flight."""
        part = self._part(cell.parts)
        (slow, fast), turn = cell.speeds, cell.angles[1] - cell.angles[0]
        largest, radius = part.doubles[2], part.held.middle.plain.radius
        around = 2 * np.pi * float(turn) * min(float(fast) * largest, radius)
        sides = [
            float((abs(side.gamma) + abs(side.omega_squared) + abs(side.radius)).mid()) for side in part.held.sides
        ]
        return float(fast - slow) * largest, around, *sides

    def data(self) -> Data:
        """Plain data of it, from which :func:`disc_of` makes it again in another process."""
        return json.dumps(self.hypotheses.document()), self.largest, self.most_impacts, self.along


Data = tuple[str, str, int, tuple[tuple[str, ...], ...]]


@lru_cache(maxsize=2)
def disc_of(data: Data) -> Disc:
    """A disc from plain data, once for all cells that a process looks at."""
    document, largest, most, along = data
    return Disc(Hypotheses.from_document(json.loads(document)), largest, most, along)


@dataclass(frozen=True)
class BoxPart:
    """The machines of a part of the box.

    Attributes
    ----------
    held : Held
    units : tuple of arb
        The largest speed in ``c_r Ω`` of the machine in the middle, and of all.
    moves : list of arb
        Its derivatives by the parameters, times half their widths.
    phase : float
        Of the unbalance.
    """

    held: Held
    units: tuple[Any, Any]
    moves: list[Any]
    phase: float

    @cached_property
    def doubles(self) -> tuple[Jeffcott, complex, float]:
        """The rotor in the middle, the direction in which it levitates, and the largest speed, in double precision."""
        rotor = Jeffcott(doubles_at(self.held.middle.numbers, self.phase))
        place = rotor.equilibrium
        return rotor, place / abs(place) if place else 1.0, float(self.units[0].mid())

    @classmethod
    def of(cls, disc: Disc, parts: tuple[Part, ...]) -> BoxPart:
        """From a part of the box of a disc."""
        box = disc.box
        units = disc.unit(box.middles(parts)), disc.unit(box.values(parts))
        with terms(2):
            series = [disc.unit(moved) for moved in box.series(parts)]
        moves = [x[1] if isinstance(x, arb_series) else arb(0) for x in series]
        numbers = box.numbers(parts)
        held = Held(numbers, box.middle(parts), box.sides(parts)) if parts else Held(numbers)
        return cls(held, units, moves, float(ball_of(disc.hypotheses.numbers["phi"]).mid()))
