"""Ball arithmetic: exact numbers in, decimal enclosures out."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal, localcontext
from fractions import Fraction
from itertools import takewhile

from flint import arb, ctx, fmpq

from carom.parameters.quantities import ExactNumber

_MOST_DIGITS, _SHOWN = 60, 16
MARGIN = Fraction(1, 32)
"""By how much an enclosure is written wider on each side, as a share of its width."""


@contextmanager
def at_precision(bits: int) -> Iterator[None]:
    """Compute with this many bits."""
    before = ctx.prec
    ctx.prec = bits
    try:
        yield
    finally:
        ctx.prec = before


def rational(number: Fraction) -> arb:
    """Ball that contains a rational number."""
    return arb(fmpq(number.numerator, number.denominator))


def interval(low: Fraction, high: Fraction) -> arb:
    """Ball that contains all numbers between two rational ones."""
    return rational(low) if low == high else rational(low).union(rational(high))


def ball_of(number: ExactNumber) -> arb:
    """Ball that contains an exact number, or all numbers of an interval."""
    ball = interval(number.low, number.high)
    return ball * arb.pi() ** number.turns if number.turns else ball


def decided(ball: arb) -> int:
    """Sign that is proven for all numbers of a real ball: 1, −1, or 0 if none is."""
    if ball > 0:
        return 1
    return -1 if ball < 0 else 0


def exact_ends(ball: arb) -> tuple[Fraction, Fraction]:
    """Both ends of a real ball, outward, as rational numbers."""
    ends = []
    for end in (ball.lower(), ball.upper()):
        mantissa, exponent = map(int, end.man_exp())
        ends.append(Fraction(mantissa * 2**exponent) if exponent >= 0 else Fraction(mantissa, 2**-exponent))
    return ends[0], ends[1]


@dataclass(frozen=True)
class Enclosure:
    """Two decimal numbers between which a real number is proven to lie.

    Attributes
    ----------
    low, high : str
    inner : tuple of Fraction
        Ends of the ball that was computed, well inside.
    """

    low: str
    high: str
    inner: tuple[Fraction, Fraction] = field(compare=False, repr=False)

    @property
    def value(self) -> float:
        """A double between them, or next to them."""
        return float((Fraction(self.low) + Fraction(self.high)) / 2)

    @property
    def width(self) -> Fraction:
        """Difference of both numbers."""
        return Fraction(self.high) - Fraction(self.low)

    def holds(self, other: Enclosure) -> bool:
        """Whether the ball of another one lies between its numbers."""
        return Fraction(self.low) <= other.inner[0] and other.inner[1] <= Fraction(self.high)

    @property
    def short(self) -> str:
        """The digits that both have in common, at most ``_SHOWN``, or both numbers."""
        pairs = zip(self.low, self.high, strict=False)
        common = "".join(one for one, _ in takewhile(lambda pair: pair[0] == pair[1], pairs))
        places = {len(end.partition(".")[0]) for end in (self.low, self.high)}
        # Digits in common say nothing where the decimal point is not at the same place, or is not shown.
        shown = len(places) == 1 and max(places) <= min(len(common), _SHOWN) and set(common) & set("123456789")
        if not shown or "E" in self.low + self.high:
            return str(self)
        return common if self.low == self.high and len(common) <= _SHOWN else f"{common[:_SHOWN]}…"

    def __str__(self) -> str:
        return self.low if self.low == self.high else f"[{self.low}, {self.high}]"


def enclosure_of_fraction(number: Fraction) -> Enclosure:
    """Decimal enclosure of a rational number: the number itself, if it has few enough digits."""
    low, high = (_decimal(number, _MOST_DIGITS, rounding) for rounding in (ROUND_FLOOR, ROUND_CEILING))
    return Enclosure(low, high, (number, number))


def enclosures_of(**balls: arb) -> dict[str, Enclosure]:
    """Decimal enclosures of those real balls that are bounded."""
    return {name: enclosure_of(ball) for name, ball in balls.items() if ball.is_finite()}


def enclosure_of(ball: arb) -> Enclosure:
    """Decimal enclosure of a real ball, wider by a share of it (``MARGIN``) on both sides, with the digits that it has.

    The margin allows a check by another version of the arithmetic, whose roundings differ in far less.
    """
    low, high = exact_ends(ball)
    width = high - low
    size = max(abs(low), abs(high))
    digits = min(_MOST_DIGITS, max(3, len(str(int(size / width))) + 3)) if width else _MOST_DIGITS
    ends = _decimal(low - MARGIN * width, digits, ROUND_FLOOR), _decimal(high + MARGIN * width, digits, ROUND_CEILING)
    return Enclosure(*ends, (low, high))


def _decimal(number: Fraction, digits: int, rounding: str) -> str:
    with localcontext(Context(prec=digits, rounding=rounding)):
        # The quotient of two exact integers is rounded once, in the direction asked for.
        return str((Decimal(number.numerator) / Decimal(number.denominator)).normalize())
