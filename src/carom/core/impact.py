"""Impact and friction laws, independent of the rotor they act on."""

from __future__ import annotations

import math

from carom.core.flow import displacement, squared_modulus
from carom.core.layout import part


@part
def unit(z):
    """``z/|z|``."""
    scale = 1.0 / math.sqrt(squared_modulus(z))
    return complex(scale * z.real, scale * z.imag)


@part
def strike(position, velocity, friction, restitution, drive):
    """Change of velocity in an impact with Newton restitution and slip-limited Coulomb friction.

    Parameters
    ----------
    position, velocity : complex
        Displacement on the wall and velocity just before the impact, in clearances.
    friction, restitution, drive : float
        Coefficients of the plane and the slip velocity at rest, ``s + 1`` in the co-rotating frame.

    Returns
    -------
    change : complex
        ``ẏ⁺ − ẏ⁻``.  Normal part ``−(1 + d) ṙ⁻``; tangential part ``−min(μ(1 + d) ṙ⁻, |v|) sgn v`` with the slip
        velocity ``v = drive + θ̇``, so friction stops the slip but never reverses it.
    sticks : bool
        Whether the slip was stopped.
    """
    normal = unit(position)
    change, sticks = rebound(normal.conjugate() * velocity, friction, restitution, drive)
    return normal * change, sticks


@part
def rebound(local, friction, restitution, drive):
    """:func:`strike` in the frame of the contact: change of ``ṙ + iθ̇`` and whether the slip was stopped."""
    slip = drive + local.imag
    normal_change = (1.0 + restitution) * local.real
    tangential_change = friction * normal_change
    sticks = tangential_change >= abs(slip)
    if sticks:
        tangential_change = abs(slip)
    # Not copysign(tangential_change, slip): virtual orbits strike with ṙ⁻ < 0.
    return complex(-normal_change, -math.copysign(1.0, slip) * tangential_change), sticks


@part
def strike_variation(position, velocity, friction, restitution, drive, position_change, velocity_change):
    """Directional derivative of the change of velocity in :func:`strike` (real-linear in the two changes)."""
    normal = unit(position)
    radius = abs(position)
    local = normal.conjugate() * velocity
    slip = drive + local.imag
    turn = (normal.conjugate() * position_change).imag / radius
    local_change = normal.conjugate() * velocity_change - 1j * turn * local
    normal_change = (1.0 + restitution) * local.real
    normal_variation = (1.0 + restitution) * local_change.real
    if friction * normal_change >= abs(slip):
        change = complex(-normal_change, -slip)
        variation = complex(-normal_variation, -local_change.imag)
    else:
        grip = math.copysign(friction, slip)
        change = complex(-normal_change, -grip * normal_change)
        variation = complex(-normal_variation, -grip * normal_variation)
    return normal * (variation + 1j * turn * change)


@part
def set_on_wall(rotor, plane, amplitudes):
    """Move a plane to the nearest point of the wall by the smallest change of the amplitudes."""
    position = displacement(rotor, plane, amplitudes)
    move_plane(rotor, plane, unit(position) - position, amplitudes)


@part
def move_plane(rotor, plane, shift, amplitudes):
    """Move a plane by the smallest change of the amplitudes."""
    scale = 1.0 / rotor.weights[plane]
    scaled = complex(scale * shift.real, scale * shift.imag)
    for k in range(amplitudes.shape[0]):
        amplitudes[k] += rotor.rows[plane, k].conjugate() * scaled
