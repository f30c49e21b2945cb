"""Whether all disturbances of a cell return to levitation, and after how many impacts at most, or all end in the stable rub."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from flint import arb

from carom.proofs.impacts import after_brush, after_impact, patch_of
from carom.proofs.moments import FORM
from carom.proofs.passages import (
    EARLY,
    MANY,
    RETURNS,
    SLOW,
    Brush,
    Impact,
    LeftOpenError,
    PatchReturn,
    begin,
    bounce,
    brush_of,
    next_event,
)
from carom.proofs.patches import Held, Patch, PatchDeparture
from carom.proofs.rub_traps import ends_in_rub
from carom.proofs.series import hull

MOST_BRANCHES = 200
"""Patches followed for one cell."""
_Ahead = tuple[Patch, int, tuple[float, ...] | None]
"""A patch, the impacts before it, and how much each span had to do with the brush that it comes from."""
MOST_BOUNCES = 60
"""Impacts followed for one that ends in the rub."""


def disturbed(size: tuple[arb, arb], angle: tuple[arb, arb]) -> Patch:
    """Patch of disturbances between two sizes and two angles from the direction in which the rotor levitates, as balls."""
    centre, spans = [], []
    for j, (low, high) in enumerate((size, angle)):
        sign = -1 if j else 1
        middle = ((low + high) / 2 * sign).mid()
        half = abs(high * sign - middle).max(abs(low * sign - middle)).upper().mid()
        centre.append(middle)
        spans.append([half if i == j else arb(0) for i in range(2)])
    return Patch(centre, spans, [arb(0), arb(0)])


def disturbed_in_box(
    share: tuple[arb, arb], angle: tuple[arb, arb], units: tuple[arb, arb], moves: Sequence[arb]
) -> Patch:
    """The same for a box of rotors, the sizes as shares of a largest one.

    ``units`` are the largest size of the rotor in the middle and of all of them, ``moves`` its derivatives by the parameters, times half their
    widths.
    """
    middles = [(low + high) / 2 for low, high in (share, angle)]
    halves = [abs(high - x).max(abs(low - x)) for (low, high), x in zip((share, angle), middles, strict=True)]
    zero = arb(0)
    columns = [[halves[0] * units[1], zero], [zero, halves[1]], *([zero, zero] for _ in range(FORM - 2))]
    columns += [[hull(*share) * move, zero] for move in moves]
    patch = patch_of([middles[0] * units[0], -middles[1]], columns, [zero, zero], len(columns))
    # Nothing else moves along the first two: they hold what was rounded too.
    for j, rest in enumerate(patch.rest):
        patch.spans[j][j] = (patch.spans[j][j] + rest).upper().mid()
    return replace(patch, rest=[zero, zero])


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
    ahead: list[_Ahead] = [(patch, 0, None)]
    found, branches = 0, 0
    while ahead:
        start, before, touched = ahead.pop()
        try:
            for after, weights in _after_impacts(held, start):
                branches += 1
                if is_end(after):
                    found = max(found, before + (after is not None))
                elif after is None:
                    raise LeftOpenError(RETURNS)
                elif before == most or branches > MOST_BRANCHES:
                    raise LeftOpenError(MANY)
                else:
                    ahead.append((after, before + 1, weights))
                    found = max(found, before + 1)
        except LeftOpenError as problem:
            # How slow a touch may be is a matter of how wide the patch was in it, which its spans do not tell any more.
            shown = touched if touched and problem.reason == SLOW else problem.weights
            raise LeftOpenError(problem.reason, shown) from None
    return found


def _after_impacts(held: Held, patch: Patch) -> Iterator[tuple[Patch | None, tuple[float, ...] | None]]:
    """Patches after the next impact of all flights of a patch, and ``None`` for those that return without one.

    After a brush with how much each span had to do with it.
    """
    departure = PatchDeparture(held, patch)
    impact = bounce(departure)
    if impact is not None:
        yield after_impact(departure, impact), None
        return
    time = begin(departure)
    while True:
        event = next_event(departure, time)
        if isinstance(event, PatchReturn):
            yield None, None
            return
        _check_free(departure, event)
        brush = event if isinstance(event, Brush) else _impact_or_brush(departure, event)
        if isinstance(brush, Patch):
            yield brush, None
            return
        if brush.touches:
            yield after_brush(departure, brush), departure.weights(brush.last)
        if not brush.misses:
            return
        time = brush.end


def _impact_or_brush(departure: PatchDeparture, impact: Impact) -> Patch | Brush:
    """The patch after an impact; where that is not known the impact as a brush."""
    try:
        return after_impact(departure, impact)
    except LeftOpenError:
        brush = brush_of(departure, impact)
        if brush is None:
            raise
        _check_free(departure, brush)
        return brush


def _check_free(departure: PatchDeparture, event: Impact | Brush) -> None:
    """Refuse an impact before motion is free."""
    if not departure.busy <= event.begin:
        raise LeftOpenError(EARLY, departure.weights(event.begin))
