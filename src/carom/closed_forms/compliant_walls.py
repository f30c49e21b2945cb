r"""Steady motions of a rotor that is pressed on a compliant wall: synchronous rubs, slipping backward whirl.

At a constant indentation ``δ`` the rate ``δ̇`` vanishes, and the dashpot of a Kelvin–Voigt wall or the dissipation of a
Hunt–Crossley wall does nothing: both push with ``N = κδⁿ`` per effective mass (``n = 1`` for Kelvin–Voigt).  Lengths are clearances.

*Synchronous rub.*  At rest in the co-rotating frame, at the displacement ``y = (1 + δ)e^{iθ}``, slip is forward, so that the
contact force is ``−(1 + iμ)N e^{iθ}``.  Through the static receptance ``H`` of the plane (that of the fixed frame at the frequency
``Ω``) it moves the plane from its contact-free place ``y*``:

    (1 + δ + hκδⁿ) e^{iθ} = y*,      h = H(1 + iμ),      thus      |1 + δ + hκδⁿ| = |y*|.

Squared, that is a sum of real powers of ``δ``,

    1 − |y*|² + 2δ + δ² + 2 Re(h)κ(δⁿ + δ^{n+1}) + |h|²κ²δ^{2n} = 0.

All its positive roots are found (:mod:`carom.closed_forms.statics`), of whatever powers; :func:`carom.find_equilibria` lists them.

For the disc of an overhung rotor in a frictionless ring, with the natural frequency as the unit of time, polar inertia ``J_p``
per diametral one, damping ``2ζ``, unbalance ``mε`` and the ring's stiffness ``β``, the receptance is
``1/(1 − (1 − J_p)Ω² + 2iζΩ)`` and the condition ``|1 − (1 − J_p)Ω² + β(1 − 1/r) + 2iζΩ| r = mεΩ²``.

*Slipping backward whirl* of a rotor without unbalance, at the speed ``ν`` in the fixed frame: the plane is at ``re^{−iνt}`` with the
contact force ``−(1 + iμ)N`` in its direction.  With the receptance ``G`` of the plane, seen in the fixed frame,

    r = −G(−iν)(1 + iμ) N,      thus      arg[G(−iν)(1 + iμ)] = π,

which decides ``ν`` whatever the wall is.  ``g(ν) = −G(−iν)(1 + iμ)`` is a ratio of polynomials, and it is real where it equals its
conjugate: the zeros of ``g − ḡ``, all of which are eigenvalues of a pencil of matrices with the modes of the rotor and their conjugates.
Those count that are real with ``g > 0``.  The wall decides the radius, ``1 + δ = gκδⁿ``; on a spring ``r = 1/(1 − 1/(gκ))``, for
``gκ > 1``.  With ``n > 1`` there is one radius for each stiffness: ``δⁿ/(1 + δ)`` grows from zero to infinity.  Slip is forward while
``νr < s``; a rotor that would whirl faster rolls.

Of the planar rotor ``(ν² − ω²) r = N`` and ``γνr = μN``, so that ``μ(ν² − ω²) = γν``: ``ν`` is the averaged threshold of the runaway on
a rigid wall (:func:`~carom.closed_forms.thresholds.sustaining_speed`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from scipy.linalg import eigvals  # type: ignore[import-untyped]

from carom.base.arguments import ArgumentKind, Positive, Whole, checked
from carom.base.outcome import InputError
from carom.closed_forms.statics import positive_roots
from carom.models import Subject, System, rotor_of
from carom.models.subjects import refuse_forces

Exponent = Annotated[float, ArgumentKind(lambda number: number >= 1.0, "a number of at least 1")]
REAL = 1e-6
"""Imaginary part, relative to the fastest mode, up to which a zero is tried as a real one: rounding splits double ones by its root."""
EXACT = 1e-10
"""What may be left of the imaginary part of ``g``, relative to its modulus."""
CLOSEST = 4 * 2.220446049250313e-16
"""Last step of Newton's method that counts as rounding: close to a resonance ``g`` changes by more than :data:`EXACT` in it."""
NEWTON_STEPS = 8


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
def slipping_whirls(
    machine: Subject, stiffness: Positive, exponent: Exponent = 1.0, *, plane: Whole = 0
) -> tuple[SlippingWhirl, ...]:
    """All slipping backward whirls of a rotor without unbalance on one plane, derived in :mod:`carom.closed_forms.compliant_walls`.

    Their speeds depend on the rotor and on friction alone, their radii on the wall.  Stability is not judged, and whether other planes
    are clear is not asked.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        Any linear rotor; its unbalance and the law of its walls are not used.  A race that turns counts as held.
    stiffness : float
        ``κ`` of the force ``κδⁿ`` per effective mass, in ``Ω²`` and clearances.
    exponent : float
        ``n``, at least 1; 1 for a Kelvin–Voigt wall.
    plane : int
        The plane in contact.

    Returns
    -------
    tuple of SlippingWhirl
        By growing speed; none without friction or damping, and where the wall is too soft to hold the rotor.

    Raises
    ------
    InputError
        There is no such plane, a value is not allowed, or forces on the rotor change with time.

    See Also
    --------
    carom.closed_forms.runaway_speed : the speed as a threshold of the planar rotor on a rigid wall

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/source-paper.toml")
    >>> for whirl in cm.closed_forms.slipping_whirls(machine, stiffness=1e4):
    ...     print(f"{whirl.speed:.9f}, {whirl.radius:.9f}")
    1.163219537, 1.000077554
    """
    model = rotor_of(machine)
    refuse_forces(model)
    system = model.system
    if plane >= (count := len(system.arrays["rows"])):
        raise InputError("plane", plane, f"a contact plane of the rotor, from 0 to {count - 1}")
    surface = float(system.arrays["surface_speed"][plane]) - 1.0
    whirls = []
    for speed, lever in _slipping_speeds(system, plane):
        for depth in positive_roots([(exponent, lever * stiffness), (1.0, -1.0), (0.0, -1.0)]):
            force, radius = stiffness * depth**exponent, 1.0 + depth
            whirls.append(SlippingWhirl(speed, radius, force, slips=bool(speed * radius < surface)))
    return tuple(whirls)


def _slipping_speeds(system: System, plane: int) -> list[tuple[float, float]]:
    """Speeds ``ν > 0`` at which ``g`` is positive, and ``g`` there."""
    free = np.asarray(system.free)
    generator = 1j * system.generator[np.ix_(free, free)]
    row = -1j * complex(1.0, system.arrays["friction"][plane]) * system.arrays["rows"][plane][free]
    column = system.arrays["columns"][free, plane]
    size, fastest = len(generator), float(np.abs(generator).max())
    pencil, shifts = np.zeros((2 * size + 1, 2 * size + 1), complex), np.diag([*np.ones(2 * size), 0.0])
    parts = (generator, row, column), (generator.conj(), -row.conj(), column.conj())
    for part, (matrix, out, into) in enumerate(parts):
        here = slice(part * size, (part + 1) * size)
        pencil[here, here], pencil[-1, here], pencil[here, -1] = matrix, out * fastest, into
    zeros: np.ndarray = eigvals(pencil, shifts)
    found = set()
    for zero in zeros[np.isfinite(zeros)]:
        if zero.real > 1.0 and abs(zero.imag) <= REAL * fastest:
            turn, lever, step = _refined(generator, row, column, float(zero.real))
            is_zero = abs(lever.imag) <= EXACT * abs(lever) or abs(step) <= CLOSEST * turn
            if lever.real > 0.0 and is_zero and turn > 1.0:
                found.add((turn - 1.0, lever.real))
    return sorted(found)


def _refined(generator: np.ndarray, row: np.ndarray, column: np.ndarray, turn: float) -> tuple[float, complex, float]:
    """Real zero of ``Im g`` near ``1 + ν`` by Newton's method, ``g`` there, and the last step."""
    identity = np.eye(len(generator))
    lever, step = 0j, np.inf
    for _ in range(NEWTON_STEPS):
        moved = np.linalg.solve(turn * identity - generator, column)
        lever = complex(row @ moved)
        slope = -complex(row @ np.linalg.solve(turn * identity - generator, moved)).imag
        if slope == 0.0 or lever.imag == 0.0:
            break
        step = lever.imag / slope
        turn -= step
    return turn, lever, step
