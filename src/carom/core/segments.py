"""Maps of the segments that an orbit consists of, with their exact derivatives, for any linear rotor.

A segment begins with an impact with a given slip case at its node, and flies for a given duration.  At its end the wall is to be met.
Neither the kind of an impact nor the duration of a flight is decided here.  So all maps are smooth, even where an impact grazes or the
motion is impossible.

Directions are changes of the amplitudes, to which everything here is real-linear: those by which each of the ``S`` coordinates and
rates changes by ``1`` and by ``i``, ``2S`` in all, stand for the derivative.
"""

from __future__ import annotations

import numpy as np

from carom.core.compiling.decorators import inlined, kernel
from carom.core.flow import displacement, flight_increments, squared_modulus
from carom.core.friction import BACKWARD, FORWARD, STOPPED
from carom.core.variation import apply_impact

IMPACT_FORWARD, IMPACT_BACKWARD, IMPACT_STOPPED = range(3)
"""Kinds of impacts, by the slip after them."""


@kernel
def follow_flights(rotor, basis, to_modes, rest, kinds, stations, targets, nodes, durations, ends, values, slopes):
    """Follow each impact and flight from its node, with the derivatives of its end, where the wall is to be met.

    Parameters
    ----------
    rotor : record of :func:`~carom.core.layout.rotor_record`
    basis, to_modes : complex arrays, shape (S, N) and (N, S)
        State (coordinates, then their rates) per amplitude, and amplitudes per state.
    rest : complex array, shape (S,)
        State whose amplitudes are zero.
    kinds, stations : int arrays, shape (m,)
        Kind and station of the impact with which each segment begins.
    targets : int array, shape (m,)
        Station at whose wall it ends.
    nodes : complex array, shape (m, S)
        States at the beginning: just before the impact.
    durations : array, shape (m,)
    impacts : complex array, shape (m, S)
        Overwritten: states at the end.
    values : array, shape (m,)
        Overwritten: value of the condition, ``(|y|² − 1)/2``.
    slopes : array, shape (m, 2S + 1, 2S + 1)
        Overwritten: derivative of real and imaginary parts of the end, then of the condition, by those of the node, then
        by the duration.
    """
    modes, last = to_modes.shape[0], 2 * nodes.shape[1]
    moved, increments = np.empty((last + 1, modes), np.complex128), np.empty((last + 1, modes), np.complex128)
    rate = np.empty(modes, np.complex128)
    for i in range(kinds.shape[0]):
        directions = perturbation_basis(to_modes, rest, nodes[i], moved)
        apply_impact(rotor, stations[i], sense_after(kinds[i]), moved[last], directions)
        flight_increments(rotor, moved, durations[i], increments)
        for row in range(last + 1):
            for k in range(modes):
                moved[row, k] += increments[row, k]
        _flight_rate(rotor, moved[last], rate)
        store_result(basis, rest, moved, rate, ends[i], slopes[i])
        y = displacement(rotor, targets[i], moved[last])
        values[i] = 0.5 * (squared_modulus(y) - 1.0)
        for row in range(last + 1):
            part_of_y = 0j
            for k in range(modes):
                part_of_y += rotor.rows[targets[i], k] * (rate[k] if row == last else moved[row, k])
            slopes[i, last, row] = (y.conjugate() * part_of_y).real


@inlined
def perturbation_basis(to_modes, rest, node, moved):
    """Write the amplitudes of a unit change of each real and imaginary part of the state, and in the last row those of the state.

    Return the rows of the changes.
    """
    size = node.shape[0]
    for k in range(to_modes.shape[0]):
        moved[2 * size, k] = 0j
        for j in range(size):
            moved[j, k], moved[size + j, k] = to_modes[k, j], 1j * to_modes[k, j]
            moved[2 * size, k] += to_modes[k, j] * (node[j] - rest[j])
    return moved[: 2 * size]


@inlined
def store_result(basis, rest, moved, rate, end, slopes):
    """Write the state from its amplitudes, and the derivatives of its real and imaginary parts."""
    size, modes = basis.shape
    for j in range(size):
        for row in range(2 * size + 1):
            change = 0j
            for k in range(modes):
                change += basis[j, k] * (rate[k] if row == 2 * size else moved[row, k])
            slopes[j, row], slopes[size + j, row] = change.real, change.imag
        end[j] = rest[j]
        for k in range(modes):
            end[j] += basis[j, k] * moved[2 * size, k]


@inlined
def sense_after(kind):
    """Sense of the slip after the impact of a segment."""
    if kind == IMPACT_STOPPED:
        return STOPPED
    return FORWARD if kind == IMPACT_FORWARD else BACKWARD


@inlined
def _flight_rate(rotor, state, rate):
    """Write ``ċ`` of a flight."""
    for k in range(state.shape[0]):
        rate[k] = rotor.exponents[k] * state[k]
        if rotor.driven[k]:
            rate[k] += state[k - 1]
