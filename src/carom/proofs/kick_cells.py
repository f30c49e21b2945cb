"""The disc of kick velocities as cells that halve one another, so that they have no gaps and no overlaps.

Polar coordinates: the speed as a share of the largest one, the angle from the direction in which the rotor levitates as a share of a turn.
The first cell is the whole disc.  A cell is halved in one of the two or not at all, and what is known of it then is one letter.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from typing import NamedTuple

from carom.proofs.evidence import NotShownError
from carom.proofs.passages import REASONS

BY_SPEED, BY_ANGLE = "v", "a"
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
    """The ``ring``-th of ``2^rings`` parts of the speeds and the ``sector``-th of ``2^sectors`` parts of a turn."""

    ring: int
    rings: int
    sector: int
    sectors: int

    @property
    def speeds(self) -> tuple[Fraction, Fraction]:
        """Both ends of its speeds, as shares of the largest one."""
        return Fraction(self.ring, 2**self.rings), Fraction(self.ring + 1, 2**self.rings)

    @property
    def angles(self) -> tuple[Fraction, Fraction]:
        """Both ends of its angles, as shares of a turn."""
        return Fraction(self.sector, 2**self.sectors), Fraction(self.sector + 1, 2**self.sectors)

    @property
    def share(self) -> Fraction:
        """Its share of the area of the disc."""
        return Fraction(2 * self.ring + 1, 4**self.rings * 2**self.sectors)

    def halves(self, by: str) -> tuple[Cell, Cell]:
        """Both halves, by speed or by angle, the smaller values first."""
        ring, rings, sector, sectors = self
        if by == BY_SPEED:
            return Cell(2 * ring, rings + 1, sector, sectors), Cell(2 * ring + 1, rings + 1, sector, sectors)
        return Cell(ring, rings, 2 * sector, sectors + 1), Cell(ring, rings, 2 * sector + 1, sectors + 1)


DISC = Cell(0, 0, 0, 0)
Tree = dict[Cell, str]
"""What is known of each cell: a letter of :data:`IMPACTS` or :data:`OPEN`, :data:`REFUTED`, or by what it is halved."""


def leaves(tree: Mapping[Cell, str]) -> Iterator[tuple[Cell, str]]:
    """The cells that are not halved, which fill the disc, each with its letter."""
    return ((cell, letter) for cell, letter in tree.items() if letter not in (BY_SPEED, BY_ANGLE))


def written(tree: Mapping[Cell, str]) -> str:
    """The letters of all cells, each halved one before its halves."""
    letters, ahead = [], [DISC]
    while ahead:
        cell = ahead.pop()
        letters.append(tree[cell])
        if letters[-1] in (BY_SPEED, BY_ANGLE):
            ahead += reversed(cell.halves(letters[-1]))
    return "".join(letters)


def read(text: object) -> Tree:
    """Read what :func:`written` gives; :class:`~carom.proofs.evidence.NotShownError` for cells that do not fill the disc."""
    if not isinstance(text, str):
        raise NotShownError("the cells of a certificate are no text")
    tree: Tree = {}
    ahead = [DISC]
    for letter in text:
        if not ahead:
            raise NotShownError("the certificate has more cells than fill the disc")
        cell = ahead.pop()
        tree[cell] = letter
        if letter in (BY_SPEED, BY_ANGLE):
            if max(cell.rings, cell.sectors) >= DEEPEST:
                raise NotShownError("the certificate has cells that are too small")
            ahead += reversed(cell.halves(letter))
        elif letter not in IMPACTS and letter != REFUTED and letter not in OPEN:
            raise NotShownError(f"the certificate has a cell of an unknown kind: {letter!r}")
    if ahead:
        raise NotShownError("the cells of the certificate do not fill the disc")
    return tree


def share_of(cells: Iterable[Cell]) -> Fraction:
    """Share of the area of the disc."""
    return sum((cell.share for cell in cells), Fraction(0))
