"""Whether all disturbances of a cell return to levitation, and after how many impacts at most, or all end in the stable rub."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from flint import arb

from carom.proofs.passages import EARLY, MANY, RETURNS, LeftOpenError, Return, Strike, begin, bounce, next_event
from carom.proofs.patches import Departure, Held, Patch
from carom.proofs.rub_traps import ends_in_rub
from carom.proofs.strikes import after_brush, after_strike

MOST_BRANCHES = 200
"""Patches followed for one cell."""
MOST_BOUNCES = 60
"""Impacts followed for one that ends in the rub."""


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
    return _followed(held, patch, most, lambda after: after is None)


def show_in_rub(held: Held, patch: Patch) -> None:
    """Show that all states of a patch decay to the stable rub, and so never return; :class:`LeftOpenError` if it is open."""
    _followed(held, patch, MOST_BOUNCES, lambda after: after is not None and ends_in_rub(held, after))


def _followed(held: Held, patch: Patch, most: int, is_end: Callable[[Patch | None], bool]) -> int:
    """The most impacts after which all states of a patch are at an end; ``None`` stands for flights that return."""
    ahead, found, branches = [(patch, 0)], 0, 0
    while ahead:
        start, before = ahead.pop()
        for after in _struck(held, start):
            branches += 1
            if is_end(after):
                found = max(found, before + (after is not None))
            elif after is None:
                raise LeftOpenError(RETURNS)
            elif before == most or branches > MOST_BRANCHES:
                raise LeftOpenError(MANY)
            else:
                ahead.append((after, before + 1))
                found = max(found, before + 1)
    return found


def _struck(held: Held, patch: Patch) -> Iterator[Patch | None]:
    """Patches after the next impact of all flights of a patch, and ``None`` for those that return without one."""
    departure = Departure(held, patch)
    strike = bounce(departure)
    if strike is not None:
        yield after_strike(departure, strike)
        return
    time = begin(departure)
    while True:
        event = next_event(departure, time)
        if isinstance(event, Return):
            yield None
            return
        if not departure.busy <= event.begin:
            raise LeftOpenError(EARLY, departure.weights(event.begin))
        if isinstance(event, Strike):
            yield after_strike(departure, event)
            return
        if event.touches:
            yield after_brush(departure, event)
        if not event.misses:
            return
        time = event.end
