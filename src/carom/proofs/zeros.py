"""Zeros in ball arithmetic: signs of an analytic function on intervals, and zeros of systems by the operator of Krawczyk.

Signs follow from Taylor's formula.  On a cell with middle ``m`` and half width ``h``, ``f = Σ_{k<n} c_k (x − m)^k + c_n(ξ)(x − m)^n``: the coefficients about
``m`` are narrow balls, the last is one that holds for every ``ξ`` of the cell.  If ``|c_0|`` exceeds the sum of all other
moduli times ``h^k``, ``f`` keeps its sign on the cell; in the same way ``f'`` does.

Next to zero, where ``f`` and its first derivatives are known to vanish, the first term that does not takes the part of ``c_0``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from flint import arb, arb_mat, arb_series, ctx

from carom.proofs.balls import decided, exact_ends, interval, rational, terms
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


def _leads(series: list[arb], order: int, width: arb) -> bool:
    """Whether the term of an order exceeds the sum of all higher ones within a width."""
    total = arb(0)
    for term in reversed(series[order + 1 :]):
        total = (total + abs(term)) * width
    return bool(abs(series[order]) > total)


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


def runs_of(function: Analytic, cells: CellTree) -> Iterator[tuple[Fraction, Fraction, str, int, int]]:
    """Both ends, kind and signs at the ends of runs of monotone cells, and of open ones."""
    shown = {POSITIVE: 1, NEGATIVE: -1}
    first = 0
    while first < len(cells.kinds):
        kind, last = cells.kinds[first], first
        while last + 1 < len(cells.kinds) and cells.kinds[last + 1] == kind:
            last += 1
        if kind not in shown:
            low, high = cells.cuts[first], cells.cuts[last + 1]
            before = shown.get(cells.kinds[first - 1], 0) if first else 0
            after = shown.get(cells.kinds[last + 1], 0) if last + 1 < len(cells.kinds) else 0
            yield low, high, kind, before or function.sign(low), after or function.sign(high)
        first = last + 1


def power_of_two_below(number: Fraction) -> Fraction:
    """A power of two of at most a positive number, and more than a quarter of it."""
    exponent = number.numerator.bit_length() - number.denominator.bit_length() - 1
    return Fraction(2) ** exponent


System = Callable[..., Sequence[arb | arb_series]]
"""Takes as many balls or power series as it gives."""
STEPS = 14
"""Largest number of steps of Newton's method."""
_WIDTHS = (8, 12, 16, 20, 26, 32, 40, 50, 64, 80, 100)
"""Widths of the boxes that are tried: these powers of 1/2, relative to the unknowns."""


def derivatives(system: System, box: Sequence[arb]) -> tuple[list[arb], arb_mat]:
    """Values of a system on a box and its Jacobian, an ``arb_mat``."""
    columns, values = [], []
    with terms(2):
        for place in range(len(box)):
            found = system(*(arb_series([x, 1]) if k == place else x for k, x in enumerate(box)))
            series = [f if isinstance(f, arb_series) else arb_series([f]) for f in found]
            columns.append([f[1] for f in series])
            values = [f[0] for f in series]
    return values, arb_mat([[column[row] for column in columns] for row in range(len(values))])


def newton(system: System, guess: Sequence[arb | float]) -> list[arb] | None:
    """Zero near a guess by Newton's method, not proven; ``None`` if the method fails."""
    place = [arb(x).mid() for x in guess]
    for _ in range(STEPS):
        try:
            values, jacobian = derivatives(system, place)
            change = jacobian.mid().solve(arb_mat([[value.mid()] for value in values]))
        except (ValueError, ZeroDivisionError):
            return None
        place = [(x - change[k, 0]).mid() for k, x in enumerate(place)]
        if not all(x.is_finite() for x in place):
            return None
        if all(abs(change[k, 0]) <= abs(x) * arb(2) ** (-ctx.prec // 2) for k, x in enumerate(place)):
            return place
    return None


def enclosed_zero(system: System, centre: Sequence[arb], width: int | None = None) -> tuple[list[arb], int] | None:
    """Balls that contain a zero of a system, which is the only one in a wider box, and the width of that box.

    The operator ``K(X) = c − Y f(c) + (1 − Y f'(X))(X − c)`` maps a box into its interior only if the box has exactly one
    zero.  It then lies in ``K(X)``.  The centre is exact, next to the zero.  The width is ``2**-width`` relative to the centre; if
    it is given, no other box is tried.  ``None`` if no box shows a zero.
    """
    try:
        values, jacobian = derivatives(system, centre)
        inverse = jacobian.mid().inv().mid()
    except (ValueError, ZeroDivisionError):
        return None
    shift = inverse * arb_mat([[value] for value in values])

    def image(box: list[arb]) -> list[arb] | None:
        try:
            _, slopes = derivatives(system, box)
        except (ValueError, ZeroDivisionError):
            return None
        count = len(box)
        unit = arb_mat(count, count, [int(i == j) for i in range(count) for j in range(count)])
        away = arb_mat([[x - c] for x, c in zip(box, centre, strict=True)])
        found = arb_mat([[c] for c in centre]) - shift + (unit - inverse * slopes) * away
        return [found[k, 0] for k in range(count)]

    for bits in _WIDTHS if width is None else (width,):
        box = box_around(centre, bits)
        inner = image(box)
        if inner is None or not all(x.contains_interior(y) for x, y in zip(box, inner, strict=True)):
            continue
        for _ in range(6):
            again = image(inner)
            if again is None or not all(x.overlaps(y) for x, y in zip(inner, again, strict=True)):
                break
            narrow = [x.intersection(y) for x, y in zip(inner, again, strict=True)]
            gained = any(x.rad() < 0.5 * y.rad() for x, y in zip(narrow, inner, strict=True))
            inner = narrow
            if not gained:
                break
        return inner, bits
    return None


def box_around(centre: Sequence[arb], width: int) -> list[arb]:
    """The box ``2**-width`` wide around a centre, relative to that, in which a zero is unique."""
    return [c + arb(0, (arb(2) ** -width * (abs(c) + 2**-10)).upper()) for c in centre]


def box_of(evidence: Document) -> list[arb]:
    """The box in which the zero of such evidence is unique."""
    centre = [rational(rational_of(text)).mid() for text in evidence["centre"]]
    return box_around(centre, int(evidence["width"]))


def found_zero(system: System, guess: Sequence[arb | float]) -> tuple[dict[str, object], list[arb]] | None:
    """Evidence of a zero near a guess, for a certificate, and balls that contain it; ``None`` if none is shown."""
    centre = newton(system, guess)
    found = None if centre is None else enclosed_zero(system, centre)
    if centre is None or found is None:
        return None
    return {"centre": [str(exact_ends(x)[0]) for x in centre], "width": found[1]}, found[0]


def shown_zero(system: System, evidence: Document) -> list[arb] | None:
    """Balls that contain the zero of such evidence; ``None`` if it shows none."""
    centre = [rational(rational_of(text)).mid() for text in evidence["centre"]]
    found = enclosed_zero(system, centre, int(evidence["width"]))
    return None if found is None else found[0]
