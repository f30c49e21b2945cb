"""One step of lasting contact: up to the first change of contact at a station, or until the rub has settled."""

from __future__ import annotations

import math

from carom.base.outcome import Outcome
from carom.core.compiling.decorators import inlined, kernel
from carom.core.compliance import next_form, stay_in_wall
from carom.core.contact_series import rub_series
from carom.core.layout import RECURRENCE_RTOL
from carom.core.limits import FREE as FREE_AXIS
from carom.core.limits import TURN, WHOLE, change_limits, first_limit, keeps_time, pass_time
from carom.core.phases import AWAY, FLIGHT, FORWARD_SLIP, ROLLING, lasts, stays
from carom.core.planar_proofs import absorbed, hastens, runs_away
from carom.core.rub import first_contact, first_transition, next_phase, rest_on_wall, turn_ahead
from carom.core.settling import (
    approaches_turn,
    at_rest,
    in_step,
    is_turn_periodic,
    near_rub,
    never_repeats,
    note_turn,
    reset_rub,
    same_state,
)
from carom.core.taylor import margin_step, series_step, sum_series
from carom.core.wall import is_compliant, set_on_wall, unit

CONTACT, GRAZING, TIME_REACHED = int(Outcome.CONTACT), int(Outcome.GRAZING), int(Outcome.TIME_REACHED)
FORWARD_RUB, BACKWARD_WHIRL, ROLLS_ON = (
    int(Outcome.FORWARD_RUB),
    int(Outcome.BACKWARD_WHIRL),
    int(Outcome.ROLLING),
)
NOWHERE = -1
"""Instead of a station: none of them."""
SWEEPS = 8
"""Corrections of the stations in contact, one after another: with a coupling of 0.9 their error falls to a fifth."""


@kernel
def rub_step(rotor, contact, amplitudes, horizon, memory, rub):
    """Follow the Taylor series of a motion up to the first change of contact, in place.

    Returns the outcome (CONTACT: the motion continues), the duration, and the station that has changed, or the first station
    in lasting contact.
    """
    rub_series(rotor, contact, amplitudes, rub)
    step, leading = _longest_step(rotor, contact, rub), leading_station(rotor, contact)
    if step == 0.0:  # forces at several stations have grown without bound, until there are none (Painlevé)
        return GRAZING, 0.0, leading
    duration, changed, following, undecided = _first_change(rotor, contact, min(step, horizon), rub)
    axis, at_bound = WHOLE, FREE_AXIS
    if rotor.limit_bounds.shape[0] > 0:
        met, axis, at_bound = first_limit(rotor, duration, rub)
        if met < duration:
            duration, changed = met, NOWHERE
    turned, whole, speed = False, False, 0.0
    # Contact that would end a stage when it has persisted for a time is followed until then.
    if memory.patience > 0 and memory.contact_time == math.inf and leading != NOWHERE:
        position = unit(rub.position[leading, 0])
        speed = (position.conjugate() * rub.speed[leading, 0]).imag
        end = _known_end(rotor, contact[leading] == FORWARD_SLIP, position, speed, memory, rub)
        if end != CONTACT:
            return end, 0.0, leading
        if approaches_turn(memory, position, amplitudes, speed):
            turn = turn_ahead(leading, memory.turn_position, math.copysign(1.0, speed), duration, rub)
            if turn < duration:
                duration, changed, turned, axis = turn, NOWHERE, True, WHOLE
        if keeps_time(rotor) and TURN - rub.clock <= duration:
            duration, changed, turned, axis, whole = TURN - rub.clock, NOWHERE, False, WHOLE, True
    sum_series(rub, duration, amplitudes)
    if keeps_time(rotor):
        pass_time(duration, whole, memory, rub)
    if rotor.limit_bounds.shape[0] > 0:
        change_limits(rotor, axis, at_bound, amplitudes, memory, rub)
    memory.turn_time += duration
    _remove_rounding(rotor, contact, changed, following, undecided, duration > 0.0, amplitudes, memory)
    if changed != NOWHERE:
        _change_contact(rotor, contact, changed, following, undecided, amplitudes, memory, rub)
    if turned or whole:
        end = _end_by_turns(rotor, whole, speed, amplitudes, memory)
        if end != CONTACT:
            return end, duration, leading
    return (TIME_REACHED if duration >= horizon else CONTACT), duration, leading if changed == NOWHERE else changed


@inlined
def _longest_step(rotor, contact, rub):
    """Longest step of the series; zero if they are not finite."""
    step = series_step(rub)
    for station in range(rotor.rows.shape[0]):
        if is_compliant(rotor, station) and stays(contact[station]):
            # The distance from the centre is a root: its series may reach less far than those of the amplitudes.
            step = min(step, margin_step(rub.depth[station]))
    return step


@inlined
def _end_by_turns(rotor, whole, speed, amplitudes, memory):
    """What contact settles to after a turn along the wall, or a whole turn of the shaft; CONTACT if it goes on."""
    if whole:
        if not is_turn_periodic(memory, amplitudes):
            return CONTACT
        backward = ROLLS_ON if memory.turn_slipped == 0 else BACKWARD_WHIRL
        return backward if speed < -1.0 else FORWARD_RUB
    note_turn(rotor, memory, amplitudes)
    recurred = same_state(memory.turn_state, amplitudes, RECURRENCE_RTOL * min(1.0, memory.turn_time))
    recurred = recurred and in_step(memory, memory.turn_clock, memory.turn_limited)
    # Of a shaft that loses its speed the state changes in each turn until it stands.
    if recurred or (rotor.shaft.shape[0] == 0 and never_repeats(memory, amplitudes)):
        backward = speed < 0.0 and memory.turn_time < 2.0 * math.pi
        rub_outcome = BACKWARD_WHIRL if backward else FORWARD_RUB
        return rub_outcome if memory.turn_slipped > 0 else ROLLS_ON
    reset_rub(memory)
    return CONTACT


@inlined
def _remove_rounding(rotor, contact, changed, following, undecided, moved, amplitudes, memory):
    """Remove rounding errors across the walls at the end of a step, and from a slip that has stopped."""
    # What puts one station to rest on its wall moves the others: several sweeps leave no more than rounding.
    for sweep in range(1 if rotor.rows.shape[0] == 1 else SWEEPS):
        for station in range(rotor.rows.shape[0]):
            phase = contact[station]
            if stays(phase):
                rolls = phase == ROLLING or (station == changed and undecided and lasts(phase))
                if is_compliant(rotor, station):
                    leaves = station == changed and not undecided and following == FLIGHT
                    stay_in_wall(rotor, station, rolls, leaves, amplitudes)
                else:
                    rest_on_wall(rotor, station, amplitudes, rolls)
                if phase != ROLLING:
                    memory.turn_slipped = 1
            elif moved and sweep == 0:
                contact[station] = AWAY


@inlined
def _known_end(rotor, slips, position, speed, memory, rub):
    """What lasting contact settles to, if that is known from its state; otherwise CONTACT."""
    if near_rub(memory, position, speed) or (slips and absorbed(memory.proofs, memory.rub_position, position, speed)):
        return FORWARD_RUB
    if memory.resting != 0:
        rests = at_rest(rotor, rub)
        if rests and memory.resting > 0:
            return FORWARD_RUB
        memory.resting = -1 if rests else 1
    if hastens(memory.proofs, speed):
        return FORWARD_RUB if speed > -1.0 else BACKWARD_WHIRL
    return ROLLS_ON if slips and runs_away(memory.proofs, speed) else CONTACT


@inlined
def _first_change(rotor, contact, step, rub):
    """First change of contact within a step: its time, station and following phase, and whether the phase is undecided."""
    duration, changed, following, undecided = step, NOWHERE, FLIGHT, False
    for station in range(rotor.rows.shape[0]):
        after, unsure = FLIGHT, False
        if stays(contact[station]):
            if is_compliant(rotor, station):
                form = next_form(rotor, station, duration, rub)
                if form < duration:
                    duration, changed, following, undecided = form, NOWHERE, FLIGHT, False
            time, after, unsure = first_transition(rotor, station, contact[station], duration, rub)
        elif rotor.rows.shape[0] > 1 or rotor.limit_bounds.shape[0] > 0:
            time = first_contact(rotor, station, contact[station] == FLIGHT, duration, rub)
        else:
            time = duration
        if time < duration:
            duration, changed, following, undecided = time, station, after, unsure
    return duration, changed, following, undecided


@inlined
def leading_station(rotor, contact):
    """First station that stays at its wall, whose turns are watched; NOWHERE if there is none."""
    for station in range(rotor.rows.shape[0]):
        if stays(contact[station]):
            return station
    return NOWHERE


@inlined
def _change_contact(rotor, contact, station, following, undecided, amplitudes, memory, rub):
    """Change the contact of a station: it lifts off, slips, rolls, or has come to the wall."""
    if undecided:
        following = next_phase(rotor, contact, station, amplitudes, rub)
    stayed = stays(contact[station])
    if not stayed:
        set_on_wall(rotor, station, amplitudes)
    elif following == FLIGHT:
        memory.lifting = station + 1
    if rotor.rows.shape[0] > 1 and not (stayed and stays(following)):
        reset_rub(memory)
    contact[station] = following
