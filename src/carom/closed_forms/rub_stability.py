"""Whether a synchronous rub attracts sliding: the motion next to it, linearised, for any modes and contact planes.

With the planes ``p`` of a set in forward slip, ``ċ = Mc − Σ B_p (1 + iμ_p) N_p y_p`` where the normal forces solve
``Σ_q A_pq N_q = w_p``, ``A_pq = Re(ȳ_p G_pq (1 + iμ_q) y_q)`` and ``w_p = Re(ȳ_p a_p) + |ẏ_p|²`` (see
:mod:`carom.core.contact_series`).  At rest ``ẏ = 0``, so

    A δN = Re(δȳ a + ȳ δa) − δA N,

and small motions keep ``Re(ȳ_p δy_p) = Re(ȳ_p δẏ_p) = 0``.

A plane in a compliant wall is free to move along its normal ``n = y/|y|``.  Its force ``−(1 + iμ) N n`` follows from the law, with
``δN = N_δ Re(n̄δy) + N_δ̇ Re(n̄δẏ)`` and ``δn = i n Im(n̄δy)/|y|``, and adds to the accelerations ``a`` of the others.
"""

from __future__ import annotations

import numpy as np

from carom.base.outcome import Phase
from carom.core.friction import FORWARD, friction_ratio
from carom.core.laws.choice import force_change, force_coefficient
from carom.models import System


def rub_attracts(system: System, amplitudes: np.ndarray, contact: np.ndarray) -> bool:
    """Whether sliding next to a synchronous rub approaches it."""
    return bool((sliding_rates(system, amplitudes, contact).real < 0.0).all())


def sliding_rates(system: System, amplitudes: np.ndarray, contact: np.ndarray) -> np.ndarray:
    """Exponents, in ``Ω``, of the sliding motions next to a synchronous rub; shape (4n − 2C,) for ``C`` rigid planes in contact.

    The amplitudes (N,) are those of the rub, at rest in the co-rotating frame.  The state of contact (P,) is
    ``FORWARD_SLIP`` at each plane that rubs.
    """
    stiffness, rubs = system.arrays["stiffness"], np.flatnonzero(contact == Phase.FORWARD_SLIP)
    pressed, rubs = rubs[stiffness[rubs] > 0.0], rubs[stiffness[rubs] == 0.0]
    # Real and imaginary parts of all free amplitudes are changed by one, in turn.
    free = np.eye(len(amplitudes))[system.free]
    changes = np.concatenate([free, 1j * free])
    forces, pulls = np.zeros(len(pressed), complex), np.zeros((len(changes), len(pressed)), complex)
    for place, plane in enumerate(pressed.tolist()):
        forces[place], pulls[:, place] = _in_wall(system, plane, amplitudes, changes)
    rates = changes @ system.generator.T
    if len(pressed):
        rates = rates + pulls @ system.arrays["columns"][:, pressed].T
    if len(rubs):
        beside = system.arrays["mobility"][np.ix_(rubs, pressed)]
        return _on_walls(system, rubs, amplitudes, changes, rates, beside @ forces, pulls @ beside.T)
    rates = rates[:, system.free]
    return np.linalg.eigvals(np.concatenate([rates.real, rates.imag], axis=1).T)


def _on_walls(
    system: System,
    rubs: np.ndarray,
    amplitudes: np.ndarray,
    changes: np.ndarray,
    rates: np.ndarray,
    pulled: np.ndarray,
    pulls: np.ndarray,
) -> np.ndarray:
    """Exponents of motions that slide on rigid walls at some planes (C,), from changes (M, N) and their rates without these forces.

    The other planes pull these ones with accelerations (C,), which change by (M, C).
    """
    arrays = system.arrays
    rows, columns = arrays["rows"][rubs], arrays["columns"][:, rubs]
    grip = 1.0 + 1j * arrays["friction"][rubs]
    y, a = rows @ amplitudes + arrays["offsets"][rubs], arrays["acceleration_rows"][rubs] @ amplitudes + pulled
    mobility = arrays["mobility"][np.ix_(rubs, rubs)] * grip
    matrix = (y.conj()[:, None] * mobility * y).real
    push = np.linalg.solve(matrix, (y.conj() * a).real)
    dy, da = changes @ rows.T, changes @ arrays["acceleration_rows"][rubs].T + pulls
    turned = dy.conj()[:, :, None] * mobility * y + y.conj()[:, None] * mobility * dy[:, None, :]
    right = (dy.conj() * a + y.conj() * da).real - turned.real @ push
    force = -grip * (np.linalg.solve(matrix, right.T).T * y + push * dy)
    rates = (rates + force @ columns.T)[:, system.free]
    jacobian = np.concatenate([rates.real, rates.imag], axis=1).T
    across = np.concatenate([(y.conj() * dy).real, (y.conj() * (changes @ arrays["rate_rows"][rubs].T)).real], axis=1)
    along = np.linalg.svd(across.T)[2][2 * len(rubs) :]
    return np.linalg.eigvals(along @ jacobian @ along.T)


def _in_wall(system: System, plane: int, amplitudes: np.ndarray, changes: np.ndarray) -> tuple[complex, np.ndarray]:
    """Contact force of a plane at rest in a compliant wall, and how changes (M, N) of the amplitudes change it, shape (M,)."""
    contact, arrays = system.contacts[plane], system.arrays
    y = complex(contact.row @ amplitudes) + contact.offset
    normal, radius, wall = y / abs(y), abs(y), contact.wall
    moved = (changes @ contact.row) * normal.conjugate()
    deeper, faster = moved.real, (normal.conjugate() * (changes @ arrays["rate_rows"][plane])).real
    depth, rest, power, power_change = np.array([radius - 1.0]), np.zeros(1), np.zeros(1), np.zeros(1)
    push = force_coefficient(0, depth, rest, power, wall)
    ratio = complex(-1.0, friction_ratio(FORWARD, wall))
    stiffness, damping = (
        force_change(0, depth, rest, power, np.array([by_depth]), np.array([by_rate]), power_change, wall)
        for by_depth, by_rate in ((1.0, 0.0), (0.0, 1.0))
    )
    turned = 1j * moved.imag / radius
    return ratio * push * normal, ratio * normal * (stiffness * deeper + damping * faster + push * turned)
