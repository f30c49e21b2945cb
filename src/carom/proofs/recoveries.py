"""Whether all kicks of a cell return to levitation, and after how many impacts at most."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from flint import arb

from carom.proofs.passages import MANY, SLOW, Brush, Event, LeftOpenError, Strike, begin, brush_of, next_event
from carom.proofs.patches import Departure, Held, Patch
from carom.proofs.series import hull
from carom.proofs.strikes import after_brush, after_strike, patch_of

MOST_BRANCHES = 200
"""Patches followed for one cell."""
_Ahead = tuple[Patch, int, tuple[float, ...] | None]
"""A patch, the impacts before it, and how much each span had to do with the brush that it comes from."""


def kicked(
    speed: tuple[Any, Any], angle: tuple[Any, Any], units: tuple[Any, Any] = (1, 1), moves: Sequence[Any] = ()
) -> Patch:
    """Patch of kicks between two speeds and two angles from the direction in which the rotor levitates, as balls.

    Rotors of a box may not share the unit of the speeds: ``units`` are those of the rotor in the middle and of all of them, and ``moves`` its
    derivatives by the parameters, times half their widths.
    """
    middles = [(low + high) / 2 for low, high in (speed, angle)]
    halves = [abs(high - x).max(abs(low - x)) for (low, high), x in zip((speed, angle), middles, strict=True)]
    zero = arb(0)
    columns = [[halves[0] * units[1], zero], [zero, halves[1]], *([hull(*speed) * move, zero] for move in moves)]
    patch = patch_of([middles[0] * units[0], -middles[1]], columns, [zero, zero], len(columns))
    # Nothing else moves along these two: they hold what was rounded too.
    for j, rest in enumerate(patch.rest):
        patch.spans[j][j] = (patch.spans[j][j] + rest).upper().mid()
    return replace(patch, rest=[zero, zero])


def impacts_of(held: Held, patch: Patch, most: int) -> int:
    """Number of impacts after which all states of a patch return at most; :class:`LeftOpenError` if it is open.

    Each brush that some flights miss makes two patches of one.
    """
    ahead: list[_Ahead] = [(patch, 0, None)]
    found, branches = 0, 0
    while ahead:
        start, before, touched = ahead.pop()
        try:
            for after, weights in _struck(held, start):
                branches += 1
                if before == most or branches > MOST_BRANCHES:
                    raise LeftOpenError(MANY)
                ahead.append((after, before + 1, weights))
                found = max(found, before + 1)
        except LeftOpenError as problem:
            # How slow a touch may be is a matter of how wide the patch was in it, which its spans do not tell any more.
            weights = touched if touched and problem.reason == SLOW else problem.weights
            raise LeftOpenError(problem.reason, weights) from None
    return found


def _struck(held: Held, patch: Patch) -> Iterator[tuple[Patch, tuple[float, ...] | None]]:
    """Patches after the next impact of all flights of a patch that do not return without one.

    After a brush with how much each span had to do with it.
    """
    departure = Departure(held, patch)
    time = begin(departure)
    while True:
        event: Event | None = next_event(departure, time)
        if isinstance(event, Strike):
            try:
                yield after_strike(departure, event), None
            except LeftOpenError:
                event = brush_of(departure, event)
                if event is None:
                    raise
        if isinstance(event, Brush) and event.touches:
            yield after_brush(departure, event), departure.weights(event.last)
        if not (isinstance(event, Brush) and event.misses):
            return
        time = event.end
