"""Names of the orbits to which a curve of bifurcations belongs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from carom.bifurcations.axes import Numbers
from carom.bifurcations.conditions import conditions_at, letter
from carom.closed_forms.periods import PeriodCondition
from carom.models import Jeffcott

__all__ = ["listed", "orbits_on_curve"]

BELOW = 1e-4
"""Relative distance from a period within which a root counts as that period."""
PLACES = 5
"""Points of a curve at which the number of the pair is determined: it increases where a shorter pair appears."""


def listed(names: tuple[str, ...]) -> str:
    """List of names with the letters of each pair combined, such as ``B1,a/b/c, B2,d``."""
    pairs: dict[str, list[str]] = {}
    for name in names:
        pair, letter = name.split(",")
        pairs.setdefault(pair, []).append(letter)
    return ", ".join(f"{pair},{'/'.join(letters)}" for pair, letters in pairs.items())


def orbits_on_curve(kind: str, points: Sequence[tuple[Numbers, float, float]]) -> tuple[str, ...]:
    """Names of the orbits that bifurcate on a curve, in alphabetical order.

    Parameters
    ----------
    kind : str
        One of :data:`~carom.bifurcations.curves.KINDS`.
    points : sequence of tuple
        Numbers, period and radial speed along the curve.
    """
    last = max(len(points) - 1, 1)
    pairs = [_pair(*points[i]) for i in np.linspace(0, len(points) - 1, PLACES).round().astype(int)]
    names = set()
    for i, point in enumerate(points):
        conditions = conditions_at(*point)
        letters = letter(conditions)
        if kind == "fold":
            letters = "ab" if conditions.speed_fold < 0.0 else "cd"
        elif kind == "speed-fold":
            letters = "ac" if conditions.period_fold < 0.0 else "bd"
        names |= {f"B{pairs[round(i / last * (PLACES - 1))]},{each}" for each in letters}
    return tuple(sorted(names))


def _pair(numbers: Numbers, period: float, speed: float) -> int:
    """Number of the pair of periods, counted by the shorter roots of ``F₁``."""
    shorter = PeriodCondition(Jeffcott(numbers.parameters).system).roots((1.0 - BELOW) * period)
    return (len(shorter.periods) + int(shorter.starts_below)) // 2 + 1
