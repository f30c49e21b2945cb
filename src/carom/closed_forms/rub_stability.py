"""Whether a synchronous rub attracts sliding: the motion next to it, linearised, for any modes and contact planes.

With the planes ``p`` of a set in forward slip, ``ċ = Mc − Σ B_p (1 + iμ_p) N_p y_p`` where the normal forces solve
``Σ_q A_pq N_q = w_p``, ``A_pq = Re(ȳ_p G_pq (1 + iμ_q) y_q)`` and ``w_p = Re(ȳ_p a_p) + |ẏ_p|²`` (see
:mod:`carom.core.contact_series`).  At rest ``ẏ = 0``, so

    A δN = Re(δȳ a + ȳ δa) − δA N,

and small motions keep ``Re(ȳ_p δy_p) = Re(ȳ_p δẏ_p) = 0``.
"""

from __future__ import annotations

import numpy as np

from carom.models import System
from carom.outcome import Phase


def rub_attracts(system: System, amplitudes: np.ndarray, contact: np.ndarray) -> bool:
    """Whether sliding next to a synchronous rub approaches it."""
    return bool((sliding_rates(system, amplitudes, contact).real < 0.0).all())


def sliding_rates(system: System, amplitudes: np.ndarray, contact: np.ndarray) -> np.ndarray:
    """Exponents, in ``Ω``, of the sliding motions next to a synchronous rub; shape (4n − 2C,) for ``C`` planes in contact.

    The amplitudes (N,) are those of the rub, at rest in the co-rotating frame.  The state of contact (P,) is
    ``FORWARD_SLIP`` at each plane that rubs.
    """
    arrays = system.arrays
    rubs = np.flatnonzero(contact == Phase.FORWARD_SLIP)
    rows, columns = arrays["rows"][rubs], arrays["columns"][:, rubs]
    grip = 1.0 + 1j * arrays["friction"][rubs]
    # Real and imaginary parts of all free amplitudes are changed by one, in turn.
    free = np.eye(len(amplitudes))[system.free]
    changes = np.concatenate([free, 1j * free])
    y, a = rows @ amplitudes + arrays["offsets"][rubs], arrays["acceleration_rows"][rubs] @ amplitudes
    mobility = arrays["mobility"][np.ix_(rubs, rubs)] * grip
    matrix = (y.conj()[:, None] * mobility * y).real
    push = np.linalg.solve(matrix, (y.conj() * a).real)
    dy, da = changes @ rows.T, changes @ arrays["acceleration_rows"][rubs].T
    turned = dy.conj()[:, :, None] * mobility * y + y.conj()[:, None] * mobility * dy[:, None, :]
    right = (dy.conj() * a + y.conj() * da).real - turned.real @ push
    force = -grip * (np.linalg.solve(matrix, right.T).T * y + push * dy)
    rates = (changes @ system.generator.T + force @ columns.T)[:, system.free]
    jacobian = np.concatenate([rates.real, rates.imag], axis=1).T
    across = np.concatenate([(y.conj() * dy).real, (y.conj() * (changes @ arrays["rate_rows"][rubs].T)).real], axis=1)
    along = np.linalg.svd(across.T)[2][2 * len(rubs) :]
    return np.linalg.eigvals(along @ jacobian @ along.T)
