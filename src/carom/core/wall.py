"""Planes at their walls: the velocity there, and how to put them exactly on it."""

from __future__ import annotations

import math

from carom.core.flow import displacement, squared_modulus, velocity
from carom.core.layout import part


@part
def unit(z):
    """``z/|z|``."""
    scale = 1.0 / math.sqrt(squared_modulus(z))
    return complex(scale * z.real, scale * z.imag)


@part
def local_velocity(rotor, plane, amplitudes):
    """Velocity ``ṙ + iθ̇`` of a plane in the frame of its contact."""
    return unit(displacement(rotor, plane, amplitudes)).conjugate() * velocity(rotor, plane, amplitudes)


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
