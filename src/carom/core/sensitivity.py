"""How the equations of multiple shooting change with a parameter of the rotor, exactly, for words of impacts.

The nodes and durations stay.  What changes are the law of the impacts and the accelerations of the flights, by ``δA (U, U̇) + δf``.
In the amplitudes of the unchanged rotor, a flight ``ċ = Λc`` becomes ``δċ = Λδc + Gc + g``, so that

    δc(t) = e^{Λt} δc(0) + D(t) c(0) + V(t).

``e^{Λt}``, ``D`` and ``V`` come from their power series at a short time, which is doubled: ``D(2t) = e^{Λt} D(t) + D(t) e^{Λt}``.
That needs no quotients of differences of exponents, and no more work the stiffer the rotor is.
"""

from __future__ import annotations

import math

import numpy as np

from carom.core.compiling.decorators import inlined, kernel
from carom.core.flow import displacement, squared_modulus
from carom.core.friction import velocity_change_by_law
from carom.core.segments import sense_after
from carom.core.variation import apply_impact
from carom.core.wall import local_velocity, rigid_wall, unit, wall_of

NEGLIGIBLE, MOST_TERMS = 1e-17, 30
"""Size of the first term left out of the power series, relative to the sum, and more terms than that takes."""


@kernel
def sensitivity_of_flights(
    rotor,
    basis,
    to_modes,
    rest,
    accelerations,
    force,
    friction,
    restitution,
    surface_speed,
    kinds,
    stations,
    targets,
    nodes,
    durations,
):
    """Derivative of the left sides of the equations of a word of impacts by a parameter.

    Parameters
    ----------
    rotor, basis, to_modes, rest, kinds, stations, targets, nodes, durations
        As for :func:`~carom.core.segments.follow_flights`.
    accelerations : complex array, shape (S/2, S)
        Derivative of the accelerations of the coordinates per coordinate, then per rate of a coordinate.
    force : complex array, shape (S/2,)
        Derivative of their constant part.
    friction, restitution, surface_speed : arrays, shape (P,)
        Derivatives of the contact law of each station.

    Returns
    -------
    array, shape (m (2S + 1),)
        In the order of :func:`~carom.core.closure.shooting_equations`.
    """
    (m, size), modes = nodes.shape, to_modes.shape[0]
    width = 2 * size + 1
    left = np.empty(m * width)
    coupling = _coupling(basis, to_modes, rest, accelerations, force)
    state, changed, still = (
        np.empty(modes, np.complex128),
        np.empty(modes, np.complex128),
        np.empty((0, modes), np.complex128),
    )
    end, end_change = np.empty(modes, np.complex128), np.empty(modes, np.complex128)
    growth, response = np.empty((modes, modes), np.complex128), np.empty((modes, modes + 1), np.complex128)
    for i in range(m):
        station = stations[i]
        for k in range(modes):
            state[k] = 0j
            for j in range(size):
                state[k] += to_modes[k, j] * (nodes[i, j] - rest[j])
        normal, sense = unit(displacement(rotor, station, state)), sense_after(kinds[i])
        by_law = rigid_wall(friction[station], restitution[station], surface_speed[station])
        change = velocity_change_by_law(local_velocity(rotor, station, state), sense, wall_of(rotor, station), by_law)
        for k in range(modes):
            changed[k] = rotor.columns[k, station] * (normal * change)
        apply_impact(rotor, station, sense, state, still)
        _respond(rotor, coupling, durations[i], growth, response)
        for k in range(modes):
            end[k], end_change[k] = 0j, response[k, modes]
            for j in range(modes):
                end[k] += growth[k, j] * state[j]
                end_change[k] += growth[k, j] * changed[j] + response[k, j] * state[j]
        moved, y = 0j, displacement(rotor, targets[i], end)
        for k in range(modes):
            moved += rotor.rows[targets[i], k] * end_change[k]
        for k in range(size):
            shift = 0j
            for j in range(modes):
                shift += basis[k, j] * end_change[j]
            left[i * width + k], left[i * width + size + k] = shift.real, shift.imag
        left[i * width + 2 * size] = (y.conjugate() * moved).real
    return left


@inlined
def _coupling(basis, to_modes, rest, accelerations, force):
    """``G``, and ``g`` as last column: what changed accelerations do to the amplitudes, per amplitude and at rest."""
    half, size = accelerations.shape
    modes = to_modes.shape[0]
    coupling = np.zeros((modes, modes + 1), np.complex128)
    for row in range(half):
        for column in range(modes + 1):
            pull = force[row] if column == modes else 0j
            for k in range(size):
                pull += accelerations[row, k] * (rest[k] if column == modes else basis[k, column])
            for k in range(modes):
                coupling[k, column] += to_modes[k, half + row] * pull
    return coupling


@inlined
def _respond(rotor, coupling, time, growth, response):
    """Write ``e^{Λt}``, and ``D(t)`` with ``V(t)`` as last column."""
    # The driven modes couple with one.
    fastest, step, doublings = 1.0, time, 0
    for k in range(growth.shape[0]):
        fastest = max(fastest, 1.0 + math.sqrt(squared_modulus(rotor.exponents[k])))
    while 1.0 < abs(step) * fastest < np.inf:
        step *= 0.5
        doublings += 1
    power, driven = np.empty_like(growth), np.empty_like(response)
    _sum_series(rotor, coupling, step, step * fastest, growth, response, power, driven)
    for _ in range(doublings):
        for row in range(growth.shape[0]):
            for column in range(growth.shape[0]):
                power[row, column] = growth[row, column]
                driven[row, column] = response[row, column]
            driven[row, growth.shape[0]] = response[row, growth.shape[0]]
        _double(power, driven, growth, response)


@inlined
def _sum_series(rotor, coupling, step, angle, growth, response, power, driven):
    """Power series of ``e^{Λt}``, ``D`` and ``V`` at a short time with ``|Λ|t`` below an angle; ``power`` and ``driven`` hold their terms."""
    modes = growth.shape[0]
    for row in range(modes):
        for column in range(modes):
            power[row, column] = complex(1.0 if row == column else 0.0, 0.0)
            growth[row, column], driven[row, column], response[row, column] = power[row, column], 0j, 0j
        driven[row, modes], response[row, modes] = 0j, 0j
    term, size = 1, abs(angle)
    while not size <= NEGLIGIBLE and term < MOST_TERMS:
        share = step / term
        # From the last row on, as each is made from the one before.
        for row in range(modes - 1, -1, -1):
            for column in range(modes + 1):
                change = _rate(rotor, driven, row, column)
                if column < modes:
                    for k in range(modes):
                        change += coupling[row, k] * power[k, column]
                elif term == 1:
                    change += coupling[row, modes]
                driven[row, column] = share * change
                response[row, column] += driven[row, column]
        for row in range(modes - 1, -1, -1):
            for column in range(modes):
                power[row, column] = share * _rate(rotor, power, row, column)
                growth[row, column] += power[row, column]
        term += 1
        size *= abs(angle) / term


@inlined
def _rate(rotor, amplitudes, row, column):
    """``Λc`` of one of several amplitudes, each in a column."""
    rate = rotor.exponents[row] * amplitudes[row, column]
    if rotor.driven[row]:
        rate += amplitudes[row - 1, column]
    return rate


@inlined
def _double(power, driven, growth, response):
    """Write what follows from ``e^{Λt}``, ``D`` and ``V`` for twice the time."""
    modes = growth.shape[0]
    for row in range(modes):
        for column in range(modes):
            twice, total = 0j, 0j
            for k in range(modes):
                twice += power[row, k] * power[k, column]
                total += power[row, k] * driven[k, column] + driven[row, k] * power[k, column]
            growth[row, column], response[row, column] = twice, total
        total = driven[row, modes]
        for k in range(modes):
            total += power[row, k] * driven[k, modes]
        response[row, modes] = total
