"""A restitution that falls with the speed ``ṙ`` of the arrival: ``d/(1 + ṙ/v)``, as of a wall that yields more the harder it is hit.

The law's own number is ``1/v``.  No rebound is faster than ``dv``.
"""

from __future__ import annotations

from carom.compiling.decorators import formula


@formula
def impulse(speed, wall):
    """Impulse of an arrival with a radial speed."""
    return speed + wall.restitution * impulse_by_restitution(speed, wall)


@formula
def impulse_by_speed(speed, wall):
    """Derivative of :func:`impulse` by the speed."""
    less = 1.0 + wall.law_number * abs(speed)
    return 1.0 + wall.restitution / (less * less)


@formula
def impulse_by_restitution(speed, wall):
    """Derivative of :func:`impulse` by the restitution."""
    return speed / (1.0 + wall.law_number * abs(speed))
