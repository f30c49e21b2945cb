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
from carom.core.friction import BACKWARD, FORWARD, STOPPED, arrival_in_sense, friction_ratio, slip_of, spare_grip
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
from carom.core.rounding import RESTING, position_rounding, push_rounding, speed_rounding, yielding_rounding
from carom.core.surfaces import may_change, relative_excess
from carom.core.taylor import first_fall, series_step, sum_series
from carom.core.wall import push_plane, rigid_wall, set_on_wall, unit, wall_of, yields

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
        for plane in range(phases.shape[1]):
            if lasts(phases[i, plane]):
                push, grip = work.push[plane, 0], work.grip[plane, 0]
                if phases[i, plane] != ROLLING:
                    grip = friction_ratio(sense_of_phase(phases[i, plane]), wall_of(rotor, plane)) * push
                forces[i, plane, 0], forces[i, plane, 1] = push, grip
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
    """Whether any plane stays at its wall."""
    found = False
    for plane in range(contact.shape[0]):
        found = found or stays(contact[plane])
    return found


@inlined
def _limited(states):
    """Whether any axis of a magnetic bearing may be at its bound."""
    found = False
    for axis in range(states.shape[0]):
        found = found or states[axis] != FREE
    return found


@kernel
def first_transition(rotor, plane, phase, step, work):
    """First time within a step at which the kind of contact changes, and the phase that follows.

    Sliding ends where the normal force vanishes (flight follows) or the slip vanishes; rolling ends where the friction
    it needs leaves the cone.  In a wall that gives way the depth may vanish (flight follows) or the force alone (the plane is separated).

    Returns
    -------
    time : float
        The step itself if nothing changes.
    phase : int
        The phase that follows; the same if nothing changes, or if :func:`next_phase` must decide.
    undecided : bool
        Whether :func:`next_phase` must decide: the slip vanishes, or a separated plane meets its wall again.
    """
    wall, push = wall_of(rotor, plane), work.push[plane]
    if yields(rotor, plane):
        first, following, met = first_release(rotor, plane, phase, step, work)
        if phase == SEPARATED:
            return first, following, met
        rounding = yielding_rounding(rotor, plane, work.series[0])
    else:
        rounding = push_rounding(rotor, plane, work.series[0])
        first = first_fall(push, step, rounding)
        following = FLIGHT if first < step else phase
    if phase == ROLLING:
        for k in range(ORDER + 1):
            work.first_margin[k] = spare_grip(push[k], work.grip[plane, k], BACKWARD, wall)
            work.second_margin[k] = spare_grip(push[k], work.grip[plane, k], FORWARD, wall)
        rounding *= 1.0 + wall.friction
        backward = first_fall(work.first_margin, first, rounding)
        forward = first_fall(work.second_margin, backward, rounding)
        if forward < backward:
            return forward, FORWARD_SLIP, False
        if backward < first:
            return backward, BACKWARD_SLIP, False
        return first, following, False
    if yields(rotor, plane) and wall.friction == 0.0:
        return first, following, False  # the sense of the slip changes nothing: all of it counts as forward
    sign = -1.0 if phase == BACKWARD_SLIP else 1.0
    for k in range(ORDER + 1):
        work.first_margin[k] = sign * work.slip[plane, k]
    stop = first_fall(work.first_margin, first, speed_rounding(rotor, plane, work.series[0]))
    if stop < first:
        return stop, phase, True
    return first, following, False


@kernel
def first_contact(rotor, plane, on_wall, step, work):
    """First time within a step at which a plane without lasting contact comes to the wall, or the step.

    From ``(|y|²)'' = 2(Re(ȳÿ) + |ẏ|²)``; at rest on the wall see :func:`lift_off`.
    """
    state, rise = work.series[0], _rise(plane, work)
    if on_wall and abs(rise) <= 2.0 * RESTING * speed_rounding(rotor, plane, state):
        return _first_return(rotor, plane, step, work)
    gap = 0.0 if on_wall else 1.0 - squared_modulus(work.position[plane, 0])
    work.first_margin[0], work.first_margin[1] = gap, rise
    for k in range(ORDER - 1):
        work.first_margin[k + 2] = -2.0 * work.push[plane, k] / ((k + 1) * (k + 2))
    return first_fall(work.first_margin, step, 2.0 * position_rounding(rotor, plane, state))


@inlined
def _rise(plane, work):
    """Rate of ``1 − |y|²`` at the start of a step."""
    return -2.0 * (work.position[plane, 0].conjugate() * work.speed[plane, 0]).real


@inlined
def _first_return(rotor, plane, step, work):
    """First time within a step at which a plane that starts at rest on its wall is back there, or the step.

    Its distance from there on is ``1 − |y|² = rise t − 2∬N``.  Where it is pulled off by more than rounding, the little
    ``rise`` that counts as rest is kept, and the margin is the distance by ``t``.  Elsewhere it is left out: the margin is
    the distance by ``t²``, which tells a return from the start.
    """
    rounding = push_rounding(rotor, plane, work.series[0])
    if work.push[plane, 0] < -rounding:
        work.first_margin[0] = max(_rise(plane, work), 0.0)
        for k in range(ORDER):
            work.first_margin[k + 1] = -2.0 * work.push[plane, k] / ((k + 1) * (k + 2))
        return first_fall(work.first_margin, step, speed_rounding(rotor, plane, work.series[0]))
    for k in range(ORDER + 1):
        work.first_margin[k] = -2.0 * work.push[plane, k] / ((k + 1) * (k + 2))
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
def turn_ahead(plane, reference, direction, step, work):
    """Time within a step at which a plane next passes a reference position in the given direction, or the step."""
    for k in range(ORDER + 1):
        work.first_margin[k] = -direction * (reference.conjugate() * work.position[plane, k]).imag
    return first_fall(work.first_margin, step, NO_TURN)


@kernel
def rest_on_wall(rotor, plane, amplitudes, rolling):
    """Remove the rounding errors of ``|y| = 1`` and ``Re(ȳẏ) = 0``, and those of the rolling condition if it rolls."""
    set_on_wall(rotor, plane, amplitudes)
    normal = unit(displacement(rotor, plane, amplitudes))
    local, surface_speed = normal.conjugate() * velocity(rotor, plane, amplitudes), rotor.surface_speed[plane]
    surface_speed += relative_excess(rotor, plane, amplitudes)
    wall = rigid_wall(0.0, 0.0, surface_speed)
    change = normal * arrival_in_sense(local, STOPPED if rolling else FORWARD, wall)
    push_plane(rotor, plane, change, amplitudes, amplitudes)


@kernel
def meets_wall(rotor, plane, amplitudes):
    """Whether a plane is at its wall, to rounding."""
    gap = 1.0 - squared_modulus(displacement(rotor, plane, amplitudes))
    return gap <= 2.0 * RESTING * position_rounding(rotor, plane, amplitudes)


@kernel
def wall_push(rotor, plane, amplitudes):
    """Normal force that keeps a rotor at rest against the wall, and its rate at zero force."""
    position = unit(displacement(rotor, plane, amplitudes))
    speed = velocity(rotor, plane, amplitudes)
    free, jerk = 0j, 0j
    for m in range(amplitudes.shape[0]):
        rate = rotor.exponents[m] * amplitudes[m]
        if rotor.driven[m]:
            rate += amplitudes[m - 1]
        free += rotor.acceleration_rows[plane, m] * amplitudes[m]
        jerk += rotor.acceleration_rows[plane, m] * rate
    if rotor.shaft.shape[0] > 0:
        drive = unbalance_drive(rotor, amplitudes)
        turning = complex(0.0, amplitudes[rotor.shaft[0] + 1].real - 1.0)
        free += rotor.unbalance_rows[plane] * drive
        jerk += rotor.unbalance_rows[plane] * (turning * drive)
        for m in range(amplitudes.shape[0]):
            jerk += rotor.acceleration_rows[plane, m] * (rotor.unbalance[m] * drive)
    inward = (position.conjugate() * free).real
    turning = (position.conjugate() * speed).imag
    change = (position.conjugate() * jerk).real + 3.0 * (speed.conjugate() * free).real
    return inward + turning * turning, change


@kernel
def press(rotor, contact, plane, amplitudes, work):
    """:func:`wall_push` with the forces of lasting contact at other planes."""
    rub_series(rotor, contact, amplitudes, work)
    radial = (unit(work.position[plane, 0]).conjugate() * work.speed[plane, 0]).real
    return work.push[plane, 0] - radial * radial, work.push[plane, 1]


@kernel
def next_phase(rotor, contact, plane, amplitudes, work):
    """Phase that follows from rest against the wall (``|y| = 1``, no radial speed, pressed outward).

    If the slip is zero, the rotor rolls if the friction needed for that lies within the cone.  Otherwise it slips in
    the direction of the tangential acceleration that friction cannot balance.  With ``μ = 0`` and no such acceleration,
    it continues to slip, in the direction opposite to that of the phase before.
    """
    position, wall = unit(displacement(rotor, plane, amplitudes)), wall_of(rotor, plane)
    slip = slip_of(position.conjugate() * velocity(rotor, plane, amplitudes), wall)
    gives_way = yields(rotor, plane)
    if gives_way and wall.friction == 0.0:
        return FORWARD_SLIP
    if gives_way:
        slip = slip_in_wall(rotor, plane, amplitudes)
    else:
        slip += relative_excess(rotor, plane, amplitudes)
    if abs(slip) > speed_rounding(rotor, plane, amplitudes):
        return FORWARD_SLIP if slip > 0.0 else BACKWARD_SLIP
    alone = rotor.rows.shape[0] == 1 and not may_change(rotor, plane) and not gives_way
    if alone and rotor.limit_bounds.shape[0] == 0:
        push, _ = wall_push(rotor, plane, amplitudes)
        pull = (position.conjugate() * acceleration(rotor, plane, amplitudes)).imag
    else:
        push, pull = _rolling_forces(rotor, contact, plane, amplitudes, work)
    begins = FORWARD if pull > 0.0 else BACKWARD
    if -spare_grip(max(push, 0.0), -pull, begins, wall) > push_rounding(rotor, plane, amplitudes):
        return phase_of_slip(begins)
    if wall.friction > 0.0:
        return ROLLING
    return BACKWARD_SLIP if contact[plane] == FORWARD_SLIP else FORWARD_SLIP


@kernel
def phase_in_wall(rotor, contact, plane, amplitudes, work):
    """Phase of a plane that is in a wall that gives way: parted from it where its force would pull."""
    position = displacement(rotor, plane, amplitudes)
    rate = (unit(position).conjugate() * velocity(rotor, plane, amplitudes)).real
    if force(math.sqrt(squared_modulus(position)) - 1.0, rate, wall_of(rotor, plane)) <= 0.0:
        return SEPARATED
    return next_phase(rotor, contact, plane, amplitudes, work)


@inlined
def _rolling_forces(rotor, contact, plane, amplitudes, work):
    """Normal force if a plane rolls, and the pull along growing angle that friction then has to balance."""
    before = contact[plane]
    contact[plane] = ROLLING
    rub_series(rotor, contact, amplitudes, work)
    contact[plane] = before
    return work.push[plane, 0], -work.grip[plane, 0]
