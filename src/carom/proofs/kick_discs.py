"""A disc of disturbances out of levitation, and what is proven of its cells one by one."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any, NamedTuple, TypeVar

import numpy as np
from flint import arb, arb_series

from carom.base.outcome import InputError, Outcome
from carom.models import Rotor, jeffcott
from carom.motions import State, settle
from carom.parameters import DIMENSIONLESS_FIELDS
from carom.parameters.terms import set_by
from carom.proofs.balls import ball_of, rational, terms
from carom.proofs.families import FAMILIES, KICKS, DisturbanceFamily, Scale
from carom.proofs.hypotheses import Hypotheses
from carom.proofs.kick_cells import CUTS, IMPACTS, LOST, REFUTED, Box, Cell, Part, box_of, whole
from carom.proofs.lines import LineNumbers
from carom.proofs.passages import GRAZE, OUTSIDE, LeftOpenError
from carom.proofs.patches import Held, Patch
from carom.proofs.recoveries import disturbed, disturbed_in_box, impacts_of, show_in_rub
from carom.proofs.seeds import doubles_at

DiscData = tuple[str, str, str, int, tuple[tuple[str, ...], ...]]
_KEPT = 4096
"""Parts of a box that are kept."""
_Result = TypeVar("_Result")


class DiscResult(NamedTuple):
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
class KickDisc:
    """A disc of disturbances out of levitation by size and direction, in the fixed frame.

    Attributes
    ----------
    family : DisturbanceFamily
        What they are.
    hypotheses : Hypotheses
    largest : str
        The largest of them: with units for a machine, without for a dimensionless one.
    most_impacts : int
        A disturbance that may have more of them is left open.
    along : tuple of tuples of str
        Parameters of a box of machines, each with both ends of its interval; for kicks only.

    Raises
    ------
    InputError
        The largest size is none, or a parameter is not.
    """

    family: DisturbanceFamily
    hypotheses: Hypotheses
    largest: str
    most_impacts: int
    along: tuple[tuple[str, ...], ...] = ()

    def __post_init__(self) -> None:
        self.scale, self.box  # noqa: B018  (raise if it is no size, or a parameter is none)
        if self.along and self.family is not KICKS:
            raise InputError("along", [name for name, *_ in self.along], "is for kicks only")

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
        """Whether its sizes have a unit."""
        return self.hypotheses.table == "machine"

    @cached_property
    def scale(self) -> Scale:
        """What its sizes count."""
        return self.family.reads(self.largest, self.hypotheses)

    @property
    def exact(self) -> tuple[Fraction, int]:
        """Its largest size in the SI unit, or dimensionless: a rational number, times π to a power."""
        return self.scale.largest.low, self.scale.largest.turns

    def size(self, share: Fraction) -> arb:
        """Ball of a share of the largest size, dimensionless."""
        return rational(self.exact[0] * share) * arb.pi() ** self.exact[1] * self.scale.one()

    @property
    def shares_unit(self) -> bool:
        """Whether the unit of dimensionless sizes is the same for all its machines."""
        return not self.physical or not {"speed", "clearance"} & {set_by(name) for name, *_ in self.along}

    @property
    def levitates(self) -> bool:
        """Whether the rotor in the middle of its box levitates inside the wall, with damping."""
        return _levitates(self.part(self.whole.parts).held.middle)

    def part(self, parts: tuple[Part, ...]) -> BoxPart:
        """The machines of a part of the box, kept for the cells that share it, at the precision of their first use."""
        if parts not in self._known:
            if len(self._known) >= _KEPT:
                self._known.clear()
            self._known[parts] = BoxPart.of(self, parts)
        return self._known[parts]

    @cached_property
    def _known(self) -> dict[tuple[Part, ...], BoxPart]:
        return {}

    def reach(self, numbers: LineNumbers[arb], moved: Mapping[str, arb | arb_series]) -> Any:
        """``v`` of the largest size, for numbers of a rotor at values of the parameters: a ball or a power series."""
        size = rational(self.exact[0]) * arb.pi() ** self.exact[1]
        if not self.along:
            return size * self.scale.one() * self.scale.gain(numbers)
        if not self.physical:
            return size
        table = self.box.machines.table(
            {name: value for name, value in moved.items() if name not in DIMENSIONLESS_FIELDS}
        )
        return size / (table["clearance"] * table["speed"])

    def show(self, cell: Cell, most: int) -> int:
        """Impacts after which all of a cell return at most; :class:`LeftOpenError` if this is not shown."""
        return self._followed(cell, lambda held, patch: impacts_of(held, patch, most))

    def refute(self, cell: Cell) -> None:
        """Show that all of a cell decay to the stable rub; :class:`LeftOpenError` if this is not shown."""
        self._followed(cell, show_in_rub)

    def _followed(self, cell: Cell, follow: Callable[[Held, Patch], _Result]) -> _Result:
        part = self.part(cell.parts)
        low, high = (rational(share) for share in cell.speeds)
        first, last = (2 * arb.pi() * rational(share) for share in cell.angles)
        try:
            if not _levitates(part.held):
                raise LeftOpenError(OUTSIDE, self._sizes(cell))
            if self.along:
                return follow(part.held, disturbed_in_box((low, high), (first, last), part.reaches, part.moves))
            return follow(part.held, disturbed((low * part.reaches[1], high * part.reaches[1]), (first, last)))
        except (ArithmeticError, ValueError):
            # Balls of a wide cell that hold everything: numbers in double precision fail then.
            raise LeftOpenError(GRAZE, self._sizes(cell)) from None

    def try_(self, cell: Cell, returns: bool) -> DiscResult:
        """What can be proven of a cell, the disturbance in the middle of which returns or does not."""
        sizes = self._sizes(cell)
        try:
            if returns:
                return DiscResult(IMPACTS[self.show(cell, self.most_impacts)])
            if not self.part(cell.parts).held.rub.exists:
                return DiscResult(LOST, CUTS[int(np.argmax(sizes))])
            self.refute(cell)
            return DiscResult(REFUTED)
        except LeftOpenError as problem:
            weights = problem.weights if len(problem.weights) == len(sizes) else sizes
            return DiscResult(
                problem.reason[0] if returns else LOST, CUTS[max(range(len(sizes)), key=weights.__getitem__)]
            )

    def come_back(self, cells: list[Cell]) -> list[bool]:
        """Whether the disturbance in the middle of each cell returns, in double precision: it decides what is tried."""
        returned = dict.fromkeys(cells, False)
        for parts in {cell.parts for cell in cells}:
            alike = [cell for cell in cells if cell.parts == parts]
            returned |= zip(alike, self.part(parts).come_back(alike), strict=True)
        return [returned[cell] for cell in cells]

    def tried(self, cells: list[Cell]) -> list[DiscResult]:
        """What is found of some cells."""
        return [self.try_(cell, returns) for cell, returns in zip(cells, self.come_back(cells), strict=True)]

    def _sizes(self, cell: Cell) -> tuple[float, ...]:
        """How wide a cell is in each of its coordinates: about by how much they move a flight."""
        part = self.part(cell.parts)
        (slow, fast), turn = cell.speeds, cell.angles[1] - cell.angles[0]
        largest, radius = part.doubles[2], part.held.middle.plain.radius
        around = 2 * np.pi * float(turn) * min(float(fast) * largest, radius)
        sides = [
            float((abs(side.gamma) + abs(side.omega_squared) + abs(side.radius)).mid()) for side in part.held.sides
        ]
        return float(fast - slow) * largest, around, *sides

    def data(self) -> DiscData:
        """Plain data of it, from which :func:`disc_of` makes it again in another process."""
        hypotheses = json.dumps(self.hypotheses.document())
        return self.family.about, hypotheses, self.largest, self.most_impacts, self.along


@lru_cache(maxsize=2)
def disc_of(data: DiscData) -> KickDisc:
    """A disc from plain data, once for all cells that a process looks at."""
    about, document, largest, most, along = data
    return KickDisc(FAMILIES[about], Hypotheses.from_document(json.loads(document)), largest, most, along)


def _levitates(held: Held) -> bool:
    """Whether all rotors levitate inside the wall, with damping."""
    return bool(held.room > 0 and held.numbers.gamma > 0)


@dataclass(frozen=True)
class BoxPart:
    """The machines of a part of the box, or the one machine that there is.

    Attributes
    ----------
    held : Held
    reaches : tuple of arb
        ``v`` of the largest size for the machine in the middle, and for all.
    moves : list of arb
        Its derivatives by the parameters, times half their widths.
    phase : float
        Of the unbalance.
    """

    held: Held
    reaches: tuple[arb, arb]
    moves: list[arb]
    phase: float

    @cached_property
    def doubles(self) -> tuple[Rotor, complex, float]:
        """The rotor in the middle, the direction in which it levitates, and the largest ``v``, in double precision."""
        rotor = jeffcott(doubles_at(self.held.middle.numbers, self.phase))
        place = rotor.equilibrium
        return rotor, place / abs(place) if place else 1.0, float(self.reaches[0].mid())

    def come_back(self, cells: list[Cell]) -> list[bool]:
        """Whether the disturbance in the middle of each cell returns, in double precision."""
        rotor, ahead, largest = self.doubles
        middles = [(float(sum(cell.speeds)) / 2, float(sum(cell.angles)) / 2) for cell in cells]
        sizes = np.array([largest * size * np.exp(2j * np.pi * angle) * ahead for size, angle in middles])
        busy = float(self.held.start.lasts.mid())
        place, rate, _ = self.held.start.plain_response(self.held, busy)
        back = np.exp(-1j * busy)
        starts, velocities = rotor.equilibrium + sizes * place * back, sizes * (rate - 1j * place) * back
        # What is outside by then is tried, to be stated why it is open.
        outside = np.abs(starts) >= 1
        starts[outside], velocities[outside] = rotor.equilibrium, 0
        endings = settle(rotor, State(starts, velocities), threads=1, progress=False)
        returned: list[bool] = (endings.outcomes == Outcome.LEVITATED).tolist()
        return returned

    @classmethod
    def of(cls, disc: KickDisc, parts: tuple[Part, ...]) -> BoxPart:
        """From a part of the box of a disc."""
        box = disc.box
        values = box.middles(parts), box.values(parts)
        middle, numbers = map(box.machines.at, values)
        with terms(2):
            series = [disc.reach(numbers, moved) for moved in box.series(parts)]
        moves = [x[1] if isinstance(x, arb_series) else arb(0) for x in series]
        if parts:
            held = Held(numbers, disc.scale.start(), middle, box.sides(parts))
        else:
            held = Held(numbers, disc.scale.start())
        reaches = tuple(disc.reach(n, moved) for n, moved in zip((held.middle.numbers, numbers), values, strict=True))
        return cls(held, (reaches[0], reaches[1]), moves, float(ball_of(disc.hypotheses.numbers["phi"]).mid()))
