"""A Hunt–Crossley wall: the force ``κδⁿ(1 + χδ̇)`` on a station that is ``δ`` deep in the wall, which vanishes with the depth.

The wall's ``loss`` is ``χ`` and the law's own number is ``n``.

A power ``n`` that is no whole number has a branch point where contact begins, next to which no Taylor series converges.  There, below a
depth ``ε`` of :data:`ONSET`, a parabola ``ε^n (αδ/ε + βδ²/ε²)`` takes its place that has the same value at ``ε`` and does the same work
up to it: ``α + β = 1`` and ``α/2 + β/3 = 1/(n + 1)``.  Through a contact entered with the speed ``v`` its impulse is then the same to
``κε^(n + 2)/v²``, below rounding for any wall of a machine.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from carom.base.arguments import NotNegative, Positive, checked
from carom.core.compiling.decorators import formula
from carom.core.laws.compliant import no_impulse
from carom.core.laws.law import FromOneToTwo, Law

impulse = impulse_by_speed = impulse_by_restitution = no_impulse
ONSET = 1e-9
"""Depth in clearances below which a parabola takes the place of the power."""
AT_EDGE = 5e-5
"""Distance from the onset, relative to its depth, within which a station counts as there."""


@formula
def edge(depth, rate, wall):
    """Depth at which the series of the force takes another form, negative if the station is deeper; zero if there is none.

    At the edge, to far more than the rounding error of a depth, the station is on the side to which it moves.  That must be less than
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
def force_change(k, depth, rate, power, depth_change, rate_change, power_change, wall):
    """Coefficient ``k`` of the change of the normal force, from those of depth and rate and of their changes up to it.

    Parameters
    ----------
    k : int
    depth, rate, power : arrays, shape (k + 1,)
        As :func:`force_coefficient` takes and leaves them.
    depth_change, rate_change : arrays, shape (k + 1,)
    power_change : array, shape (k + 1,)
        Receives the coefficient of the change of ``δⁿ``, from ``δ (δⁿ)˙ = n δ̇ δⁿ``, or of the parabola that takes its place.
    wall : Wall
    """
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


@checked
@dataclass(frozen=True)
class HuntCrossley(Law):
    """A wall whose damping grows with the depth: the force ``k δⁿ (1 + χδ̇)`` at the depth ``δ`` .

    Attributes
    ----------
    stiffness : float
       ``k`` in ``m Ω² c_r^(1 − n)``, with the unit ``m`` of the rotor's masses.
    dissipation : float
       ``χ`` in ``1/(c_r Ω)``.
    exponent : float
       ``n``: 1, 10/9 (rollers) or 3/2 (balls), or another one from 1 to 2.
    """

    stiffness: Positive
    dissipation: NotNegative
    exponent: FromOneToTwo = 1.0

    law: ClassVar = "hunt_crossley"
    parameters: ClassVar = {"wall_stiffness": "stiffness", "wall_dissipation": "dissipation"}

    def numbers(self, mass: float) -> dict[str, float]:
        """Numbers of its wall."""
        return {"stiffness": self.stiffness / mass, "loss": self.dissipation, "law_number": self.exponent}

    def at_speed(self, factor: float) -> HuntCrossley:
        """Return the same at another speed of the shaft."""
        return HuntCrossley(self.stiffness / factor**2, self.dissipation * factor, self.exponent)
