"""What happens where a station arrives at its wall: an impact, a landing, or contact with a compliant wall; or how the motion has settled."""

from __future__ import annotations

from carom.base.outcome import Outcome
from carom.core.compiling.decorators import expanded, inlined, kernel
from carom.core.flow import copy, displacement, squared_modulus, velocity
from carom.core.friction import landing, velocity_change
from carom.core.joint import join, joint_impact, land_together
from carom.core.limits import set_limits
from carom.core.phases import AWAY, FLIGHT, lasts
from carom.core.planar_proofs import fades_to_rolling
from carom.core.rounding import RESTING, speed_rounding
from carom.core.rub import is_at_wall, next_phase, rest_on_wall
from carom.core.settling import discard_candidate, persists, recurs, reset_rub
from carom.core.surfaces import may_change
from carom.core.wall import is_compliant, move_station, push_station, set_on_wall, unit, wall_of

CONTACT, GRAZING, CHATTER = int(Outcome.CONTACT), int(Outcome.GRAZING), int(Outcome.CHATTER)
BOUNCING, MIXED, ROLLING = int(Outcome.BOUNCING), int(Outcome.MIXED), int(Outcome.ROLLING)
LANDING = -1
"""What a station does that is pressed to its wall and leaves it too slowly to be followed."""
SHORTEST_LAP = 1e-6
"""Time within which impacts at several stations count as one when a motion is tested for recurrence.

Where stations have impacts in turn at one instant their speeds fall by a factor each time: the state recurs, but is no orbit.
"""


@kernel
def rests(rotor, station, amplitudes):
    """Whether a station on its wall has no radial speed, to rounding."""
    normal = unit(displacement(rotor, station, amplitudes))
    radial = (normal.conjugate() * velocity(rotor, station, amplitudes)).real
    return abs(radial) <= RESTING * speed_rounding(rotor, station, amplitudes)


@expanded
def begin_contact(rotor, contact, station, reaction, elapsed, memory, work, rub):
    """Impact or landing of a station in the state ``work.end``; returns the outcome."""
    contact[station] = FLIGHT
    if is_compliant(rotor, station):
        outcome = _enter(rotor, contact, station, elapsed, memory, work, rub)
    elif reaction == CONTACT:
        outcome = _impact(rotor, contact, station, elapsed, memory, work, rub)
        if rotor.limit_bounds.shape[0] > 0:
            set_limits(rotor, work.current, rub)
        if rotor.rows.shape[0] > 1 and outcome == CONTACT:
            _loosen(rotor, contact, station, work.current, rub)
    else:
        outcome = _end_flight(rotor, contact, station, reaction, memory, work, rub)
    return outcome


@kernel
def _end_flight(rotor, contact, station, reaction, memory, work, rub):
    """Landing of a station in the state ``work.end``, or a grazing that ends the motion; returns the outcome."""
    state = work.current
    if reaction == LANDING:
        set_on_wall(rotor, station, work.end)
    copy(work.end, state)
    if reaction == GRAZING:
        return GRAZING
    if memory.stop_at_landing:
        return CHATTER
    _land(rotor, contact, station, state, rub)
    if rotor.limit_bounds.shape[0] > 0:
        set_limits(rotor, state, rub)
    memory.rubbed = 1
    reset_rub(memory)
    contact[station] = next_phase(rotor, contact, station, state, rub)
    if rotor.rows.shape[0] > 1:
        _loosen(rotor, contact, station, state, rub)
    return CONTACT


@kernel
def _loosen(rotor, contact, impacting, amplitudes, rub):
    """Adapt the other stations on their walls to an impulse at one station, which changes their velocities too."""
    for station in range(rotor.rows.shape[0]):
        if contact[station] == AWAY and is_at_wall(rotor, station, amplitudes):
            contact[station] = FLIGHT
        if is_compliant(rotor, station):
            if lasts(contact[station]):
                contact[station] = next_phase(rotor, contact, station, amplitudes, rub)
        elif station != impacting and lasts(contact[station]):
            if not rests(rotor, station, amplitudes):
                contact[station] = FLIGHT
            else:
                contact[station] = next_phase(rotor, contact, station, amplitudes, rub)


@expanded
def _impact(rotor, contact, station, elapsed, memory, work, rub):
    """Apply the impact to the arriving state; return CONTACT, or how the motion has settled."""
    normal, speed = displacement(rotor, station, work.end), velocity(rotor, station, work.end)
    memory.turns = 0
    if memory.watches > 0:
        memory.hardest_impact = max(memory.hardest_impact, (normal.conjugate() * speed).real)
    # Remove the rounding error of |y| = 1 from the state, to first order; the impact law does not need that.
    excess = 0.5 * (squared_modulus(normal) - 1.0)
    move_station(rotor, station, complex(-excess * normal.real, -excess * normal.imag), work.end)
    for other in range(rotor.rows.shape[0]):
        if lasts(contact[other]):
            memory.rubbed = 1
    settle = memory.patience > 0 and memory.hardest_impact < memory.impact_speed
    if settle and _comes_again(rotor, elapsed, memory, work):
        copy(work.end, work.current)
        return MIXED if memory.rubbed > 0 else BOUNCING
    if settle and fades_to_rolling(memory.proofs, rotor, work.end):
        copy(work.end, work.current)
        return ROLLING
    changes = may_change(rotor, station)
    if rotor.rows.shape[0] > 1 or changes:
        others = join(rotor, contact, station, work.end, rub)
        if others or changes:
            if memory.watches > 0:
                _note_speeds(rotor, memory, work, rub)
            joint_impact(rotor, work.end, work.current, rub)
            return CONTACT
    change = normal * velocity_change(normal.conjugate() * speed, wall_of(rotor, station))
    push_station(rotor, station, change, work.end, work.current)
    return CONTACT


@kernel
def _enter(rotor, contact, station, elapsed, memory, work, rub):
    """Begin contact with a compliant wall in the arriving state; return CONTACT, or how the motion has settled."""
    set_on_wall(rotor, station, work.end)
    normal, speed = unit(displacement(rotor, station, work.end)), velocity(rotor, station, work.end)
    copy(work.end, work.current)
    rest = RESTING * speed_rounding(rotor, station, work.end)
    if rotor.rows.shape[0] > 1 and (normal.conjugate() * speed).real < -rest:
        # Two stations leave their walls in one instant: the second is still at its own where the first has left.
        _loosen(rotor, contact, station, work.current, rub)
        return CONTACT
    memory.turns = 0
    if memory.watches > 0:
        memory.hardest_impact = max(memory.hardest_impact, (normal.conjugate() * speed).real)
    settle = memory.patience > 0 and memory.hardest_impact < memory.impact_speed
    if settle and _comes_again(rotor, elapsed, memory, work):
        return MIXED if memory.rubbed > 0 else BOUNCING
    reset_rub(memory)
    contact[station] = next_phase(rotor, contact, station, work.current, rub)
    return CONTACT


@inlined
def _comes_again(rotor, elapsed, memory, work):
    """Whether the arriving state recurs, and contact that persists is not what would end the stage."""
    if (rotor.rows.shape[0] == 1 or _time_has_passed(memory, elapsed)) and recurs(memory, work.end):
        if not persists(memory, elapsed):
            return True
        discard_candidate(memory)
    return False


@kernel
def _note_speeds(rotor, memory, work, rub):
    """Note the radial speeds of all stations of a joint impact."""
    for station in range(rotor.rows.shape[0]):
        if rub.joined[station]:
            normal, speed = unit(displacement(rotor, station, work.end)), velocity(rotor, station, work.end)
            memory.hardest_impact = max(memory.hardest_impact, (normal.conjugate() * speed).real)


@inlined
def _time_has_passed(memory, elapsed):
    """Whether time has passed since the last impact that was tested for recurrence; the time elapsed is not yet part of the lap."""
    passed = memory.lap + elapsed > SHORTEST_LAP
    if passed:
        memory.lap = -elapsed
    return passed


@kernel
def _land(rotor, contact, station, amplitudes, rub):
    """Complete a chatter: replace its remaining bounces by lasting contact from now on.

    Let ``v`` be the speed of the first rebound and ``τ`` the remaining duration of the chatter.  The bounces have the
    total normal impulse ``N τ − v``, lasting contact has ``N τ``; each comes with its share of friction.  The
    difference is balanced by an outward impulse ``v`` with its share of friction.  With ``h = v²/(2N)``, the height of
    the first bounce, the error of the angle is ``8(1 + μ²)(1 + θ̇) h v/(3N(1 − d³))`` while the contact slips.  It is
    ``4hP/(N(1 − d²))`` where every impact stops the slip against a force ``P`` along the wall.  Both hold to leading
    order in ``v`` for the planar rotor.
    """
    if rotor.rows.shape[0] > 1 or may_change(rotor, station):
        land_together(rotor, contact, station, amplitudes, rub)
        return
    normal = unit(displacement(rotor, station, amplitudes))
    local = normal.conjugate() * velocity(rotor, station, amplitudes)
    change = normal * landing(local, wall_of(rotor, station))
    push_station(rotor, station, change, amplitudes, amplitudes)
    rest_on_wall(rotor, station, amplitudes, False)
