"""Exact derivatives of the equations and test functions in :mod:`carom.bifurcations.conditions`.

The flight is ``e^{Mt}`` with ``M = [[0, 1], [−P, S]]``, ``S = −γ − 2i`` and ``P = ω² − 1 + iγ``.  Its discriminant
``D = S²/4 − P = γ²/4 − ω²`` is real, and ``B = M − S/2`` has the square ``D``, so

    e^{Mt} = e^{St/2} (c + s B),      c = cosh(√D t),   s = sinh(√D t)/√D.

Both are entire functions of ``D``: ``∂c/∂D = ts/2`` and ``∂s/∂D = (tc − s)/(2D)`` are regular at critical damping.  The
second column of ``(e^{−MT} − 1)⁻¹ = (e^{MT} − e^{ST})/det(1 − e^{MT})`` holds ``a₁₂`` and ``a₂₂``, and

    ∂a₂₂/∂T = S a₂₂ (1 + a₂₂) − P a₁₂ (1 + 2a₂₂).

All else follows by the rules of differentiation.  Plain numbers are used, as arrays of two or three entries take longer.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np

from carom.bifurcations.conditions import jacobian_at
from carom.core.periods import returns
from carom.core.planar import planar_exponents
from carom.parameters import Numbers

STEP = 1e-30
"""Imaginary step: its square is far below the rounding error of any parameter."""
_SERIES = [n / math.factorial(2 * n + 1) for n in range(1, 11)]
"""Coefficients of ``(cosh y − sinh(y)/y)/(2y²)`` in powers of ``y²``."""


def analytic_rates(function: Callable[..., Sequence[complex]], *values: float) -> np.ndarray:
    """Derivatives of real analytic functions by each argument, exact but for rounding.

    They are the imaginary parts of the results for arguments with a tiny imaginary part [1]_.

    Parameters
    ----------
    function : callable
        It takes no absolute values and compares no arguments, as it is called with complex ones.
    *values : float
        The arguments.

    Returns
    -------
    ndarray, shape (number of results, number of arguments)

    References
    ----------
    .. [1] Squire and Trapp, "Using complex variables to estimate derivatives of real functions", SIAM Review 40 (1998).
    """
    return np.array(_columns(function, values)).T


def _columns(function: Callable[..., Sequence[complex]], values: Sequence[float]) -> list[list[float]]:
    columns = []
    for place in range(len(values)):
        moved = [complex(value, STEP) if place == other else value for other, value in enumerate(values)]
        columns.append([result.imag / STEP for result in function(*moved)])
    return columns


class Direction(NamedTuple):
    """Rates of change of the dimensionless numbers, of the period and of the radial speed."""

    gamma: float = 0.0
    omega: float = 0.0
    rho: float = 0.0
    phi: float = 0.0
    mu: float = 0.0
    d: float = 0.0
    radius_ratio: float = 0.0
    period: float = 0.0
    speed: float = 0.0


class _Flight(NamedTuple):
    """``e^{Mt} = [[upper, odd], [−P odd, lower]]``; ``even``, ``odd`` and ``third`` are ``c, s, ∂s/∂D`` times ``e^{St/2}``."""

    time: float
    even: complex
    odd: complex
    third: complex
    upper: complex
    lower: complex


class _FlightChange(NamedTuple):
    """Changes of ``c e^{St/2}`` and of the entries of ``e^{Mt}``, row by row."""

    even: complex
    upper: complex
    right: complex
    left: complex
    lower: complex


class OrbitValues:
    """Values on a single-impact orbit that its changes in all directions share.

    Parameters
    ----------
    numbers : Numbers
        With negative ``mu`` for backward slip.
    period, speed : float
        ``T > 0`` and ``ṙ``.
    """

    def __init__(self, numbers: Numbers, period: float, speed: float) -> None:
        gamma, omega, rho, _, mu, d, *_ = numbers
        self.numbers, self.period, self.speed = numbers, period, speed
        self.sum, self.product = complex(-gamma, -2.0), complex(omega * omega - 1.0, gamma)
        self.split = (0.5 * gamma - omega) * (0.5 * gamma + omega)
        self.size = rho / abs(self.product)
        self.flight = self.flight_of(period)
        self.decay = cmath.exp(self.sum * period)
        root = cmath.sqrt(self.split)
        first, second = np.expm1([(0.5 * self.sum + root) * period, (0.5 * self.sum - root) * period]).tolist()
        self.gap = first * second
        # The kernel sums a series at short periods, where the differences here would cancel.
        lower, upper = planar_exponents(gamma, omega)
        self.a12, self.a22, self.a22_rate, _ = returns(lower, upper, period)
        self.a12_rate = self.a22 * (1.0 + self.a22) - self.product * self.a12**2
        self.factor = complex(1.0 + d, (1.0 + d) * mu)
        self.lever, self.turn = self.factor * self.a12, self.factor * self.a22
        # Velocity before the impact and acceleration, over the radial speed, and velocity after the impact.
        self.approach = complex(1.0, -self.turn.imag)
        self.force = self.sum * self.approach + self.product * self.lever
        self.leaving = (self.approach - self.factor) * speed

    def flight_of(self, time: float) -> _Flight:
        """The flight over a time."""
        even, odd, third = _entire(0.5 * self.sum, self.split, time)
        share = 0.5 * self.sum * odd
        return _Flight(time, even, odd, third, even - share, even + share)

    @cached_property
    def weights(self) -> dict[str, list[float]]:
        """Derivatives of functions of the multipliers by the entries of the impact map's derivative, row by row."""
        entries = jacobian_at(self.numbers, self.period, self.speed).ravel().tolist()
        a, b, c, d, e, f, g, h, i = entries
        cofactors = [e * i - f * h, f * g - d * i, d * h - e * g, c * h - b * i, a * i - c * g, b * g - a * h]
        cofactors += [b * f - c * e, c * d - a * f, a * e - b * d]
        trace, determinant = a + e + i, a * cofactors[0] + b * cofactors[1] + c * cofactors[2]
        across, one = [a, d, g, b, e, h, c, f, i], [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
        each = list(zip(one, across, cofactors, strict=True))
        outer = 2.0 * determinant - trace
        return {
            "period-doubling": [(1.0 + trace) * x - y + z for x, y, z in each],
            "neimark-sacker": [(trace - determinant) * x - y + outer * z for x, y, z in each],
            "pair-sum": [x - z for x, _, z in each],
        }


class OrbitChange:
    """First-order change of a single-impact orbit, and of its equations and test functions, in one direction."""

    def __init__(self, values: OrbitValues, direction: Direction) -> None:
        numbers = values.numbers
        self.values, self.direction = values, direction
        self.sum = complex(-direction.gamma)
        self.product = complex(2.0 * numbers.omega * direction.omega, direction.gamma)
        self.split = 0.5 * numbers.gamma * direction.gamma - 2.0 * numbers.omega * direction.omega
        self.a12, self.a22 = values.a12_rate * direction.period, values.a22_rate * direction.period
        if direction.gamma or direction.omega:
            still, decay = self._flight(values.flight, 0.0), values.decay * self.sum * values.period
            gap = decay - 2.0 * still.even
            self.a12 += (still.right - values.a12 * gap) / values.gap
            self.a22 += (still.lower - decay - values.a22 * gap) / values.gap
        grip = complex(1.0, numbers.mu)
        self.factor = grip * direction.d + complex(0.0, (1.0 + numbers.d) * direction.mu)
        self.lever = self.factor * values.a12 + values.factor * self.a12
        self.turn = self.factor * values.a22 + values.factor * self.a22
        self.approach = complex(0.0, -self.turn.imag)
        self.leaving = (self.approach - self.factor) * values.speed + (
            values.approach - values.factor
        ) * direction.speed

    @cached_property
    def flight(self) -> _FlightChange:
        """Change of the flight over the period."""
        return self._flight(self.values.flight, self.direction.period)

    def _flight(self, flight: _Flight, time: float) -> _FlightChange:
        """Change of a flight whose time changes at this rate."""
        values = self.values
        growth = 0.5 * (self.sum * flight.time + values.sum * time)
        even = flight.even * growth + flight.odd * (0.5 * flight.time * self.split + values.split * time)
        odd = flight.odd * growth + flight.third * self.split + flight.even * time
        share = 0.5 * (self.sum * flight.odd + values.sum * odd)
        left = -self.product * flight.odd - values.product * odd
        return _FlightChange(even, even - share, odd, left, even + share)

    def equations(self) -> tuple[float, float]:
        """Changes of both equations of an orbit, ``closing`` and ``balance``."""
        values, direction = self.values, self.direction
        nearness = (self.product / values.product).real
        rest = 2.0 * values.size * (direction.rho / abs(values.product) - values.size * nearness)
        place = 1.0 + values.lever * values.speed
        change = self.lever * values.speed + values.lever * direction.speed
        return self.turn.real, 2.0 * (place.conjugate() * change).real - rest

    def test(self, kind: str) -> float:
        """Change of the test function of a kind of bifurcation of orbits, or of ``"pair-sum"``.

        The test functions are those of :data:`~carom.bifurcations.conditions.TESTS`; ``"pair-sum"`` is that of
        :class:`~carom.bifurcations.conditions.OrbitConditions`.  Grazing has equations of its own, :meth:`course`.
        """
        if kind in _TESTS:
            return _TESTS[kind](self.values, self)
        return sum(map(float.__mul__, self.values.weights[kind], self._impact_map()))

    def course(self, flight: _Flight, time: float) -> tuple[float, float]:
        """Changes of ``Re(Ū U̇)`` and of ``r² − 1`` at the end of a flight whose time changes at the rate ``time``."""
        values, change = self.values, self._flight(flight, time)
        offset = values.lever * values.speed
        offset_change = self.lever * values.speed + values.lever * self.direction.speed
        position = 1.0 + offset - flight.upper * offset + flight.odd * values.leaving
        velocity = values.product * flight.odd * offset + flight.lower * values.leaving
        position_change = (
            offset_change * (1.0 - flight.upper)
            - change.upper * offset
            + change.right * values.leaving
            + flight.odd * self.leaving
        )
        velocity_change = (
            values.product * flight.odd * offset_change
            - change.left * offset
            + change.lower * values.leaving
            + flight.lower * self.leaving
        )
        outward = position_change.conjugate() * velocity + position.conjugate() * velocity_change
        return outward.real, 2.0 * (position.conjugate() * position_change).real

    def _impact_map(self) -> list[float]:
        """Changes of the entries of :func:`carom.core.planar.impact_jacobian`, row by row."""
        values, change, speed = self.values, self.flight, self.values.speed
        flight = values.flight
        force = (
            self.sum * values.approach
            + values.sum * self.approach
            + self.product * values.lever
            + values.product * self.lever
        )
        sweep = speed * values.approach.imag
        sweep_change = self.direction.speed * values.approach.imag + speed * self.approach.imag
        columns = []
        for place, start, start_change in (
            (1j, 1j * values.leaving, 1j * self.leaving),
            (0j, 1.0 - values.factor, -self.factor),
            (0j, 1j, 0j),
        ):
            position = flight.upper * place + flight.odd * start
            position_change = change.upper * place + change.right * start + flight.odd * start_change
            velocity_change = change.left * place + change.lower * start + flight.lower * start_change
            late, late_change = -position.real, -position_change.real
            turned = (position + values.approach * late).imag
            turned_change = (position_change + self.approach * late + values.approach * late_change).imag
            velocity_change += force * late + values.force * late_change
            columns.append(
                (
                    turned_change,
                    velocity_change.real + turned_change * sweep + turned * sweep_change,
                    velocity_change.imag - turned_change * speed - turned * self.direction.speed,
                )
            )
        return [entry for row in zip(*columns, strict=True) for entry in row]


def orbit_jacobian(
    numbers_at: Callable[..., Numbers],
    values: Sequence[float],
    period: float,
    speed: float,
    tests: Sequence[str] = (),
    time: float | None = None,
) -> np.ndarray:
    """Exact Jacobian of the equations of an orbit and of test functions.

    Parameters
    ----------
    numbers_at : callable
        Numbers at some values of the parameters; an analytic function.
    values : sequence of float
        Values of the ``k`` parameters.
    period, speed : float
        ``T`` and ``ṙ``.
    tests : sequence of str
        Test functions (:meth:`OrbitChange.test`) whose derivatives follow those of both equations.
    time : float, optional
        Time after the impact, as a further unknown: the derivatives of both equations of grazing follow too.

    Returns
    -------
    ndarray, shape (number of equations, number of unknowns)
        By the period, the radial speed, the time if given, and each parameter; ``nan`` without a positive period, and where a flight
        grows beyond all numbers.
    """
    timed = time is not None
    undefined = np.full((2 + len(tests) + 2 * timed, 2 + timed + len(values)), np.nan)
    if not period > 0.0:
        return undefined
    try:
        at = OrbitValues(numbers_at(*values), period, speed)
        flight = None if time is None else at.flight_of(time)
    except OverflowError:
        return undefined
    directions = [(Direction(period=1.0), 0.0), (Direction(speed=1.0), 0.0), *([(Direction(), 1.0)] * timed)]
    directions += [(Direction(*column), 0.0) for column in _columns(lambda *moved: numbers_at(*moved)[:7], values)]
    columns = []
    for direction, late in directions:
        change = OrbitChange(at, direction)
        column = [*change.equations(), *map(change.test, tests)]
        columns.append(column if flight is None else [*column, *change.course(flight, late)])
    return np.array(columns).T


def _period_fold(at: OrbitValues, by: OrbitChange) -> float:
    stretch = 1.0 + 2.0 * at.a22
    rate = at.sum * at.a22 * (1.0 + at.a22) - at.product * at.a12 * stretch
    change = by.sum * at.a22 * (1.0 + at.a22) - (by.product * at.a12 + at.product * by.a12) * stretch
    change += (at.sum * stretch - 2.0 * at.product * at.a12) * by.a22
    return (by.factor * rate + at.factor * change).real


def _speed_fold(at: OrbitValues, by: OrbitChange) -> float:
    size, change = abs(at.lever) ** 2, 2.0 * (at.lever.conjugate() * by.lever).real
    return by.lever.real + change * at.speed + size * by.direction.speed


def _slip_stop(at: OrbitValues, by: OrbitChange) -> float:
    loss, change = (at.turn + at.factor).imag, (by.turn + by.factor).imag
    return by.direction.radius_ratio - change * at.speed - loss * by.direction.speed


def _pressed_on(at: OrbitValues, by: OrbitChange) -> float:
    pull = (by.product * at.lever + at.product * by.lever) * at.speed + at.product * at.lever * by.direction.speed
    drag = by.sum * at.leaving + at.sum * by.leaving
    return (pull + drag + 2.0 * at.leaving.conjugate() * by.leaving).real


_TESTS: dict[str, Callable[[OrbitValues, OrbitChange], float]] = {
    "fold": _period_fold,
    "speed-fold": _speed_fold,
    "slip-stop": _slip_stop,
    "contact-onset": _pressed_on,
    "non-smooth-hopf": lambda _, by: by.direction.speed,
}


def _entire(half: complex, split: float, time: float) -> tuple[complex, complex, complex]:
    """``c``, ``s`` and ``∂s/∂D`` times ``e^{St/2}``, for ``half = S/2`` and ``split = D``."""
    square = split * time * time
    root = math.sqrt(abs(split))
    if square > 1.0:
        # The product with a small exponential first: at long times the hyperbolic functions overflow.
        upper, lower = cmath.exp((half + root) * time), cmath.exp((half - root) * time)
        even, odd = 0.5 * (upper + lower), 0.5 * (upper - lower) / root
        return even, odd, 0.5 * (time * even - odd) / split
    growth, angle = cmath.exp(half * time), root * time
    if split > 0.0:
        even, odd = growth * math.cosh(angle), growth * math.sinh(angle) / root
    elif split < 0.0:
        even, odd = growth * math.cos(angle), growth * math.sin(angle) / root
    else:
        even, odd = growth, growth * time
    if square < -1.0:
        return even, odd, 0.5 * (time * even - odd) / split
    third = 0.0
    for coefficient in reversed(_SERIES):
        third = third * square + coefficient
    return even, odd, growth * time**3 * third
