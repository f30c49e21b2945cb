"""Periods of single-impact orbits: the roots of ``F₁(T) = 1 + Re(q a₂₂(T))``, all of them.

For one contact plane with row ``W``, column ``B`` and flight ``ċ = Mc`` let, in the source paper's notation (4.1),

    a₁₂(T) = W (e^{−MT} − 1)⁻¹ B,     a₂₂(T) = W M (e^{−MT} − 1)⁻¹ B.

With ``g(z) = 1/(e^{−z} − 1)`` and its regular part ``g̃(z) = g(z) + 1/z`` these are sums over the modes of
``λⁿ g(λT)`` times a residue; for a driven pair a divided difference replaces the value.  Because an impulse does not
change the position at once (``WB = 0``) the poles of ``a₂₂`` at ``T = 0`` cancel, so ``g̃`` may replace ``g`` there, and
``a₁₂(T) = H/T +`` the same sum with ``g̃``, where ``H = −W M⁻¹ B`` is the static receptance.

Completeness rests on two bounds.  ``|a₂₂|`` is below a decreasing function of ``T``, so beyond ``longest_period``
there is ``F₁ > 0``.  Up to there, ``g̃(z) = −1/2 − Σ_{k≠0} 1/(z − 2πik)`` gives

    |g̃⁽ⁿ⁾(z)| ≤ 2 n! (δ^{−n−1} + ζ(n+1) (2π)^{−n−1}),      δ = min_{k≠0} |z − 2πik|,

hence a bound of ``|F₁''|`` on any interval, and ``g(z) = Σ e^{mz}`` gives a sharper one at long periods.  Near a pole
the bounds grow at the rate of ``|F₁''|`` itself, so the intervals need only shrink in proportion to the distance from
the pole, unless the pole is one of the imaginary part alone (no damping and no friction).  An interval is discarded, or
accepted as monotone, only when that bound proves it; one on which ``F₁`` cannot be distinguished from zero in double
precision holds a double root, or a single one if ``F₁`` changes sign across it.  So all roots are counted correctly,
down to the last pair.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial, pi

import numpy as np

from carom.models import System
from carom.outcome import CaromError, InputError
from carom.results import Result

__all__ = ["PeriodCondition", "PeriodRoots"]

SERIES_RADIUS = 1.0
# Bernoulli numbers B₂ₘ: g̃(z) = −1/2 − Σ B₂ₘ z^{2m−1}/(2m)!, twelve terms reach rounding at |z| = 1.
_BERNOULLI = (
    1 / 6, -1 / 30, 1 / 42, -1 / 30, 5 / 66, -691 / 2730, 7 / 6, -3617 / 510, 43867 / 798, -174611 / 330,
    854513 / 138, -236364091 / 2730,
)  # fmt: skip
_ODD = np.arange(1, 25, 2)
_SERIES = -np.array([number / factorial(power + 1) for number, power in zip(_BERNOULLI, _ODD, strict=True)])
# Coefficients in powers of z² of g̃ + 1/2 and g̃'', both over z, and of g̃'.
_SERIES = np.array([_SERIES, _SERIES * _ODD, np.append((_SERIES * _ODD * (_ODD - 1))[1:], 0.0)])
_ZETA = {2: 1.2020569031595943, 3: 1.0823232337111382}
"""``ζ(n + 1)``."""
# Eight nodes integrate a divided difference to rounding where CLOSE holds.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
CLOSE = 0.25
"""Split ``|λ₊ − λ₋|T`` of a pair, relative to the distance from the poles, below which a difference would cancel."""

FIRST_WIDTH = 0.25
BATCH = 20_000
"""Intervals searched at a time."""
MOST_INTERVALS = 1_000_000
MOST_STEPS = 200
"""More than bisection takes to exhaust double precision."""
ROUNDING = 16 * np.finfo(float).eps
"""Rounding error of a sum relative to the moduli of its terms."""


@dataclass(frozen=True, eq=False, repr=False)
class PeriodRoots(Result):
    """All roots of ``F₁`` on ``0 < T ≤ longest_period``.

    Attributes
    ----------
    periods : ndarray
        The roots in ascending order, a double root twice.
    longest_period : float
        End of the searched range.
    proven : bool
        Whether ``F₁ > 0`` is proven beyond it, so that there is no other root at all.
    starts_below : bool
        Whether ``F₁ < 0`` next to ``T = 0``.  This requires ``d = 1`` and a root at ``T = 0``, which is not counted.
    """

    periods: np.ndarray
    longest_period: float
    proven: bool
    starts_below: bool


class PeriodCondition:
    """``F₁`` of a system, its derivative and its bounds.

    :func:`carom.core.planar.returns` computes the same sums for the planar rotor alone.  Both are needed.  This class
    takes any number of modes and many periods at a time, and gives the rounding error of each sum, which the proofs
    need.  The function takes less than a microsecond for one period, a hundredth of the time here; kernels that
    continuation calls thousands of times use it.  The tests compare the two.

    Parameters
    ----------
    system : System
    slip : {1, -1}
        Direction of the slip during impacts.
    """

    def __init__(self, system: System, slip: int = 1) -> None:
        arrays = system.arrays
        row, column = arrays.rows[0], arrays.columns[:, 0]
        self.factor = complex(1.0 + arrays.restitution[0]) * complex(1.0, slip * arrays.friction[0])
        self.exponents = np.array(arrays.exponents)
        self.singles = [(k, complex(row[k] * column[k])) for k in np.flatnonzero(row * column)]
        self.pairs = [(k, complex(row[k] * column[k - 1])) for k in np.flatnonzero(arrays.driven)]
        self.receptance = -complex(row @ np.linalg.solve(system.generator, column))

    def a12(self, periods: np.ndarray) -> np.ndarray:
        """``a₁₂(T)``, complex, of the shape of ``periods``."""
        return self.receptance / np.asarray(periods) + self._sums(periods, (0, 0))[0][0]

    def a22(self, periods: np.ndarray) -> np.ndarray:
        """``a₂₂(T)``, complex, of the shape of ``periods``."""
        return self._sums(periods, (1, 0))[0][0]

    def value(self, periods: np.ndarray) -> np.ndarray:
        """``F₁(T)``."""
        return 1.0 + (self.factor * self.a22(periods)).real

    def slope(self, periods: np.ndarray) -> np.ndarray:
        """``F₁'(T)``."""
        return (self.factor * self._sums(periods, (2, 1))[0][0]).real

    def measure(self, periods: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """``F₁``, its slope, and the possible rounding error of ``F₁`` (including that of ``λT``)."""
        (a22, rate), (size, rate_size) = self._sums(periods, (1, 0), (2, 1))
        noise = ROUNDING * (1.0 + abs(self.factor) * (size + periods * rate_size))
        return 1.0 + (self.factor * a22).real, (self.factor * rate).real, noise

    def _sums(self, periods: np.ndarray, *terms: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
        """Sums over the modes of ``λⁿ g̃⁽ᵏ⁾(λT)`` times a residue, for each ``(n, k)``, and sums of the moduli."""
        periods = np.asarray(periods, float)
        regular = _regular(np.multiply.outer(self.exponents, periods), max(k for _, k in terms))
        totals = np.zeros((len(terms), *periods.shape), complex)
        sizes = np.zeros(totals.shape)
        for index, residue in self.singles:
            for i, (n, k) in enumerate(terms):
                part = residue * self.exponents[index] ** n * regular[k, index]
                totals[i] += part
                sizes[i] += np.abs(part)
        for index, residue in self.pairs:
            first, second = self.exponents[index], self.exponents[index - 1]
            close = _close(first, second, periods)
            inverse = np.where(close, 0.0, residue / (first - second) if first != second else 0.0)
            for i, (n, k) in enumerate(terms):
                ends = first**n * inverse * regular[k, index], second**n * inverse * regular[k, index - 1]
                totals[i] += ends[0] - ends[1]
                sizes[i] += np.abs(ends[0]) + np.abs(ends[1])
            if close.any():
                mean = residue * _mean_derivatives(first, second, periods[close], terms)
                totals[:, close] += mean
                sizes[:, close] += np.abs(mean)
        return totals, sizes

    def curvature_bound(self, middles: np.ndarray, half_widths: np.ndarray) -> np.ndarray:
        """Bound of ``|F₁''|`` on intervals, the smaller of a bound from ``g̃`` and one from ``g``.

        The second, ``|g⁽ⁿ⁾(z)| ≤ Σ mⁿ e^{m Re z}``, decays at long periods.
        """
        longest = middles + half_widths
        moduli = np.abs(self.exponents)[:, None]
        distance = _pole_distance(self.exponents[:, None], middles) - moduli * half_widths
        decay = np.multiply.outer(-self.exponents.real, middles - half_widths)
        bounds = moduli**3 * np.array([_regular_bound(2, distance), _geometric_bound(2, decay)])
        total = np.zeros((2, len(middles)))
        for index, residue in self.singles:
            total += abs(residue) * bounds[:, index]
        for index, residue in self.pairs:
            gap = abs(self.exponents[index] - self.exponents[index - 1])
            size = moduli[index - 1 : index + 1].max()
            apart = bounds[:, index] + bounds[:, index - 1]
            part = apart / gap if gap > 0.0 else np.full_like(total, np.inf)
            along = gap * longest < 1.0
            if along.any():
                # The pair lies within gap·T of its slower exponent, the driven one.
                room, fall = distance[index, along] - gap * longest[along], decay[index, along]
                second = np.array([_regular_bound(2, room), _geometric_bound(2, fall)])
                third = np.array([_regular_bound(3, room), _geometric_bound(3, fall)])
                together = size**2 * (3.0 * second + size * longest[along] * third)
                part[:, along] = np.minimum(part[:, along], together)
            total += abs(residue) * part
        return abs(self.factor) * total.min(axis=0)

    def longest_period(self) -> float:
        """Time beyond which ``|q a₂₂| < 1``, hence ``F₁ > 0``; infinite without damping."""
        if self.exponents.real.max() >= 0.0:
            return np.inf
        low, high = 0.0, 1.0
        while self._decay_bound(high) >= 1.0:
            low, high = high, 2.0 * high
        while high - low > 1e-2 * high:
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self._decay_bound(middle) >= 1.0 else (low, middle)
        return high

    def _decay_bound(self, period: float) -> float:
        """Bound of ``|q a₂₂|`` that decreases with the period, from ``|g(z)| ≤ 1/(e^{−Re z} − 1)``."""
        moduli = np.abs(self.exponents)
        decay = self.exponents.real * period
        geometric = -np.exp(decay) / np.expm1(decay)
        total = sum(abs(residue) * moduli[index] * geometric[index] for index, residue in self.singles)
        for index, residue in self.pairs:
            gap, size = abs(self.exponents[index] - self.exponents[index - 1]), moduli[index - 1 : index + 1].max()
            slow = geometric[index]
            bound = slow + size * period * slow * (1.0 + slow)
            if gap > 0:
                bound = min(bound, (moduli[index] * slow + moduli[index - 1] * geometric[index - 1]) / gap)
            total += abs(residue) * bound
        return float(abs(self.factor) * total)

    def roots(self, longest_period: float | None = None) -> PeriodRoots:
        """All roots up to ``longest_period``; by default all roots there are.

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
        periods, starts_below = self._search(end)
        return PeriodRoots(periods, end, end >= bound, starts_below)

    def _search(self, end: float) -> tuple[np.ndarray, bool]:
        """Roots up to ``end``, and whether ``F₁`` starts below zero."""
        count = int(np.ceil(end / FIRST_WIDTH))
        if count > MOST_INTERVALS:
            raise CaromError(f"periods up to {end:.3g}/Omega are too many to search; give a shorter longest_period")
        grid = np.linspace(0.0, end, count + 1)
        batches = [self._sort_out(grid[k : k + BATCH + 1]) for k in range(0, count, BATCH)]
        monotone = np.concatenate([batch[0] for batch in batches])
        doubtful = _joined(np.concatenate([batch[1] for batch in batches]))
        pieces = np.concatenate([monotone, doubtful])
        edges, place = np.unique(pieces, return_inverse=True)
        positive = (self.value(edges) >= 0.0)[place.reshape(pieces.shape)]
        # Only d = 1 makes T = 0 a root; no other root lies in the piece that begins there.
        value, _, noise = self.measure(np.zeros(1))
        from_zero = (pieces[:, 0] == 0.0) & (value <= noise)
        positive[from_zero, 0] = positive[from_zero, 1]
        starts_below = bool((~positive[from_zero, 0]).any())
        single = positive[:, 0] != positive[:, 1]
        double = np.flatnonzero(~single[len(monotone) :] & ~from_zero[len(monotone) :])
        simple = self._polish(pieces[single], positive[single, 1])
        return np.sort(np.concatenate([simple, np.repeat(self._folds(doubtful[double]), 2)])), starts_below

    def _sort_out(self, grid: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Intervals on which ``F₁`` is monotone, and those on which it cannot be distinguished from zero.

        Both have shape (n, 2).  ``F₁`` has no root outside them.
        """
        left, right = grid[:-1], grid[1:]
        monotone, doubtful = [np.empty((0, 2))], [np.empty((0, 2))]
        while len(left):
            middle, half = 0.5 * (left + right), 0.5 * (right - left)
            value, slope, noise = self.measure(middle)
            bend = self.curvature_bound(middle, half)
            change = (np.abs(slope) + 0.5 * bend * half) * half
            undecided = np.abs(value) <= change + noise
            steady = np.abs(slope) > bend * half
            lost = undecided & ~steady & (change < noise)
            intervals = np.stack([left, right], axis=1)
            monotone.append(intervals[undecided & steady])
            # Without damping F₁ has poles.  Next to one the rounding error is large, but there is no root.
            doubtful.append(intervals[lost & (noise < 1.0)])
            split = undecided & ~steady & ~lost & (half > ROUNDING * middle)
            if split.sum() > MOST_INTERVALS // 4:
                raise CaromError(
                    f"periods up to {grid[-1]:.3g}/Omega are too near resonance; give a shorter longest_period"
                )
            left = np.concatenate([left[split], middle[split]])
            right = np.concatenate([middle[split], right[split]])
        return np.concatenate(monotone), np.concatenate(doubtful)

    def _polish(self, brackets: np.ndarray, rising: np.ndarray) -> np.ndarray:
        """Roots of brackets, shape (n, 2), by Newton's method, bisecting where it leaves the bracket."""
        low, high = brackets[:, 0].copy(), brackets[:, 1].copy()
        root = 0.5 * (low + high)
        for _ in range(MOST_STEPS):
            value, slope, noise = self.measure(root)
            above = (value >= 0.0) == rising
            high, low = np.where(above, root, high), np.where(above, low, root)
            step = np.divide(value, slope, out=np.full_like(value, np.inf), where=slope != 0)
            newton = root - step
            better = np.where((newton >= low) & (newton <= high), newton, 0.5 * (low + high))
            settled = (np.abs(value) <= noise) | (np.abs(better - root) <= 4e-16 * root)
            root = better
            if settled.all():
                break
        return root

    def _folds(self, intervals: np.ndarray) -> np.ndarray:
        """Double roots on short intervals, shape (n, 2): the places where the slope vanishes."""
        left, right = intervals.T
        at_left, at_right = self.slope(left), self.slope(right)
        crosses = at_left * at_right < 0
        share = np.divide(at_left, at_left - at_right, out=np.full_like(left, 0.5), where=crosses)
        return left + share * (right - left)


def _regular(z: np.ndarray, highest: int) -> np.ndarray:
    """``g̃`` and its derivatives up to order ``highest`` (at most 2) at complex ``z``, shape (highest + 1, ...)."""
    small = np.abs(z) < SERIES_RADIUS
    # g(z) = −1 − g(−z) avoids growing exponentials.
    flip = z.real > 0
    far = np.where(small, -1.0, np.where(flip, -z, z))
    g = -np.exp(far) / np.expm1(far)
    g = np.where(flip, -1.0 - g, g)
    inverse = 1.0 / np.where(small, -1.0, z)
    results = [g + inverse]
    if highest > 0:
        slope = g * (1.0 + g)
        results.append(slope - inverse**2)
    if highest > 1:
        results.append(slope * (1.0 + 2.0 * g) + 2.0 * inverse**3)
    regular = np.array(results)
    if small.any():
        near = z[small]
        series = _SERIES[: highest + 1] @ np.vander(near * near, len(_ODD), increasing=True).T
        series[::2] *= near
        series[0] -= 0.5
        regular[:, small] = series
    return regular


def _close(first: complex, second: complex, periods: np.ndarray) -> np.ndarray:
    """Whether the difference of values at the two exponents of a pair would cancel."""
    room = np.minimum(_pole_distance(first, periods), _pole_distance(second, periods))
    close: np.ndarray = np.abs(first - second) * periods < CLOSE * np.minimum(room, 1.0)
    return close


def _mean_derivatives(
    first: complex, second: complex, periods: np.ndarray, terms: tuple[tuple[int, int], ...]
) -> np.ndarray:
    """Divided differences over ``λ`` of ``λⁿ g̃⁽ᵏ⁾(λT)``, shape (terms, periods), as means of the derivative."""
    exponents = (0.5 * (first + second) + 0.5 * (first - second) * _NODES)[:, None]
    regular = _regular(exponents * periods, max(k for _, k in terms) + 1)
    means = []
    for n, k in terms:
        rates = exponents**n * periods * regular[k + 1] + (n * exponents ** (n - 1) * regular[k] if n else 0.0)
        means.append(0.5 * _WEIGHTS @ rates)
    return np.array(means)


def _pole_distance(exponent: complex | np.ndarray, periods: np.ndarray) -> np.ndarray:
    """Distance of ``λT`` from the nearest ``2πik``, ``k ≠ 0``."""
    z = exponent * periods
    turns = np.round(z.imag / (2 * pi))
    turns = np.where(turns == 0, np.where(z.imag >= 0, 1.0, -1.0), turns)
    distance: np.ndarray = np.abs(z - 2j * pi * turns)
    return distance


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


def _joined(intervals: np.ndarray) -> np.ndarray:
    """Merge adjacent intervals, shape (n, 2)."""
    if not len(intervals):
        return intervals
    intervals = intervals[np.argsort(intervals[:, 0])]
    apart = intervals[1:, 0] != intervals[:-1, 1]
    return np.stack([intervals[np.append(True, apart), 0], intervals[np.append(apart, True), 1]], axis=1)
