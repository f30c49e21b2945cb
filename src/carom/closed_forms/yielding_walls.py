r"""Steady motions of a rotor that is pressed on a wall that gives way: synchronous rubs, slipping backward whirl.

At a constant indentation ``δ`` the rate ``δ̇`` vanishes, and the dashpot of a Kelvin–Voigt wall or the dissipation of a
Hunt–Crossley wall does nothing: both push with ``N = κδⁿ`` per felt mass (``n = 1`` for Kelvin–Voigt).  Lengths are clearances.

*Synchronous rub.*  At rest in the co-rotating frame, at the displacement ``y = (1 + δ)e^{iθ}``, slip is forward, so that the
contact force is ``−(1 + iμ)N e^{iθ}``.  Through the static receptance ``H`` of the plane (that of the fixed frame at the frequency
``Ω``) it moves the plane from its contact-free place ``y*``:

    (1 + δ + hκδⁿ) e^{iθ} = y*,      h = H(1 + iμ),      thus      |1 + δ + hκδⁿ| = |y*|.

Squared, that is a sum of real powers of ``δ``,

    1 − |y*|² + 2δ + δ² + 2 Re(h)κ(δⁿ + δ^{n+1}) + |h|²κ²δ^{2n} = 0.

All its positive roots are found (:mod:`carom.closed_forms.power_sums`), of whatever powers.

For the disc of an overhung rotor in a frictionless ring, with the natural frequency as the unit of time, polar inertia ``J_p``
per diametral one, damping ``2ζ``, unbalance ``mε`` and the ring's stiffness ``β``, the receptance is
``1/(1 − (1 − J_p)Ω² + 2iζΩ)`` and the condition ``|1 − (1 − J_p)Ω² + β(1 − 1/r) + 2iζΩ| r = mεΩ²``.

*Slipping backward whirl* of a planar rotor without unbalance, at the speed ``ν`` in the fixed frame: ``z = re^{−iνt}`` with the
contact force ``−(1 + iμ)Nz/r``.  Radial and tangential parts of ``z̈ + γż + ω²z`` are

    (ν² − ω²) r = N,      γνr = μN,

so that ``μ(ν² − ω²) = γν`` whatever the wall is: ``ν`` is the averaged threshold of the runaway on a rigid wall
(:func:`~carom.closed_forms.thresholds.sustaining_speed`).  The wall decides the radius, ``κδⁿ = (γν/μ)(1 + δ)``; of a spring
``r = 1/(1 − γν/(μκ))``, for ``κ > γν/μ``.  With ``n > 1`` there is one radius for each stiffness: ``δⁿ/(1 + δ)`` grows from
zero to infinity.  Slip is forward while ``νr < s``; a rotor that would whirl faster rolls.
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass

import numpy as np

from carom.arguments import Positive, Whole, checked
from carom.closed_forms.free_impact import Exponent
from carom.closed_forms.power_sums import positive_roots
from carom.closed_forms.statics import rubs_in_wall
from carom.closed_forms.thresholds import sustaining_speed
from carom.models import Subject, jeffcott_of, model_of
from carom.outcome import InputError


@dataclass(frozen=True)
class YieldingRub:
    """A rotor at rest in the co-rotating frame, pressed on a wall that gives way.

    Attributes
    ----------
    depth : float
        Indentation ``δ``, in clearances.
    place : complex
        Displacement at the plane, ``(1 + δ)e^{iθ}``, in clearances.
    normal_force : float
        ``κδⁿ``, per felt mass, in ``c_r Ω²``.
    """

    depth: float
    place: complex
    normal_force: float


@dataclass(frozen=True)
class SlippingWhirl:
    """Circular backward whirl in which friction against the spin and the damping balance.

    Attributes
    ----------
    speed : float
        Whirl speed ``ν`` against the spin in the fixed frame, in ``Ω``.
    radius : float
        In clearances.
    normal_force : float
        Per mass, in ``c_r Ω²``.
    slips : bool
        Whether the contact point slips forward at this speed, as is assumed; otherwise the rotor rolls before it gets there.
    """

    speed: float
    radius: float
    normal_force: float
    slips: bool


@checked
def yielding_rubs(
    machine: Subject, stiffness: Positive, exponent: Exponent = 1.0, *, plane: Whole = 0
) -> tuple[YieldingRub, ...]:
    """All synchronous rubs of a rotor on one plane whose wall gives way, derived in :mod:`carom.closed_forms.yielding_walls`.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        Any linear rotor; the law of its walls is not used.  Stability is not judged.
    stiffness : float
        ``κ`` of the force ``κδⁿ`` per felt mass, in ``Ω²`` and clearances.
    exponent : float
        ``n``, at least 1; 1 for a Kelvin–Voigt wall.
    plane : int
        The plane in contact; whether others are clear is not asked.

    Returns
    -------
    tuple of YieldingRub
        By growing depth; none where any angle would do, as for a balanced rotor.

    Raises
    ------
    InputError
        There is no such plane, a value is not allowed, or forces on the rotor change with time.

    See Also
    --------
    carom.find_equilibria : the same on rigid walls

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/source-paper.toml")
    >>> [f"{rub.depth:.3e}" for rub in cm.closed_forms.yielding_rubs(machine, stiffness=1e4)]
    ['5.871e-07', '7.910e-05']
    """
    system = model_of(machine).system
    system.refuse_forces()
    if plane >= len(system.arrays["rows"]):
        raise InputError("plane", plane, f"a contact plane of the rotor, from 0 to {len(system.arrays['rows']) - 1}")
    row, column = system.arrays["rows"][plane], system.arrays["columns"][:, plane]
    receptance = complex(-row @ np.linalg.solve(system.generator, column))
    lever = receptance * complex(1.0, system.arrays["friction"][plane])
    rubs = rubs_in_wall(lever, complex(system.arrays["offsets"][plane]), stiffness, exponent)
    return tuple(
        YieldingRub(depth, cmath.rect(1.0 + depth, cmath.phase(turned)), stiffness * depth**exponent)
        for depth, turned in rubs
    )


@checked
def slipping_whirl(machine: Subject, stiffness: Positive, exponent: Exponent = 1.0) -> SlippingWhirl | None:
    """Slipping backward whirl of the planar rotor without unbalance, derived in :mod:`carom.closed_forms.yielding_walls`.

    Its speed depends on damping and friction alone, its radius on the wall.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        The planar rotor; its unbalance is not used.
    stiffness : float
        ``κ`` of the force ``κδⁿ`` per mass, in ``Ω²`` and clearances.
    exponent : float
        ``n``, at least 1; 1 for a Kelvin–Voigt wall.

    Returns
    -------
    SlippingWhirl or None
        ``None`` without friction or damping, and where the wall is too soft to hold the rotor.

    Raises
    ------
    InputError
        It is not the planar rotor, or a value is not allowed.

    See Also
    --------
    carom.closed_forms.runaway_speed : the speed as a threshold on a rigid wall

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/source-paper.toml")
    >>> whirl = cm.closed_forms.slipping_whirl(machine, stiffness=1e4)
    >>> print(f"{whirl.speed:.9f}, {whirl.radius:.9f}")
    1.163219537, 1.000077554
    """
    at = jeffcott_of(machine).parameters
    if at.mu == 0.0 or at.gamma <= 0.0:
        return None
    speed = sustaining_speed(at)
    pull = at.gamma * speed / at.mu
    depths = positive_roots([(exponent, stiffness), (1.0, -pull), (0.0, -pull)])
    if not depths:
        return None
    radius = 1.0 + depths[0]
    return SlippingWhirl(speed, radius, pull * radius, slips=speed * radius < at.radius_ratio)
