"""Whether a known curve passes through a point of the plane, and where curves cross a straight line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from carom.bifurcations.curves import KINDS, Curve

__all__ = ["Cause", "Place", "crossings", "passes", "with_curve"]

Place = Sequence[float] | np.ndarray
CLOSE = 5e-4
"""Distance from a curve, in widths of the plane, within which a point lies on it: ten times that from its chords."""
SAME_PERIOD, SAME_SPEED = 0.02, 0.02
"""Relative difference of periods, and difference of radial speeds in ``c_r Ω``, of orbits that count as the same."""
SAMPLES = 9
"""Number of points of a curve that must lie on another one for it to count as part of that one."""


class Cause(NamedTuple):
    """A bifurcation at a point of the plane; without a period it is one of equilibria or of rolling."""

    kind: str
    period: float | None = None
    radial_speed: float | None = None

    @property
    def unknowns(self) -> tuple[float, ...]:
        """Period and radial speed, if it is a bifurcation of an orbit."""
        return () if self.period is None or self.radial_speed is None else (self.period, self.radial_speed)


def passes(curve: Curve, place: Place, cause: Cause) -> bool:
    """Whether the bifurcation at a place lies on a curve: the curve must pass close by with the same orbit."""
    if curve.kind != cause.kind:
        return False
    points, here = curve.points / curve.plane.widths, np.asarray(place) / curve.plane.widths
    ahead = np.diff(points, axis=0)
    share = np.clip(((here - points[:-1]) * ahead).sum(axis=1) / np.maximum((ahead**2).sum(axis=1), 1e-300), 0.0, 1.0)
    distance = np.linalg.norm(points[:-1] + share[:, None] * ahead - here, axis=1)
    # Onsets of lasting contact are not refined: a curve deviates from a chord by less than an eighth of its length.
    near = np.flatnonzero(distance <= (CLOSE if curve.kind in KINDS else 0.125 * np.linalg.norm(ahead, axis=1)))
    return any(_same_orbit(curve, int(i), float(share[i]), cause) for i in near)


def _same_orbit(curve: Curve, step: int, share: float, cause: Cause) -> bool:
    """Whether the orbit on a step of a curve is that of the cause."""
    if cause.period is None:
        return True
    weights = np.array([1.0 - share, share])
    period = weights @ curve.periods[step : step + 2]
    if not abs(period - cause.period) < SAME_PERIOD * cause.period:
        return False
    speed = weights @ curve.radial_speeds[step : step + 2]
    return cause.radial_speed is None or bool(abs(speed - cause.radial_speed) < SAME_SPEED)


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
    return all(passes(other, curve.points[i], _cause_on(curve, int(i))) for i in looked_at)


def _cause_on(curve: Curve, index: int) -> Cause:
    if np.isnan(curve.periods[index]):
        return Cause(curve.kind)
    speed = float(curve.radial_speeds[index])
    return Cause(curve.kind, float(curve.periods[index]), None if np.isnan(speed) else speed)


def crossings(curve: Curve, first: Place, last: Place) -> Iterator[float]:
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
