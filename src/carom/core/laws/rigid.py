"""The rigid wall: Newton's restitution for impacts, no way through in lasting contact, Coulomb friction in both.

At the wall a plane has the velocity ``ṙ + iθ̇`` in the frame of its contact, which is called *local* here, and its contact point slips
with ``v = surface_speed + θ̇``.  Impulses are per effective mass of the plane, so that they are changes of its velocity.

An arrival changes the velocity by ``−(1 + d)ṙ`` along the normal and by ``−min(μ(1 + d)ṙ, |v|) sgn v`` along the wall: friction stops the
slip, but never reverses it.  In lasting contact the normal force ``N`` keeps the plane on the wall, and friction is
``−μN sgn v`` while it slips, and whatever keeps ``v = 0`` while that is within ``±μN``.

The *sense* of a slip is one of FORWARD, BACKWARD and STOPPED.  For a given sense all of this is linear in the velocities and forces,
and so small changes obey the same functions, at a wall whose surface is at rest (:func:`at_rest`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from carom.core.layout import formula
from carom.core.vector import join, where

BACKWARD, STOPPED, FORWARD = -1, 0, 1
"""Senses of a slip."""


class Wall(NamedTuple):
    """Numbers of the law at a plane.

    Attributes
    ----------
    friction, restitution : float
        Coefficients ``μ`` and ``d``.
    surface_speed : float
        Slip velocity of a rotor at rest in the co-rotating frame, ``s + 1``, in clearances per unit time.
    """

    friction: float
    restitution: float
    surface_speed: float


@formula
def wall_of(rotor, plane):
    """Numbers of the law at a plane of a rotor, or arrays of them at several planes."""
    return Wall(rotor.friction[plane], rotor.restitution[plane], rotor.surface_speed[plane])


@formula
def at_rest(wall):
    """The same wall without the speed of its surface: the law of small changes."""
    return Wall(wall.friction, wall.restitution, 0.0)


@formula
def slip_of(local, wall):
    """Slip velocity of the contact point."""
    return wall.surface_speed + local.imag


@formula
def spare_friction(local, wall):
    """What the friction of an arrival could take away from the slip beyond stopping it; below zero if it does not stop it."""
    return wall.friction * ((1.0 + wall.restitution) * local.real) - abs(slip_of(local, wall))


@formula
def arrival(local, wall):
    """Change of the local velocity by an arrival; numbers or lanes."""
    normal, slip = (1.0 + wall.restitution) * local.real, slip_of(local, wall)
    most = wall.friction * normal
    taken = where(most < abs(slip), most, abs(slip))
    return join(-normal, where(slip >= 0.0, -taken, taken))


@formula
def arrival_in_sense(local, sense, wall):
    """:func:`arrival` with a given sense of the slip after it, whatever the slip before it.

    So it is smooth, even for impacts that cannot be.
    """
    normal = (1.0 + wall.restitution) * local.real
    return complex(-normal, -slip_of(local, wall) if sense == STOPPED else friction_ratio(sense, wall) * normal)


@formula
def landing(local, wall):
    """Change of the local velocity by the outward impulse that completes a chatter; friction pulls along the slip, up to it."""
    share = min(wall.friction * max(-local.real, 0.0), abs(slip_of(local, wall)))
    return complex(-local.real, math.copysign(share, slip_of(local, wall)))


@formula
def arrival_by_law(local, sense, wall, change):
    """Derivative of :func:`arrival_in_sense` by the numbers of the law, which change by those of ``change``."""
    normal = change.restitution * local.real
    along = wall.friction * normal + change.friction * (1.0 + wall.restitution) * local.real
    return complex(-normal, -change.surface_speed if sense == STOPPED else -sense * along)


@formula
def margin_of_slip(local, sense, wall):
    """Distance of an arrival from one with another sense of the slip: the slip left, or what friction could still take."""
    spare = spare_friction(local, wall)
    if sense == STOPPED:
        return spare
    return sense * slip_of(local, wall) - wall.friction * ((1.0 + wall.restitution) * local.real)


@formula
def sense_of(local, wall):
    """Sense of the slip after an arrival."""
    if spare_friction(local, wall) >= 0.0:
        return STOPPED
    return FORWARD if slip_of(local, wall) > 0.0 else BACKWARD


@formula
def friction_ratio(sense, wall):
    """Ratio of the friction along growing angle to the normal force while the contact point slips."""
    return -sense * wall.friction


@formula
def rolling_force(position, free, wall):
    """Contact force that lets a plane roll, ``ẏ = −i s y``, against its acceleration without the force."""
    return -wall.surface_speed * wall.surface_speed * position - free


@formula
def spare_grip(push, grip, sense, wall):
    """Distance of rolling from slip of this sense, from its normal force and its friction along growing angle."""
    return wall.friction * push + sense * grip
