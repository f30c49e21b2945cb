"""The loop of a motion: fly, meet the wall, strike."""

from __future__ import annotations

from carom.core.events import first_crossing
from carom.core.flow import acceleration, displacement, velocity
from carom.core.impact import strike, unit
from carom.core.layout import kernel
from carom.outcome import Outcome

__all__ = ["advance", "set_on_wall"]

CLEAR, CONTACT, GRAZING = int(Outcome.CLEAR), int(Outcome.CONTACT), int(Outcome.GRAZING)
TIME_REACHED, IMPACT_LIMIT = int(Outcome.TIME_REACHED), int(Outcome.IMPACT_LIMIT)
CHATTER = int(Outcome.CHATTER)

CHATTER_HEIGHT = 1e-13
"""Height of a bounce, in clearances, below which a chatter counts as complete; penetration is allowed to 1e-12."""

RESTING = 16 * 2.220446049250313e-16
"""Radial speed, relative to the whole, that is rounding: the rotor rests on the wall."""


@kernel
def advance(rotor, table, amplitudes, until, plane, times, planes, before, after, work):
    """Follow a motion through impacts until a time, a full log, or an end of bouncing.

    Parameters
    ----------
    rotor, table : records of :mod:`carom.core.layout`
    amplitudes : complex array, shape (N,)
        State at time zero; on return the state at the returned time.
    until : float
        Duration to follow.
    plane : int
        Plane whose wall the start lies on, or −1 for a start inside all of them.
    times, planes, before, after : arrays, shapes (L,), (L,), (L, N), (L, N)
        Log: time and plane of each impact, amplitudes just before and just after it.
    work : record of :func:`~carom.core.layout.workspace`

    Returns
    -------
    outcome : int
        ``TIME_REACHED``, ``IMPACT_LIMIT`` (log full), ``CHATTER`` or ``GRAZING``.
    time : float
    impacts : int
    plane : int
        Plane whose wall the end lies on, or −1.
    """
    modes = amplitudes.shape[0]
    time = 0.0
    impacts = 0
    if plane >= 0:
        outcome = _wall_state(rotor, plane, amplitudes)
        if outcome in (CHATTER, GRAZING):
            return outcome, time, impacts, plane
        if outcome == CONTACT:
            times[0], planes[0] = time, plane
            _record_strike(rotor, plane, amplitudes, before, after, 0)
            impacts = 1
    while impacts < times.shape[0]:
        if impacts > 0 and _wall_state(rotor, plane, amplitudes) == CHATTER:
            return CHATTER, time, impacts, plane
        outcome, duration, target = _next_contact(rotor, table, amplitudes, until - time, plane, work)
        for k in range(modes):
            amplitudes[k] = work.nearest[k]
        if outcome == CLEAR:
            return TIME_REACHED, until, impacts, -1
        time += duration
        plane = target
        if outcome == GRAZING:
            return GRAZING, time, impacts, plane
        set_on_wall(rotor, plane, amplitudes)
        times[impacts], planes[impacts] = time, plane
        _record_strike(rotor, plane, amplitudes, before, after, impacts)
        impacts += 1
    return IMPACT_LIMIT, time, impacts, plane


@kernel
def _next_contact(rotor, table, amplitudes, horizon, touched, work):
    """Earliest contact over all planes; ``work.nearest`` holds the amplitudes there."""
    outcome = CLEAR
    target = -1
    for plane in range(rotor.rows.shape[0]):
        found, time = first_crossing(rotor, table, plane, amplitudes, horizon, plane == touched, work)
        if found != CLEAR or target < 0:
            for k in range(amplitudes.shape[0]):
                work.nearest[k] = work.arrival[k]
        if found != CLEAR:
            outcome, horizon, target = found, time, plane
    return outcome, horizon, target


@kernel
def _record_strike(rotor, plane, amplitudes, before, after, entry):
    """Apply the impact law in place and note the amplitudes on both sides in an entry of the log."""
    position = displacement(rotor, plane, amplitudes)
    speed = velocity(rotor, plane, amplitudes)
    change, _ = strike(position, speed, rotor.friction[plane], rotor.restitution[plane], rotor.drive[plane])
    for k in range(amplitudes.shape[0]):
        before[entry, k] = amplitudes[k]
        amplitudes[k] += rotor.columns[k, plane] * change
        after[entry, k] = amplitudes[k]


@kernel
def set_on_wall(rotor, plane, amplitudes):
    """Remove the rounding error of ``|y| = 1`` by the smallest change of the amplitudes."""
    position = displacement(rotor, plane, amplitudes)
    shift = unit(position) - position
    scale = 1.0 / rotor.weights[plane]
    for k in range(amplitudes.shape[0]):
        amplitudes[k] += rotor.rows[plane, k].conjugate() * shift * scale


@kernel
def _wall_state(rotor, plane, amplitudes):
    """What a state on the wall does next: CONTACT (strikes), CLEAR (leaves), CHATTER (stays) or GRAZING.

    It stays when it is pressed outward (``push > 0``, the normal force of lasting contact) and leaves so slowly that the
    whole remaining geometric series of bounces, of duration ``2ṙ/(push (1 − d))``, stays below CHATTER_HEIGHT and
    cannot outlast the push.
    """
    position = displacement(rotor, plane, amplitudes)
    normal = unit(position)
    local = normal.conjugate() * velocity(rotor, plane, amplitudes)
    push = (normal.conjugate() * acceleration(rotor, plane, amplitudes)).real + local.imag * local.imag
    rebound = -local.real
    if abs(rebound) <= RESTING * (1.0 + abs(local.real) + abs(local.imag)):
        rebound = 0.0
    if rebound < 0.0:
        return CONTACT
    if push <= 0.0:
        return GRAZING if rebound == 0.0 and push == 0.0 else CLEAR
    if rebound == 0.0:
        return CHATTER
    loss = 1.0 - rotor.restitution[plane]
    if rebound * rebound > 2.0 * push * CHATTER_HEIGHT or loss <= 0.0:
        return CLEAR
    duration = 2.0 * rebound / (push * loss)
    return CHATTER if duration * _push_rate(rotor, plane, amplitudes, abs(local)) < 0.5 * push else CLEAR


@kernel
def _push_rate(rotor, plane, amplitudes, speed):
    """Bound of ``|d/dt (r̈ + rθ̇²)|`` on the wall, from ``|y⃛|``, ``|ÿ|`` and ``|ẏ|``."""
    jerk = 0j
    for k in range(amplitudes.shape[0]):
        rate = rotor.exponents[k] * amplitudes[k]
        if rotor.driven[k]:
            rate += amplitudes[k - 1]
        jerk += rotor.acceleration_rows[plane, k] * rate
    force = abs(acceleration(rotor, plane, amplitudes))
    return abs(jerk) + 3.0 * speed * force + 4.0 * speed**3
