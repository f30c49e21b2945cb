"""Signs of an analytic function on intervals, by Taylor's formula in ball arithmetic.

On a cell with middle ``m`` and half width ``h``, ``f = Σ_{k<n} c_k (x − m)^k + c_n(ξ)(x − m)^n``: the coefficients about
``m`` are narrow balls, the last is one that holds for every ``ξ`` of the cell.  If ``|c_0|`` exceeds the sum of all other
moduli times ``h^k``, ``f`` keeps its sign on the cell; in the same way ``f'`` does.

Next to zero, where ``f`` and its first derivatives are known to vanish, the first term that does not takes the part of ``c_0``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from flint import arb

from carom.proofs.balls import decided, interval
from carom.proofs.claims import Document, NotShownError, rational_of

ORDER = 10
"""Order of the Taylor formula: with fewer the cells are more, with more each costs more than it saves."""
POSITIVE, NEGATIVE, RISING, FALLING, OPEN = "+", "-", "r", "f", "?"
"""What is shown of a function on a cell; the last one: nothing, the cell is too narrow for the precision."""


@dataclass(frozen=True)
class CellTree:
    """Consecutive cells, and what is shown of a function on each.

    Attributes
    ----------
    cuts : tuple of Fraction
        Their ends in ascending order, one more than cells.
    kinds : str
        One letter a cell.
    """

    cuts: tuple[Fraction, ...]
    kinds: str

    def document(self) -> dict[str, object]:
        """As plain data for JSON."""
        return {"cuts": [str(cut) for cut in self.cuts], "kinds": self.kinds}

    @classmethod
    def from_document(cls, document: Document) -> CellTree:
        """Read what :meth:`document` gives."""
        cells = cls(tuple(rational_of(text) for text in document["cuts"]), str(document["kinds"]))
        if len(cells.cuts) != len(cells.kinds) + 1 or any(
            low >= high for low, high in zip(cells.cuts, cells.cuts[1:], strict=False)
        ):
            raise NotShownError("the cells of a certificate do not follow one another")
        return cells


class Analytic:
    """A real analytic function of one real variable, by its Taylor coefficients; remembers what it has shown.

    Parameters
    ----------
    series : callable
        Takes a real ball and a number of terms, and gives that many Taylor coefficients about every point of the ball.
    """

    def __init__(self, series: Callable[[arb, int], list[arb]]) -> None:
        self.series = series
        self._cells: dict[tuple[Fraction, Fraction], tuple[int, int]] = {}
        self._signs: dict[Fraction, int] = {}

    def sign(self, place: Fraction) -> int:
        """Sign at a place; 0 if it is not decided."""
        if place not in self._signs:
            self._signs[place] = decided(self.series(interval(place, place), 2)[0])
        return self._signs[place]

    def on(self, low: Fraction, high: Fraction) -> tuple[int, int]:
        """Signs of the function and of its slope on a cell, 0 where none is shown."""
        if (low, high) not in self._cells:
            middle, half = (low + high) / 2, (high - low) / 2
            about = self.series(interval(middle, middle), ORDER)
            about.append(self.series(interval(low, high), ORDER + 1)[ORDER])
            width = interval(half, half)
            value = decided(about[0]) if _leads(about, 0, width) else 0
            slope = decided(about[1]) if _leads([k * about[k] for k in range(ORDER + 1)], 1, width) else 0
            self._cells[low, high] = value, slope
        return self._cells[low, high]

    def sign_next_to_zero(self, width: Fraction, order: int) -> int:
        """Sign on the interval from zero, which is left out, to a width; 0 if none is shown.

        At zero the function and its derivatives below ``order`` vanish.
        """
        about = self.series(arb(0), ORDER)
        about.append(self.series(interval(Fraction(0), width), ORDER + 1)[ORDER])
        return decided(about[order]) if _leads(about, order, interval(width, width)) else 0


def _leads(terms: list[arb], order: int, width: arb) -> bool:
    """Whether the term of an order exceeds the sum of all higher ones within a width."""
    total = arb(0)
    for term in reversed(terms[order + 1 :]):
        total = (total + abs(term)) * width
    return bool(abs(terms[order]) > total)


def cells_of(
    function: Analytic, low: Fraction, high: Fraction, *, width: Fraction, least: Fraction, most: int
) -> CellTree:
    """Cells from one place to another, on each of which something is shown.

    Cells have at first the given width; one that is narrower than ``least`` is left open, and the search ends after ``most`` cells
    and attempts.
    """
    cuts, found, left = [low], "", low
    for _ in range(most if low < high else 0):
        right = min(left + width, high)
        sign, slope = function.on(left, right)
        kind = {1: POSITIVE, -1: NEGATIVE}.get(sign) or {1: RISING, -1: FALLING}.get(slope, OPEN)
        if kind == OPEN and right - left > least:
            width = (right - left) / 2
            continue
        left, found = right, found + kind
        cuts.append(right)
        if left == high:
            break
        if found[-2:-1] == kind or kind == OPEN:
            width *= 2
    return CellTree(tuple(cuts), found)


def show(function: Analytic, cells: CellTree) -> None:
    """Show what is said of each cell; :class:`NotShownError` if it is not so."""
    for low, high, kind in zip(cells.cuts, cells.cuts[1:], cells.kinds, strict=False):
        sign, slope = (0, 0) if kind == OPEN else function.on(low, high)
        stated = {POSITIVE: sign > 0, NEGATIVE: sign < 0, RISING: slope > 0, FALLING: slope < 0, OPEN: True}
        if not stated.get(kind, False):
            raise NotShownError(f"the certificate does not show {kind!r} between {low} and {high}")


def power_of_two_below(number: Fraction) -> Fraction:
    """A power of two of at most a positive number, and more than a quarter of it."""
    exponent = number.numerator.bit_length() - number.denominator.bit_length() - 1
    return Fraction(2) ** exponent
