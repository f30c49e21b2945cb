"""Whether all disturbances of a cell return to levitation, and after how many impacts at most, or all end in the stable rub.

States after an impact follow, by mean value forms, from a patch of flights and the times at which they reach the wall.  At the wall ``a = Re(z̄ż)``, ``b = Im(z̄ż)`` and ``ψ⁺ = ψ + t − arg z``.  An impact changes them to

    a⁺ = −d a,      b⁺ = b − clip(s + b, ±f),      f = μ(1 + d)a :

slip ``s + b`` keeps its direction while it exceeds ``f``, else it stops.  ``clip`` has the slopes ``(∂/∂b, ∂/∂f)``
``(0, 1)``, ``(1, 0)`` and ``(0, −1)`` where slip goes on forward, stops, and goes on backward; on a patch whose case is not
decided it lies in the hull of those that are possible, as a mean value form of a Lipschitz function may take.

*Impact.*  With the crossing time ``t(x)``, ``|z(t(x), x)| = 1``, derivatives along a column are total ones, ``t' = −Re(z̄z')/Re(z̄ż)``.

*Brush.*  Time is one more column, and of ``a`` only ``0 ≤ a ≤ p`` is known.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from flint import arb

from carom.proofs.balls import hull
from carom.proofs.bends import bent, remainder, second_derivatives
from carom.proofs.moments import FORM, UNIT, Moment, cross, dot, spread
from carom.proofs.passages import (
    EARLY,
    GRAZE,
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

Columns = list[list[arb]]
MOST_SPANS = 14
"""Spans that a patch keeps at most."""


def after_impact(departure: PatchDeparture, impact: Impact) -> Patch:
    """Patch after the impact; :class:`LeftOpenError` where the radial speed is not known to be positive."""
    window = hull(impact.begin, impact.end)
    moment = departure.at(window)
    if not moment.slope > 0:
        raise LeftOpenError(GRAZE, departure.weights(impact.end))
    time, directions = _crossing(departure, window), departure.patch.directions
    if departure.held.sides:
        # Second derivatives by parameters are not known.
        columns, centre = _columns(moment), _at_wall(departure, departure.at(time), time)
        if not centre[0] + spread([column[0] for column in columns]) > 0:
            raise LeftOpenError(GRAZE, departure.weights(impact.end))
        return _reset(departure, centre, columns, [arb(0)] * 3)
    middle = PatchDeparture(departure.held, departure.patch, alone=True).at(time)
    columns, drift = _columns(middle), []
    for j, squares in enumerate(second_derivatives(departure, time, window)):
        for column, term in zip(columns[2:FORM], bent(directions, squares), strict=True):
            column[j] = column[j] + term
        drift.append(remainder(directions, squares) * UNIT)
    centre = _at_wall(departure, middle, time)
    if not centre[0] + spread([column[0] for column in columns]) + drift[0] > 0:
        raise LeftOpenError(GRAZE, departure.weights(impact.end))
    return _reset(departure, centre, columns, drift)


def _columns(moment: Moment) -> Columns:
    """The state at the wall differentiated along the columns, at the times of a moment at which flights cross."""
    place, rate, bend = moment.wide
    rates = moment.curve / 2, cross(place, bend), 1 - cross(place, rate)
    columns: Columns = []
    along = moment.height_along, moment.rise_along, moment.twist_along, moment.angle_along(arb(1))
    for height, *fixed in zip(*along, strict=True):
        late = -height / moment.slope
        columns.append([x + late * y for x, y in zip(fixed, rates, strict=True)])
    return columns


def after_brush(departure: PatchDeparture, brush: Brush) -> Patch:
    """Patch after a touch."""
    window = hull(brush.begin, brush.last)
    moment, middle = departure.at(window), window.mid()
    place, rate, bend = moment.wide
    square = dot(place, place)
    along = moment.twist_along, moment.angle_along(square)
    columns: Columns = [[arb(0), twist, angle] for twist, angle in zip(*along, strict=True)]
    late = window - middle
    drift = [brush.fastest * UNIT / 2, cross(place, bend) * late, (1 - cross(place, rate) / square) * late]
    centre = _at_wall(departure, departure.at(middle), middle)
    return _reset(departure, [brush.fastest / 2, *centre[1:]], columns, drift)


def _crossing(departure: PatchDeparture, window: arb) -> arb:
    """Time at which the flight of the centre crosses, by one step of Newton's method on an interval."""
    guess = float(window.mid())
    for _ in range(8):
        height, rise, _ = departure.plain(guess)
        guess -= (height - 1) / rise
    guess = min(max(guess, float(window.lower())), float(window.upper()))
    near = departure.at(arb(guess))
    z = near.centre(0)
    far = departure.at(window)
    slope = dot(far.centre(0), far.centre(1)) * 2
    return (arb(guess) - (dot(z, z) - 1) / slope).intersection(window)


def _at_wall(departure: PatchDeparture, moment: Moment, time: arb) -> list[arb]:
    """``a``, ``b`` and ``ψ`` of the flight of the centre."""
    z, dz = moment.centre(0), moment.centre(1)
    # Away from the cut of the argument on the negative axis.
    angle = z.log().imag if z.real > 0 else (-z).log().imag + arb.pi()
    return [dot(z, dz), cross(z, dz), departure.patch.centre[-1] + time - angle]


def _reset(departure: PatchDeparture, centre: list[arb], columns: Columns, drift: list[arb]) -> Patch:
    """Patch after the impact of states ``a, b, ψ`` before it."""
    held = departure.held
    wide = [x + spread([column[j] for column in columns]) + drift[j] for j, x in enumerate(centre)]
    stops, goes = _slip_slopes(held.numbers.radius_ratio + wide[1], held.grip * wide[0])
    middle = held.middle.numbers
    slip, most = middle.radius_ratio + centre[1], held.middle.grip * centre[0]
    kept = slip - slip.min(most).max(-most)
    start = [-middle.d * centre[0], kept - middle.radius_ratio, centre[2]]

    def through(x: list[arb]) -> list[arb]:
        return [-held.numbers.d * x[0], (1 - stops) * x[1] - goes * held.grip * x[0], x[2]]

    after = [through(column) for column in columns]
    for j, side in enumerate(held.sides, FORM):
        # The law of the impact depends on the parameters by itself.
        after[j][0] = after[j][0] - side.restitution * wide[0]
        after[j][1] = after[j][1] - stops * side.rim - goes * side.grip * wide[0]
    return patch_of(start, after, through(drift), FORM + len(held.sides))


def _slip_slopes(slip: arb, grip: arb) -> tuple[arb, arb]:
    """Slopes of ``clip`` by the slip and by what friction can take of it."""
    if slip > grip:
        return arb(0), arb(1)
    if slip < -grip:
        return arb(0), arb(-1)
    if abs(slip) < grip:
        return arb(1), arb(0)
    return hull(0, 1), UNIT


def patch_of(centre: list[arb], columns: Columns, drift: list[arb], first: int) -> Patch:
    """Patch with exact numbers that holds all states of mean value forms; the first columns keep their places, small ones are taken together."""
    kept, small = columns[:first], sorted(columns[first:], key=lambda column: -_length(column))
    kept, small = kept + small[: MOST_SPANS - first], small[MOST_SPANS - first :]
    rest = []
    for j, x in enumerate(centre):
        # Half widths of the balls of the spans count once for each: a factor of at most 1 stands before them.
        total = sum((arb(column[j].rad()) for column in kept), arb(x.rad()) + abs(drift[j]))
        rest.append(sum((abs(column[j]) for column in small), total).upper().mid())
    return Patch([x.mid() for x in centre], [[x.mid() for x in column] for column in kept], rest)


def _length(column: list[arb]) -> float:
    return sum(abs(float(x.mid())) for x in column)


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
