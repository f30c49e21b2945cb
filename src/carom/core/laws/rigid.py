"""The rigid wall with Newton's restitution: the rebound has a constant share of the speed of the arrival."""

from __future__ import annotations

from carom.compiling.decorators import formula


@formula
def impulse(speed, wall):
    """Impulse of an arrival with a radial speed."""
    return (1.0 + wall.restitution) * speed


@formula
def impulse_by_speed(speed, wall):
    """Derivative of :func:`impulse` by the speed."""
    return 1.0 + wall.restitution


@formula
def impulse_by_restitution(speed, wall):
    """Derivative of :func:`impulse` by the restitution."""
    return speed
