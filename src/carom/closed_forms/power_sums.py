"""All positive roots of a sum of real powers."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import pairwise

from carom.base.roots import bracketed_root

FARTHEST = 1e6
"""Number up to which roots are searched: no wall is that many clearances deep."""


def positive_roots(terms: Iterable[tuple[float, float]]) -> list[float]:
    """All positive roots of ``Σ a xᵉ``, in ascending order, from pairs ``(e, a)``.

    Divided by its lowest power, the sum has a constant term, and its derivative a term less.  Between neighbouring roots of
    the derivative, which are found in the same way, it is monotone and has at most one root (Rolle).  Two roots that meet are
    found or missed by rounding.
    """
    return _roots(_gathered(terms))


def _gathered(terms: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
    """Terms by growing power, each power once, without zeros."""
    total: dict[float, float] = {}
    for power, factor in terms:
        total[power] = total.get(power, 0.0) + factor
    return [(power, total[power]) for power in sorted(total) if total[power] != 0.0]


def _roots(terms: list[tuple[float, float]]) -> list[float]:
    """:func:`positive_roots` of terms that are gathered."""
    if len(terms) < 2:
        return []
    lowest = terms[0][0]
    terms = [(power - lowest, factor) for power, factor in terms]

    def total(x: float) -> float:
        return math.fsum(factor * x**power for power, factor in terms)

    turns = _roots([(power - 1.0, factor * power) for power, factor in terms[1:]])
    ends = [0.0, *turns, _beyond(terms)]
    found = [turn for turn in turns if total(turn) == 0.0]
    found += [
        bracketed_root(total, *between) for between in pairwise(ends) if total(between[0]) * total(between[1]) < 0.0
    ]
    return sorted(found)


def _beyond(terms: list[tuple[float, float]]) -> float:
    """A number beyond all roots: there the last term exceeds each of the others as many times as there are."""
    *others, (highest, factor) = terms
    rooms = (math.log(len(others) * abs(other / factor)) / (highest - power) for power, other in others)
    return 2.0 * math.exp(min(max(rooms), math.log(FARTHEST)))
