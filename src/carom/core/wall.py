"""Walls: their numbers, and planes at them: the velocity there, and how to put them exactly on it."""

from __future__ import annotations

import math
from typing import NamedTuple

from carom.core.compiling.decorators import formula, inlined
from carom.core.flow import displacement, squared_modulus, velocity


class Wall(NamedTuple):
    """What the laws need to know of a contact plane.

    Attributes
    ----------
    friction, restitution : float
        Coefficients ``μ``, and ``d`` of slow arrivals.
    surface_speed : float
        Slip velocity of a rotor at rest in the co-rotating frame, ``s + 1``, in clearances per unit time.
    law : int
        Number of the law along the normal (:mod:`carom.core.laws.choice`); 0 is the rigid wall.
    law_number : float
        The law's own number.
    stiffness, loss : float
        Of a wall that gives way, per effective mass of the plane; a wall without stiffness does not.
    farthest : float
        Distance of the plane from the centre, in clearances, up to which a motion is followed in a wall that gives way.
    """

    friction: float
    restitution: float
    surface_speed: float
    law: int = 0
    law_number: float = 0.0
    stiffness: float = 0.0
    loss: float = 0.0
    farthest: float = math.inf


@formula
def wall_of(rotor, plane):
    """Numbers of the wall at a plane of a rotor."""
    return Wall(
        rotor.friction[plane],
        rotor.restitution[plane],
        rotor.surface_speed[plane],
        rotor.law[plane],
        rotor.law_number[plane],
        rotor.stiffness[plane],
        rotor.loss[plane],
        rotor.farthest[plane],
    )


@formula
def rigid_wall(friction, restitution, surface_speed):
    """A rigid wall, for kernels: these take no defaults."""
    return Wall(friction, restitution, surface_speed, 0, 0.0, 0.0, 0.0, math.inf)


@inlined
def yields(rotor, plane):
    """Whether the wall at a plane gives way."""
    return rotor.stiffness[plane] > 0.0


@inlined
def unit(z):
    """``z/|z|``."""
    scale = 1.0 / math.sqrt(squared_modulus(z))
    return complex(scale * z.real, scale * z.imag)


@inlined
def local_velocity(rotor, plane, amplitudes):
    """Velocity ``ṙ + iθ̇`` of a plane in the frame of its contact."""
    return unit(displacement(rotor, plane, amplitudes)).conjugate() * velocity(rotor, plane, amplitudes)


@inlined
def set_on_wall(rotor, plane, amplitudes):
    """Move a plane to the nearest point of the wall by the smallest change of the amplitudes."""
    position = displacement(rotor, plane, amplitudes)
    move_plane(rotor, plane, unit(position) - position, amplitudes)


@inlined
def move_plane(rotor, plane, shift, amplitudes):
    """Move a plane by the smallest change of the amplitudes of free modes: forces do not depend on where it is."""
    scale = 1.0 / rotor.weights[plane]
    scaled = complex(scale * shift.real, scale * shift.imag)
    for k in range(amplitudes.shape[0]):
        if rotor.free[k]:
            amplitudes[k] += rotor.rows[plane, k].conjugate() * scaled


@inlined
def push_plane(rotor, plane, change, before, after):
    """Amplitudes after an impulse at a plane that changes its velocity by so much; before and after may be one array."""
    for k in range(after.shape[0]):
        after[k] = before[k] + rotor.columns[k, plane] * change
    if rotor.mirror.shape[0] > 0:
        mirrored = change.conjugate() * after[rotor.mirror[0]]
        for k in range(after.shape[0]):
            after[k] += rotor.mirror_columns[k, plane] * mirrored
