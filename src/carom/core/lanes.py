"""Sixteen motions of a rotor with one pair of modes side by side, as one stream of vector instructions.

Each lane holds a motion in free flight.  :func:`fly_lanes` takes every lane one block of flight on, with the proofs of
:mod:`carom.core.events`, or up to and through its next impact.  What cannot be proven here, and everything but a plain
flight and a plain impact, is left as it was and marked, for :mod:`carom.core.ensemble` to look at singly.

A lane never sees another: all of them go through the same instructions, so a motion is the same to the last bit whatever
its company.  The loops over lanes are free of branches and calls, and what they read beside lanes is read before them:
only then does the compiler turn them into vector instructions.
"""

from __future__ import annotations

import numpy as np

from carom.core.events import POLISHED, householder_step
from carom.core.fate import NEAR
from carom.core.flow import acceleration, displacement, velocity
from carom.core.lane_search import (
    derivatives,
    examine,
    load_products,
    look_up_nodes,
    moved,
    step_towards_root,
    sum_all_series,
)
from carom.core.layout import DEGREE, LANES, LEVELS, kernel, part, record

__all__ = ["CLEARED", "LATE", "NOTED", "OPEN", "STRUCK", "TOUCHING", "fly_lanes", "lanes_record", "surely_flies"]

CLEARED, STRUCK, NOTED, TOUCHING, LATE, OPEN = 0.0, 1.0, 2.0, 3.0, 4.0, 5.0
"""What happened to a lane: a free block of flight; an impact; an impact whose recurrence is to be looked at; an impact after
which the wall has to be watched; none, because time would run out; none, because nothing could be proven."""

CLEARLY_OFF = 1e-9
"""Speed off the wall that is no rest, whatever the rounding of a state of moderate size."""
LOWEST = 4.0 * 1e-13
"""Twice :data:`carom.core.advance.CHATTER_HEIGHT`, with room: lower bounces are for the loop of single motions."""
NEARBY = 1.5 * NEAR
"""The distance of :func:`carom.core.fate.same_state` in the sum of absolute parts, which is at most √2 as large."""
REACH = 0.75
"""Distance from a node, in spacings, to which the power series serve: their first missing term is below rounding."""
THIRD = 1.0 / 3.0

_STATE = ("lower_re", "lower_im", "upper_re", "upper_im", "level", "clock")
_FATE = (
    "quiet", "due", "watched",
    "reference_lower_re", "reference_lower_im", "reference_upper_re", "reference_upper_im",
)  # fmt: skip
_ARRIVAL = ("arrival_lower_re", "arrival_lower_im", "arrival_upper_re", "arrival_upper_im")
_BOOKS = ("motion", "plane", "events", "struck", "stalled", "seen", "since", "renewal", "candidate", "rubbed")
_WORK = (
    "floor", "share", "curvature", "square", "duration", "depth", "open", "free", "guess", "rest", "verdict",
    "decay_re", "decay_im", "growth_re", "growth_im", "response_re", "response_im",
)  # fmt: skip


def lanes_record() -> np.record:
    """Lanes; every field has one number per lane.

    ``lower`` and ``upper`` are the amplitudes of the driving and the driven mode, with the exponents ``λ₋`` and ``λ₊``;
    ``level`` is ``|y|² − 1``, zero on the wall; ``clock`` counts time.  ``depth`` is the first block to try.  A plain
    impact adds to ``quiet``; it is to be NOTED when ``due`` is reached or the state is near the ``reference``.  The whole
    numbers are books of :mod:`carom.core.ensemble`: the motion held, its events, impacts, events without progress, and,
    with the ``reference``, what :func:`carom.core.fate.memory` holds of it.
    """
    numbers = {name: np.zeros(LANES) for name in (*_STATE, *_FATE, *_ARRIVAL, *_WORK)}
    return record(
        **numbers,
        products=np.zeros((8, LANES)),
        polynomial=np.zeros((DEGREE, LANES)),
        series=np.zeros((6, LANES)),
        **{name: np.zeros(LANES, np.int64) for name in ("node", *_BOOKS)},
    )


@kernel
def fly_lanes(rotor, table, until, lanes):
    """Take every lane a block of flight or an impact on; how many need a look afterwards (verdicts above STRUCK).

    The rotor is one of :func:`~carom.rotors.second_order_record`.
    """
    load_products(rotor, table, lanes)
    undecided = examine(table, 0, lanes)
    for depth in range(1, LEVELS):
        if undecided > 0:
            undecided = examine(table, depth, lanes)
    look_up_nodes(table, lanes)
    sum_all_series(table, lanes)
    step_towards_root(rotor, table.spacing, lanes)
    sum_all_series(table, lanes)
    return _arrive(rotor, table.spacing, until, lanes)


@part
def _arrive(rotor, spacing, until, lanes):
    """Polish each root, certify it and apply the impact; how many lanes need a look."""
    offset, lower, upper = rotor.offsets[0], rotor.exponents[0], rotor.exponents[1]
    offset_re, offset_im = offset.real, offset.imag
    lower_re, lower_im, upper_re, upper_im = lower.real, lower.imag, upper.real, upper.imag
    friction, restitution, drive = rotor.friction[0], rotor.restitution[0], rotor.drive[0]
    reach = REACH * spacing
    looks = 0
    for lane in range(LANES):
        rest, guess, level, clock = lanes.rest[lane], lanes.guess[lane], lanes.level[lane], lanes.clock[lane]
        b0_re, b0_im = lanes.lower_re[lane], lanes.lower_im[lane]
        a0_re, a0_im = lanes.upper_re[lane], lanes.upper_im[lane]
        b_re, b_im, change_re, change_im = moved(lanes, lane)
        a_re, a_im = a0_re + change_re, a0_im + change_im
        value, slope, bend, third = derivatives(
            offset_re + a0_re, offset_im + a0_im, level, change_re, change_im, b_re, b_im, a_re, a_im,
            lower_re, lower_im, upper_re, upper_im,
        )  # fmt: skip
        step = householder_step(value, slope, bend, third)
        time, duration = guess + step, lanes.duration[lane]
        found, free = lanes.open[lane] == 0.0, lanes.free[lane] > 0.0
        certified = (
            (slope > 0.0) & (slope * slope > lanes.square[lane]) & (abs(step) * lanes.curvature[lane] < POLISHED * slope)
            & (abs(rest) <= reach) & (time > 0.0) & (time <= duration)
        )  # fmt: skip
        free = free & found
        strikes = certified & found & ~free
        step = step if strikes else 0.0
        spent = time if strikes else duration
        b_re, b_im, a_re, a_im = _nudged(step, b_re, b_im, a_re, a_im, lower_re, lower_im, upper_re, upper_im)
        y_re, y_im = offset_re + a_re, offset_im + a_im
        beyond = (y_re * y_re + y_im * y_im) - 1.0
        # The displacement goes on to the wall, the velocity stays.
        speed_re, speed_im = b_re + (upper_re * a_re - upper_im * a_im), b_im + (upper_re * a_im + upper_im * a_re)
        excess = 0.5 * beyond if strikes else 0.0
        a_re, a_im = a_re - excess * y_re, a_im - excess * y_im
        change_re, change_im = _rebound(y_re, y_im, speed_re, speed_im, friction, restitution, drive)
        after_re, after_im = b_re + change_re, b_im + change_im
        flies = _flies(y_re, y_im, after_re, after_im, a_re, a_im, lower_re, lower_im, upper_re, upper_im)
        # Whether the state before recurs (fate.recurs), by a test that lets all pass that do.
        away = (abs(b_re - lanes.reference_lower_re[lane]) + abs(b_im - lanes.reference_lower_im[lane])) + (
            abs(a_re - lanes.reference_upper_re[lane]) + abs(a_im - lanes.reference_upper_im[lane])
        )
        size = 1.0 + ((abs(b_re) + abs(b_im)) + (abs(a_re) + abs(a_im)))
        quiet, depth = lanes.quiet[lane] + 1.0, lanes.depth[lane]
        noted = (away <= NEARBY * size) | (quiet >= lanes.due[lane])
        late = clock + spent > until
        moves = (strikes | free) & ~late
        struck = strikes & ~late
        plain = struck & flies & ~noted
        verdict = CLEARED if free else (TOUCHING if ~flies else (NOTED if noted else STRUCK))
        verdict = verdict if moves else (LATE if strikes | free else OPEN)
        lanes.verdict[lane] = verdict
        lanes.quiet[lane] = quiet if plain else quiet - 1.0
        lanes.clock[lane] = clock + spent if moves else clock
        lanes.depth[lane] = 0.0 if moves else depth + 1.0
        lanes.level[lane] = (0.0 if struck else beyond) if moves else level
        lanes.arrival_lower_re[lane], lanes.arrival_lower_im[lane] = b_re, b_im
        lanes.arrival_upper_re[lane], lanes.arrival_upper_im[lane] = a_re, a_im
        lanes.lower_re[lane] = (after_re if struck else b_re) if moves else b0_re
        lanes.lower_im[lane] = (after_im if struck else b_im) if moves else b0_im
        lanes.upper_re[lane] = a_re if moves else a0_re
        lanes.upper_im[lane] = a_im if moves else a0_im
        looks += 0 if plain | (free & (lanes.watched[lane] == 0.0)) else 1
    return looks


@part
def _nudged(time, b_re, b_im, a_re, a_im, lower_re, lower_im, upper_re, upper_im):
    """Amplitudes a short time later; see :func:`carom.core.flow.nudge`."""
    b1_re, b1_im = lower_re * b_re - lower_im * b_im, lower_re * b_im + lower_im * b_re
    a1_re, a1_im = (upper_re * a_re - upper_im * a_im) + b_re, (upper_re * a_im + upper_im * a_re) + b_im
    b2_re, b2_im = lower_re * b1_re - lower_im * b1_im, lower_re * b1_im + lower_im * b1_re
    a2_re, a2_im = (upper_re * a1_re - upper_im * a1_im) + b1_re, (upper_re * a1_im + upper_im * a1_re) + b1_im
    b3_re, b3_im = lower_re * b2_re - lower_im * b2_im, lower_re * b2_im + lower_im * b2_re
    a3_re, a3_im = (upper_re * a2_re - upper_im * a2_im) + b2_re, (upper_re * a2_im + upper_im * a2_re) + b2_im
    half, third = 0.5 * time, THIRD * time
    return (
        b_re + time * (b1_re + half * (b2_re + third * b3_re)),
        b_im + time * (b1_im + half * (b2_im + third * b3_im)),
        a_re + time * (a1_re + half * (a2_re + third * a3_re)),
        a_im + time * (a1_im + half * (a2_im + third * a3_im)),
    )


@part
def _rebound(y_re, y_im, speed_re, speed_im, friction, restitution, drive):
    """Change of velocity in an impact; see :func:`carom.core.impact.rebound`."""
    radial, angular = y_re * speed_re + y_im * speed_im, y_re * speed_im - y_im * speed_re
    normal, slip = (1.0 + restitution) * radial, drive + angular
    tangential = min(friction * normal, abs(slip))
    tangential = tangential if slip >= 0.0 else -tangential
    return -(y_re * normal - y_im * tangential), -(y_re * tangential + y_im * normal)


@part
def _flies(y_re, y_im, b_re, b_im, a_re, a_im, lower_re, lower_im, upper_re, upper_im):
    """:func:`surely_flies` in a lane."""
    speed_re, speed_im = b_re + (upper_re * a_re - upper_im * a_im), b_im + (upper_re * a_im + upper_im * a_re)
    force_re = (lower_re * b_re - lower_im * b_im) + (upper_re * speed_re - upper_im * speed_im)
    force_im = (lower_re * b_im + lower_im * b_re) + (upper_re * speed_im + upper_im * speed_re)
    departure, turning = -(y_re * speed_re + y_im * speed_im), y_re * speed_im - y_im * speed_re
    push = (y_re * force_re + y_im * force_im) + turning * turning
    return (departure > CLEARLY_OFF) & ((push <= 0.0) | (departure * departure > LOWEST * push))


@part
def surely_flies(rotor, amplitudes):
    """Whether a state on the wall leaves it for a flight that is not too low for lanes."""
    position, speed = displacement(rotor, 0, amplitudes), velocity(rotor, 0, amplitudes)
    force = acceleration(rotor, 0, amplitudes)
    departure, turning = -(position.conjugate() * speed).real, (position.conjugate() * speed).imag
    push = (position.conjugate() * force).real + turning * turning
    return departure > CLEARLY_OFF and (push <= 0.0 or departure * departure > LOWEST * push)
