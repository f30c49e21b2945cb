"""Rounding errors of sums over the modes: of the place of a station, its speed, and the force that keeps it on its wall."""

from __future__ import annotations

from carom.core.compiling.decorators import inlined, kernel
from carom.core.flow import unbalance_drive
from carom.core.laws.choice import force_rounding
from carom.core.wall import wall_of

ROUNDING = 64 * 2.220446049250313e-16
"""Rounding error of a sum over the modes, relative to the moduli of its terms."""
RESTING = 4.0
"""Radial speed, in rounding errors, up to which the rotor rests on the wall: so low a flight cannot be resolved."""


@inlined
def position_rounding(rotor, station, amplitudes):
    """Rounding error of the distance of a station on its wall."""
    return ROUNDING * _spread(rotor, station, amplitudes)


@inlined
def speed_rounding(rotor, station, amplitudes):
    """Rounding error of the radial speed and the speed along the wall.

    It is that of the velocity's terms, and that of the position, which turns the wall's normal against the velocity.
    """
    rates, speed = 1.0, 0j
    for m in range(amplitudes.shape[0]):
        rate = rotor.rate_rows[station, m] * amplitudes[m]
        rates += _size(rate)
        speed += rate
    return ROUNDING * (rates + _spread(rotor, station, amplitudes) * _size(speed))


@kernel
def push_rounding(rotor, station, amplitudes):
    """Rounding error of the normal force ``Re(ȳÿ) + |ẏ|²``: of the terms of ``ÿ`` and ``ẏ``, and of the position.

    The position counts twice, by its direction and by the force that it changes; that dominates near the equilibrium.
    """
    forces, rates, lever, force, speed = 0.0, 0.0, 0.0, 0j, 0j
    for m in range(amplitudes.shape[0]):
        row, rate = rotor.acceleration_rows[station, m], rotor.rate_rows[station, m] * amplitudes[m]
        lever += _size(row * rotor.rows[station, m]) / rotor.weights[station]
        forces += _size(row * amplitudes[m])
        rates += _size(rate)
        force += row * amplitudes[m]
        speed += rate
    if rotor.shaft.shape[0] > 0:
        turning = rotor.unbalance_rows[station] * unbalance_drive(rotor, amplitudes)
        forces += _size(turning)
        force += turning
    of_position = _spread(rotor, station, amplitudes) * (_size(force) + lever)
    return ROUNDING * (forces + 2.0 * _size(speed) * rates + of_position)


@inlined
def compliant_rounding(rotor, station, amplitudes):
    """Rounding error of the force of a compliant wall, and of the friction that rolling needs there."""
    wall = wall_of(rotor, station)
    of_depth, of_rate = position_rounding(rotor, station, amplitudes), speed_rounding(rotor, station, amplitudes)
    return force_rounding(of_depth, of_rate, wall) + push_rounding(rotor, station, amplitudes)


@inlined
def _spread(rotor, station, amplitudes):
    """Sum of the sizes of the terms of a displacement of modulus one, on the wall: a measure of their cancellation."""
    spread = _size(rotor.offsets[station])
    for m in range(amplitudes.shape[0]):
        spread += _size(rotor.rows[station, m] * amplitudes[m])
    return spread


@inlined
def _size(z):
    """Bound of ``|z|``."""
    return abs(z.real) + abs(z.imag)
