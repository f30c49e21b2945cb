"""When lasting contact changes: how long sliding, rolling and flights next to the wall last, and what follows.

The motion is a Taylor series (:mod:`carom.core.contact_series`).  A phase lasts while its margins (normal force, slip,
distance from the limit of the friction cone) stay above minus their rounding error.  When a margin falls below, the
phase ends at the last zero before that.  So a margin that is zero at the start of a phase ends it only if it then falls.
Such a margin is the slip where rolling ends, or the normal force where a rotor lifts off.  Two phases can therefore not
pass a state back and forth.
"""

from __future__ import annotations

import math

import numpy as np

from carom.core.compiling.decorators import inlined, kernel
from carom.core.compliance import first_release, slip_in_wall
from carom.core.contact_series import contact_forces, rub_series
from carom.core.flow import acceleration, displacement, fly, squared_modulus, unbalance_drive, velocity
from carom.core.friction import (
    BACKWARD,
    FORWARD,
    STOPPED,
    friction_ratio,
    rolling_margin,
    slip_of,
    velocity_change_in_sense,
)
from carom.core.laws.choice import force
from carom.core.layout import ORDER
from carom.core.limits import FREE, set_limits
from carom.core.phases import (
    BACKWARD_SLIP,
    FLIGHT,
    FORWARD_SLIP,
    ROLLING,
    SEPARATED,
    lasts,
    phase_of_slip,
    sense_of_phase,
    stays,
)
from carom.core.rounding import RESTING, compliant_rounding, position_rounding, push_rounding, speed_rounding
from carom.core.surfaces import may_change, relative_excess
from carom.core.taylor import first_fall, series_step, sum_series
from carom.core.wall import is_compliant, push_station, rigid_wall, set_on_wall, unit, wall_of

NO_TURN = 1e-15
"""Distance along the wall that counts as zero."""


@kernel
def fly_or_rub_all(rotor, amplitudes, phases, limited, clocks, times, work):
    """Amplitudes (M, N) after given times (M,), each from its own amplitudes (M, N), phases (M, P), states of limits (M, 2L) and instants (M,)."""
    moved = np.empty_like(amplitudes)
    for i in range(times.shape[0]):
        if _stays(phases[i]) or _limited(limited[i]):
            begins = i == 0 or not (_same(phases[i], phases[i - 1]) and _same(amplitudes[i], amplitudes[i - 1]))
            if rotor.limit_bounds.shape[0] > 0:
                begins = begins or not (_same(limited[i], limited[i - 1]) and clocks[i] == clocks[i - 1])
                work.clock = clocks[i]
                work.limited[:] = limited[i]
            if begins:
                rub_series(rotor, phases[i], amplitudes[i], work)
            sum_series(work, times[i], moved[i])
        else:
            fly(rotor, amplitudes[i : i + 1], times[i], moved[i : i + 1])
    return moved


@kernel
def forces_all(rotor, amplitudes, phases, clocks, work):
    """Normal and friction force of lasting contact (M, P, 2) of states (M, N) in given phases (M, P) at instants (M,); zero in flight."""
    forces = np.zeros((*phases.shape, 2))
    for i in range(amplitudes.shape[0]):
        if not _stays(phases[i]):
            continue
        if rotor.limit_bounds.shape[0] > 0:
            work.clock = clocks[i]
            set_limits(rotor, amplitudes[i], work)
        contact_forces(rotor, phases[i], amplitudes[i], work)
        for station in range(phases.shape[1]):
            if lasts(phases[i, station]):
                push, grip = work.push[station, 0], work.grip[station, 0]
                if phases[i, station] != ROLLING:
                    grip = friction_ratio(sense_of_phase(phases[i, station]), wall_of(rotor, station)) * push
                forces[i, station, 0], forces[i, station, 1] = push, grip
    return forces


@inlined
def _same(first, second):
    """Whether two rows are the same to the last bit."""
    same = True
    for k in range(first.shape[0]):
        same = same and first[k] == second[k]
    return same


@inlined
def _stays(contact):
    """Whether any station stays at its wall."""
    found = False
    for station in range(contact.shape[0]):
        found = found or stays(contact[station])
    return found


@inlined
def _limited(states):
    """Whether any axis of a magnetic bearing may be at its bound."""
    found = False
    for axis in range(states.shape[0]):
        found = found or states[axis] != FREE
    return found


@kernel
def first_transition(rotor, station, phase, step, work):
    """First time within a step at which the kind of contact changes, and the phase that follows.

    Sliding ends where the normal force vanishes (flight follows) or the slip vanishes; rolling ends where the friction
    it needs leaves the cone.  In a compliant wall the depth may vanish (flight follows) or the force alone (the station is separated).

    Returns
    -------
    time : float
        The step itself if nothing changes.
    phase : int
        The phase that follows; the same if nothing changes, or if :func:`next_phase` must decide.
    undecided : bool
        Whether :func:`next_phase` must decide: the slip vanishes, or a separated station reaches its wall again.
    """
    wall, push = wall_of(rotor, station), work.push[station]
    if is_compliant(rotor, station):
        first, following, met = first_release(rotor, station, phase, step, work)
        if phase == SEPARATED:
            return first, following, met
        rounding = compliant_rounding(rotor, station, work.series[0]) if phase == ROLLING else 0.0
    else:
        rounding = push_rounding(rotor, station, work.series[0])
        first = first_fall(push, step, rounding)
        following = FLIGHT if first < step else phase
    if phase == ROLLING:
        for k in range(ORDER + 1):
            work.first_margin[k] = rolling_margin(push[k], work.grip[station, k], BACKWARD, wall)
            work.second_margin[k] = rolling_margin(push[k], work.grip[station, k], FORWARD, wall)
        rounding *= 1.0 + wall.friction
        backward = first_fall(work.first_margin, first, rounding)
        forward = first_fall(work.second_margin, backward, rounding)
        if forward < backward:
            return forward, FORWARD_SLIP, False
        if backward < first:
            return backward, BACKWARD_SLIP, False
        return first, following, False
    if is_compliant(rotor, station) and wall.friction == 0.0:
        return first, following, False  # the sense of the slip changes nothing: all of it counts as forward
    sign = -1.0 if phase == BACKWARD_SLIP else 1.0
    for k in range(ORDER + 1):
        work.first_margin[k] = sign * work.slip[station, k]
    stop = first_fall(work.first_margin, first, speed_rounding(rotor, station, work.series[0]))
    if stop < first:
        return stop, phase, True
    return first, following, False


@kernel
def first_contact(rotor, station, on_wall, step, work):
    """First time within a step at which a station without lasting contact comes to the wall, or the step.

    From ``(|y|²)'' = 2(Re(ȳÿ) + |ẏ|²)``; at rest on the wall see :func:`lift_off`.
    """
    state, rise = work.series[0], _rise(station, work)
    if on_wall and abs(rise) <= 2.0 * RESTING * speed_rounding(rotor, station, state):
        return _first_return(rotor, station, step, work)
    gap = 0.0 if on_wall else 1.0 - squared_modulus(work.position[station, 0])
    work.first_margin[0], work.first_margin[1] = gap, rise
    for k in range(ORDER - 1):
        work.first_margin[k + 2] = -2.0 * work.push[station, k] / ((k + 1) * (k + 2))
    return first_fall(work.first_margin, step, 2.0 * position_rounding(rotor, station, state))


@inlined
def _rise(station, work):
    """Rate of ``1 − |y|²`` at the start of a step."""
    return -2.0 * (work.position[station, 0].conjugate() * work.speed[station, 0]).real


@inlined
def _first_return(rotor, station, step, work):
    """First time within a step at which a station that starts at rest on its wall is back there, or the step.

    Its distance from there on is ``1 − |y|² = rise t − 2∬N``.  Where it is pulled off by more than rounding, the little
    ``rise`` that counts as rest is kept, and the margin is the distance by ``t``.  Elsewhere it is left out: the margin is
    the distance by ``t²``, which tells a return from the start.
    """
    rounding = push_rounding(rotor, station, work.series[0])
    if work.push[station, 0] < -rounding:
        work.first_margin[0] = max(_rise(station, work), 0.0)
        for k in range(ORDER):
            work.first_margin[k + 1] = -2.0 * work.push[station, k] / ((k + 1) * (k + 2))
        return first_fall(work.first_margin, step, speed_rounding(rotor, station, work.series[0]))
    for k in range(ORDER + 1):
        work.first_margin[k] = -2.0 * work.push[station, k] / ((k + 1) * (k + 2))
    return first_fall(work.first_margin, step, rounding)


@kernel
def lift_off(rotor, contact, amplitudes, horizon, work):
    """Follow a flight that starts at rest on the only wall, in place, to its return or to the end of a Taylor step.

    There ``|y|² − 1 = 2∬N`` with ``N = Re(ȳÿ) + |ẏ|²``, so the series of ``N`` gives the distance from the wall without
    cancellation, even for a departure as slow as ``N't³/3``.  A speed within rounding adds to that (:func:`_first_return`).

    Returns
    -------
    time : float
        Zero if it does not leave at all.
    returned : bool
        Whether it is back on the wall.
    """
    rub_series(rotor, contact, amplitudes, work)
    step = min(series_step(work), horizon)
    time = _first_return(rotor, 0, step, work)
    sum_series(work, time, amplitudes)
    returned = time < step
    if returned:
        set_on_wall(rotor, 0, amplitudes)
    return time, returned


@kernel
def turn_ahead(station, reference, direction, step, work):
    """Time within a step at which a station next passes a reference position in the given direction, or the step."""
    for k in range(ORDER + 1):
        work.first_margin[k] = -direction * (reference.conjugate() * work.position[station, k]).imag
    return first_fall(work.first_margin, step, NO_TURN)


@kernel
def rest_on_wall(rotor, station, amplitudes, rolling):
    """Remove the rounding errors of ``|y| = 1`` and ``Re(ȳẏ) = 0``, and those of the rolling condition if it rolls."""
    set_on_wall(rotor, station, amplitudes)
    normal = unit(displacement(rotor, station, amplitudes))
    local, surface_speed = normal.conjugate() * velocity(rotor, station, amplitudes), rotor.surface_speed[station]
    surface_speed += relative_excess(rotor, station, amplitudes)
    wall = rigid_wall(0.0, 0.0, surface_speed)
    change = normal * velocity_change_in_sense(local, STOPPED if rolling else FORWARD, wall)
    push_station(rotor, station, change, amplitudes, amplitudes)


@kernel
def is_at_wall(rotor, station, amplitudes):
    """Whether a station is at its wall, to rounding."""
    gap = 1.0 - squared_modulus(displacement(rotor, station, amplitudes))
    return gap <= 2.0 * RESTING * position_rounding(rotor, station, amplitudes)


@kernel
def wall_push(rotor, station, amplitudes):
    """Normal force that keeps a rotor at rest against the wall, and its rate at zero force."""
    position = unit(displacement(rotor, station, amplitudes))
    speed = velocity(rotor, station, amplitudes)
    free, jerk = 0j, 0j
    for m in range(amplitudes.shape[0]):
        rate = rotor.exponents[m] * amplitudes[m]
        if rotor.driven[m]:
            rate += amplitudes[m - 1]
        free += rotor.acceleration_rows[station, m] * amplitudes[m]
        jerk += rotor.acceleration_rows[station, m] * rate
    if rotor.shaft.shape[0] > 0:
        drive = unbalance_drive(rotor, amplitudes)
        turning = complex(0.0, amplitudes[rotor.shaft[0] + 1].real - 1.0)
        free += rotor.unbalance_rows[station] * drive
        jerk += rotor.unbalance_rows[station] * (turning * drive)
        for m in range(amplitudes.shape[0]):
            jerk += rotor.acceleration_rows[station, m] * (rotor.unbalance[m] * drive)
    inward = (position.conjugate() * free).real
    turning = (position.conjugate() * speed).imag
    change = (position.conjugate() * jerk).real + 3.0 * (speed.conjugate() * free).real
    return inward + turning * turning, change


@kernel
def press(rotor, contact, station, amplitudes, work):
    """:func:`wall_push` with the forces of lasting contact at other stations."""
    rub_series(rotor, contact, amplitudes, work)
    radial = (unit(work.position[station, 0]).conjugate() * work.speed[station, 0]).real
    return work.push[station, 0] - radial * radial, work.push[station, 1]


@kernel
def next_phase(rotor, contact, station, amplitudes, work):
    """Phase that follows from rest against the wall (``|y| = 1``, no radial speed, pressed outward).

    If the slip is zero, the rotor rolls if the friction needed for that lies within the cone.  Otherwise it slips in
    the direction of the tangential acceleration that friction cannot balance.  With ``μ = 0`` and no such acceleration,
    it continues to slip, in the direction opposite to that of the phase before.
    """
    position, wall = unit(displacement(rotor, station, amplitudes)), wall_of(rotor, station)
    slip = slip_of(position.conjugate() * velocity(rotor, station, amplitudes), wall)
    gives_way = is_compliant(rotor, station)
    if gives_way and wall.friction == 0.0:
        return FORWARD_SLIP
    if gives_way:
        slip = slip_in_wall(rotor, station, amplitudes)
    else:
        slip += relative_excess(rotor, station, amplitudes)
    if abs(slip) > speed_rounding(rotor, station, amplitudes):
        return FORWARD_SLIP if slip > 0.0 else BACKWARD_SLIP
    alone = rotor.rows.shape[0] == 1 and not may_change(rotor, station) and not gives_way
    if alone and rotor.limit_bounds.shape[0] == 0:
        push, _ = wall_push(rotor, station, amplitudes)
        pull = (position.conjugate() * acceleration(rotor, station, amplitudes)).imag
    else:
        push, pull = _rolling_forces(rotor, contact, station, amplitudes, work)
    begins = FORWARD if pull > 0.0 else BACKWARD
    if -rolling_margin(max(push, 0.0), -pull, begins, wall) > push_rounding(rotor, station, amplitudes):
        return phase_of_slip(begins)
    if wall.friction > 0.0:
        return ROLLING
    return BACKWARD_SLIP if contact[station] == FORWARD_SLIP else FORWARD_SLIP


@kernel
def phase_in_wall(rotor, contact, station, amplitudes, work):
    """Phase of a station that is in a compliant wall: parted from it where its force would pull."""
    position = displacement(rotor, station, amplitudes)
    rate = (unit(position).conjugate() * velocity(rotor, station, amplitudes)).real
    if force(math.sqrt(squared_modulus(position)) - 1.0, rate, wall_of(rotor, station)) <= 0.0:
        return SEPARATED
    return next_phase(rotor, contact, station, amplitudes, work)


@inlined
def _rolling_forces(rotor, contact, station, amplitudes, work):
    """Normal force if a station rolls, and the pull along growing angle that friction then has to balance."""
    before = contact[station]
    contact[station] = ROLLING
    rub_series(rotor, contact, amplitudes, work)
    contact[station] = before
    return work.push[station, 0], -work.grip[station, 0]
