"""How the force of a wall that gives way changes with its depth and rate, as Taylor series: the derivative of each law's ``force``."""

from __future__ import annotations

from carom.compiling.decorators import formula
from carom.core.laws.choice import LAWS, edge
from carom.core.laws.hunt_crossley import ONSET

HUNT_CROSSLEY = LAWS.index("hunt_crossley")


@formula
def force_change(k, depth, rate, power, depth_change, rate_change, power_change, wall):
    """Coefficient ``k`` of the change of the normal force, from those of depth and rate and of their changes up to it.

    Parameters
    ----------
    k : int
    depth, rate, power : arrays, shape (k + 1,)
        As :func:`~carom.core.laws.choice.force_coefficient` takes and leaves them.
    depth_change, rate_change : arrays, shape (k + 1,)
    power_change : array, shape (k + 1,)
        Receives the coefficient of the change of ``δⁿ``, from ``δ (δⁿ)˙ = n δ̇ δⁿ``, or of the parabola that takes its place.
    wall : Wall
    """
    if wall.law != HUNT_CROSSLEY:
        return wall.stiffness * depth_change[k] + wall.loss * rate_change[k]
    exponent = wall.law_number
    if exponent == 1.0:
        power_change[k] = depth_change[k]
    elif edge(depth[0], rate[0], wall) > 0.0:
        share, square = 6.0 / (exponent + 1.0) - 2.0, 0.0
        for j in range(k + 1):
            square += 2.0 * depth[j] * depth_change[k - j]
        power_change[k] = ONSET ** (exponent - 1.0) * (share * depth_change[k] + (1.0 - share) * square / ONSET)
    elif k == 0:
        power_change[0] = exponent * depth[0] ** (exponent - 1.0) * depth_change[0]
    else:
        total = -k * depth_change[0] * power[k]
        for j in range(1, k + 1):
            share = exponent * j - (k - j)
            total += share * (depth_change[j] * power[k - j] + depth[j] * power_change[k - j])
        power_change[k] = total / (k * depth[0])
    change = power_change[k]
    for j in range(k + 1):
        change += wall.loss * (power_change[j] * rate[k - j] + power[j] * rate_change[k - j])
    return wall.stiffness * change
