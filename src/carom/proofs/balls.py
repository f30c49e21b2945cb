"""Ball arithmetic: exact numbers in, decimal enclosures out."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal, localcontext
from fractions import Fraction
from typing import Any

from flint import arb, ctx, fmpq

from carom.parameters.exact import ExactNumber

_MOST_DIGITS = 60


@contextmanager
def at_precision(bits: int) -> Iterator[None]:
    """Compute with this many bits."""
    before = ctx.prec
    ctx.prec = bits
    try:
        yield
    finally:
        ctx.prec = before


def rational(number: Fraction) -> Any:
    """Ball that contains a rational number."""
    return arb(fmpq(number.numerator, number.denominator))


def interval(low: Fraction, high: Fraction) -> Any:
    """Ball that contains all numbers between two rational ones."""
    return rational(low) if low == high else rational(low).union(rational(high))


def ball_of(number: ExactNumber) -> Any:
    """Ball that contains an exact number, or all numbers of an interval."""
    ball = interval(number.low, number.high)
    return ball * arb.pi() ** number.turns if number.turns else ball


def decided(ball: Any) -> int:
    """Sign that is proven for all numbers of a real ball: 1, −1, or 0 if none is."""
    if ball > 0:
        return 1
    return -1 if ball < 0 else 0


def exact_ends(ball: Any) -> tuple[Fraction, Fraction]:
    """Both ends of a real ball, outward, as rational numbers."""
    ends = []
    for end in (ball.lower(), ball.upper()):
        mantissa, exponent = end.man_exp()
        mantissa, exponent = int(mantissa), int(exponent)
        ends.append(Fraction(mantissa * 2**exponent) if exponent >= 0 else Fraction(mantissa, 2**-exponent))
    return ends[0], ends[1]


@dataclass(frozen=True)
class Enclosure:
    """Two decimal numbers between which a real number is proven to lie.

    Attributes
    ----------
    low, high : str
    """

    low: str
    high: str

    @property
    def value(self) -> float:
        """A double between them, or next to them."""
        return float((Fraction(self.low) + Fraction(self.high)) / 2)

    @property
    def digits(self) -> int:
        """Number of significant digits that are certain, about."""
        low, high = Fraction(self.low), Fraction(self.high)
        size = max(abs(low), abs(high))
        if not size or low == high:
            return _MOST_DIGITS
        with localcontext(Context(prec=20)):
            ratio = Decimal((high - low).numerator) / Decimal((high - low).denominator)
            ratio /= Decimal(size.numerator) / Decimal(size.denominator)
            return max(0, -ratio.adjusted() - 1)

    def __str__(self) -> str:
        return self.low if self.low == self.high else f"[{self.low}, {self.high}]"


def enclosure_of(ball: Any) -> Enclosure:
    """Decimal enclosure of a real ball, rounded outward to the digits that it has."""
    low, high = exact_ends(ball)
    width = high - low
    if not width:
        digits = _MOST_DIGITS
    else:
        size = max(abs(low), abs(high))
        digits = min(_MOST_DIGITS, max(3, len(str(int(size / width))) + 2))
    return Enclosure(_decimal(low, digits, ROUND_FLOOR), _decimal(high, digits, ROUND_CEILING))


def _decimal(number: Fraction, digits: int, rounding: str) -> str:
    with localcontext(Context(prec=digits, rounding=rounding)):
        # The quotient of two exact integers is rounded once, in the direction asked for.
        return str((Decimal(number.numerator) / Decimal(number.denominator)).normalize())
