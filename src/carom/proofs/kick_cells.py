"""The disc of kick velocities as cells that halve one another, so that they have no gaps and no overlaps.

Polar coordinates: the speed as a share of the largest one, the angle from the direction in which the rotor levitates as a share of a turn.
For a box of machines each parameter is one more coordinate, as a share of its interval.  The first cell is the whole disc, with the whole box.
A cell is halved in one of these or not at all, and what is known of it then is one letter.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from typing import NamedTuple

from carom.proofs.evidence import NotShownError
from carom.proofs.passages import REASONS

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
    AHEAD: "time was up",
    LOST: "the one in the middle does not return in double precision",
    **{reason[0]: words for reason, words in REASONS.items()},
}
"""Letters of cells that are open: why the cell that was halved into them was."""
DEEPEST = 64
"""Halvings of a coordinate."""


class Cell(NamedTuple):
    """The ``ring``-th of ``2^rings`` parts of the speeds and the ``sector``-th of ``2^sectors`` parts of a turn.

    ``parts`` has for each parameter the same two numbers.
    """

    ring: int
    rings: int
    sector: int
    sectors: int
    parts: tuple[tuple[int, int], ...] = ()

    @property
    def speeds(self) -> tuple[Fraction, Fraction]:
        """Both ends of its speeds, as shares of the largest one."""
        return Fraction(self.ring, 2**self.rings), Fraction(self.ring + 1, 2**self.rings)

    @property
    def angles(self) -> tuple[Fraction, Fraction]:
        """Both ends of its angles, as shares of a turn."""
        return Fraction(self.sector, 2**self.sectors), Fraction(self.sector + 1, 2**self.sectors)

    @property
    def ends(self) -> list[tuple[Fraction, Fraction]]:
        """Both ends of each parameter, as shares of its interval."""
        return [(Fraction(k, 2**n), Fraction(k + 1, 2**n)) for k, n in self.parts]

    @property
    def share(self) -> Fraction:
        """Its share of the area of the disc, times that of the box."""
        return Fraction(2 * self.ring + 1, 4**self.rings * 2**self.sectors * 2 ** sum(part[1] for part in self.parts))

    @property
    def halvings(self) -> int:
        """How often it is halved, in the coordinate in which it is most often."""
        return max(self.rings, self.sectors, *(part[1] for part in self.parts))

    def halves(self, by: str) -> tuple[Cell, Cell]:
        """Both halves by one of :data:`CUTS`, the smaller values first."""
        ring, rings, sector, sectors, parts = self
        if by == BY_SPEED:
            one, other = (self._replace(ring=2 * ring + k, rings=rings + 1) for k in (0, 1))
        elif by == BY_ANGLE:
            one, other = (self._replace(sector=2 * sector + k, sectors=sectors + 1) for k in (0, 1))
        else:
            j = BY_PARAMETER.index(by)
            place, halvings = parts[j]
            one, other = (
                self._replace(parts=(*parts[:j], (2 * place + k, halvings + 1), *parts[j + 1 :])) for k in (0, 1)
            )
        return one, other


DISC = Cell(0, 0, 0, 0)


def whole(parameters: int) -> Cell:
    """The whole disc with the whole box of so many parameters."""
    return DISC._replace(parts=((0, 0),) * parameters)


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
    """Read what :func:`written` gives; :class:`~carom.proofs.evidence.NotShownError` for cells that do not fill the disc."""
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
