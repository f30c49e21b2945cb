"""Whether a known curve passes through a point of the plane, and where curves cross a straight line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from carom.bifurcations.curve_results import Curve
from carom.bifurcations.points import Bifurcation

CURVE_RADIUS = 5e-4
"""Distance from a curve, in widths of the plane, within which a point lies on it: ten times that from its chords."""
SAME_PERIOD, SAME_SPEED = 0.02, 0.02
"""Relative difference of periods, and difference of radial speeds in ``c_r Ω``, of orbits that count as the same."""
SAMPLES = 9
"""Number of points of a curve that must lie on another one for it to count as part of that one."""


def passes(curve: Curve, point: Bifurcation) -> bool:
    """Whether a bifurcation lies on a curve: the curve must pass close by with the same orbit."""
    place = curve.plane.place_of(point.at)
    return curve.kind == point.kind and _lies_on(curve, place, point.period, point.radial_speed)


def _lies_on(curve: Curve, place: Sequence[float], period: float, speed: float) -> bool:
    points, here = curve.points / curve.plane.widths, np.asarray(place) / curve.plane.widths
    ahead = np.diff(points, axis=0)
    share = np.clip(((here - points[:-1]) * ahead).sum(axis=1) / np.maximum((ahead**2).sum(axis=1), 1e-300), 0.0, 1.0)
    distance = np.linalg.norm(points[:-1] + share[:, None] * ahead - here, axis=1)
    for i in np.flatnonzero(distance <= CURVE_RADIUS):
        weights = np.array([1.0 - share[i], share[i]])
        # Equilibria have neither period nor radial speed.
        other = abs(weights @ curve.periods[i : i + 2] - period) >= SAME_PERIOD * period
        if not (other or abs(weights @ curve.radial_speeds[i : i + 2] - speed) >= SAME_SPEED):
            return True
    return False


def with_curve(curves: Sequence[Curve], new: Curve) -> list[Curve]:
    """Add a new curve to the known ones, and drop curves that are part of another."""
    if any(_is_part(new, curve) for curve in curves):
        return list(curves)
    return [*(curve for curve in curves if not _is_part(curve, new)), new]


def _is_part(curve: Curve, other: Curve) -> bool:
    """Whether a curve lies on another one."""
    if curve.kind != other.kind:
        return False
    looked_at = np.unique(np.linspace(0, len(curve.points) - 1, SAMPLES).round().astype(int))
    rows = zip(curve.points[looked_at], curve.periods[looked_at], curve.radial_speeds[looked_at], strict=True)
    return all(_lies_on(other, *row) for row in rows)


def crossings(curve: Curve, first: np.ndarray, last: np.ndarray) -> Iterator[float]:
    """Where a curve of motions of the machine crosses the straight line between two points, as shares of the line."""
    start, line = np.asarray(first), np.subtract(last, first) / curve.plane.widths
    offsets = (curve.points - start) / curve.plane.widths
    across = offsets[:, 0] * line[1] - offsets[:, 1] * line[0]
    along = offsets @ line / (line @ line)
    real = curve.admissible[:-1] | curve.admissible[1:]
    for i in np.flatnonzero(real & ((across[:-1] < 0.0) != (across[1:] < 0.0))):
        share = across[i] / (across[i] - across[i + 1])
        place = float(along[i] + share * (along[i + 1] - along[i]))
        if 0.0 <= place <= 1.0:
            yield place
