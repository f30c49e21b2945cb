"""Equilibria in the co-rotating frame: contact-free levitation and synchronous rub."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from carom.models import Jeffcott, Subject, jeffcott_of
from carom.results import Result

Kind = Literal["contact-free", "rub"]
Status = Literal["admissible", "boundary", "virtual"]

BOUNDARY = 1e-12
"""Distance from the wall (in clearances) or normal force (in ``m c_r Ω²``) that counts as zero."""
NEUTRAL = 64 * np.finfo(float).eps
"""Rounding error of the exponents along the wall, relative to the largest."""


@dataclass(frozen=True, eq=False, repr=False)
class Equilibrium(Result):
    """A synchronous motion: at rest in the co-rotating frame, a circle in the fixed one.

    Attributes
    ----------
    kind : {"contact-free", "rub"}
    position : complex
        ``U*`` in clearances.
    normal_force : float
        ``N`` in ``m c_r Ω²``; zero for the contact-free one.
    status : {"admissible", "boundary", "virtual"}
        Contact-free: inside, on or outside the wall.  Rub: pressed on the wall, just touching, or only possible if the
        wall could pull.
    eigenvalues : ndarray of complex
        Exponents of small disturbances; for a rub those along the wall.
    stable : bool
        Whether small disturbances die out, including those that lift a rubbing rotor off the wall.
    """

    kind: Kind
    position: complex
    normal_force: float
    status: Status
    eigenvalues: np.ndarray
    stable: bool

    @property
    def radius(self) -> float:
        """``|U*|`` in clearances."""
        return abs(self.position)

    @property
    def attracts_sliding(self) -> bool:
        """Whether a rub attracts, as long as nothing lifts the rotor off the wall."""
        return self.kind == "rub" and self.status == "admissible" and _dies_out(self.eigenvalues)

    @property
    def angle(self) -> float:
        """``arg U*`` in rad."""
        return float(np.angle(self.position))


def find_equilibria(machine: Subject) -> tuple[Equilibrium, ...]:
    """All equilibria: the contact-free one, then the synchronous rubs (none or two, the stable one first).

    Contact-free: ``U* = ρe^{iφ}/(ω² − 1 + iγ)``, source paper (3.7).

    Synchronous rub: the contact force ``−N(1 + iμ)e^{iθ}`` (slip is forward, ``s + 1 > 0``) acts through the static
    receptance ``H = −W M⁻¹ B`` of the contact plane, so ``e^{iθ}(1 + hN) = U*`` with ``h = H(1 + iμ)``, and
    ``|h|²N² + 2 Re(h) N + 1 − |U*|² = 0``.  For the planar rotor ``H = 1/(ω² − 1 + iγ)``, which is
    ``ρ sin x + μρ cos x = −γ − μ(1 − ω²)``, ``N = ρ cos x + 1 − ω²`` with ``x = θ − φ``.

    For a balanced rotor (``ρ = 0``) no rub is listed, because no angle is distinguished: if ``γ + μ(1 − ω²) = 0``, as
    without damping and friction, it may rub at every angle, otherwise at none.
    """
    rotor = jeffcott_of(machine)
    return (_contact_free(rotor), *_rubs(rotor))


def _contact_free(rotor: Jeffcott) -> Equilibrium:
    eigenvalues = rotor.system.exponents
    gap = 1.0 - abs(rotor.equilibrium)
    stable = bool(eigenvalues.real.max() < 0.0)
    return Equilibrium("contact-free", rotor.equilibrium, 0.0, _status(gap), eigenvalues, stable)


def _status(margin: float) -> Status:
    if abs(margin) <= BOUNDARY:
        return "boundary"
    return "admissible" if margin > 0 else "virtual"


def _rubs(rotor: Jeffcott) -> list[Equilibrium]:
    arrays = rotor.system.arrays
    grip = complex(1.0, arrays.friction[0])
    receptance = -complex(arrays.rows[0] @ np.linalg.solve(rotor.system.generator, arrays.columns[:, 0]))
    h = receptance * grip
    reach = abs(h) * abs(rotor.equilibrium)
    if reach < abs(h.imag) or reach == 0.0:
        return []
    # The square root of Re(h)² − |h|²(1 − |U*|²), and 1 + hN below, in forms that neither cancel nor underflow.
    distance = float(np.sqrt(reach - abs(h.imag)) * np.sqrt(reach + abs(h.imag)))
    rubs = []
    for root in (distance, -distance):
        force = float((root - h.real) / abs(h) ** 2)
        position = rotor.equilibrium * h.conjugate() / complex(root, -h.imag)
        position /= abs(position)
        eigenvalues = _eigenvalues_along_wall(rotor, position, force)
        stable = _dies_out(eigenvalues) and force > 0.0 and bool(arrays.restitution[0] < 1.0)
        rubs.append(Equilibrium("rub", position, force, _status(force), eigenvalues, stable))
    return sorted(rubs, key=lambda rub: not rub.stable)


def _dies_out(eigenvalues: np.ndarray) -> bool:
    """Whether disturbances along the wall die out, with a margin above the rounding errors."""
    return bool(eigenvalues.real.max() < -NEUTRAL * np.abs(eigenvalues).max())


def _eigenvalues_along_wall(rotor: Jeffcott, position: complex, force: float) -> np.ndarray:
    """Exponents of small disturbances of a rub that maintain contact and slip.

    With ``n = e^{iθ}`` the contact force changes by ``−(1 + iμ)n (δN + iN δθ)``.  Staying on the wall,
    ``Re(n̄ δÿ) = 0`` gives ``δN = Re(n̄ W M² δc) + μN δθ``.  The motion is then restricted to disturbances with
    ``Re(n̄ δy) = Re(n̄ δẏ) = 0``.
    """
    arrays = rotor.system.arrays
    modes = len(arrays.exponents)
    grip = complex(1.0, arrays.friction[0])
    inward = position.conjugate()

    def rate(change: np.ndarray) -> np.ndarray:
        turn = (inward * (arrays.rows[0] @ change)).imag
        push = (inward * (arrays.acceleration_rows[0] @ change)).real + arrays.friction[0] * force * turn
        return rotor.system.generator @ change - arrays.columns[:, 0] * grip * position * (push + 1j * force * turn)

    def as_real(vector: np.ndarray) -> np.ndarray:
        return np.concatenate([vector.real, vector.imag])

    units = np.concatenate([np.eye(modes), 1j * np.eye(modes)])
    matrix = np.array([as_real(rate(unit)) for unit in units]).T
    constraints = np.array(
        [[(inward * (row @ unit)).real for unit in units] for row in (arrays.rows[0], arrays.rate_rows[0])]
    )
    _, _, directions = np.linalg.svd(constraints)
    along = directions[2:].T
    return np.linalg.eigvals(along.T @ matrix @ along).astype(complex)
