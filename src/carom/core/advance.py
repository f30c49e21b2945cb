"""The loop of a motion: fly, meet the wall, strike; land, slide, roll, lift off; end where it settles."""

from __future__ import annotations

import math

from carom.core.events import INSIDE, LEAVING, first_crossing
from carom.core.fate import NEAR, approaches_turn, forget_rub, levitates, near_rub, recurs, same_state
from carom.core.flow import displacement, velocity
from carom.core.impact import set_on_wall, strike, unit
from carom.core.layout import kernel
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
FLIGHT, ROLLING = int(Phase.FLIGHT), int(Phase.ROLLING)

CHATTER_HEIGHT = 1e-13
"""Height of a bounce, in clearances, below which a chatter counts as complete; penetration is allowed to 1e-12."""
RESTING = 4.0
"""Radial speed, in rounding errors, up to which the rotor rests on the wall: a flight as low cannot be followed."""
STALLED = 64
"""Events in a row without progress in time after which double precision cannot decide what follows."""
SHORTEST = 1e-15
"""Duration that counts as no progress."""
LEAST_LOSS = 1e-3
"""Loss of speed per bounce below which bounces lower than CHATTER_HEIGHT are not followed to their end."""


@kernel
def advance(rotor, table, amplitudes, until, phase, plane, times, phases, planes, before, after, memory, work, rub):
    """Follow a motion until a time, a full log, or the end it settles to.

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
        Plane whose wall the start lies on, or −1 (``INSIDE_ALL``).
    times, phases, planes, before, after : arrays, shapes (L,), (L,), (L,), (L, N), (L, N)
        Log of events: time, phase that follows, plane, amplitudes just before and just after.  An impact is followed by
        ``FLIGHT`` and changes the amplitudes; a long contact is logged in steps that change nothing.  A motion that
        settles at an impact ends just before it.
    memory : record of :func:`~carom.core.fate.memory`
    work, rub : records of :func:`~carom.core.layout.workspace` and :func:`~carom.core.layout.rub_workspace`

    Returns
    -------
    outcome : int
        ``TIME_REACHED``, ``EVENT_LIMIT`` (log full), ``GRAZING`` or where the motion settles.
    time : float
    events : int
    phase : int
    plane : int
        Plane whose wall the end lies on, or −1.
    """
    time = 0.0
    events, stalled = 0, 0
    while events < times.shape[0]:
        if phase == FLIGHT:
            outcome, duration, phase, plane = _fly(
                rotor, table, amplitudes, until - time, plane, before[events], memory, work, rub
            )
        else:
            outcome, duration, phase = _rub(rotor, plane, amplitudes, phase, until - time, memory, rub)
            before[events, :] = amplitudes
        time = until if outcome == TIME_REACHED else time + duration
        if outcome != CONTACT:
            return outcome, time, events, phase, plane
        times[events], phases[events], planes[events] = time, phase, plane
        after[events, :] = amplitudes
        events += 1
        stalled = stalled + 1 if duration <= SHORTEST else 0
        if stalled == STALLED:
            return GRAZING, time, events, phase, plane
    return EVENT_LIMIT, time, events, phase, plane


@kernel
def _fly(rotor, table, amplitudes, horizon, plane, arrival, memory, work, rub):
    """One flight and the impact or landing at its end, in place.

    Returns the outcome (CONTACT: it goes on), the duration, the phase that follows and the plane touched.
    ``arrival`` receives the amplitudes just before the impact.
    """
    elapsed = 0.0
    settle = memory.patience > 0
    while True:
        reaction, at_rest = CLEAR, False
        if plane >= 0:
            reaction, at_rest = _wall_reaction(rotor, plane, amplitudes, memory.lifting)
            memory.lifting = 0
        if reaction == CLEAR:
            if settle and levitates(rotor, amplitudes, work):
                return LEVITATED, elapsed, FLIGHT, plane
            leap = min(horizon - elapsed, memory.recheck) if settle else horizon - elapsed
            reaction, duration, plane = _leap(rotor, table, amplitudes, leap, plane, at_rest, work, rub)
            elapsed += duration
        if reaction == GRAZING:
            return GRAZING, elapsed, FLIGHT, plane
        if reaction != CLEAR:
            break
        if elapsed >= horizon:
            return TIME_REACHED, horizon, FLIGHT, plane
    set_on_wall(rotor, plane, amplitudes)
    arrival[:] = amplitudes
    if reaction == CONTACT:
        if settle and recurs(memory, amplitudes):
            return (MIXED if memory.rubbed > 0 else BOUNCING), elapsed, FLIGHT, plane
        _apply_strike(rotor, plane, amplitudes)
        return CONTACT, elapsed, FLIGHT, plane
    if memory.stop_at_landing:
        return CHATTER, elapsed, FLIGHT, plane
    _land(rotor, plane, amplitudes)
    memory.rubbed = 1
    forget_rub(memory)
    return CONTACT, elapsed, next_phase(rotor, plane, amplitudes, FLIGHT), plane


@kernel
def _leap(rotor, table, amplitudes, horizon, plane, at_rest, work, rub):
    """Fly on, in place, to the next contact or the horizon, or just off the wall from a start at rest on it.

    Returns the reaction of the wall (CLEAR: the flight goes on), the duration and the plane touched.
    """
    if at_rest:
        duration, returned = lift_off(rotor, plane, amplitudes, horizon, rub)
        if duration == 0.0:
            return LANDING, duration, plane
        return CLEAR, duration, plane if returned else INSIDE_ALL
    start = LEAVING if plane >= 0 else INSIDE
    reaction, duration, target = _next_contact(rotor, table, amplitudes, horizon, plane, start, work)
    amplitudes[:] = work.nearest
    return reaction, duration, target


@kernel
def _next_contact(rotor, table, amplitudes, horizon, touched, start, work):
    """Earliest contact over all planes; ``work.nearest`` holds the amplitudes there."""
    outcome = CLEAR
    target = -1
    for plane in range(rotor.rows.shape[0]):
        found, time = first_crossing(
            rotor, table, plane, amplitudes, horizon, start if plane == touched else INSIDE, work
        )
        if found != CLEAR or target < 0:
            for k in range(amplitudes.shape[0]):
                work.nearest[k] = work.arrival[k]
        if found != CLEAR:
            outcome, horizon, target = found, time, plane
    return outcome, horizon, target


@kernel
def _apply_strike(rotor, plane, amplitudes):
    """Apply the impact law in place."""
    position = displacement(rotor, plane, amplitudes)
    speed = velocity(rotor, plane, amplitudes)
    change, _ = strike(position, speed, rotor.friction[plane], rotor.restitution[plane], rotor.drive[plane])
    for k in range(amplitudes.shape[0]):
        amplitudes[k] += rotor.columns[k, plane] * change


@kernel
def _land(rotor, plane, amplitudes):
    """Complete a chatter: replace its remaining bounces by lasting contact from now on.

    Over the rest of the chatter the bounces have the normal impulse ``N τ − v``, where lasting contact has ``N τ``, if
    ``v`` is the speed of the first rebound; both have the friction that goes with it.  An outward impulse ``v`` with its
    share of friction makes up the difference.  With ``h = v²/(2N)``, the height of the first bounce, what is left out of
    the angle is ``8(1 + μ²)(1 + θ̇) h v/(3N(1 − d³))`` while the contact slips and ``4hP/(N(1 − d²))`` where every impact
    stops the slip against a force ``P`` along the wall; both to leading order in ``v``, for the planar rotor.
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
    """One step of lasting contact, in place: outcome (CONTACT: it goes on), duration and phase that follows."""
    rub_series(rotor, plane, amplitudes, phase, rub)
    step = min(rub_step(rub), horizon)
    duration, following, slip_stops = first_transition(rotor, plane, phase, step, rub)
    turned, speed = False, 0.0
    if memory.patience > 0:
        position = unit(rub.position[0])
        speed = (position.conjugate() * rub.speed[0]).imag
        if near_rub(memory, position, speed):
            return FORWARD_RUB, 0.0, phase
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


@kernel
def _wall_reaction(rotor, plane, amplitudes, lifting):
    """What a state on the wall does next, and whether it is at rest there.

    It strikes (CONTACT) with outward speed; lands (LANDING) when it is pressed outward and leaves so slowly that the
    whole remaining geometric series of bounces, of duration ``2v/(N(1 − d))``, stays below CHATTER_HEIGHT and cannot
    outlast the push; and else flies (CLEAR), as it does where a contact has just lost its push (``lifting``).
    """
    normal = unit(displacement(rotor, plane, amplitudes))
    rebound = -(normal.conjugate() * velocity(rotor, plane, amplitudes)).real
    rest = RESTING * speed_rounding(rotor, plane, amplitudes)
    if rebound < -rest:
        return CONTACT, False
    push, rate = wall_push(rotor, plane, amplitudes)
    if rebound <= rest:
        pressed = push > 0.0 if abs(push) > push_rounding(rotor, plane, amplitudes) else rate > 0.0
        return (LANDING if pressed and lifting == 0 else CLEAR), True
    if push <= 0.0 or rebound * rebound > 2.0 * push * CHATTER_HEIGHT:
        return CLEAR, False
    loss = max(1.0 - rotor.restitution[plane], LEAST_LOSS)
    brief = 2.0 * rebound * abs(rate) < 0.5 * push * push * loss
    return (LANDING if brief else CLEAR), False
