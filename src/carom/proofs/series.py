"""Functions of balls and of power series of balls alike: the same formula gives values and derivatives.

A number is here a ball (``arb``, ``acb``) or a power series whose coefficients are balls (``arb_series``, ``acb_series``),
truncated at ``flint.ctx.cap`` terms.  A formula evaluated for ``[x, 1]`` gives an enclosure of its value and its derivative at
every point of the ball ``x``.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

from flint import acb, acb_series, arb, arb_series, ctx, fmpq

I = acb(0, 1)  # noqa: E741  (the imaginary unit)
Ball = arb | arb_series
ComplexBall = acb | acb_series
N = TypeVar("N", arb, arb_series)
_SERIES = (arb_series, acb_series)
_REACH = 4
"""Largest ``|D t²|`` at which the functions of :func:`hyperbolic` are summed as power series."""
_SHORT = 0.3
"""Largest ``(|λ| T/6)²`` at which :func:`short_return` is summed: its terms fall faster than the powers of this."""
_BERNOULLI: dict[tuple[int, int], arb] = {}


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
        factor = _bernoulli(k) * power
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


def _bernoulli(k: int) -> arb:
    key = k, ctx.prec
    if key not in _BERNOULLI:
        _BERNOULLI[key] = arb(fmpq.bernoulli(2 * k)) / arb(2 * k).fac()
    return _BERNOULLI[key]
