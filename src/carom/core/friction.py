"""Arrivals at a wall and lasting contact there, with Coulomb friction.

At the wall a station has the velocity ``ṙ + iθ̇`` in the frame of its contact, which is called *local* here, and its contact point slips
with ``v = surface_speed + θ̇``.  Impulses are per effective mass of the station, so that they are changes of its velocity.

An impact has the impulse ``p`` that the wall's law says (:mod:`carom.core.laws.choice`).  With it friction changes the velocity along the wall by ``−min(μp, |v|) sgn v``: it stops the slip, but never reverses it.  In lasting contact the
normal force ``N`` keeps the station on the wall, and friction is ``−μN sgn v`` while it slips, and whatever keeps ``v = 0`` while that is
within ``±μN``.

The *sense* of a slip is one of FORWARD, BACKWARD and STOPPED.  For a given sense all of this is smooth, even for impacts that cannot be.
"""

from __future__ import annotations

import math

from carom.core.compiling.decorators import formula
from carom.core.laws.choice import impulse, impulse_by_restitution, impulse_by_speed
from carom.core.vector import join, where

BACKWARD, STOPPED, FORWARD = -1, 0, 1
"""Senses of a slip."""


@formula
def rebound(speed, wall):
    """Speed of the rebound of an impact with a radial speed."""
    return wall.restitution * impulse_by_restitution(speed, wall)


@formula
def slip_of(local, wall):
    """Slip velocity of the contact point."""
    return wall.surface_speed + local.imag


@formula
def friction_margin(local, wall):
    """What the friction of an impact could take away from the slip beyond stopping it; below zero if it does not stop it."""
    return wall.friction * impulse(local.real, wall) - abs(slip_of(local, wall))


@formula
def velocity_change(local, wall):
    """Change of the local velocity by an impact; numbers or lanes."""
    normal, slip = impulse(local.real, wall), slip_of(local, wall)
    most = wall.friction * normal
    taken = where(most < abs(slip), most, abs(slip))
    return join(-normal, where(slip >= 0.0, -taken, taken))


@formula
def velocity_change_in_sense(local, sense, wall):
    """:func:`velocity_change` with a given sense of the slip after it, whatever the slip before it."""
    normal = impulse(local.real, wall)
    return complex(-normal, -slip_of(local, wall) if sense == STOPPED else friction_ratio(sense, wall) * normal)


@formula
def velocity_change_by_speed(local, sense, wall, change):
    """Small change of :func:`velocity_change_in_sense` for a small change of the local velocity."""
    normal = impulse_by_speed(local.real, wall) * change.real
    return complex(-normal, -change.imag if sense == STOPPED else friction_ratio(sense, wall) * normal)


@formula
def landing(local, wall):
    """Change of the local velocity by the outward impulse that completes a chatter; friction pulls along the slip, up to it."""
    share = min(wall.friction * max(-local.real, 0.0), abs(slip_of(local, wall)))
    return complex(-local.real, math.copysign(share, slip_of(local, wall)))


@formula
def velocity_change_by_law(local, sense, wall, change):
    """Derivative of :func:`velocity_change_in_sense` by friction, restitution and surface speed, which change by those of ``change``."""
    normal = change.restitution * impulse_by_restitution(local.real, wall)
    along = wall.friction * normal + change.friction * impulse(local.real, wall)
    return complex(-normal, -change.surface_speed if sense == STOPPED else -sense * along)


@formula
def margin_of_slip(local, sense, wall):
    """Distance of an impact from one with another sense of the slip: the slip left, or what friction could still take."""
    margin = friction_margin(local, wall)
    if sense == STOPPED:
        return margin
    return sense * slip_of(local, wall) - wall.friction * impulse(local.real, wall)


@formula
def sense_of(local, wall):
    """Sense of the slip after an impact."""
    if friction_margin(local, wall) >= 0.0:
        return STOPPED
    return FORWARD if slip_of(local, wall) > 0.0 else BACKWARD


@formula
def sliding_factor(friction, restitution):
    """Impulse of an impact at a rigid wall that slips forward, per radial speed: ``q = (1 + d)(1 + iμ)``."""
    return complex(1.0 + restitution, (1.0 + restitution) * friction)


@formula
def friction_ratio(sense, wall):
    """Ratio of the friction along growing angle to the normal force while the contact point slips."""
    return -sense * wall.friction


@formula
def rolling_force(position, free, wall):
    """Contact force that lets a station roll, ``ẏ = −i s y``, against its acceleration without the force."""
    return -wall.surface_speed * wall.surface_speed * position - free


@formula
def rolling_margin(push, grip, sense, wall):
    """Distance of rolling from slip of this sense, from its normal force and its friction along growing angle."""
    return wall.friction * push + sense * grip
