"""What happens where a plane arrives at its wall: an impact, a landing, or contact with a wall that gives way; or how the motion has settled."""

from __future__ import annotations

from carom.base.outcome import Outcome
from carom.core.compiling.decorators import expanded, inlined, kernel
from carom.core.fate import doubt, forget_rub, persists, recurs
from carom.core.flow import copy, displacement, squared_modulus, velocity
from carom.core.friction import arrival, landing
from carom.core.joint import join, land_together, strike_together
from carom.core.limits import set_limits
from carom.core.phases import AWAY, FLIGHT, lasts
from carom.core.planar_proofs import fades_to_rolling
from carom.core.rounding import RESTING, speed_rounding
from carom.core.rub import meets_wall, next_phase, rest_on_wall
from carom.core.surfaces import may_change
from carom.core.wall import move_plane, push_plane, set_on_wall, unit, wall_of, yields

CONTACT, GRAZING, CHATTER = int(Outcome.CONTACT), int(Outcome.GRAZING), int(Outcome.CHATTER)
BOUNCING, MIXED, ROLLING = int(Outcome.BOUNCING), int(Outcome.MIXED), int(Outcome.ROLLING)
LANDING = -1
"""What a plane does that is pressed to its wall and leaves it too slowly to be followed."""
SHORTEST_LAP = 1e-6
"""Time within which impacts at several planes count as one when a motion is tested for recurrence.

Where planes strike in turn at one instant their speeds fall by a factor each time: the state recurs, but is no orbit.
"""


@kernel
def rests(rotor, plane, amplitudes):
    """Whether a plane on its wall has no radial speed, to rounding."""
    normal = unit(displacement(rotor, plane, amplitudes))
    radial = (normal.conjugate() * velocity(rotor, plane, amplitudes)).real
    return abs(radial) <= RESTING * speed_rounding(rotor, plane, amplitudes)


@expanded
def touch(rotor, contact, plane, reaction, elapsed, memory, work, rub):
    """Impact or landing of a plane in the state ``work.arrival``; returns the outcome."""
    contact[plane] = FLIGHT
    if yields(rotor, plane):
        outcome = _enter(rotor, contact, plane, elapsed, memory, work, rub)
    elif reaction == CONTACT:
        outcome = _meet(rotor, contact, plane, elapsed, memory, work, rub)
        if rotor.limit_bounds.shape[0] > 0:
            set_limits(rotor, work.current, rub)
        if rotor.rows.shape[0] > 1 and outcome == CONTACT:
            _loosen(rotor, contact, plane, work.current, rub)
    else:
        outcome = _end_flight(rotor, contact, plane, reaction, memory, work, rub)
    return outcome


@kernel
def _end_flight(rotor, contact, plane, reaction, memory, work, rub):
    """Landing of a plane in the state ``work.arrival``, or a grazing that ends the motion; returns the outcome."""
    state = work.current
    if reaction == LANDING:
        set_on_wall(rotor, plane, work.arrival)
    copy(work.arrival, state)
    if reaction == GRAZING:
        return GRAZING
    if memory.stop_at_landing:
        return CHATTER
    _land(rotor, contact, plane, state, rub)
    if rotor.limit_bounds.shape[0] > 0:
        set_limits(rotor, state, rub)
    memory.rubbed = 1
    forget_rub(memory)
    contact[plane] = next_phase(rotor, contact, plane, state, rub)
    if rotor.rows.shape[0] > 1:
        _loosen(rotor, contact, plane, state, rub)
    return CONTACT


@kernel
def _loosen(rotor, contact, struck, amplitudes, rub):
    """Adapt the other planes on their walls to an impulse at one plane, which changes their velocities too."""
    for plane in range(rotor.rows.shape[0]):
        if contact[plane] == AWAY and meets_wall(rotor, plane, amplitudes):
            contact[plane] = FLIGHT
        if yields(rotor, plane):
            if lasts(contact[plane]):
                contact[plane] = next_phase(rotor, contact, plane, amplitudes, rub)
        elif plane != struck and lasts(contact[plane]):
            if not rests(rotor, plane, amplitudes):
                contact[plane] = FLIGHT
            else:
                contact[plane] = next_phase(rotor, contact, plane, amplitudes, rub)


@expanded
def _meet(rotor, contact, plane, elapsed, memory, work, rub):
    """Apply the impact to the arriving state; return CONTACT, or how the motion has settled."""
    normal, speed = displacement(rotor, plane, work.arrival), velocity(rotor, plane, work.arrival)
    memory.turns = 0
    if memory.watches > 0:
        memory.struck = max(memory.struck, (normal.conjugate() * speed).real)
    # Remove the rounding error of |y| = 1 from the state, to first order; the impact law does not need that.
    excess = 0.5 * (squared_modulus(normal) - 1.0)
    move_plane(rotor, plane, complex(-excess * normal.real, -excess * normal.imag), work.arrival)
    for other in range(rotor.rows.shape[0]):
        if lasts(contact[other]):
            memory.rubbed = 1
    settle = memory.patience > 0 and memory.struck < memory.impact_speed
    if settle and _comes_again(rotor, elapsed, memory, work):
        copy(work.arrival, work.current)
        return MIXED if memory.rubbed > 0 else BOUNCING
    if settle and fades_to_rolling(memory.proofs, rotor, work.arrival):
        copy(work.arrival, work.current)
        return ROLLING
    changes = may_change(rotor, plane)
    if rotor.rows.shape[0] > 1 or changes:
        others = join(rotor, contact, plane, work.arrival, rub)
        if others or changes:
            if memory.watches > 0:
                _note_speeds(rotor, memory, work, rub)
            strike_together(rotor, work.arrival, work.current, rub)
            return CONTACT
    change = normal * arrival(normal.conjugate() * speed, wall_of(rotor, plane))
    push_plane(rotor, plane, change, work.arrival, work.current)
    return CONTACT


@kernel
def _enter(rotor, contact, plane, elapsed, memory, work, rub):
    """Begin contact with a wall that gives way in the arriving state; return CONTACT, or how the motion has settled."""
    set_on_wall(rotor, plane, work.arrival)
    normal, speed = unit(displacement(rotor, plane, work.arrival)), velocity(rotor, plane, work.arrival)
    copy(work.arrival, work.current)
    rest = RESTING * speed_rounding(rotor, plane, work.arrival)
    if rotor.rows.shape[0] > 1 and (normal.conjugate() * speed).real < -rest:
        # Two planes leave their walls in one instant: the second is still at its own where the first has left.
        _loosen(rotor, contact, plane, work.current, rub)
        return CONTACT
    memory.turns = 0
    if memory.watches > 0:
        memory.struck = max(memory.struck, (normal.conjugate() * speed).real)
    settle = memory.patience > 0 and memory.struck < memory.impact_speed
    if settle and _comes_again(rotor, elapsed, memory, work):
        return MIXED if memory.rubbed > 0 else BOUNCING
    forget_rub(memory)
    contact[plane] = next_phase(rotor, contact, plane, work.current, rub)
    return CONTACT


@inlined
def _comes_again(rotor, elapsed, memory, work):
    """Whether the arriving state recurs, and contact that persists is not what would end the stage."""
    if (rotor.rows.shape[0] == 1 or _time_has_passed(memory, elapsed)) and recurs(memory, work.arrival):
        if not persists(memory, elapsed):
            return True
        doubt(memory)
    return False


@kernel
def _note_speeds(rotor, memory, work, rub):
    """Note the radial speeds of all planes of a joint impact."""
    for plane in range(rotor.rows.shape[0]):
        if rub.joined[plane]:
            normal, speed = unit(displacement(rotor, plane, work.arrival)), velocity(rotor, plane, work.arrival)
            memory.struck = max(memory.struck, (normal.conjugate() * speed).real)


@inlined
def _time_has_passed(memory, elapsed):
    """Whether time has passed since the last impact that was tested for recurrence; the time elapsed is not yet part of the lap."""
    passed = memory.lap + elapsed > SHORTEST_LAP
    if passed:
        memory.lap = -elapsed
    return passed


@kernel
def _land(rotor, contact, plane, amplitudes, rub):
    """Complete a chatter: replace its remaining bounces by lasting contact from now on.

    Let ``v`` be the speed of the first rebound and ``τ`` the remaining duration of the chatter.  The bounces have the
    total normal impulse ``N τ − v``, lasting contact has ``N τ``; each comes with its share of friction.  The
    difference is balanced by an outward impulse ``v`` with its share of friction.  With ``h = v²/(2N)``, the height of
    the first bounce, the error of the angle is ``8(1 + μ²)(1 + θ̇) h v/(3N(1 − d³))`` while the contact slips.  It is
    ``4hP/(N(1 − d²))`` where every impact stops the slip against a force ``P`` along the wall.  Both hold to leading
    order in ``v`` for the planar rotor.
    """
    if rotor.rows.shape[0] > 1 or may_change(rotor, plane):
        land_together(rotor, contact, plane, amplitudes, rub)
        return
    normal = unit(displacement(rotor, plane, amplitudes))
    local = normal.conjugate() * velocity(rotor, plane, amplitudes)
    change = normal * landing(local, wall_of(rotor, plane))
    push_plane(rotor, plane, change, amplitudes, amplitudes)
    rest_on_wall(rotor, plane, amplitudes, False)
