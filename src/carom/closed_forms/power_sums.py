"""All positive roots of a sum of real powers."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping

from carom.continuation.roots import bracketed_root

FARTHEST = 1e150
"""Largest argument at which a sum is evaluated."""


def positive_roots(terms: Mapping[float, float]) -> list[float]:
    """All simple positive roots of ``Σ a xᵉ``, in ascending order, from the coefficient ``a`` of each exponent ``e``.

    Divided by its lowest power, the sum has a constant term, and its derivative a term less.  Between neighbouring roots of
    the derivative, which are found in the same way, it is monotone and has at most one root (Rolle).  A root that the
    derivative shares, to rounding, may be missed: two rubs that meet in a fold.
    """
    kept = sorted((exponent, factor) for exponent, factor in terms.items() if factor != 0.0)
    if len(kept) < 2:
        return []
    lowest = kept[0][0]
    shifted = {exponent - lowest: factor for exponent, factor in kept}
    turns = positive_roots({exponent - 1.0: exponent * factor for exponent, factor in shifted.items() if exponent})

    def value(x: float) -> float:
        return math.fsum(factor * x**exponent for exponent, factor in shifted.items())

    edges = [0.0, *turns, _beyond(kept)]
    found = []
    for low, high in itertools.pairwise(edges):
        if low < high and value(low) * value(high) < 0.0:
            found.append(float(bracketed_root(value, low, high)))
    return found


def _beyond(kept: list[tuple[float, float]]) -> float:
    """Argument from which on the highest power outweighs all others together."""
    (*others, (highest, leading)) = kept
    reach = 1.0
    while reach < FARTHEST:
        if sum(abs(factor) * reach ** (exponent - highest) for exponent, factor in others) < abs(leading):
            break
        reach *= 2.0
    return reach
