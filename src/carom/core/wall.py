"""Walls: their numbers, and stations at them: the velocity there, and how to put them exactly on it."""

from __future__ import annotations

import math
from typing import NamedTuple

from carom.core.compiling.decorators import formula, inlined
from carom.core.flow import displacement, squared_modulus, velocity


class Wall(NamedTuple):
    """What the laws need to know of a contact station.

    Attributes
    ----------
    friction, restitution : float
        Coefficients ``μ``, and ``d`` of slow impacts.
    surface_speed : float
        Slip velocity of a rotor at rest in the co-rotating frame, ``s + 1``, in clearances per unit time.
    law : int
        Number of the law along the normal (:mod:`carom.core.laws.choice`); 0 is the rigid wall.
    law_number : float
        The law's own number.
    stiffness, loss : float
        Of a compliant wall, per effective mass of the station; a wall without stiffness does not.
    farthest : float
        Distance of the station from the centre, in clearances, up to which a motion is followed in a compliant wall.
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
def wall_of(rotor, station):
    """Numbers of the wall at a station of a rotor."""
    return Wall(
        rotor.friction[station],
        rotor.restitution[station],
        rotor.surface_speed[station],
        rotor.law[station],
        rotor.law_number[station],
        rotor.stiffness[station],
        rotor.loss[station],
        rotor.farthest[station],
    )


@formula
def rigid_wall(friction, restitution, surface_speed):
    """A rigid wall, for kernels: these take no defaults."""
    return Wall(friction, restitution, surface_speed, 0, 0.0, 0.0, 0.0, math.inf)


@inlined
def is_compliant(rotor, station):
    """Whether the wall at a station is compliant."""
    return rotor.stiffness[station] > 0.0


@inlined
def unit(z):
    """``z/|z|``."""
    scale = 1.0 / math.sqrt(squared_modulus(z))
    return complex(scale * z.real, scale * z.imag)


@inlined
def local_velocity(rotor, station, amplitudes):
    """Velocity ``ṙ + iθ̇`` of a station in the frame of its contact."""
    return unit(displacement(rotor, station, amplitudes)).conjugate() * velocity(rotor, station, amplitudes)


@inlined
def set_on_wall(rotor, station, amplitudes):
    """Move a station to the nearest point of the wall by the smallest change of the amplitudes."""
    position = displacement(rotor, station, amplitudes)
    move_station(rotor, station, unit(position) - position, amplitudes)


@inlined
def move_station(rotor, station, shift, amplitudes):
    """Move a station by the smallest change of the amplitudes of free modes: forces do not depend on where it is."""
    scale = 1.0 / rotor.weights[station]
    scaled = complex(scale * shift.real, scale * shift.imag)
    for k in range(amplitudes.shape[0]):
        if rotor.free[k]:
            amplitudes[k] += rotor.rows[station, k].conjugate() * scaled


@inlined
def push_station(rotor, station, change, before, after):
    """Amplitudes after an impulse at a station that changes its velocity by so much; before and after may be one array."""
    for k in range(after.shape[0]):
        after[k] = before[k] + rotor.columns[k, station] * change
    if rotor.anisotropy.shape[0] > 0:
        conjugated = change.conjugate() * after[rotor.anisotropy[0]]
        for k in range(after.shape[0]):
            after[k] += rotor.conjugate_columns[k, station] * conjugated
