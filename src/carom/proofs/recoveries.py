"""Whether all kicks of a cell return to levitation, and after how many impacts at most."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from flint import arb

from carom.proofs.passages import EARLY, MANY, Brush, LeftOpenError, Return, Strike, begin, next_event
from carom.proofs.patches import Departure, Held, Patch
from carom.proofs.strikes import after_brush, after_strike

MOST_BRANCHES = 200
"""Patches followed for one cell."""


def disturbed(size: tuple[Any, Any], angle: tuple[Any, Any]) -> Patch:
    """Patch of disturbances between two sizes and two angles from the direction in which the rotor levitates, as balls."""
    centre, spans = [], []
    for j, (low, high) in enumerate((size, angle)):
        sign = -1 if j else 1
        middle = ((low + high) / 2 * sign).mid()
        half = abs(high * sign - middle).max(abs(low * sign - middle)).upper().mid()
        centre.append(middle)
        spans.append([half if i == j else arb(0) for i in range(2)])
    return Patch(centre, spans, [arb(0), arb(0)])


def impacts_of(held: Held, patch: Patch, most: int) -> int:
    """Number of impacts after which all states of a patch return at most; :class:`LeftOpenError` if it is open.

    Each brush that some flights miss makes two patches of one.
    """
    ahead, found, branches = [(patch, 0)], 0, 0
    while ahead:
        start, before = ahead.pop()
        for after in _struck(held, start):
            branches += 1
            if before == most or branches > MOST_BRANCHES:
                raise LeftOpenError(MANY)
            ahead.append((after, before + 1))
            found = max(found, before + 1)
    return found


def _struck(held: Held, patch: Patch) -> Iterator[Patch]:
    """Patches after the next impact of all flights of a patch that do not return without one."""
    departure = Departure(held, patch)
    time = begin(departure)
    while True:
        event = next_event(departure, time)
        if not isinstance(event, Return) and not departure.busy <= event.begin:
            raise LeftOpenError(EARLY, departure.weights(event.begin))
        if isinstance(event, Strike):
            yield after_strike(departure, event)
        elif isinstance(event, Brush) and event.touches:
            yield after_brush(departure, event)
        if not (isinstance(event, Brush) and event.misses):
            return
        time = event.end
