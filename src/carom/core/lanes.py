"""Many motions of a rotor with one pair of modes side by side.

Each lane holds a motion in free flight.  :func:`fly_lanes` advances every lane by one block of flight, with the proofs
of :mod:`carom.core.events`, or up to and through its next impact.  A lane in which nothing can be proved, or which
needs more than a plain flight and a plain impact, is left unchanged and marked; :mod:`carom.core.ensemble` then treats
it by itself.

Lanes do not affect each other.  All execute the same instructions (:mod:`carom.core.vector`), except for two branches
that save work and change no bit.  So a motion is the same to the last bit whatever motions the other lanes hold.
"""

from __future__ import annotations

import numpy as np

from carom.core.advance import CHATTER_HEIGHT, flies
from carom.core.compiling.decorators import inlined, kernel
from carom.core.events import MARGIN
from carom.core.flow import acceleration, displacement, squared_modulus, velocity
from carom.core.friction import velocity_change
from carom.core.lane_search import departure, examine, halley_ratio, look_up, travel
from carom.core.layout import DEGREE, LANES, LEVELS, WIDTH
from carom.core.records import record
from carom.core.vector import align_stack, fma, join, lanes_of, load, store, where
from carom.core.wall import rigid_wall

CLEARED, STRUCK, NOTED, LATE, OPEN = 0.0, 1.0, 2.0, 3.0, 4.0
"""What happened to a lane.

In this order: a free block of flight; an impact; an impact to be checked for recurrence; nothing, because the time
limit would be exceeded; nothing, because the block proved nothing (a shorter one is tried next, if there is one).
"""

CLEARLY_OFF = 1e-9
"""Speed away from the wall that is certainly not zero, given the rounding of a state of moderate size."""
LOWEST = 4.0 * CHATTER_HEIGHT
"""Twice the height, with a margin, below which bounces are left to the loop of single motions."""
REACH = 0.75
"""Distance from a node, in spacings, up to which the truncation error of the power series is below rounding."""
ROUGH_TERMS = 6
"""Number of terms that suffice for the first step to the root."""
STEADY = 2e-6
"""Value of ``|f| M₂/f'²`` below which a root is proven to be near (:data:`carom.core.events.POLISHED`).

A Halley step from there errs by the third power of it, in ``f``.
"""
BRIEF = 1e-4
"""Length of that step, in spacings of the nodes for lanes, below which it and the quadratic nudge are exact to rounding.

A spacing is at most ``5.3/31`` of the time ``1/|λ|`` of the faster mode.
"""

_STATE = ("lower_re", "lower_im", "upper_re", "upper_im", "level", "clock", "depth")
_SETTLING = (
    "quiet", "due", "watched",
    "reference_lower_re", "reference_lower_im", "reference_upper_re", "reference_upper_im", "reach",
)  # fmt: skip
_ANSWER = ("verdict", "end_lower_re", "end_lower_im", "end_upper_re", "end_upper_im")
_BOOK = ("motion", "contact", "events", "impacts", "stalled", "calm", "seen", "since", "renewal", "candidate", "rubbed")


def lanes_record() -> np.record:
    """Record of all lanes; every field has one number per lane, except for the last two, which are scratch arrays.

    - ``lower`` and ``upper`` are the amplitudes of the driving and the driven mode, with the exponents ``λ₋`` and
      ``λ₊``.
    - ``level`` is ``|y|² − 1``, zero on the wall; ``clock`` is the time.
    - ``depth`` is the first block to try; LEVELS or more if none is left.
    - ``quiet`` counts plain impacts.  An impact is NOTED instead when ``due`` is reached, or when the state is within
      ``reach`` of the ``reference``.
    - ``watched`` lanes are examined after each free block.
    - ``verdict`` says what happened last; ``end`` is the state just before an impact.
    - The integers belong to :mod:`carom.core.ensemble`: number of the motion, its state of contact, events, impacts, events
      without progress, free blocks, and the values that :func:`carom.core.settling.memory` holds for it besides the
      ``reference``.
    """
    return record(
        **{name: np.zeros(LANES) for name in (*_STATE, *_SETTLING, *_ANSWER)},
        **{name: np.zeros(LANES, np.int64) for name in _BOOK},
        polynomial=np.zeros((DEGREE, WIDTH)),
        factors=np.zeros((DEGREE + 1, WIDTH)),
    )


@kernel
def fly_lanes(rotor, table, until, lanes):
    """Advance every lane by a block of flight or an impact; return the lanes that must be examined afterwards, as bits.

    The rotor is one of :func:`~carom.models.from_modes.second_order_system`.
    """
    align_stack()
    looks = 0
    for first in range(0, LANES, WIDTH):
        looks |= _fly(rotor, table, until, first, lanes) << first
    return looks


@inlined
def _fly(rotor, table, until, first, lanes):
    """Find and certify the first crossing of WIDTH lanes, and advance them; return the lanes to examine, as bits."""
    lower = _load_complex(lanes.lower_re, lanes.lower_im, first)
    upper = _load_complex(lanes.upper_re, lanes.upper_im, first)
    start = departure(rotor, table, lower, upper, load(lanes.level, first))
    depth = where(_leaves(rotor, start), load(lanes.depth, first), float(LEVELS))
    search = examine(table, depth, start, lanes.polynomial, lanes.factors)
    node = look_up(rotor, table, start, search.guess)
    reach = table.lane_spacing * REACH
    rest = _first_step(rotor, table, start, search, node, reach)
    lower, upper, rates, (value, slope, bend) = travel(rotor, table, start, node, rest, table.terms)
    step = _halley_step(value, slope, bend)
    time = node.time + (rest + step)
    error, square = start.floor + search.growth * time, slope * slope
    certified = (
        (slope > 0.0) & (square > error * start.curvature * MARGIN) & (abs(rest) <= reach)
        & (abs(value) * start.curvature < STEADY * square) & (abs(step) < table.lane_spacing * BRIEF)
        & (time > 0.0) & (time <= search.duration)
    )  # fmt: skip
    free, impacting = search.decides & search.free, search.decides & ~search.free & certified
    lower, upper = _nudged(where(impacting, step, 0.0), lower, upper, rates, rotor.exponents[0])
    end = load(lanes.clock, first) + where(impacting, time, search.duration)
    return _move_on(rotor, until, first, lanes, start, depth, free, impacting, end, lower, upper)


@inlined
def _move_on(rotor, until, first, lanes, start, depth, free, impacting, end, lower, upper):
    """Store the end of a free block or the state after an impact; return the lanes to examine, as bits."""
    decided = free | impacting
    late = end > until
    moves, impacts = decided & ~late, impacting & ~late
    position = upper + rotor.offsets[0]
    beyond = squared_modulus(position) - 1.0
    speed = fma(upper, rotor.exponents[1], lower)
    # Put the displacement exactly on the wall; the velocity stays.
    upper = upper - position * where(impacting, 0.5 * beyond, 0.0)
    wall = rigid_wall(rotor.friction[0], rotor.restitution[0], rotor.surface_speed[0])
    after = lower + position * velocity_change(position.conjugate() * speed, wall)
    quiet = load(lanes.quiet, first)
    noted = impacts & (_near_reference(lower, upper, first, lanes) | (quiet + 1.0 >= load(lanes.due, first)))
    plain = impacts & ~noted
    stays = where(decided, LATE, OPEN)
    store(lanes.verdict, first, where(moves, where(free, CLEARED, where(noted, NOTED, STRUCK)), stays))
    store(lanes.quiet, first, where(plain, quiet + 1.0, quiet))
    store(lanes.clock, first, where(moves, end, load(lanes.clock, first)))
    # Low bounces come in series: try the block first that worked for the last one.
    store(lanes.depth, first, where(decided, where(impacting, depth, 0.0), depth + 1.0))
    store(lanes.level, first, where(impacts, 0.0, where(moves, beyond, start.level)))
    _store_complex(lanes.end_lower_re, lanes.end_lower_im, first, lower)
    _store_complex(lanes.end_upper_re, lanes.end_upper_im, first, upper)
    _store_complex(lanes.lower_re, lanes.lower_im, first, where(impacts, after, where(moves, lower, start.lower)))
    _store_complex(lanes.upper_re, lanes.upper_im, first, where(moves, upper, start.upper))
    watched = load(lanes.watched, first) > 0.0
    return lanes_of(~(plain | (free & moves & ~watched) | (~decided & (depth < LEVELS - 1.0))))


@inlined
def _leaves(rotor, start):
    """Whether a start on the wall leaves it for a flight that is high enough for lanes; true for a start inside."""
    slow, fast = rotor.exponents[0], rotor.exponents[1]
    speed = fma(start.upper, fast, start.lower)
    inward = -(start.position.conjugate() * speed).real
    # Half of the bound of f'' bounds the acceleration towards the wall.
    leaves = (start.level < 0.0) | ((inward > CLEARLY_OFF) & (inward * inward > start.curvature * (0.5 * LOWEST)))
    if lanes_of(~leaves) != 0:
        leaves = leaves | flies(
            start.position, speed, fma(speed, fast, start.lower * slow), CLEARLY_OFF, CHATTER_HEIGHT
        )
    return leaves


@inlined
def _first_step(rotor, table, start, search, node, reach):
    """Time from the node after a first step towards the root."""
    rest = search.guess - node.time
    _, _, _, (value, slope, bend) = travel(rotor, table, start, node, rest, ROUGH_TERMS)
    step = _halley_step(value, slope, bend)
    # Discard a step out of the range of the series, a NaN, and a step in a lane that is free.
    return rest + where(~search.free & (abs(rest + step) <= reach), step, 0.0)


@inlined
def _halley_step(value, slope, bend):
    above, below = halley_ratio(value, slope, 0.5 * bend)
    return -above / below


@inlined
def _load_complex(real, imag, first):
    return join(load(real, first), load(imag, first))


@inlined
def _store_complex(real, imag, first, values):
    store(real, first, values.real)
    store(imag, first, values.imag)


@inlined
def _nudged(time, lower, upper, rates, exponent):
    """Amplitudes a very short time later."""
    rate, speed, force = rates
    half = 0.5 * time
    return lower + (rate + rate * exponent * half) * time, upper + (speed + force * half) * time


@inlined
def _near_reference(lower, upper, first, lanes):
    """Whether a state may recur (:func:`carom.core.settling.recurs`): a cheap condition that is necessary for it."""
    away = abs(lower.real - load(lanes.reference_lower_re, first)) + abs(
        upper.real - load(lanes.reference_upper_re, first)
    )
    return away <= load(lanes.reach, first)


@inlined
def surely_flies(rotor, amplitudes):
    """Whether a state on the wall leaves it for a flight that is high enough for lanes."""
    position, speed = displacement(rotor, 0, amplitudes), velocity(rotor, 0, amplitudes)
    return flies(position, speed, acceleration(rotor, 0, amplitudes), CLEARLY_OFF, CHATTER_HEIGHT)
