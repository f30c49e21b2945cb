"""A Hunt–Crossley wall: the force ``κδⁿ(1 + χδ̇)`` on a plane that is ``δ`` deep in the wall, which vanishes with the depth.

The wall's ``loss`` is ``χ`` and the law's own number is ``n``.

A power ``n`` that is no whole number has a branch point where contact begins, next to which no Taylor series converges.  There, below a
depth ``ε`` of :data:`ONSET`, a parabola ``ε^n (αδ/ε + βδ²/ε²)`` takes its place that has the same value at ``ε`` and does the same work
up to it: ``α + β = 1`` and ``α/2 + β/3 = 1/(n + 1)``.  Through a contact entered with the speed ``v`` its impulse is then the same to
``κε^(n + 2)/v²``, below rounding for any wall of a machine.
"""

from __future__ import annotations

from carom.compiling.decorators import formula
from carom.core.laws.yielding import no_impulse

impulse = impulse_by_speed = impulse_by_restitution = no_impulse
ONSET = 1e-9
"""Depth in clearances below which a parabola takes the place of the power."""
AT_EDGE = 5e-5
"""Distance from the onset, relative to its depth, within which a plane counts as there."""


@formula
def edge(depth, rate, wall):
    """Depth at which the series of the force takes another form, negative if the plane is deeper; zero if there is none.

    At the edge, to far more than the rounding error of a depth, the plane is on the side to which it moves.  That must be less than
    what the search for the edge takes for none (:data:`carom.core.compliance.SHARP`), or it stops where it starts.
    """
    if wall.law_number == 1.0:
        return 0.0
    return ONSET if depth < (1.0 - AT_EDGE) * ONSET or (depth < (1.0 + AT_EDGE) * ONSET and rate < 0.0) else -ONSET


@formula
def force(depth, rate, wall):
    """Normal force at a depth that grows at a rate."""
    power = max(depth, 0.0) ** wall.law_number
    if wall.law_number != 1.0 and depth < ONSET:
        share = 6.0 / (wall.law_number + 1.0) - 2.0
        part = max(depth, 0.0) / ONSET
        power = ONSET**wall.law_number * part * (share + (1.0 - share) * part)
    return wall.stiffness * power * (1.0 + wall.loss * rate)


@formula
def force_coefficient(k, depth, rate, power, wall):
    """Taylor coefficient ``k`` of the force from those of depth and rate up to it.

    ``power`` receives that of ``δⁿ``, by the recurrence that follows from ``δ (δⁿ)˙ = n δ̇ δⁿ``.
    """
    if wall.law_number == 1.0:
        power[k] = depth[k]
    elif edge(depth[0], rate[0], wall) > 0.0:
        share, square = 6.0 / (wall.law_number + 1.0) - 2.0, 0.0
        for j in range(k + 1):
            square += depth[j] * depth[k - j]
        power[k] = ONSET ** (wall.law_number - 1.0) * (share * depth[k] + (1.0 - share) * square / ONSET)
    elif k == 0:
        power[0] = depth[0] ** wall.law_number
    else:
        total = 0.0
        for j in range(1, k + 1):
            total += (wall.law_number * j - (k - j)) * depth[j] * power[k - j]
        power[k] = total / (k * depth[0])
    force = power[k]
    for j in range(k + 1):
        force += wall.loss * power[j] * rate[k - j]
    return wall.stiffness * force


@formula
def press_coefficient(k, depth, rate, wall):
    """Taylor coefficient ``k`` of what vanishes with the force, at any depth: ``1 + χδ̇``."""
    return wall.loss * rate[k] + (1.0 if k == 0 else 0.0)


@formula
def press_rounding(of_depth, of_rate, wall):
    """Rounding error of :func:`press_coefficient`, from those of depth and rate."""
    return wall.loss * of_rate


@formula
def force_rounding(of_depth, of_rate, wall):
    """Bound of the rounding error of the force at depths below one, from those of depth and rate.

    The rate's is at least the rate times that of the depth, which turns the normal against the velocity.
    """
    return wall.stiffness * (wall.law_number * of_depth + (wall.law_number + 1.0) * wall.loss * of_rate)


@formula
def stored_energy(depth, wall):
    """Energy of the wall's spring."""
    return wall.stiffness * max(depth, 0.0) ** (wall.law_number + 1.0) / (wall.law_number + 1.0)
