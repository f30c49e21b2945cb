"""How small changes of a state propagate through an impact, a flight and up to the next impact."""

from __future__ import annotations

import math

import numpy as np

from carom.core.compiling.decorators import inlined, kernel
from carom.core.flow import displacement, flight_increments, squared_modulus, velocity
from carom.core.friction import sense_of, velocity_change_by_speed, velocity_change_in_sense
from carom.core.wall import local_velocity, unit, wall_of


@kernel
def carry_through_impact(rotor, station, before, directions):
    """Replace changes of the amplitudes just before an impact by those just after it.

    Parameters
    ----------
    rotor : record of :func:`~carom.core.layout.rotor_record`
    station : int
    before : complex array, shape (N,)
        Amplitudes just before the impact.
    directions : complex array, shape (D, N)
        Changes of the amplitudes, along the wall; overwritten.
    """
    impact_derivatives(
        rotor, station, wall_of(rotor, station), sense_of_impact(rotor, station, before), before, directions
    )


@inlined
def impact_derivatives(rotor, station, wall, sense, before, directions):
    """:func:`carry_through_impact` for a given sense of the slip; returns the change of the station's velocity.

    The directions need not lie along the wall.
    """
    position = displacement(rotor, station, before)
    normal, radius = unit(position), math.sqrt(squared_modulus(position))
    local = normal.conjugate() * velocity(rotor, station, before)
    change = velocity_change_in_sense(local, sense, wall)
    for row in range(directions.shape[0]):
        moved = displacement(rotor, station, directions[row]) - rotor.offsets[station]
        turn = (normal.conjugate() * moved).imag / radius
        swing = normal.conjugate() * velocity(rotor, station, directions[row]) - 1j * turn * local
        varied = normal * (velocity_change_by_speed(local, sense, wall, swing) + 1j * turn * change)
        for k in range(before.shape[0]):
            directions[row, k] += rotor.columns[k, station] * varied
    return normal * change


@kernel
def apply_impact(rotor, station, sense, state, directions):
    """Impact with a given sense of the slip, in place, whether or not it is possible; the directions go along."""
    apply_impact_with(rotor, station, wall_of(rotor, station), sense, state, directions)


@inlined
def apply_impact_with(rotor, station, wall, sense, state, directions):
    """:func:`apply_impact` at a wall with numbers of its own."""
    change = impact_derivatives(rotor, station, wall, sense, state, directions)
    for k in range(state.shape[0]):
        state[k] += rotor.columns[k, station] * change


@kernel
def saltation_step(rotor, station, duration, end, directions, delays):
    """Replace changes at the start of a flight by the changes at its end on the wall.

    A changed flight arrives later by ``δt = −Re(ȳ δy)/Re(ȳ ẏ)`` (earlier if negative), which moves its end by
    ``ċ δt``: the saltation term.

    Parameters
    ----------
    rotor : record of :func:`~carom.core.layout.rotor_record`
    station : int
    duration : float
        Length of the unchanged flight.
    impact : complex array, shape (N,)
        Amplitudes of the unchanged flight where it meets the wall.
    directions : complex array, shape (D, N)
        Changes of the amplitudes; overwritten.
    delays : array, shape (D,)
        On return ``δt`` of each change.
    """
    position = displacement(rotor, station, end)
    outward = (position.conjugate() * velocity(rotor, station, end)).real
    increments = np.empty_like(directions)
    flight_increments(rotor, directions, duration, increments)
    for i in range(directions.shape[0]):
        for k in range(end.shape[0]):
            directions[i, k] += increments[i, k]
        position_change = displacement(rotor, station, directions[i]) - rotor.offsets[station]
        delays[i] = -(position.conjugate() * position_change).real / outward
    shift(rotor, end, directions, delays)


@kernel
def carry_through_impacts(rotor, stations, befores, afters, durations, directions):
    """Replace changes at the start of a sequence of flights and impacts by the changes at its end, at the same time.

    Returns the largest distance of amplitudes after an impact from those of an impact on this touchdown bearing alone.

    Parameters
    ----------
    rotor : record of :func:`~carom.core.layout.rotor_record`
    stations : int array, shape (n,)
        Touchdown bearing of each impact; −1 where one flight goes over into the next.
    impacts, afters : complex arrays, shape (n, N)
        Amplitudes before and after each impact.
    durations : array, shape (n + 1,)
        Length of each flight.
    directions : complex array, shape (D, N)
        Changes of the amplitudes; overwritten.
    """
    delays, increments, apart = np.empty(directions.shape[0]), np.empty_like(directions), 0.0
    for i in range(durations.shape[0]):
        if i < stations.shape[0] and stations[i] >= 0:
            saltation_step(rotor, stations[i], durations[i], befores[i], directions, delays)
            carry_through_impact(rotor, stations[i], befores[i], directions)
            after = befores[i].copy()
            apply_impact(rotor, stations[i], sense_of_impact(rotor, stations[i], befores[i]), after, directions[:0])
            for k in range(after.shape[0]):
                apart = max(apart, squared_modulus(after[k] - afters[i, k]))
            for row in range(delays.shape[0]):
                delays[row] = -delays[row]
            shift(rotor, after, directions, delays)
        else:
            flight_increments(rotor, directions, durations[i], increments)
            for row in range(directions.shape[0]):
                for k in range(directions.shape[1]):
                    directions[row, k] += increments[row, k]
    return math.sqrt(apart)


@inlined
def sense_of_impact(rotor, station, before):
    """Sense of the slip in an impact, from the amplitudes just before it."""
    wall = wall_of(rotor, station)
    return sense_of(local_velocity(rotor, station, before), wall)


@kernel
def shift(rotor, amplitudes, directions, delays):
    """Add to each change the motion during its delay, ``ċ δt``."""
    for i in range(directions.shape[0]):
        for k in range(amplitudes.shape[0]):
            rate = rotor.exponents[k] * amplitudes[k]
            if rotor.driven[k]:
                rate += amplitudes[k - 1]
            directions[i, k] += rate * delays[i]


@kernel
def section_jacobian(rotor, orbit, durations, jacobian):
    """Jacobian of a sequence of impacts of a planar rotor in angle, radial and angular speed.

    Parameters
    ----------
    rotor : record of :func:`~carom.models.from_modes.second_order_system`
    orbit : complex array, shape (P + 1, 2)
        Amplitudes just before each impact, and just before the one that follows.
    durations : array, shape (P,)
        Times between them, in ``1/Ω``.
    jacobian : array, shape (3, 3)
        Overwritten: derivative of ``(θ, ṙ, θ̇)`` just before the impact that follows by those before the first.
    """
    directions, delays = np.empty((3, 2), np.complex128), np.empty(3)
    position, speed = displacement(rotor, 0, orbit[0]), velocity(rotor, 0, orbit[0])
    set_amplitude_change(rotor, 1j * position, 1j * speed, directions[0])
    set_amplitude_change(rotor, 0j, position, directions[1])
    set_amplitude_change(rotor, 0j, 1j * position, directions[2])
    for i in range(durations.shape[0]):
        carry_through_impact(rotor, 0, orbit[i], directions)
        saltation_step(rotor, 0, durations[i], orbit[i + 1], directions, delays)
    normal = unit(displacement(rotor, 0, orbit[-1]))
    local = normal.conjugate() * velocity(rotor, 0, orbit[-1])
    for i in range(3):
        turn = (normal.conjugate() * (displacement(rotor, 0, directions[i]) - rotor.offsets[0])).imag
        swing = normal.conjugate() * velocity(rotor, 0, directions[i])
        jacobian[0, i] = turn
        jacobian[1, i] = swing.real + turn * local.imag
        jacobian[2, i] = swing.imag - turn * local.real


@inlined
def set_amplitude_change(rotor, position_change, velocity_change, amplitudes):
    """Write the change of the two amplitudes of a planar rotor that gives these changes of position and velocity."""
    amplitudes[0], amplitudes[1] = velocity_change - rotor.exponents[1] * position_change, position_change
