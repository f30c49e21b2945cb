"""The event loop of one motion: fly, meet the wall, strike; land, slide, roll, lift off; end where it settles."""

from __future__ import annotations

import math

from carom.core.events import INSIDE, LEAVING, search
from carom.core.fate import (
    NEAR,
    absorbed,
    approaches_turn,
    forget_rub,
    levitates,
    near_rub,
    recurs,
    same_state,
    stays_inside,
)
from carom.core.flow import acceleration, copy, displacement, squared_modulus, velocity
from carom.core.impact import move_plane, rebound, set_on_wall, unit
from carom.core.layout import kernel, passage
from carom.core.rub import (
    first_transition,
    lift_off,
    next_phase,
    push_rounding,
    rest_on_wall,
    rub_series,
    rub_step,
    speed_rounding,
    sum_series,
    turn_ahead,
    wall_push,
)
from carom.outcome import Outcome, Phase

__all__ = ["INSIDE_ALL", "advance"]

CLEAR, CONTACT, GRAZING = int(Outcome.CLEAR), int(Outcome.CONTACT), int(Outcome.GRAZING)
LANDING = -1
INSIDE_ALL = -1
TIME_REACHED, EVENT_LIMIT = int(Outcome.TIME_REACHED), int(Outcome.EVENT_LIMIT)
CHATTER = int(Outcome.CHATTER)
LEVITATED, BOUNCING, MIXED = int(Outcome.LEVITATED), int(Outcome.BOUNCING), int(Outcome.MIXED)
FORWARD_RUB, BACKWARD_WHIRL, ROLLS_ON = (
    int(Outcome.FORWARD_RUB),
    int(Outcome.BACKWARD_WHIRL),
    int(Outcome.ROLLING),
)
FLIGHT, FORWARD_SLIP, ROLLING = int(Phase.FLIGHT), int(Phase.FORWARD_SLIP), int(Phase.ROLLING)

CHATTER_HEIGHT = 1e-13
"""Height of a bounce, in clearances, below which a chatter counts as complete; penetration is allowed to 1e-12."""
RESTING = 4.0
"""Radial speed, in rounding errors, up to which the rotor rests on the wall: so low a flight cannot be resolved."""
STALLED = 64
"""Events in a row without progress in time after which double precision cannot decide what follows."""
SHORTEST = 1e-15
"""Duration that counts as no progress."""
LEAST_LOSS = 1e-3
"""Smallest loss of speed per bounce used in the test for the end of a chatter; an elastic one would never end."""


@kernel
def advance(rotor, table, amplitudes, until, phase, plane, times, phases, planes, before, after, memory, work, rub):
    """Follow a motion until a given time, until the log is full, or until it settles.

    Parameters
    ----------
    rotor, table : records of :mod:`carom.core.layout`
    amplitudes : complex array, shape (N,)
        State at time zero; on return the state at the returned time.
    until : float
        Duration to follow.
    phase : int
        :class:`~carom.outcome.Phase` at the start.
    plane : int
        Plane on whose wall the motion starts, or −1 (``INSIDE_ALL``).
    times, phases, planes, before, after : arrays, shapes (L,), (L,), (L,), (L, N), (L, N)
        Log of events: time, phase that follows, plane, amplitudes just before and just after.  An impact is followed by
        ``FLIGHT`` and changes the amplitudes; a long contact is logged in steps that change nothing.  A motion that
        settles at an impact ends just before it.
    memory : record of :func:`~carom.core.fate.memory`
    work, rub : records of :func:`~carom.core.layout.workspace` and :func:`~carom.core.layout.rub_workspace`

    Returns
    -------
    outcome : int
        ``TIME_REACHED``, ``EVENT_LIMIT`` (log full), ``GRAZING``, ``CHATTER`` or what the motion settles to.
    time : float
    events : int
    phase : int
    plane : int
        Plane on whose wall the motion ends, or −1.
    """
    state = work.current
    copy(amplitudes, state)
    time = 0.0
    events, stalled = 0, 0
    outcome = CONTACT
    while outcome == CONTACT and events < times.shape[0]:
        if phase == FLIGHT:
            outcome, duration, phase, plane = _fly(rotor, table, until - time, plane, memory, work, rub)
        else:
            outcome, duration, phase = _rub(rotor, plane, state, phase, until - time, memory, rub)
            copy(state, work.arrival)
        time = until if outcome == TIME_REACHED else time + duration
        if outcome == CONTACT:
            times[events], phases[events], planes[events] = time, phase, plane
            for k in range(state.shape[0]):
                before[events, k] = work.arrival[k]
                after[events, k] = state[k]
            events += 1
            stalled = stalled + 1 if duration <= SHORTEST else 0
            if stalled == STALLED:
                outcome = GRAZING
    copy(state, amplitudes)
    return (EVENT_LIMIT if outcome == CONTACT else outcome), time, events, phase, plane


@passage
def _fly(rotor, table, horizon, plane, memory, work, rub):
    """One flight from ``work.current`` and the impact or landing at its end; ``work.current`` is then the new state.

    Returns the outcome (CONTACT: the motion continues), the duration, the phase that follows and the plane touched.
    ``work.arrival`` is the state just before the impact.
    """
    state = work.current
    elapsed = 0.0
    settle = memory.patience > 0
    while True:
        reaction, at_rest = CLEAR, False
        if plane >= 0:
            reaction, at_rest = _wall_reaction(rotor, plane, state, memory.lifting)
            memory.lifting = 0
        if reaction != CLEAR:
            copy(state, work.arrival)
            break
        if settle and (levitates(rotor, state, work) or (elapsed > 0.0 and stays_inside(rotor, state))):
            return LEVITATED, elapsed, FLIGHT, plane
        leap = min(horizon - elapsed, memory.recheck) if settle else horizon - elapsed
        reaction, duration, plane = _leap(rotor, table, leap, plane, at_rest, work, rub)
        elapsed += duration
        if reaction != CLEAR:
            break
        copy(work.arrival, state)
        if elapsed >= horizon:
            return TIME_REACHED, horizon, FLIGHT, plane
    if reaction == CONTACT:
        return _meet(rotor, plane, memory, work), elapsed, FLIGHT, plane
    if reaction == LANDING:
        set_on_wall(rotor, plane, work.arrival)
    copy(work.arrival, state)
    if reaction == GRAZING:
        return GRAZING, elapsed, FLIGHT, plane
    if memory.stop_at_landing:
        return CHATTER, elapsed, FLIGHT, plane
    _land(rotor, plane, state)
    memory.rubbed = 1
    forget_rub(memory)
    return CONTACT, elapsed, next_phase(rotor, plane, state, int(FLIGHT)), plane


@passage
def _leap(rotor, table, horizon, plane, at_rest, work, rub):
    """Fly from ``work.current`` to the next contact or the horizon, or just off the wall from a start at rest on it.

    Returns the reaction of the wall (CLEAR: the flight continues), the duration and the plane touched; ``work.arrival``
    holds the state there.
    """
    if at_rest:
        copy(work.current, work.arrival)
        duration, returned = lift_off(rotor, plane, work.arrival, horizon, rub)
        if duration == 0.0:
            return LANDING, duration, plane
        return CLEAR, duration, plane if returned else INSIDE_ALL
    return _next_contact(rotor, table, horizon, plane, work)


@passage
def _next_contact(rotor, table, horizon, touched, work):
    """Earliest contact over all planes of the flight from ``work.current``; ``work.arrival`` holds the state there."""
    outcome, target = CLEAR, INSIDE_ALL
    several = rotor.rows.shape[0] > 1
    if several:
        copy(work.current, work.departure)
    for plane in range(rotor.rows.shape[0]):
        if several:
            copy(work.departure, work.current)
        found, time = search(rotor, table, plane, horizon, LEAVING if plane == touched else INSIDE, work)
        if several and (found != CLEAR or plane == 0):
            copy(work.arrival, work.nearest)
        if found != CLEAR:
            outcome, horizon, target = found, time, plane
    if several:
        copy(work.nearest, work.arrival)
    return outcome, horizon, target


@passage
def _meet(rotor, plane, memory, work):
    """Apply the impact to the arriving state; return CONTACT, or how the motion has settled."""
    normal, speed = displacement(rotor, plane, work.arrival), velocity(rotor, plane, work.arrival)
    # Remove the rounding error of |y| = 1 from the state, to first order; the impact law does not need that.
    excess = 0.5 * (squared_modulus(normal) - 1.0)
    move_plane(rotor, plane, complex(-excess * normal.real, -excess * normal.imag), work.arrival)
    if memory.patience > 0 and recurs(memory, work.arrival):
        copy(work.arrival, work.current)
        return MIXED if memory.rubbed > 0 else BOUNCING
    local = normal.conjugate() * speed
    change, _ = rebound(local, rotor.friction[plane], rotor.restitution[plane], rotor.drive[plane])
    change = normal * change
    for k in range(work.current.shape[0]):
        work.current[k] = work.arrival[k] + rotor.columns[k, plane] * change
    return CONTACT


@kernel
def _land(rotor, plane, amplitudes):
    """Complete a chatter: replace its remaining bounces by lasting contact from now on.

    Let ``v`` be the speed of the first rebound and ``τ`` the remaining duration of the chatter.  The bounces have the
    total normal impulse ``N τ − v``, lasting contact has ``N τ``; each comes with its share of friction.  The
    difference is balanced by an outward impulse ``v`` with its share of friction.  With ``h = v²/(2N)``, the height of
    the first bounce, the error of the angle is ``8(1 + μ²)(1 + θ̇) h v/(3N(1 − d³))`` while the contact slips.  It is
    ``4hP/(N(1 − d²))`` where every impact stops the slip against a force ``P`` along the wall.  Both hold to leading
    order in ``v`` for the planar rotor.
    """
    normal = unit(displacement(rotor, plane, amplitudes))
    local = normal.conjugate() * velocity(rotor, plane, amplitudes)
    slip = rotor.drive[plane] + local.imag
    share = min(rotor.friction[plane] * max(-local.real, 0.0), abs(slip))
    change = normal * complex(-local.real, math.copysign(share, slip))
    for k in range(amplitudes.shape[0]):
        amplitudes[k] += rotor.columns[k, plane] * change
    rest_on_wall(rotor, plane, amplitudes, False)


@kernel
def _rub(rotor, plane, amplitudes, phase, horizon, memory, rub):
    """One step of lasting contact, in place; return outcome (CONTACT: it continues), duration and next phase."""
    rub_series(rotor, plane, amplitudes, phase, rub)
    step = min(rub_step(rub), horizon)
    duration, following, slip_stops = first_transition(rotor, plane, phase, step, rub)
    turned, speed = False, 0.0
    if memory.patience > 0:
        position = unit(rub.position[0])
        speed = (position.conjugate() * rub.speed[0]).imag
        if near_rub(memory, position, speed) or (phase == FORWARD_SLIP and absorbed(memory, position, speed)):
            return FORWARD_RUB, 0.0, phase
        if phase == FORWARD_SLIP and -(1.0 + speed) > memory.runaway:
            return ROLLS_ON, 0.0, phase
        if approaches_turn(memory, position, amplitudes, speed):
            turn = turn_ahead(memory.turn_position, math.copysign(1.0, speed), duration, rub)
            if turn < duration:
                duration, following, slip_stops, turned = turn, phase, False, True
    sum_series(rub, duration, amplitudes)
    rest_on_wall(rotor, plane, amplitudes, phase == ROLLING or slip_stops)
    if slip_stops:
        following = next_phase(rotor, plane, amplitudes, phase)
    if following == FLIGHT:
        memory.lifting = 1
    memory.turn_time += duration
    if phase != ROLLING:
        memory.turn_slipped = 1
    if turned:
        if same_state(memory.turn_state, amplitudes, NEAR * min(1.0, memory.turn_time)):
            backward = speed < 0.0 and memory.turn_time < 2.0 * math.pi
            rub_outcome = BACKWARD_WHIRL if backward else FORWARD_RUB
            return (rub_outcome if memory.turn_slipped > 0 else ROLLS_ON), duration, phase
        forget_rub(memory)
    if duration >= horizon:
        return TIME_REACHED, duration, following
    return CONTACT, duration, following


@passage
def _wall_reaction(rotor, plane, amplitudes, lifting):
    """What a state on the wall does next, and whether it is at rest there.

    It strikes (CONTACT) if its speed is outward.  It lands (LANDING) if it is pressed outward and leaves so slowly that
    the whole remaining geometric series of bounces, of duration ``2v/(N(1 − d))``, stays below CHATTER_HEIGHT and ends
    before the normal force ``N`` can vanish.  Otherwise it flies (CLEAR); so does a state at rest whose contact has
    just lost its normal force (``lifting``).
    """
    normal = unit(displacement(rotor, plane, amplitudes))
    local = normal.conjugate() * velocity(rotor, plane, amplitudes)
    departure = -local.real
    rest = RESTING * speed_rounding(rotor, plane, amplitudes)
    if departure < -rest:
        return CONTACT, False
    push = (normal.conjugate() * acceleration(rotor, plane, amplitudes)).real + local.imag * local.imag
    if departure > rest and (push <= 0.0 or departure * departure > 2.0 * push * CHATTER_HEIGHT):
        return CLEAR, False
    push, rate = wall_push(rotor, plane, amplitudes)
    if departure <= rest:
        pressed = push > 0.0 if abs(push) > push_rounding(rotor, plane, amplitudes) else rate > 0.0
        return (LANDING if pressed and lifting == 0 else CLEAR), True
    loss = max(1.0 - rotor.restitution[plane], LEAST_LOSS)
    brief = 2.0 * departure * abs(rate) < 0.5 * push * push * loss
    return (LANDING if brief else CLEAR), False
