"""Single-impact orbits for balls and power series of balls: closing conditions, course, derivative of the impact map.

The frame is turned such that the impact is at ``U = 1``; :class:`~carom.proofs.lines.LineNumbers` has the flight.  The levers ``a₁₂`` and ``a₂₂`` of the return after a period are computed from whichever form loses least on wide balls: by
Bernoulli numbers at short periods, by the exponents ``λ± = S/2 ± √D`` where these are well apart, by ``e`` and ``o`` otherwise.

Whether a flight stays inside the wall between two impacts is decided by branch and bound over its time.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any, Generic

from flint import acb, arb, arb_series

from carom.proofs.balls import Ball, ComplexBall, I, N, first, hull, imaginary, real, short_return, squared, terms
from carom.proofs.lines import LineNumbers
from carom.proofs.rotor import Invariants

_SHORT = 2.7
"""Bound of ``|λ T|`` below which the period condition is summed: less than the reach of the sum, for its derivatives."""


def period_condition(whole: LineNumbers[arb], period: arb) -> Callable[..., Any]:
    """A function of numbers and period that has the zeros of ``F₁`` and its signs, suited to a range of periods.

    At short periods it is ``F₁`` itself, else the entire function ``|det(1 − e^{MT})|²F₁``.
    """
    apart = abs(whole.split).sqrt()
    return _short_condition if (abs(whole.gamma) * 0.5 + 1 + apart) * period < _SHORT else entire_condition


def _short_condition(n: LineNumbers[N], period: Ball) -> Ball:
    found = short_return(n.half, n.split, period)
    return period * arb.nan() if found is None else 1 + real(n.q * found[1])


def entire_condition(n: LineNumbers[N], period: Ball) -> Any:
    """``|det(1 − e^{MT})|²F₁``."""
    numerator, gap = numerator_and_gap(n, period)
    other = gap + n.q * numerator
    return real(other) * real(gap) + imaginary(other) * imaginary(gap)


def numerator_and_gap(n: LineNumbers[N], period: Ball) -> tuple[Any, Any]:
    """``a₂₂ det(1 − e^{MT})`` and ``det(1 − e^{MT})``."""
    even, odd, growth = n.flight(period)
    decay = growth * growth
    return even + n.half * odd - decay, 1 - even * 2 + decay


class Return(Generic[N]):
    """What a period and the numbers of a machine say of an orbit before its radial speed is known.

    Parameters
    ----------
    numbers : LineNumbers
    period : arb or arb_series

    Attributes
    ----------
    half, split, product : acb or acb_series, arb or arb_series
        ``S/2``, ``D`` and ``P``.
    q, lever, turn : acb or acb_series
        ``(1 + d)(1 + iμ)``, ``q a₁₂`` and ``q a₂₂``.
    closing : arb or arb_series
        ``F₁``.
    levitation : arb or arb_series
        ``|U*|²``.
    """

    def __init__(self, numbers: LineNumbers[N], period: N) -> None:
        n = numbers
        self.numbers: LineNumbers[N] = n
        self.period: N = period
        self.split: N = n.split
        self.half, self.product, self.q = n.half, n.product, n.q
        place, turn = self._levers()
        self.a12, self.a22 = place, turn
        self.lever, self.turn = self.q * place, self.q * turn
        self.closing: N = 1 + real(self.turn)
        self.levitation: N = n.rho * n.rho / squared(self.product)

    def _levers(self) -> tuple[ComplexBall, ComplexBall]:
        short = short_return(self.half, self.split, self.period)
        if short is not None:
            return short
        if first(self.split * self.period * self.period).abs_lower() > 1:
            root = (acb(1) * self.split).sqrt()
            up, down = self.half + root, self.half - root
            one, other = 1 / ((-up * self.period).exp() - 1), 1 / ((-down * self.period).exp() - 1)
            return (one - other) / (root * 2), (up * one - down * other) / (root * 2)
        numerator, gap = numerator_and_gap(self.numbers, self.period)
        return self.over[1] / gap, numerator / gap

    @cached_property
    def over(self) -> tuple[ComplexBall, ComplexBall, ComplexBall]:
        """The flight over the period."""
        return self.numbers.flight(self.period)

    @cached_property
    def closing_rate(self) -> N:
        """``∂F₁/∂T``, from ``∂a₂₂/∂T = S a₂₂(1 + a₂₂) − P a₁₂(1 + 2a₂₂)``."""
        rate = self.half * 2 * self.a22 * (1 + self.a22) - self.product * self.a12 * (1 + self.a22 * 2)
        return real(self.q * rate)

    @cached_property
    def lever_squared(self) -> N:
        """``|q a₁₂|²``."""
        return squared(self.lever)

    @cached_property
    def discriminant(self) -> N:
        """A quarter of the discriminant of ``|q a₁₂|²ṙ² + 2 Re(q a₁₂)ṙ + 1 − |U*|² = 0``."""
        half = real(self.lever)
        return half * half - self.lever_squared * (1 - self.levitation)

    @cached_property
    def determinant(self) -> N:
        """Product of the multipliers, ``d²e^{−2γT}``."""
        return self.numbers.d * self.numbers.d * (self.numbers.gamma * self.period * -2).exp()

    def speeds(self) -> tuple[N, N]:
        """Both radial speeds, the lower first, in forms without cancellation; the discriminant must be positive."""
        half, rest, root = real(self.lever), 1 - self.levitation, self.discriminant.sqrt()
        if first(half) > 0:
            larger = -(half + root)
            return larger / self.lever_squared, rest / larger
        if first(half) < 0:
            larger = root - half
            return rest / larger, larger / self.lever_squared
        return -(half + root) / self.lever_squared, (root - half) / self.lever_squared


class OrbitCourse(Generic[N]):
    """A single-impact orbit.

    Parameters
    ----------
    back : Return
        At the period of the orbit.
    speed : arb or arb_series
        ``ṙ`` before the impact.
    """

    def __init__(self, back: Return[N], speed: N) -> None:
        self.back: Return[N] = back
        self.speed: N = speed
        # Velocities before and after the impact, over the radial speed.
        self.approach = 1 - imaginary(back.turn) * I
        self.leaving = self.approach - back.q

    @property
    def balance(self) -> N:
        """``|1 + q a₁₂ṙ|² − |U*|²``: zero on an orbit."""
        back, speed = self.back, self.speed
        return 1 + real(back.lever) * speed * 2 + back.lever_squared * speed * speed - back.levitation

    @property
    def speed_fold(self) -> N:
        """Half of the derivative of ``balance`` by ``ṙ``."""
        return real(self.back.lever) + self.back.lever_squared * self.speed

    @property
    def angular_speed(self) -> N:
        """``θ̇`` before the impact."""
        return -imaginary(self.back.turn) * self.speed

    @property
    def slip_after(self) -> N:
        """Slip velocity just after the impact."""
        return self.back.numbers.radius_ratio + 1 + imaginary(self.leaving) * self.speed

    def height(self, time: Ball, backward: bool = False) -> tuple[Any, Any]:
        """``(|U|² − 1)/ṙ`` and half of its rate, which are regular where the orbit shrinks to a point.

        The time is that after the impact, or with ``backward`` the negative time before the next one.  Then it starts from the
        state at the next impact, which is exact there, as it does not depend on the period.
        """
        back = self.back
        even, odd, _ = back.numbers.flight(time)
        share = back.half * odd
        start = self.approach if backward else self.leaving
        # The contact-free equilibrium is at 1 + q a₁₂ṙ.
        place = back.lever * (1 - even + share) + odd * start
        rate = back.product * odd * back.lever + (even + share) * start
        across = real(place)
        height = across * 2 + squared(place) * self.speed
        return height, real(rate) + (across * real(rate) + imaginary(place) * imaginary(rate)) * self.speed

    def jacobian(self) -> list[list[N]]:
        """Derivative of the impact map over ``(θ, ṙ, θ̇)``, by rows; regular for ``ṙ = 0``."""
        back, speed = self.back, self.speed
        even, odd, _ = back.over
        upper, lower, left = even - back.half * odd, even + back.half * odd, -back.product * odd
        force = back.half * 2 * self.approach + back.product * back.lever
        sweep = imaginary(self.approach) * speed
        columns = []
        for place, start in ((I, I * self.leaving * speed), (acb(0), 1 - back.q), (acb(0), I)):
            position = upper * place + odd * start
            late = -real(position)
            turned = imaginary(position + self.approach * late)
            velocity = left * place + lower * start + force * late
            columns.append((turned, real(velocity) + turned * sweep, imaginary(velocity) - turned * speed))
        return [[column[row] for column in columns] for row in range(3)]

    @cached_property
    def invariants(self) -> Invariants[N]:
        """Invariants of the derivative of the impact map."""
        return Invariants.of(self.jacobian(), self.back.determinant)


Height = Callable[[Any, bool], Any]
"""A height over the wall, up to a positive factor: takes the time after the first impact, or with ``True`` the negative time before
the second, as a ball or a power series."""
_ORDER = 4
"""Order of Taylor's formula on a cell of times."""
NARROWEST, FINEST = 1e-4, 1e-11
"""Width of a cell, as a share of half the flight, at which the search gives up: on blocks, and for one machine.

Next to a maximum at a small depth below the wall the cells become as narrow as the root of the depth.
"""
_SAMPLES = 16


def stays_inside(
    height: Height,
    narrow: Height,
    period: arb,
    falls: tuple[arb, arb],
    touch: arb | None = None,
    narrowest: float = NARROWEST,
) -> bool | None:
    """Whether a height that vanishes at both impacts is negative in between; ``None`` if this is open.

    ``height`` gives balls for balls, ``narrow`` narrower ones for exact times.  ``falls`` are the rates, not negative, at which
    the height falls from zero at the first impact and, backward in time, at the second.  At the time ``touch``, if given, it is
    allowed to vanish with its rate.
    """
    half = 0.5 * float(period.mid())
    times = [half * 2 * k / _SAMPLES for k in range(1, _SAMPLES)]
    top, at = max((float(height(arb(time), False).mid()), time) for time in times)
    at = _peak(height, at, float(period.mid()))
    if top > 0 or height(arb(at), False).mid() > 0:
        return False if narrow(arb(at), False) > 0 and at < period else None
    for backward, end in ((False, half), (True, float((period - half).upper()) * (1 + 1e-15))):
        touched = period - touch if touch is not None and backward else touch
        stack = [(end * k / 3, end * (k + 1) / 3) for k in range(3)]
        while stack:
            low, high = stack.pop()
            if _below(height, narrow, falls[backward], (low, high), backward):
                continue
            if touched is not None and _touches(height, (low, high), backward, touched):
                continue
            if not high - low > narrowest * end:
                return None
            middle = 0.5 * (low + high)
            stack += [(middle, high), (low, middle)]
    return True


def _peak(height: Height, near: float, period: float) -> float:
    """Time of a maximum of the height next to a time, by Newton's method; that time itself if there is none."""
    time = near
    with terms(3):
        for _ in range(6):
            series = height(arb_series([arb(time), 1]), False)
            slope, curve = float(series[1].mid()), 2 * float(series[2].mid())
            time -= slope / curve if curve < 0.0 else period
            if not 0.0 < time < period:
                return near
    return time


def _touches(height: Height, cell: tuple[float, float], backward: bool, touch: arb) -> bool:
    """Whether the height is concave from a cell of times to a time at which it vanishes with its rate."""
    time = hull(hull(*cell), touch)
    if not time.rad() < 0.5:
        return False
    with terms(3):
        return bool(height(arb_series([-time if backward else time, 1]), backward)[2] < 0)


def _below(height: Height, narrow: Height, fall: arb, cell: tuple[float, float], backward: bool) -> bool:
    """Whether the height is negative on a cell of times; at time zero itself it vanishes."""
    low, high = cell
    sign = -1 if backward else 1
    time = hull(low, high)
    middle = time.mid()
    late = (time - middle) * sign
    with terms(_ORDER + 1):
        far = height(arb_series([time * sign, 1]), backward)
    if low == 0.0:
        # The height is what it falls, and at most the curvature times t² more.
        return bool(far[2] < 0 or far[2] * high < fall)
    if far[0] < 0:
        return True
    with terms(_ORDER):
        near = height(arb_series([middle * sign, 1]), backward)
    value = far[_ORDER]
    for k in range(_ORDER - 1, 0, -1):
        value = near[k] + value * late
    return bool(narrow(middle * sign, backward) + value * late < 0)
