"""For which damping, and for which stiffness, orbits with one impact a period exist: by search.

Every such orbit has a period that is a root of ``F₁``.  ``F₁`` is not negative at ``T = 0`` and tends to one, so it has a
root exactly if its deepest minimum, the *dip*, is not above zero.  A gain is scanned in small steps for changes of the
sign of the dip; between two steps the fold, ``F₁ = F₁' = 0``, is the root of the dip as a function of the gain.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from carom.parameters import DIMENSIONLESS_FIELDS, Parameters
from carom.periods import PeriodCondition
from carom.rotors import jeffcott
from carom.study.ranges import Edge, Gain, MotionRange, Span

__all__ = ["deepest_dip", "single_impact_range"]

POINTS_PER_RADIAN = 8
"""Samples of ``F₁`` while its fastest mode turns, or decays, by one."""
MOST_SAMPLES = 60_000
"""Samples of ``F₁`` beyond which a parameter set is left out of the search."""
ROUNDING = 2e-16
"""Rounding of ``F₁`` near its roots."""
NOISE = 1e-14
"""Depth below ``F₁(0)`` from which on a minimum is none of rounding."""
GAIN_STEPS = 240
NEARBY = 1e-6
"""Relative distance from a fold at which the number of roots is counted with proof."""

Progress = Callable[[float], None]


@dataclass(frozen=True)
class _Point:
    gain: float
    period: float
    depth: float


def single_impact_range(parameters: Parameters, gain: Gain, progress: Progress | None = None) -> MotionRange | None:
    """Where ``F₁`` has roots, which orbits with one impact a period and forward slip need.

    A balanced rotor has no such orbit (:func:`~carom.orbits.single_impact_orbits`), whatever the roots: ``U* = 0``.

    Damping is searched from a fraction of the machine's own to where the rotor is far overdamped; stiffness from a
    quarter of the machine's own to four times it.

    Parameters
    ----------
    parameters : Parameters
    gain : {"gamma", "omega"}
        The one that is varied.
    progress : callable, optional
        Called with the share done, 0 to 1.

    Returns
    -------
    MotionRange or None
        ``None`` where no search is possible: stiffness without damping, or a rotor with so little of it that ``F₁``
        oscillates too often.
    """
    values = _gains(parameters, gain)
    if values is None:
        return None
    searched = Span(Edge(float(values[0])), Edge(float(values[-1])))
    points: list[_Point] = []
    spans: tuple[Span, ...] = ()
    for done, value in enumerate(values if parameters.rho > 0.0 else ()):
        points.append(_dip_at(parameters, gain, float(value), sign_only=True))
        if progress:
            progress((done + 1) / (len(values) + 4))
    if points:
        spans = _spans(parameters, gain, _with_narrow_windows(parameters, gain, points))
    if progress:
        progress(1.0)
    return MotionRange("single-impact", gain, spans, searched, float(values[1] / values[0] - 1.0))


def deepest_dip(parameters: Parameters, sign_only: bool = False) -> tuple[float, float]:
    """Deepest local minimum of ``F₁`` over ``T > 0`` that lies below ``F₁(0)``; others cannot reach zero.

    With ``d = 1`` there is ``F₁(0) = 0``, and the slope there, if it is lower, stands for a minimum at ``T = 0``: where it
    is negative, so is ``F₁`` at short periods.

    Parameters
    ----------
    parameters : Parameters
        With ``gamma > 0``.
    sign_only : bool
        Only the sign of the depth matters: be content with a sample where that decides it.

    Returns
    -------
    period, depth : float
        Its place and value, the value to rounding; infinite where there is none.
    """
    condition = PeriodCondition(jeffcott(parameters))
    period, depth = _interior_dip(condition, sign_only)
    if parameters.d == 1.0:
        slope = float(condition.slope(np.zeros(1))[0])
        if slope < depth:
            return 0.0, slope
    return period, depth


def _interior_dip(condition: PeriodCondition, sign_only: bool) -> tuple[float, float]:
    times = _samples(condition)
    values = condition.value(times)
    lower = np.minimum(values[:-2], values[0] - NOISE)
    dips = np.flatnonzero((values[1:-1] <= lower) & (values[1:-1] < values[2:])) + 1
    if not len(dips):
        return math.inf, math.inf
    deepest = int(dips[np.argmin(values[dips])])
    depth = float(values[deepest])
    # The parabola through three samples dips by less than this below the middle one; four times that is safe.
    reach = 4.0 * float(values[deepest - 1] + values[deepest + 1] - 2.0 * depth)
    if sign_only and not 0.0 < depth < reach:
        return float(times[deepest]), depth
    period = _minimum(condition, float(times[deepest - 1]), float(times[deepest + 1]))
    return period, float(condition.value(np.asarray(period)))


def _minimum(condition: PeriodCondition, low: float, high: float) -> float:
    """Place of the minimum of ``F₁`` between two times: the root of its slope."""
    for _ in range(3):
        places = np.linspace(low, high, 33)
        falling = np.flatnonzero(condition.slope(places) < 0)
        last = int(falling[-1]) if len(falling) else 0
        low, high = float(places[last]), float(places[min(last + 1, 32)])
    left, right = condition.slope(np.array([low, high]))
    return low + float(left / (left - right)) * (high - low) if left < 0 < right else 0.5 * (low + high)


def _samples(condition: PeriodCondition) -> np.ndarray:
    """Even samples, and before the first of them geometric ones: nearly elastic impacts dip at very short periods."""
    longest = condition.longest_period()
    even = np.linspace(0.0, longest, _sample_count(condition, longest) + 1)[1:]
    return np.concatenate([[0.0], even[0] * np.geomspace(1e-7, 1.0, 48)[:-1], even])


def _sample_count(condition: PeriodCondition, longest: float) -> int:
    turns = longest * float(np.abs(condition.exponents).max())
    return max(64, math.ceil(POINTS_PER_RADIAN * turns)) if math.isfinite(turns) else MOST_SAMPLES + 1


def _can_search(parameters: Parameters) -> bool:
    if parameters.gamma <= 0:
        return False
    condition = PeriodCondition(jeffcott(parameters))
    return _sample_count(condition, condition.longest_period()) <= MOST_SAMPLES


def _gains(parameters: Parameters, gain: Gain) -> np.ndarray | None:
    """Values to look at, in geometric progression."""
    if gain == "omega":
        lowest, highest = 0.5 * parameters.omega, 2.0 * parameters.omega
    else:
        lowest = min(0.02 * max(1.0, parameters.omega), 0.5 * parameters.gamma if parameters.gamma > 0 else 1.0)
        highest = 8.0 * max(1.0, parameters.omega, parameters.gamma)
        while lowest < 0.1 * highest and not _can_search(parameters.replace(gamma=lowest)):
            lowest *= 2.0
    limits = DIMENSIONLESS_FIELDS[gain]
    lowest, highest = max(lowest, limits.lowest), min(highest, limits.highest)
    ends = [parameters.replace(**{gain: value}) for value in (lowest, highest)]
    if lowest >= highest or not all(_can_search(end) for end in ends):
        return None
    values: np.ndarray = np.geomspace(lowest, highest, GAIN_STEPS + 1)
    return values


def _dip_at(parameters: Parameters, gain: Gain, value: float, sign_only: bool = False) -> _Point:
    return _Point(value, *deepest_dip(parameters.replace(**{gain: value}), sign_only))


def _with_narrow_windows(parameters: Parameters, gain: Gain, points: list[_Point]) -> list[_Point]:
    """Look closer where the dip comes near zero between steps without having crossed it."""
    found = list(points)
    for before, here, after in zip(points, points[1:], points[2:], strict=False):
        depths = [before.depth, here.depth, after.depth]
        if not all(map(math.isfinite, depths)) or len({depth > 0 for depth in depths}) > 1:
            continue
        sizes = [abs(depth) for depth in depths]
        if sizes[1] == min(sizes) and sizes[1] < sizes[0] + sizes[2] - 2.0 * sizes[1]:
            places = [
                here.gain + share * (end.gain - here.gain) for end in (before, after) for share in (0.25, 0.5, 0.75)
            ]
            found += [_dip_at(parameters, gain, place) for place in places]
    return sorted(found, key=lambda point: point.gain)


def _spans(parameters: Parameters, gain: Gain, points: list[_Point]) -> tuple[Span, ...]:
    """Join neighbours with roots; where one has roots and the next has not, there is a fold between them."""
    spans = []
    start = Edge(points[0].gain) if points[0].depth <= 0 else None
    for before, after in pairwise(points):
        if (before.depth <= 0) == (after.depth <= 0):
            continue
        fold = _fold_between(parameters, gain, before, after)
        if start is None:
            start = fold
        else:
            spans.append(Span(start, fold))
            start = None
    if start is not None:
        spans.append(Span(start, Edge(points[-1].gain)))
    return tuple(spans)


def _fold_between(parameters: Parameters, gain: Gain, low: _Point, high: _Point) -> Edge:
    """The gain at which the dip is zero, by false position (Illinois); halving while there is no dip at one end."""
    roots_below = low.depth <= 0
    ends, sizes, kept = [low, high], [low.depth, high.depth], -1
    for _ in range(100):
        share = sizes[0] / (sizes[0] - sizes[1]) if all(map(math.isfinite, sizes)) else 0.5
        place = ends[0].gain + share * (ends[1].gain - ends[0].gain)
        if not ends[0].gain < place < ends[1].gain:
            break
        middle = _dip_at(parameters, gain, place)
        moved = 0 if (middle.depth <= 0) == (ends[0].depth <= 0) else 1
        ends[moved], sizes[moved] = middle, middle.depth
        if abs(middle.depth) < ROUNDING:
            break
        if kept == 1 - moved:  # the other end has stayed twice: pull the next guess to it
            sizes[kept] *= 0.5
        kept = 1 - moved
    return _edge(parameters, gain, min(ends, key=lambda point: abs(point.depth)), roots_below)


def _edge(parameters: Parameters, gain: Gain, fold: _Point, roots_below: bool) -> Edge:
    """Turn a fold into an edge, confirmed by the proven number of roots close by on both sides."""
    counts = []
    for factor in (1.0 - NEARBY, 1.0 + NEARBY):
        condition = PeriodCondition(jeffcott(parameters.replace(**{gain: fold.gain * factor})))
        counts.append(len(condition.roots().periods))
    below, above = counts if roots_below else reversed(counts)
    kind = "fold" if fold.period > 0 else "vanishing-period"
    return Edge(fold.gain, kind, fold.period, certified=below > 0 and above == 0)
