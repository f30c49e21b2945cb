"""The disc of kick velocities as cells that halve one another, so that they have no gaps and no overlaps.

Polar coordinates: the speed as a share of the largest one, the angle from the direction in which the rotor levitates as a share of a turn.
For a box of machines each parameter is one more coordinate, as a share of its interval.  The first cell is the whole disc, with the whole box.
A cell is halved in one of these or not at all, and what is known of it then is one letter.

In a box of machines some parameters lie each in an interval, and the other numbers are those of the hypotheses.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

from flint import arb, arb_series

from carom.base.outcome import InputError
from carom.parameters.terms import conflicts
from carom.proofs.balls import Ball, interval, rational, terms
from carom.proofs.claims import NotShownError
from carom.proofs.hypotheses import Hypotheses
from carom.proofs.lines import Line, Machines, line_of
from carom.proofs.passages import REASONS
from carom.proofs.sides import Side

Part = tuple[int, int]
"""The ``k``-th of ``2^n`` parts of an interval, as ``(k, n)``."""
BY_SPEED, BY_ANGLE = "v", "a"
BY_PARAMETER = "pqu"
CUTS = BY_SPEED + BY_ANGLE + BY_PARAMETER
"""Letters of cells that are halved: by speed, by angle, by the first to third parameter."""
IMPACTS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ"
"""Letters of cells that are proven to return with at most so many impacts."""
REFUTED = "r"
"""Letter of cells that are proven to decay to the stable rub."""
AHEAD, LOST = "t", "x"
OPEN = {
    AHEAD: "time limit reached",
    LOST: "the disturbance at its centre does not return in double precision",
    **{reason[0]: words for reason, words in REASONS.items()},
}
"""Letters of cells that are open: why the cell that was halved into them was."""
DEEPEST = 64
"""Halvings of a coordinate."""


class Cell(NamedTuple):
    """A part of the speeds, of a turn, and with a box of the interval of each parameter: the ``k``-th of ``2^n``, each as ``(k, n)``."""

    ring: Part = (0, 0)
    sector: Part = (0, 0)
    parts: tuple[Part, ...] = ()

    @property
    def speeds(self) -> tuple[Fraction, Fraction]:
        """Both ends of its speeds, as shares of the largest one."""
        return _ends(self.ring)

    @property
    def angles(self) -> tuple[Fraction, Fraction]:
        """Both ends of its angles, as shares of a turn."""
        return _ends(self.sector)

    @property
    def ends(self) -> list[tuple[Fraction, Fraction]]:
        """Both ends of each parameter, as shares of its interval."""
        return [_ends(part) for part in self.parts]

    @property
    def share(self) -> Fraction:
        """Its share of the area of the disc, times that of the box."""
        k, n = self.ring
        return Fraction(2 * k + 1, 2 ** (2 * n + self.sector[1] + sum(part[1] for part in self.parts)))

    @property
    def halvings(self) -> int:
        """How often it is halved, in the coordinate in which it is most often."""
        return max(n for _, n in (self.ring, self.sector, *self.parts))

    def halves(self, by: str) -> tuple[Cell, Cell]:
        """Both halves by one of :data:`CUTS`, the smaller values first."""
        places, j = [self.ring, self.sector, *self.parts], CUTS.index(by)
        k, n = places[j]

        def half(side: int) -> Cell:
            now = [*places[:j], (2 * k + side, n + 1), *places[j + 1 :]]
            return Cell(now[0], now[1], tuple(now[2:]))

        return half(0), half(1)


def _ends(part: Part) -> tuple[Fraction, Fraction]:
    """Both ends of a part, as shares of the whole."""
    place, halvings = part
    return Fraction(place, 2**halvings), Fraction(place + 1, 2**halvings)


DISC = Cell()


def whole(parameters: int) -> Cell:
    """The whole disc with the whole box of so many parameters."""
    return Cell(parts=((0, 0),) * parameters)


Tree = dict[Cell, str]
"""What is known of each cell: a letter of :data:`IMPACTS` or :data:`OPEN`, :data:`REFUTED`, or by what it is halved."""


def leaves(tree: Mapping[Cell, str]) -> Iterator[tuple[Cell, str]]:
    """The cells that are not halved, which fill the disc, each with its letter."""
    return ((cell, letter) for cell, letter in tree.items() if letter not in CUTS)


def written(tree: Mapping[Cell, str]) -> str:
    """The letters of all cells, each halved one before its halves; the tree's first cell is the whole."""
    letters, ahead = [], [next(iter(tree))]
    while ahead:
        cell = ahead.pop()
        letters.append(tree[cell])
        if letters[-1] in CUTS:
            ahead += reversed(cell.halves(letters[-1]))
    return "".join(letters)


def read(text: object, parameters: int = 0) -> Tree:
    """Read what :func:`written` gives; :class:`~carom.proofs.claims.NotShownError` for cells that do not fill the disc."""
    if not isinstance(text, str):
        raise NotShownError("the cells of a certificate are no text")
    tree: Tree = {}
    ahead = [whole(parameters)]
    for letter in text:
        if not ahead:
            raise NotShownError("the certificate has more cells than fill the disc")
        cell = ahead.pop()
        tree[cell] = letter
        if letter in CUTS[: 2 + parameters]:
            if cell.halvings >= DEEPEST:
                raise NotShownError("the certificate has cells that are too small")
            ahead += reversed(cell.halves(letter))
        elif letter not in IMPACTS and letter != REFUTED and letter not in OPEN:
            raise NotShownError(f"the certificate has a cell of an unknown kind: {letter!r}")
    if ahead:
        raise NotShownError("the cells of the certificate do not fill the disc")
    return tree


def share_of(cells: Iterable[Cell]) -> Fraction:
    """Share of the area of the disc, times that of the box."""
    return sum((cell.share for cell in cells), Fraction(0))


MOST_PARAMETERS = 3
"""Parameters of a box."""


@dataclass(frozen=True)
class Box:
    """All machines whose parameters lie in intervals, at the precision of their first use.

    Attributes
    ----------
    hypotheses : Hypotheses
        Their own values of the parameters do not matter.
    lines : tuple of Line
        One for each parameter.
    """

    hypotheses: Hypotheses
    lines: tuple[Line, ...]

    def ends(self, number: int, part: Part) -> tuple[Fraction, Fraction]:
        """Both ends of a part of the interval of a parameter, in its SI unit."""
        low, high = self.lines[number].ends
        place, halvings = part
        return tuple(low + (high - low) * Fraction(place + side, 2**halvings) for side in (0, 1))  # type: ignore[return-value]

    def values(self, parts: Sequence[Part]) -> dict[str, arb]:
        """Ball of each parameter on a part of the box."""
        return {line.name: interval(*self.ends(j, parts[j])) for j, line in enumerate(self.lines)}

    def middles(self, parts: Sequence[Part]) -> dict[str, arb]:
        """Ball of the middle of each parameter on a part of the box."""
        return {line.name: rational(sum(self.ends(j, parts[j]), Fraction(0)) / 2) for j, line in enumerate(self.lines)}

    def series(self, parts: Sequence[Part]) -> list[dict[str, Ball]]:
        """The parameters as power series in each of them, by half its width, on all of a part of the box."""
        balls, found = self.values(parts), list[dict[str, Ball]]()
        for j, line in enumerate(self.lines):
            low, high = self.ends(j, parts[j])
            found.append({**balls, line.name: arb_series([balls[line.name], rational((high - low) / 2)])})
        return found

    def sides(self, parts: Sequence[Part]) -> list[Side]:
        """By how much each parameter moves the numbers."""
        with terms(2):
            return [Side.of(self.machines.at(moved)) for moved in self.series(parts)]

    @cached_property
    def machines(self) -> Machines:
        """The machines as functions of the parameters."""
        return Machines(self.hypotheses)

    @property
    def words(self) -> str:
        """The intervals in words."""
        return " and ".join(line.words for line in self.lines)


def box_of(hypotheses: Hypotheses, along: Sequence[Sequence[str]]) -> Box:
    """Machines along some parameters, each as its name and both ends of its interval given as text.

    What :func:`~carom.proofs.lines.line_of` refuses is refused, and parameters two of which set the same number.
    """
    if len(along) > MOST_PARAMETERS:
        raise InputError("along", len(along), f"must be at most {MOST_PARAMETERS} parameters")
    lines = tuple(line_of(hypotheses, *entry) for entry in along)
    names = [line.name for line in lines]
    for name in names:
        if names.count(name) > 1:
            raise InputError("along", name, "must name each parameter once")
    for problem in conflicts({line.name: f"{line.start} to {line.stop}" for line in lines}):
        raise problem
    return Box(hypotheses, lines)
