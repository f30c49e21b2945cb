"""Periods of single-impact orbits: the roots of ``F₁(T) = 1 + Re(q a₂₂(T))``, all of them.

For one contact plane with row ``W``, column ``B`` and flight ``ċ = Mc`` let, in the source paper's notation (4.1),

    a₁₂(T) = W (e^{−MT} − 1)⁻¹ B,     a₂₂(T) = W M (e^{−MT} − 1)⁻¹ B.

With ``g(z) = 1/(e^{−z} − 1)`` and its regular part ``g̃(z) = g(z) + 1/z`` these are sums over the modes of
``λⁿ g(λT)`` times a residue, with a divided difference in place of the value where a pair is driven.  Because an
impulse does not move the rotor at once (``WB = 0``) the poles of ``a₂₂`` at ``T = 0`` cancel, so ``g̃`` may stand for
``g`` there, and ``a₁₂(T) = H/T +`` the same sum with ``g̃``, where ``H = −W M⁻¹ B`` is the static receptance.

Completeness rests on two bounds.  ``|a₂₂|`` is below a decreasing function of ``T``, so beyond ``longest_period``
there is ``F₁ > 0``.  Up to there, ``g̃(z) = −1/2 − Σ_{k≠0} 1/(z − 2πik)`` gives

    |g̃⁽ⁿ⁾(z)| ≤ 2 n! (δ^{−n−1} + ζ(n+1) (2π)^{−n−1}),      δ = min_{k≠0} |z − 2πik|,

hence a bound of ``|F₁''|`` on any interval (and a sharper one from ``g(z) = Σ e^{mz}`` far out); an interval is discarded, or accepted with one root, only when that bound
proves it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import factorial, pi

import numpy as np

from carom.outcome import CaromError, InputError
from carom.rotors import Rotor

__all__ = ["PeriodCondition", "PeriodRoots"]

SERIES_RADIUS = 1.0
# Bernoulli numbers B₂ₘ/(2m)!: g̃(z) = −1/2 − Σ B₂ₘ z^{2m−1}/(2m)!, twelve terms reach rounding at |z| = 1.
_BERNOULLI = (
    1 / 6, -1 / 30, 1 / 42, -1 / 30, 5 / 66, -691 / 2730, 7 / 6, -3617 / 510, 43867 / 798, -174611 / 330,
    854513 / 138, -236364091 / 2730,
)  # fmt: skip
_SERIES = np.array([number / factorial(2 * m + 2) for m, number in enumerate(_BERNOULLI)])
_ZETA = (np.inf, 1.6449340668482264, 1.2020569031595943, 1.0823232337111382)
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)

FIRST_WIDTH = 0.25
NARROWEST = 1e-11
"""Width, relative to ``1 + T``, below which an undecided interval is a double root (a fold) to rounding."""
MOST_INTERVALS = 20_000_000


@dataclass(frozen=True, eq=False)
class PeriodRoots:
    """All roots of ``F₁`` on ``0 < T ≤ longest_period``.

    Attributes
    ----------
    periods : ndarray
        The roots in growing order, a double root twice.
    longest_period : float
        End of the searched range.
    proven : bool
        Whether ``F₁ > 0`` is proven beyond it, so that there is no other root at all.
    """

    periods: np.ndarray
    longest_period: float
    proven: bool


class PeriodCondition:
    """``F₁`` of a rotor, its derivative and its bounds.

    Parameters
    ----------
    rotor : Rotor
    slip : {1, -1}
        Direction of the slip during impacts.
    """

    def __init__(self, rotor: Rotor, slip: int = 1) -> None:
        arrays = rotor.arrays
        row, column = arrays.rows[0], arrays.columns[:, 0]
        self.factor = (1.0 + arrays.restitution[0]) * complex(1.0, slip * arrays.friction[0])
        self.exponents = arrays.exponents
        self.residues = row * column
        driven = np.flatnonzero(arrays.driven)
        self.pairs = [(arrays.exponents[k], arrays.exponents[k - 1], row[k] * column[k - 1]) for k in driven]
        self.receptance = -complex(row @ np.linalg.solve(rotor.generator, column))

    def response(self, power: int, periods: np.ndarray, derivative: int = 0) -> np.ndarray:
        """``d/dT``-th derivative of the sum of ``λ^power g̃(λT)``; ``power`` 1 is ``a₂₂``."""
        periods = np.asarray(periods, float)
        order = power + derivative
        total = np.zeros(periods.shape, complex)
        for exponent, residue in zip(self.exponents, self.residues, strict=True):
            if residue != 0:
                total += residue * exponent**order * _regular(exponent * periods, derivative)
        for first, second, residue in self.pairs:
            total += residue * _divided_difference(first, second, periods, order, derivative)
        return total

    def a12(self, periods: np.ndarray) -> np.ndarray:
        """``a₁₂(T)``, complex."""
        return self.receptance / np.asarray(periods) + self.response(0, periods)

    def a22(self, periods: np.ndarray) -> np.ndarray:
        """``a₂₂(T)``, complex."""
        return self.response(1, periods)

    def value(self, periods: np.ndarray) -> np.ndarray:
        """``F₁(T)``."""
        return 1.0 + (self.factor * self.response(1, periods)).real

    def slope(self, periods: np.ndarray) -> np.ndarray:
        """``F₁'(T)``."""
        return (self.factor * self.response(1, periods, derivative=1)).real

    def curvature_bound(self, middles: np.ndarray, half_width: np.ndarray) -> np.ndarray:
        """Bound of ``|F₁''|`` on intervals, the smaller one of a bound for ``g̃`` and one for ``g``.

        The second, ``|g⁽ⁿ⁾(z)| ≤ Σ mⁿ e^{m Re z}``, falls off at long periods.
        """

        def near_poles(exponent: complex, order: int, reach: float = 0.0) -> np.ndarray:
            distance = _pole_distance(exponent, middles) - abs(exponent) * half_width
            return _regular_bound(order, distance - reach * (middles + half_width))

        def far_out(exponent: complex, order: int, reach: float = 0.0) -> np.ndarray:
            return _geometric_bound(order, -exponent.real * (middles - half_width))

        bounds = [self._curvature(middles + half_width, bound) for bound in (near_poles, far_out)]
        return abs(self.factor) * np.minimum(*bounds)

    def _curvature(self, longest: np.ndarray, bound: Callable[..., np.ndarray]) -> np.ndarray:
        """Bound of ``|a₂₂''|`` from bounds of the derivatives of ``g`` or ``g̃`` at ``λT`` (and within ``reach`` T)."""
        total = np.zeros(longest.shape)
        for exponent, residue in zip(self.exponents, self.residues, strict=True):
            if residue != 0:
                total += abs(residue) * abs(exponent) ** 3 * bound(exponent, 2)
        for first, second, residue in self.pairs:
            gap, size = abs(first - second), max(abs(first), abs(second))
            slower = first if first.real >= second.real else second
            along = 3.0 * size**2 * bound(slower, 2, gap) + size**3 * longest * bound(slower, 3, gap)
            if gap > 0:
                ends = (abs(first) ** 3 * bound(first, 2) + abs(second) ** 3 * bound(second, 2)) / gap
                along = np.minimum(along, ends)
            total += abs(residue) * along
        return total

    def longest_period(self) -> float:
        """Time beyond which ``|q a₂₂| < 1``, hence ``F₁ > 0``; infinite without damping."""
        if self.exponents.real.max() >= 0.0:
            return np.inf
        low, high = 0.0, 1.0
        while self._decay_bound(high) >= 1.0:
            low, high = high, 2.0 * high
        while high - low > 1e-3 * high:
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self._decay_bound(middle) >= 1.0 else (low, middle)
        return high

    def _decay_bound(self, period: float) -> float:
        """Bound of ``|q a₂₂|`` that decreases with the period, from ``|g(z)| ≤ 1/(e^{−Re z} − 1)``."""

        def geometric(exponent: complex) -> float:
            return float(1.0 / np.expm1(-exponent.real * period))

        total = float(np.sum(np.abs(self.residues * self.exponents) * [geometric(e) for e in self.exponents]))
        for first, second, residue in self.pairs:
            gap, size = abs(first - second), max(abs(first), abs(second))
            slow = geometric(first if first.real > second.real else second)
            bound = slow + size * period * slow * (1.0 + slow)
            if gap > 0:
                bound = min(bound, (abs(first) * geometric(first) + abs(second) * geometric(second)) / gap)
            total += abs(residue) * bound
        return abs(self.factor) * total

    def roots(self, longest_period: float | None = None) -> PeriodRoots:
        """All roots up to ``longest_period``, by default up to where there are none any more.

        Parameters
        ----------
        longest_period : float, optional
            End of the search in ``1/Ω``.  Needed where damping is not positive, as ``F₁`` then has infinitely many roots.

        Raises
        ------
        InputError
            No damping and no ``longest_period``.
        CaromError
            The search would take unreasonable work (very weak damping); give a shorter ``longest_period``.
        """
        bound = self.longest_period()
        if longest_period is None and not np.isfinite(bound):
            raise InputError(
                "gamma", -2.0 * self.exponents.real.max(), "above 0, or longest_period must limit the orbits searched"
            )
        end = bound if longest_period is None else longest_period
        if not (np.isfinite(end) and end > 0):
            raise InputError("longest_period", longest_period, "a finite time above 0, in 1/Omega")
        return PeriodRoots(self._search(end), end, end >= bound)

    def _search(self, end: float) -> np.ndarray:
        count = int(np.ceil(end / FIRST_WIDTH))
        if count > MOST_INTERVALS:
            raise CaromError(f"periods up to {end:.3g}/Omega are too many to search; give a shorter longest_period")
        edges = np.linspace(0.0, end, count + 1)
        left, right = edges[:-1], edges[1:]
        brackets: list[np.ndarray] = []
        doubles: list[np.ndarray] = []
        while len(left):
            middle, half = 0.5 * (left + right), 0.5 * (right - left)
            value, slope = self.value(middle), self.slope(middle)
            bend = self.curvature_bound(middle, half)
            free = np.abs(value) > np.abs(slope) * half + 0.5 * bend * half**2
            monotone = ~free & (np.abs(slope) > bend * half)
            brackets.append(self._with_sign_change(left[monotone], right[monotone]))
            undecided = ~(free | monotone)
            narrow = undecided & (half < NARROWEST * (1.0 + middle))
            doubles.append(middle[narrow])
            split = undecided & ~narrow
            left = np.concatenate([left[split], middle[split]])
            right = np.concatenate([middle[split], right[split]])
        simple = self._polish(np.concatenate(brackets))
        return np.sort(np.concatenate([simple, np.repeat(_merge(np.concatenate(doubles)), 2)]))

    def _with_sign_change(self, left: np.ndarray, right: np.ndarray) -> np.ndarray:
        """Those intervals, shape (n, 2), whose ends have opposite signs; a root at ``T = 0`` (``d = 1``) is none."""
        below, above = self.value(left), self.value(right)
        change = (np.sign(below) * np.sign(above) < 0) | ((below == 0) & (left > 0))
        return np.stack([left[change], right[change]], axis=1)

    def _polish(self, brackets: np.ndarray) -> np.ndarray:
        """Roots of monotone brackets by Newton's method, bisecting where it leaves the bracket."""
        low, high = brackets[:, 0].copy(), brackets[:, 1].copy()
        rising = self.value(high) > 0
        root = 0.5 * (low + high)
        for _ in range(80):
            value = self.value(root)
            above = (value > 0) == rising
            high, low = np.where(above, root, high), np.where(above, low, root)
            newton = root - value / self.slope(root)
            inside = (newton >= low) & (newton <= high)
            better = np.where(inside, newton, 0.5 * (low + high))
            settled = np.abs(better - root) <= 2e-16 * root
            root = better
            if settled.all():
                break
        return root


def _regular(z: np.ndarray, derivative: int) -> np.ndarray:
    """``g̃``, ``g̃'`` or ``g̃''`` at complex ``z``."""
    small = np.abs(z) < SERIES_RADIUS
    far = np.where(small, -1.0, z)
    decay = np.exp(far)
    away = -np.expm1(far)
    if derivative == 0:
        direct = decay / away + 1.0 / far
    elif derivative == 1:
        direct = decay / away**2 - 1.0 / far**2
    else:
        direct = decay * (1.0 + decay) / away**3 + 2.0 / far**3
    near = np.where(small, z, 0.0)
    powers = 2 * np.arange(len(_SERIES)) + 1
    coefficients = -_SERIES.astype(float)
    for _ in range(derivative):
        coefficients, powers = coefficients * powers, powers - 1
    series = np.zeros(np.shape(z), complex)
    for coefficient, power in zip(coefficients[::-1], powers[::-1], strict=True):
        if power >= 0:
            series += coefficient * near**power
    return np.where(small, series - (0.5 if derivative == 0 else 0.0), direct)


def _divided_difference(
    first: complex, second: complex, periods: np.ndarray, order: int, derivative: int
) -> np.ndarray:
    """Divided difference over ``λ`` of ``λ^order g̃⁽ᵈ⁾(λT)``; where it would cancel, the mean of the derivative."""
    gap = first - second
    room = np.minimum(_pole_distance(first, periods), _pole_distance(second, periods))
    close = np.abs(gap) * periods < 0.25 * np.minimum(room, 1.0)
    result = np.empty(periods.shape, complex)
    apart = periods[~close]
    ends = [value**order * _regular(value * apart, derivative) for value in (first, second)]
    if gap != 0:
        result[~close] = (ends[0] - ends[1]) / gap
    near = periods[close]
    mean = np.zeros(near.shape, complex)
    for node, weight in zip(_NODES, _WEIGHTS, strict=True):
        value = 0.5 * (first + second) + 0.5 * gap * node
        slope = value**order * near * _regular(value * near, derivative + 1)
        if order:
            slope = slope + order * value ** (order - 1) * _regular(value * near, derivative)
        mean += 0.5 * weight * slope
    result[close] = mean
    return result


def _pole_distance(exponent: complex, periods: np.ndarray) -> np.ndarray:
    """Distance of ``λT`` from the nearest ``2πik``, ``k ≠ 0``."""
    z = exponent * periods
    turns = np.round(z.imag / (2 * pi))
    turns = np.where(turns == 0, np.where(z.imag >= 0, 1.0, -1.0), turns)
    return np.abs(z - 2j * pi * turns)


def _regular_bound(order: int, distance: np.ndarray) -> np.ndarray:
    """Bound of ``|g̃⁽ⁿ⁾|`` at this distance from the poles; infinite where the distance is not positive."""
    safe = np.where(distance > 0, distance, np.nan)
    bound = 2.0 * factorial(order) * (safe ** -(order + 1) + _ZETA[order] / (2 * pi) ** (order + 1))
    return np.where(distance > 0, bound, np.inf)


def _geometric_bound(order: int, decay: np.ndarray) -> np.ndarray:
    """Bound ``Σ mⁿ e^{−m decay}`` of ``|g⁽ⁿ⁾|``, n = 2 or 3; infinite where there is no decay."""
    ratio = np.exp(-np.where(decay > 0, decay, np.nan))
    bound = ratio * (1.0 + ratio) / (1.0 - ratio) ** 3
    if order == 3:
        bound = ratio * (1.0 + 4.0 * ratio + ratio**2) / (1.0 - ratio) ** 4
    return np.where(decay > 0, bound, np.inf)


def _merge(points: np.ndarray) -> np.ndarray:
    """One point for each cluster of neighbours."""
    points = np.sort(points)
    if not len(points):
        return points
    breaks = np.flatnonzero(np.diff(points) > 1e-6 * (1.0 + points[:-1])) + 1
    return np.array([cluster.mean() for cluster in np.split(points, breaks)])
