"""What happens next on all flights of a patch: they return, they reach the wall, or some of them may brush it.

Let ``g = |z|²``.  Time is walked in steps on each of which ``g < 1`` is shown by Taylor's formula, or ``g' < 0``, which keeps it so.  At the
start at the wall, where ``g' ≤ 0``, it is enough that ``g' < 0`` or ``g'' < 0``.  Where no step is possible:

*Impact.*  ``g' > 0`` up to a time at which ``g > 1`` for all flights: each crosses exactly once, and none before.

*Bounce.*  ``g'' > 0`` from the wall, where ``g = 1``, to a time at which ``g > 1``, with ``g < 1`` at one before it: as ``g`` is convex, each flight is inside
until then and crosses exactly once after it.

*Brush.*  ``g'' < 0`` on a window, before which ``g < 1``, and at whose end ``g < 1`` and ``g' < 0``.  A flight that touches in the window
does so first with ``g' ≥ 0``, before the last maximum.  With ``−g'' ≤ C``, ``g`` rises above ``1`` by at least ``g'²/(2C)``, so that the radial speed
``ṙ = g'/2`` is at most ``√(C(max g − 1)/2)``.  All others go on from the end of the window.

*Return.*  ``E = |u̇ + γu/2|² + ω_d²|u|²`` of the deviation ``u`` from levitation falls as ``e^{−γt}`` and bounds ``|u| ≤ √E/ω_d``;
``|u̇|² + ω²|u|²`` does not rise and bounds ``|u|`` by its root over ``ω``.  Once one of them shows ``|u| < 1 − ℓ`` the wall is out of reach for ever.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

from flint import arb

from carom.base.outcome import CaromError
from carom.proofs.balls import hull
from carom.proofs.moments import UNIT, dot
from carom.proofs.patches import PatchDeparture

LONGEST, SHORTEST = 1.0, 1.0 / 64
"""Steps of time to begin with, and at which the wall is looked for, in ``1/Ω``."""
_START, _SCAN, _LATEST = 0.5, 0.1, 2000.0
_HALVINGS = 9
_ROUNDING = 1e-9
_LATER = 1e-5
"""What is added to the time at which energy is low enough: radii of balls have 30 bits."""


class LeftOpenError(CaromError):
    """Nothing can be shown of a patch.

    Parameters
    ----------
    reason : str
        One of :data:`REASONS`.
    weights : sequence of float
        How much each span has to do with it.
    """

    def __init__(self, reason: str, weights: tuple[float, ...] = (1.0, 1.0)) -> None:
        super().__init__(reason)
        self.reason, self.weights = reason, weights


GRAZE, SLOW, MANY, LONG = "graze", "slow impact", "many impacts", "long flight"
EARLY, OUTSIDE, RETURNS = "early contact", "outside", "both"
REASONS = {
    GRAZE: "whether flights graze the wall is not decided",
    SLOW: "an impact is slow and the wall pushes: it may be followed by chatter and lasting contact",
    MANY: "more impacts than were allowed may follow",
    LONG: "flights go on for longer than is followed",
    EARLY: "the wall may be reached while the shock lasts",
    OUTSIDE: "the rotor may not have levitated inside the wall before",
    RETURNS: "some may return and others not",
}


@dataclass(frozen=True)
class PatchReturn:
    """No flight reaches the wall again."""


@dataclass(frozen=True)
class Impact:
    """Every flight crosses between two times, and not before.

    Attributes
    ----------
    begin, end : float
    inside : float
        A time up to which all flights are inside.
    peak : float
        Time of the next maximum on the flight of the centre.
    """

    begin: float
    end: float
    inside: float
    peak: float


@dataclass(frozen=True)
class Brush:
    """Flights may touch between two times, at most with a radial speed; those that do not are inside at the end."""

    begin: float
    last: float
    end: float
    fastest: arb
    touches: bool
    misses: bool


Event = PatchReturn | Impact | Brush


def begin(departure: PatchDeparture) -> float:
    """A time at which flights that leave the wall with ``g' ≤ 0`` are inside, as they were until then; zero for those from levitation."""
    if not departure.from_wall:
        if departure.at(arb(0)).height < 1:
            return 0.0
        raise LeftOpenError(OUTSIDE, departure.weights(0.0))
    width, outward = _START, departure.wide_velocity.real * 2
    for _ in range(_HALVINGS):
        curve = departure.at(hull(0.0, width)).curve
        rise = departure.at(arb(width / 2)).rise + curve * UNIT * (width / 2)
        # Rounding may add states with g' > 0 to a patch: they need not have been inside before.
        if rise < 0 or (curve < 0 and outward + curve * width / 2 < 0):
            return width
        width /= 2
    raise LeftOpenError(SLOW, departure.weights(width))


def bounce(departure: PatchDeparture) -> Impact | None:
    """An impact before which the wall pushes all flights all the time; none if that is not shown, or they do not leave the wall."""
    if not departure.from_wall:
        return None
    _, rise, curve = departure.plain(0.0)
    if not (curve > 0 and rise < 0):
        return None
    crossing = -2 * rise / curve
    for _ in range(_HALVINGS):
        height, rate, _ = departure.plain(crossing)
        if not rate > 0:
            return None
        crossing -= (height - 1) / rate
    half = sum(map(abs, departure.plain_spread(crossing)[0])) / rate
    for factor in (1.1, 1.5, 2.2):
        low, high = crossing - factor * half - _ROUNDING, crossing + factor * half + _ROUNDING
        if low > 0 and departure.at(arb(high)).height > 1 and departure.at(arb(low)).height < 1:
            return Impact(low, high, low, high) if _holds(departure, 0.0, high, _bends, 4) else None
    return None


def _bends(departure: PatchDeparture, low: float, high: float) -> bool:
    """Whether ``g'' > 0`` between two times."""
    return bool(departure.at(hull(low, high)).curve > 0)


def next_event(departure: PatchDeparture, time: float) -> Event:
    """The next event after a time at which all flights are inside."""
    end, width, shortest = _end(departure), LONGEST, _shortest(departure, time)
    while time < end:
        if _inside(departure, time, width):
            time, width = time + width, min(2 * width, LONGEST)
        elif width > shortest:
            width /= 2
        else:
            return _joined(departure, time)
    return PatchReturn()


def _inside(departure: PatchDeparture, time: float, width: float) -> bool:
    """Whether flights that are inside at a time remain so for a while."""
    span, at = hull(time, time + width), arb(time + width / 2)
    middle, curve = departure.at(at), departure.at(span).curve
    # Not half the width: the ends are rounded.
    reach = (span - at).abs_upper()
    if middle.rise + curve * UNIT * reach < 0:
        return True
    return bool(middle.height + middle.rise * UNIT * reach + curve * hull(0, reach * reach / 2) < 1)


def _shortest(departure: PatchDeparture, time: float) -> float:
    """The step at which the wall is looked for: a disturbance that lasts changes within a part of its time."""
    lasts = float(departure.busy.mid())
    return min(SHORTEST, lasts / 16) if time < lasts else SHORTEST


def _end(departure: PatchDeparture) -> float:
    """A time after which no flight reaches the wall any more."""
    held = departure.held
    n = held.numbers
    away, speed = departure.deviation
    free = float(departure.busy.upper())
    if held.split < 0:
        turned = speed + away * held.half
        energy = (dot(turned, turned) - held.split * dot(away, away)).upper()
        allowed = -held.split * held.room * held.room
        time = max(0.0, float((energy / allowed).log().upper()) / float(n.gamma.lower())) + _LATER
        if time < _LATEST and energy * (-n.gamma * arb(time)).exp() < allowed:
            return free + time
        raise LeftOpenError(LONG, departure.weights(LONGEST))
    for k in range(int(math.log2(_LATEST))):
        time = float(2**k)
        (c, dc, _), (h, dh, _) = held.responses(arb(time))
        place, rate = away * c + speed * h, away * dc + speed * dh
        if dot(rate, rate) + n.omega_squared * dot(place, place) < n.omega_squared * held.room * held.room:
            return free + time
    raise LeftOpenError(LONG, departure.weights(LONGEST))


# ------------------------------------------------------------------------------------------------ at the wall


def _joined(departure: PatchDeparture, time: float) -> Event:
    """An impact or a brush after a time at which all flights are inside."""
    crossing, peak = _centre_meets(departure, time)
    if crossing is not None:
        impact = _impact(departure, time, crossing, peak)
        if impact is not None:
            return impact
    brush = _brush(departure, time, peak)
    if brush is None:
        raise LeftOpenError(GRAZE, departure.weights(peak))
    return brush


def brush_of(departure: PatchDeparture, impact: Impact) -> Brush | None:
    """An impact as a brush: next to a graze less is known of the impact by it, but that little may be known where the impact's is not."""
    return _brush(departure, impact.inside, impact.peak)


def _centre_meets(departure: PatchDeparture, time: float) -> tuple[float | None, float]:
    """When the flight of the centre crosses and reaches its next maximum, in doubles."""
    crossing, now = None, time
    height, rise, _ = departure.plain(now)
    if height >= 1 or rise <= 0:
        return None, now
    for _ in range(int(_LATEST)):
        later = now + _SCAN
        height, rise, _ = departure.plain(later)
        if crossing is None and height >= 1:
            crossing = _root(lambda t: departure.plain(t)[0] - 1, now, later)
        if rise <= 0:
            return crossing, _root(lambda t: -departure.plain(t)[1], now, later)
        if crossing is not None and height > 2:
            return crossing, later
        now = later
    raise LeftOpenError(LONG, departure.weights(time))


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    """Zero of a function that is negative at one end and positive at the other, by bisection."""
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if function(middle) >= 0 else (middle, high)
    return high


def _impact(departure: PatchDeparture, time: float, crossing: float, peak: float) -> Impact | None:
    rate = departure.plain(crossing)[1]
    half = sum(map(abs, departure.plain_spread(crossing)[0])) / rate if rate > 0 else math.inf
    if not half < LONGEST:
        return None
    for factor in (1.1, 1.5, 2.2):
        low, high = max(time, crossing - factor * half - _ROUNDING), crossing + factor * half + _ROUNDING
        if departure.at(arb(high)).height > 1 and (low == time or departure.at(arb(low)).height < 1):
            return Impact(low, high, time, peak) if _holds(departure, time, high, _rises) else None
    return None


def _brush(departure: PatchDeparture, time: float, peak: float) -> Brush | None:
    height, _, curve = departure.plain(peak)
    if not curve < 0:
        return None
    places, rates = (sum(map(abs, columns)) for columns in departure.plain_spread(peak))
    half = math.sqrt(max(0.0, 2 * (height + places - 1)) / -curve) + _ROUNDING
    first = _latest_inside(departure, time, peak, half)
    last = _first_falling(departure, max(first, peak), rates / -curve)
    end = None if last is None else _first_inside(departure, last, peak, half)
    if last is None or end is None:
        return None
    curves = list(_curves(departure, first, end))
    if not all(curve < 0 for curve in curves):
        return None
    least, most = min((-c).lower() for c in curves), max((-c).upper() for c in curves)
    top = departure.at(arb(min(max(peak, first), end)))
    highest = top.height + top.rise * top.rise / (2 * least)
    above = (highest - 1).upper()
    fastest = (most * above / 2).sqrt().upper() if above > 0 else arb(0)
    return Brush(first, last, end, fastest, touches=bool(above > 0), misses=not top.height > 1)


def _latest_inside(departure: PatchDeparture, time: float, peak: float, half: float) -> float:
    """A late time up to which flights that are inside at a time are still inside, as they rise."""
    for factor in (1.05, 1.3, 2.0):
        first = peak - factor * half
        if first <= time:
            return time
        if departure.at(arb(first)).height < 1 and _holds(departure, time, first, _rises):
            return first
    return time


def _first_falling(departure: PatchDeparture, peak: float, half: float) -> float | None:
    """An early time at which all flights have passed their maximum."""
    times = (peak + factor * half + _ROUNDING for factor in (1.2, 2.0, 4.0))
    return next((last for last in times if departure.at(arb(last)).rise < 0), None)


def _first_inside(departure: PatchDeparture, last: float, peak: float, half: float) -> float | None:
    """An early time after the last maximum at which all flights are inside."""
    times = (max(last, peak + factor * half) for factor in (1.05, 1.3, 2.0, 3.0))
    return next((end for end in times if departure.at(arb(end)).height < 1), None)


def _curves(departure: PatchDeparture, begin: float, end: float) -> Iterator[arb]:
    """Second derivatives of ``g`` on steps that fill an interval."""
    count = max(1, math.ceil((end - begin) / 0.25))
    cuts = [begin + (end - begin) * k / count for k in range(count)] + [end]
    for low, high in pairwise(cuts):
        yield departure.at(hull(low, high)).curve


def _rises(departure: PatchDeparture, low: float, high: float) -> bool:
    """Whether ``g' > 0`` between two times."""
    middle = 0.5 * (low + high)
    span = hull(low, high)
    late = departure.at(span).curve * (span - arb(middle))
    return bool(departure.at(arb(middle)).rise + late > 0)


def _holds(
    departure: PatchDeparture,
    low: float,
    high: float,
    shown: Callable[[PatchDeparture, float, float], bool],
    depth: int = 6,
) -> bool:
    """Whether something is shown on all parts of an interval of times."""
    if low >= high or shown(departure, low, high):
        return True
    middle = 0.5 * (low + high)
    return depth > 0 and all(
        _holds(departure, one, other, shown, depth - 1) for one, other in ((low, middle), (middle, high))
    )
