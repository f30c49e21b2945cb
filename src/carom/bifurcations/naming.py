"""Names of the orbits to which a curve of bifurcations belongs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from carom.bifurcations.conditions import name_of
from carom.closed_forms.periods import PeriodCondition
from carom.orbits.names import OrbitName, in_order
from carom.parameters import Numbers

BELOW = 1e-4
"""Relative distance from a period within which a root counts as that period."""
PLACES = 5
"""Points of a curve at which the number of the pair is determined: it increases where a shorter pair appears."""


def meeting_at(kind: str, name: OrbitName) -> tuple[OrbitName, ...]:
    """Orbits that meet at a special point of an orbit: two at a fold, the longer or faster one last; else itself."""
    if kind == "fold":
        return replace(name, longer=False), replace(name, longer=True)
    if kind == "speed-fold":
        return replace(name, faster=False), replace(name, faster=True)
    return (name,)


def orbits_on_curve(kind: str, points: Sequence[tuple[Numbers, float, float]]) -> tuple[OrbitName, ...]:
    """Names of the orbits that bifurcate on a curve, in order, from numbers, period and radial speed along it."""
    last = max(len(points) - 1, 1)
    pairs = [_pair(*points[i][:2]) for i in np.linspace(0, len(points) - 1, PLACES).round().astype(int)]
    names: set[OrbitName] = set()
    for i, (numbers, period, speed) in enumerate(points):
        pair = pairs[round(i / last * (PLACES - 1))]
        names.update(meeting_at(kind, name_of(numbers, pair, period, speed)))
    return in_order(names)


def _pair(numbers: Numbers, period: float) -> int:
    """Number of the pair of periods, counted by the shorter roots of ``F₁``."""
    shorter = PeriodCondition.planar(numbers.parameters).roots((1.0 - BELOW) * period)
    return (len(shorter.periods) + int(shorter.starts_below)) // 2 + 1
