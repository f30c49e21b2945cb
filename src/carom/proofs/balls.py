"""Ball arithmetic: exact numbers in, decimal enclosures out; functions of balls and of power series of balls alike.

In such a function a number is a ball (``arb``, ``acb``) or a power series whose coefficients are balls (``arb_series``, ``acb_series``),
truncated at ``flint.ctx.cap`` terms.  A formula evaluated for ``[x, 1]`` gives an enclosure of its value and its derivative at
every point of the ball ``x``.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal, localcontext
from fractions import Fraction
from functools import cache
from itertools import takewhile
from typing import Any, TypeVar

from flint import acb, acb_series, arb, arb_series, ctx, fmpq

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


I = acb(0, 1)  # noqa: E741  (the imaginary unit)
Ball = arb | arb_series
ComplexBall = acb | acb_series
N = TypeVar("N", arb, arb_series)
_SERIES = (arb_series, acb_series)
_REACH = 4
"""Largest ``|D t²|`` at which the functions of :func:`hyperbolic` are summed as power series."""
_SHORT = 0.3
"""Largest ``(|λ| T/6)²`` at which :func:`short_return` is summed: its terms fall faster than the powers of this."""


@contextmanager
def terms(number: int) -> Iterator[None]:
    """Truncate power series at a number of terms."""
    before = ctx.cap
    ctx.cap = number
    try:
        yield
    finally:
        ctx.cap = before


def first(x: Ball | ComplexBall) -> Any:
    """The ball itself, or the constant term of a series."""
    return x[0] if isinstance(x, _SERIES) else x


def real(x: Ball | ComplexBall) -> Any:
    """Real part."""
    if isinstance(x, acb):
        return x.real
    return arb_series([c.real for c in x.coeffs()]) if isinstance(x, acb_series) else x


def imaginary(x: ComplexBall) -> Any:
    """Imaginary part of a complex number."""
    return x.imag if isinstance(x, acb) else arb_series([c.imag for c in x.coeffs()])


def conjugate(x: ComplexBall) -> ComplexBall:
    """Conjugate of a complex number."""
    return x.conjugate() if isinstance(x, acb) else acb_series([c.conjugate() for c in x.coeffs()])


def squared(x: ComplexBall) -> Any:
    """``|z|²``."""
    a, b = real(x), imaginary(x)
    return a * a + b * b


def hull(low: arb | float, high: arb | float) -> arb:
    """Smallest ball that contains two real balls."""
    return arb(low).union(arb(high))


def narrower(one: arb, other: arb) -> arb:
    """Intersection of two enclosures of the same numbers."""
    return one.intersection(other) if one.overlaps(other) else one


# ------------------------------------------------------------------------------------------------ flight


def hyperbolic(split: Ball, time: Ball) -> tuple[Any, Any]:
    """``cosh(√D t)`` and ``sinh(√D t)/√D`` for real ``D``; both are entire functions of ``D``.

    The result is not finite where ``D`` may vanish and ``D t²`` is large.
    """
    square = split * time * time
    about = first(square)
    if about > 0.25:
        root = split.sqrt()
        up = (root * time).exp()
        down = 1 / up
        return (up + down) * 0.5, (up - down) * 0.5 / root
    if about < 0 and first(split).rel_accuracy_bits() > 4:
        root = (-split).sqrt()
        sine, cosine = (root * time).sin_cos()
        return cosine, sine / root
    if about.abs_upper() < _REACH:
        return _hyperbolic_sums(square, time)
    return square * arb.nan(), square * arb.nan()


def _hyperbolic_sums(square: arb | arb_series, time: Ball) -> tuple[Ball, Ball]:
    """The same as sums of powers of ``z = D t²``, ``|z| < 4``.

    The ``j``-th Taylor coefficient of what is left out after ``K`` terms is at most
    ``Σ_{k≥K} C(k,j) 4^{k−j}/(2k)! ≤ 2·8^K/(2K)!``.
    """
    count = 8
    while arb(8) ** count / arb(2 * count).fac() > arb(2) ** (-ctx.prec - 10):
        count += 2
    rest = arb(0, (arb(8) ** count * 2 / arb(2 * count).fac()).upper())
    even: Ball = arb(0)
    odd: Ball = arb(0)
    for k in range(count - 1, -1, -1):
        even = even * square + 1 / arb(2 * k).fac()
        odd = odd * square + 1 / arb(2 * k + 1).fac()
    left_out: Ball = rest
    if isinstance(square, arb_series):
        step: Ball = square - square[0]
        power: Ball = arb(1)
        for _ in range(1, ctx.cap):
            power = power * step
            left_out = left_out + power * rest
    return even + left_out, (odd + left_out) * time


# ------------------------------------------------------------------------------------------------ return of the flight


def short_return(half: ComplexBall, split: Ball, period: Ball) -> tuple[ComplexBall, ComplexBall] | None:
    """``a₁₂`` and ``a₂₂`` of a short period by the series of Bernoulli numbers; ``None`` where it does not serve.

    With ``1/(e^{−z} − 1) = −1/z − 1/2 − Σ B₂ₖ z^{2k−1}/(2k)!``, the complete symmetric polynomials ``hₙ`` of the exponents,
    ``h₀ = 1``, ``h₁ = S``, ``hₙ = S hₙ₋₁ − P hₙ₋₂``, and their sum ``S`` and product ``P``,

        a₁₂ = 1/(PT) − Σ B₂ₖ/(2k)! T^{2k−1} h₂ₖ₋₂,      a₂₂ = −1/2 − Σ B₂ₖ/(2k)! T^{2k−1} h₂ₖ₋₁ .

    What is left out is bounded with ``|B₂ₖ/(2k)!| ≤ 4(2π)^{−2k}`` and ``|hₙ| ≤ (n + 1)Lⁿ``, ``L = |S/2| + √|D|``, on a circle
    of the variable of the power series, by Cauchy's estimate.  The arguments are ``S/2``, ``D = S²/4 − P`` and ``T``.
    """
    total, product = half * 2, half * half - split
    if not first(product * period).abs_lower() > 0:
        return None
    values = (half, split, period)
    series = any(isinstance(x, _SERIES) for x in values)
    radius = arb(1)
    for _ in range(40):
        size, apart, time = (_largest(x, radius) for x in values)
        longest = size + apart.sqrt()
        ratio = (longest * time / 6) ** 2
        if ratio < _SHORT:
            break
        if not series:
            return None
        radius = radius / 2
    else:
        return None
    count = int(ctx.prec / -float(ratio.log() / arb(2).log())) + 2
    rest = 8 * count * ratio**count / (1 - ratio) ** 2 / longest / time
    square, power, odd = period * period, period, total
    even: ComplexBall = acb(1)
    place: ComplexBall = acb(0)
    turn: ComplexBall = acb(0)
    for k in range(1, count):
        factor = _bernoulli(k, ctx.prec) * power
        place, turn = place + factor * even, turn + factor * odd
        if k + 1 < count:
            even = total * odd - product * even
            odd = total * even - product * odd
            power = power * square
    place, turn = 1 / (product * period) - place, -turn - 0.5
    return place + _rest_series(rest / longest, radius, series), turn + _rest_series(rest, radius, series)


def _largest(x: Ball | ComplexBall, radius: arb) -> arb:
    """Bound of the modulus for a variable of the series up to a radius."""
    total, power = arb(0), arb(1)
    for c in x.coeffs() if isinstance(x, _SERIES) else [x]:
        total += arb(abs(c).upper()) * power
        power *= radius
    return total


def _rest_series(bound: arb, radius: arb, series: bool) -> ComplexBall:
    """Series of which nothing is known but a bound on a circle."""
    found = []
    for _ in range(ctx.cap if series else 1):
        end = arb(0, bound.upper())
        found.append(acb(end, end))
        bound = bound / radius
    return acb_series(found) if series else found[0]


@cache
def _bernoulli(k: int, bits: int) -> arb:
    """``B₂ₖ/(2k)!`` at the precision at hand."""
    return arb(fmpq.bernoulli(2 * k)) / arb(2 * k).fac()
