r"""Impact of a free mass on a wall that gives way: how deep, how hard, how long.

Numbers are per mass of the body, as the contact planes of a rotor feel them: a Kelvin–Voigt wall pushes with ``κδ + cδ̇`` and
a Hunt–Crossley wall with ``κδⁿ(1 + χδ̇)``, never less than zero.  Nothing else acts on the body.  How much of the
arrival's speed ``v`` comes back is derived in :mod:`carom.parameters.restitution`; the rest follows from the same solutions.

*Kelvin–Voigt*, with ``ω₀ = √κ``, ``ζ = c/(2ω₀) = cos ψ``, ``f = ψ/sin ψ`` and ``λ = ω₀e^{i(π−ψ)}``.  Contact begins with the
force ``cv`` at once, and lasts for ``2f/ω₀``.  At the deepest point ``Im λe^{λt} = 0``: half of that time has passed, and

    δ_max = (v/ω₀)e^{−ζf} = (v/ω₀)√d.

The force ``−δ̈`` is largest where ``Im λ³e^{λt} = 0``, which is at ``ω₀t sin ψ = 3ψ − π`` and comes after the arrival for
``ζ < 1/2`` only:

    N_max = vω₀ e^{−ζ(3ψ−π)/sin ψ}  for ζ < 1/2,      N_max = cv  for ζ ≥ 1/2.

*Hunt–Crossley*.  With ``x = χδ̇`` and ``G(x) = x − ln(1 + x)`` the energy integral is ``κδ^{n+1}/(n + 1) = (G(χv) − G(x))/χ²``, so

    κδ_max^{n+1} = (n + 1) G(χv)/χ².

The force is largest where ``nδ̇ = χκδ^{n+1}``, that is where

    nx + (n + 1) G(x) = (n + 1) G(χv),

whose left side grows with ``x > 0``: there ``κδ^{n+1} = nx/χ²`` and ``N_max = κδⁿ(1 + x)``.  ``G`` is free of cancellation as
``x²/(2 + x) − 2(z³/3 + z⁵/5 + …)`` with ``z = x/(2 + x)``, from ``ln(1 + x) = 2 artanh z``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

from carom.arguments import Kind, NotNegative, Positive, checked
from carom.continuation.roots import bracketed_root
from carom.parameters.restitution import (
    half_contact,
    restitution_of_damping,
    restitution_of_dissipation,
)

Exponent = Annotated[float, Kind(lambda number: number >= 1.0, "a number of at least 1")]

SMALL = 1.0
"""``χv`` below which the series of ``x − ln(1 + x)`` is summed; above, the difference loses less than a digit."""
TERMS = 18
"""Terms of that series: ``z ≤ 1/3``, so that the next one is below rounding."""


@dataclass(frozen=True)
class FreeImpact:
    """What becomes of a free mass that strikes a wall, and what the wall bears.

    Attributes
    ----------
    restitution : float
        Share ``d`` of its speed with which it leaves.
    depth : float
        Largest indentation ``δ``, in the unit of length.
    peak_force : float
        Largest force on it per mass: an acceleration.
    duration : float or None
        Time in contact; ``None`` for a Hunt–Crossley wall, where it has no closed form.
    """

    restitution: float
    depth: float
    peak_force: float
    duration: float | None


@checked
def kelvin_voigt_impact(stiffness: Positive, damping: NotNegative, speed: Positive) -> FreeImpact:
    """Impact of a free mass on a spring and a dashpot that do not pull, derived in :mod:`carom.closed_forms.free_impact`.

    Parameters
    ----------
    stiffness : float
        ``κ``, force per indentation and mass; dimensionless ``k/(mΩ²)``.
    damping : float
        ``c``, force per speed of the indentation and mass; dimensionless ``c/(mΩ)``.
    speed : float
        Speed of the arrival; dimensionless in ``c_r Ω``.

    Returns
    -------
    FreeImpact
        Units follow from those given: with dimensionless numbers lengths are in ``c_r``, times in ``1/Ω``.

    Raises
    ------
    InputError
        Stiffness or speed is not positive, or the damping negative.

    See Also
    --------
    carom.closed_forms.hunt_crossley_impact : a wall whose damping grows with its indentation

    Examples
    --------
    >>> import carom as cm
    >>> cm.closed_forms.kelvin_voigt_impact(stiffness=1e4, damping=0.0, speed=2.0)
    FreeImpact(restitution=1.0, depth=0.02, peak_force=200.0, duration=0.03141592653589793)
    """
    frequency = math.sqrt(stiffness)
    ratio = damping / (2.0 * frequency)
    restitution, half = restitution_of_damping(ratio), half_contact(ratio)
    depth = speed / frequency * math.exp(-ratio * half)
    peak = speed * damping
    if ratio < 0.5:
        delay = 3.0 * half - math.pi / math.sqrt((1.0 - ratio) * (1.0 + ratio))
        peak = speed * frequency * math.exp(-ratio * delay)
    return FreeImpact(restitution, depth, peak, 2.0 * half / frequency)


@checked
def hunt_crossley_impact(
    stiffness: Positive, dissipation: NotNegative, exponent: Exponent, speed: Positive
) -> FreeImpact:
    """Impact of a free mass on a Hunt–Crossley wall, derived in :mod:`carom.closed_forms.free_impact`.

    Parameters
    ----------
    stiffness : float
        ``κ`` of the force ``κδⁿ(1 + χδ̇)`` per mass.
    dissipation : float
        ``χ``, in the unit of one over the speed.
    exponent : float
        ``n``, at least 1: 1 of a spring, 10/9 of a line contact, 3/2 of a point contact.
    speed : float
        Speed of the arrival.

    Returns
    -------
    FreeImpact
        Without the time of contact, which has no closed form.

    Raises
    ------
    InputError
        Stiffness or speed is not positive, the dissipation negative or the exponent below 1.

    See Also
    --------
    carom.closed_forms.kelvin_voigt_impact : a spring and a dashpot

    Examples
    --------
    >>> import carom as cm
    >>> impact = cm.closed_forms.hunt_crossley_impact(1e4, dissipation=0.36, exponent=1.0, speed=1.0)
    >>> print(f"{impact.restitution:.5f} of the speed, {impact.depth:.5f} deep")
    0.80573 of the speed, 0.00900 deep
    """
    product = dissipation * speed
    root = 1.0 / (exponent + 1.0)
    # Energies per (exponent + 1) and v², so that nothing vanishes with the dissipation.
    energy = (exponent + 1.0) * _energy(product)
    depth = (energy * speed * speed / stiffness) ** root
    share = _share_at_peak(product, exponent, energy)
    at_peak = (exponent * share * speed * speed / stiffness) ** root
    peak = stiffness * at_peak**exponent * (1.0 + product * product * share)
    return FreeImpact(restitution_of_dissipation(dissipation, speed), depth, peak, None)


def _energy(product: float) -> float:
    """``(x − ln(1 + x))/x²``: 1/2 at zero."""
    if product >= SMALL:
        return (product - math.log1p(product)) / product**2
    z = product / (2.0 + product)
    # z³/x² = z/(2 + x)², and so on.
    series = sum(z ** (2 * k) / (2 * k + 3) for k in range(TERMS))
    return 1.0 / (2.0 + product) - 2.0 * z / (2.0 + product) ** 2 * series


def _share_at_peak(product: float, exponent: float, energy: float) -> float:
    """``x/(χv)²`` where the force is largest, with ``x = χδ̇``."""
    high = energy / exponent

    def balance(share: float) -> float:
        return (
            exponent * share + (exponent + 1.0) * (product * share) ** 2 * _energy(product * product * share) - energy
        )

    if product == 0.0 or balance(high) == 0.0:
        return high
    return bracketed_root(balance, 0.0, high)
